// 10,000 blocks, spheres, cylinders, cones and tori, strewn at random over a floor. The same scene in SML: mixed.raymo.
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
  light_source { <-60, 100, -80> rgb 1 }
#end
camera { perspective location <20, 26, -62> up y right x*image_width/image_height angle 40 look_at <0, 1, 0> }

#macro Paint(Colour, Class) pigment { #if (Flat) srgb Class #else srgb Colour #end } #end

// Numbers in [0, 1) without state: cubes of a permutation of the whole numbers below 99,991, modulo 2^31 - 1. All
// products stay below 2^53, so every program computes the same numbers exactly.
#declare Mixed = function(n) { mod(n*7919 + 12345, 99991) };
#declare Random = function(n) { mod(Mixed(n)*Mixed(n)*Mixed(n), 2147483647)/2147483647 };

#for (K, 0, 9999)
  #declare N = 8*K;
  #declare S = 0.25 + 0.35*Random(N+3);
  #switch (mod(K, 5))
    #case (0) box { <-S, -0.5*S, -0.75*S>, <S, 0.5*S, 0.75*S> #break
    #case (1) sphere { <0, 0, 0>, S #break
    #case (2) cylinder { <0, -S, 0>, <0, S, 0>, 0.5*S #break
    #case (3) cone { <0, -S, 0>, 0.75*S, <0, S, 0>, 0.25*S #break
    #case (4) torus { 0.75*S, 0.25*S #break
  #end
    rotate x*(360*Random(N+4)) rotate y*(360*Random(N+5))
    translate <-20 + 40*Random(N), -9 + 18*Random(N+1), -20 + 40*Random(N+2)>
    Paint(<0.4 + 0.6*Random(N+6), 0.5 + 0.4*Random(N+7), 0.7>, <1, mod(K, 2), 0>)
  }
#end
box { <-150, -12, -150>, <150, -11, 150> Paint(<0.8, 0.8, 0.8>, <0, 0, 1>) }
