// Fifty sweeps of varying radius, ten stems and forty leaves, in a turned pot. The same scene in SML: plant.raymo.
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
camera { perspective location <2, 13, -22> up y right x*image_width/image_height angle 44 look_at <0, 4.6, 0> }

#macro Paint(Colour, Class) pigment { #if (Flat) srgb Class #else srgb Colour #end } #end

// Stems rise from the pot and lean outwards; leaves are thick in the middle and hang over.
#macro Leaf(Turn, Rise, Reach, Thick)
  sphere_sweep {
    b_spline 6,
    #for (J, 0, 5)
      #local R = 0.4+Reach*J/5;
      <R*cos(radians(Turn+4*J)), Rise+0.6*J+Rise*J/5-0.13*J*J*J*Reach/6, R*sin(radians(Turn+4*J))>,
      (J < 5 ? 0.12+Thick*J*(5-J) : 0.02) #if (J < 5) , #end
    #end
    Paint(<0.3, 0.65, 0.3>, <0, 1, 0>) }
#end
#macro Stem(Turn, Height)
  sphere_sweep {
    b_spline 7,
    #for (J, 0, 6)
      #local R = 0.3+0.08*J*J;
      <R*cos(radians(Turn)), Height*J/6-1, R*sin(radians(Turn))>, (J < 5 ? 0.2-0.02*J : (J = 5 ? 0.45 : 0.3))
      #if (J < 6) , #end
    #end
    Paint(<0.8, 0.45, 0.5>, <1, 1, 0>) }
#end
#for (I, 0, 39) Leaf(137.5*I, 0.05*I, 6.5-0.1*I, 0.03) #end
#for (I, 0, 9) Stem(36*I, 8+mod(3*I, 5)) #end
lathe {
  bezier_spline 16,
  <0, -5>, <1, -5>, <2, -5>, <2.6, -5>
  <2.6, -5>, <2.9, -4>, <3.8, -1>, <4, 0>
  <4, 0>, <4.1, 0.5>, <3.7, 0.5>, <3.6, 0>
  <3.6, 0>, <3, -0.4>, <1, -0.4>, <0, -0.4>
  Paint(<0.75, 0.4, 0.28>, <1, 0, 0>) }
box { <-60, -6, -60>, <60, -5.01, 60> Paint(<0.8, 0.8, 0.8>, <0, 0, 1>) }
