// A glass turned from one profile of splines, with balls on a floor behind it. The same scene in SML: wine_glass.raymo.
// POV-Ray is left-handed with y up, RAYMO right-handed with z up: <a, b, c> here is (a, c, b) there.
// Declare=Flat=1 leaves out light and shading: every surface then shows the pure colour of its class, the glass too.
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
camera { perspective location <3, 12, -24> up y right x*image_width/image_height angle 56 look_at <0, 6.6, 0> }

#macro Paint(Colour, Class) pigment { #if (Flat) srgb Class #else srgb Colour #end } #end

lathe {
  bezier_spline 36,
  <0, 0>, <1.2, 0>, <2.3, 0>, <3.4, 0>
  <3.4, 0>, <3.6, 0>, <3.6, 0.18>, <3.4, 0.2>
  <3.4, 0.2>, <1.6, 0.35>, <0.4, 0.5>, <0.36, 1.6>
  <0.36, 1.6>, <0.33, 2.6>, <0.33, 4>, <0.36, 5.2>
  <0.36, 5.2>, <0.42, 6.4>, <3.7, 6.6>, <3.7, 9.6>
  <3.7, 9.6>, <3.7, 11.2>, <3.1, 12.6>, <2.95, 13.9>
  <2.95, 13.9>, <2.936, 14.02>, <2.786, 14.02>, <2.8, 13.9>
  <2.8, 13.9>, <2.95, 12.6>, <3.54, 11.2>, <3.54, 9.6>
  <3.54, 9.6>, <3.54, 7>, <1.2, 6.45>, <0, 6.45>
  #if (Flat)
    pigment { srgb <0, 1, 0> }
  #else
    pigment { rgbt 1 }
    finish { ambient 0 diffuse 0 specular 0 reflection { 0, 1 fresnel } conserve_energy }
    interior { ior 1.5 }
  #end }
#for (I, 0, 6)
  #for (J, 0, 2)
    sphere { <3.6*I-10.8, 1.9+4.2*J, 7+J>, 1.8 Paint(<0.4+0.1*I, 0.7, 0.9-0.1*I>, <1, mod(I+J, 2), 0>) }
  #end
#end
box { <-60, -1, -60>, <60, -0.05, 60> Paint(<0.8, 0.8, 0.8>, <0, 0, 1>) }
