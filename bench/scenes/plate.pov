// A plate with 2,500 holes over a floor. The same scene in SML: plate.raymo.
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
camera { perspective location <9, 15, -22> up y right x*image_width/image_height angle 50 look_at <0, -0.5, -0.5> }

#macro Paint(Colour, Class) pigment { #if (Flat) srgb Class #else srgb Colour #end } #end

difference {
  box { <-10, -0.25, -10>, <10, 0.25, 10> Paint(<0.9, 0.76, 0.58>, <1, 0, 0>) }
  #for (I, 0, 49)
    #for (J, 0, 49)
      cylinder { <-9.8+0.4*I, -0.5, -9.8+0.4*J>, <-9.8+0.4*I, 0.5, -9.8+0.4*J>, 0.14 Paint(<0.9, 0.76, 0.58>, <0, 1, 0>) }
    #end
  #end
}
box { <-60, -4, -60>, <60, -3, 60> Paint(<0.8, 0.8, 0.8>, <0, 0, 1>) }
