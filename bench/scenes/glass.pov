// 1,000 spheres behind a pane of glass. The same scene in SML: glass.raymo.
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
camera { perspective location <8, 7, -20> up y right x*image_width/image_height angle 46 look_at <0, -0.6, 0> }

#macro Paint(Colour, Class) pigment { #if (Flat) srgb Class #else srgb Colour #end } #end

#for (I, 0, 9)
  #for (J, 0, 9)
    #for (K, 0, 9)
      sphere { <I-4.5, J-4.5, K-4.5>, 0.4
               Paint(<0.48+0.05*I, 0.48+0.05*J, 0.48+0.05*K>, <1, mod(I+J+K, 2), 0>) }
    #end
  #end
#end
box { <-60, -7, -60>, <60, -6, 60> Paint(<0.8, 0.8, 0.8>, <0, 0, 1>) }
box { <-30, -5.5, -9>, <30, 20, -8>
      pigment { rgbt 1 }
      finish { ambient 0 diffuse 0 specular 0 reflection { 0, 1 fresnel } conserve_energy }
      interior { ior 1.5 } }
