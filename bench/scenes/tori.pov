// Two rows of twelve tori over a floor. The same scene in SML: tori.raymo.
// POV-Ray is left-handed with y up, RAYMO right-handed with z up: <a, b, c> here is (a, c, b) there, and a rotation by
// an angle here is one by the opposite angle there.
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
camera { perspective location <0, 5.5, -18> up y right x*image_width/image_height angle 58 look_at <0, -0.4, -1> }

#macro Paint(Colour, Class) pigment { #if (Flat) srgb Class #else srgb Colour #end } #end

#for (I, 0, 11)
  torus { 1, 0.35 rotate x*90 rotate y*(15*I) translate <-7.7+1.4*I, 0, 0> Paint(<1-0.04*I, 0.66, 0.58+0.03*I>, <1, 0, 0>) }
  torus { 0.8, 0.05+0.05*I rotate z*(10*I) translate <-7.7+1.4*I, -0.2, -3> Paint(<0.58, 1-0.04*I, 0.66>, <0, 1, 0>) }
#end
box { <-60, -2.6, -60>, <60, -1.6, 60> Paint(<0.8, 0.8, 0.8>, <0, 0, 1>) }
