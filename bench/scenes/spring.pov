// A spring of twelve turns between two seats: one cubic B-spline of 147 points. The same scene in SML: spring.raymo.
// POV-Ray is left-handed with y up, RAYMO right-handed with z up: <a, b, c> here is (a, c, b) there.
// Declare=Flat=1 leaves out light and shading: every surface then shows the pure colour of its class.
#version 3.7;
#ifndef (Flat) #declare Flat = 0; #end
global_settings { assumed_gamma 1.0 max_trace_level 8 adc_bailout 1/512 ambient_light rgb 1 }
#if (Flat)
  #default { finish { ambient 1 diffuse 0 specular 0 } }
  background { rgb 0 }
#else
  #default { finish { ambient 0.1 diffuse 0.7 specular 0.3 roughness 0.02 } }
  background { srgb <0.35, 0.38, 0.43> }
  light_source { <-30, 50, -40> rgb 1 }
#end
camera { perspective location <4, 9, -21> up y right x*image_width/image_height angle 54 look_at <0, 5.6, 0> }

#macro Paint(Colour, Class) pigment { #if (Flat) srgb Class #else srgb Colour #end } #end

sphere_sweep {
  b_spline 147,
  #for (I, 0, 146) <4*cos(radians(30*I)), I/12, 4*sin(radians(30*I))>, 0.32 #if (I < 146) , #end #end
  Paint(<0.75, 0.76, 0.8>, <1, 0, 0>) }
cylinder { <0, -0.9, 0>, <0, -0.2, 0>, 5.2 Paint(<0.3, 0.4, 0.55>, <0, 1, 0>) }
cylinder { <0, 12.4, 0>, <0, 13.1, 0>, 5.2 Paint(<0.55, 0.4, 0.3>, <1, 1, 0>) }
box { <-60, -2, -60>, <60, -1, 60> Paint(<0.8, 0.8, 0.8>, <0, 0, 1>) }
