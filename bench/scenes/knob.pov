// A turned knob within a knurled prism, with a tapered pointer, a dent and a collar. The same scene in SML: knob.raymo.
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
camera { perspective location <5.5, 13, -20> up y right x*image_width/image_height angle 44 look_at <0.2, 1.6, -0.2> }

#macro Paint(Colour, Class) pigment { #if (Flat) srgb Class #else srgb Colour #end } #end
// The Bezier points of the span of a closed uniform cubic B-spline that begins near its point P[I+1].
#macro Span(P, I)
  #local N = dimension_size(P, 1);
  #local A = P[mod(I, N)];
  #local B = P[mod(I+1, N)];
  #local C = P[mod(I+2, N)];
  #local D = P[mod(I+3, N)];
  (A+4*B+C)/6, (4*B+2*C)/6, (2*B+4*C)/6, (B+4*C+D)/6
#end

#declare Rim = array[36];
#for (I, 0, 35)
  #declare Rim[I] = (mod(I, 2) ? 5.2 : 6)*<cos(radians(10*I)), sin(radians(10*I))>;
#end
#declare Pointer = array[8] { <-0.9, -0.7>, <0, -0.9>, <0.9, -0.7>, <1.1, 2>, <0.7, 4.4>, <0, 5.6>, <-0.7, 4.4>,
                              <-1.1, 2> }

#declare Body = lathe {
  bezier_spline 16,
  <0, -1>, <2, -1>, <4, -1>, <6, -1>
  <6, -1>, <6.2, 0.4>, <6.1, 1.4>, <5.6, 2.6>
  <5.6, 2.6>, <5.2, 3.8>, <4.4, 4>, <3, 4>
  <3, 4>, <2, 4>, <1, 3.7>, <0, 3.7>
  Paint(<0.75, 0.2, 0.2>, <1, 0, 0>) }
#declare Grip = prism {
  bezier_spline linear_sweep -0.5, 5, 144, #for (I, 0, 35) Span(Rim, I) #if (I < 35) , #end #end
  Paint(<0.3, 0.32, 0.36>, <0, 1, 0>) }
#declare Mark = prism {
  conic_sweep bezier_spline 0.7, 1, 32, #for (I, 0, 7) Span(Pointer, I) #if (I < 7) , #end #end
  scale <1, -2/0.3, 1> translate <0, 2/0.3+3, 0>
  Paint(<0.9, 0.9, 0.85>, <1, 1, 0>) }

difference {
  union { intersection { object { Body } object { Grip } } object { Mark } }
  sphere { <0, 5.4, 3>, 0.8 Paint(<0.9, 0.35, 0.1>, <1, 0, 1>) } }
lathe {
  bezier_spline 12,
  <6.2, -0.9>, <7, -0.9>, <7.8, -1.1>, <7.8, -2>
  <7.8, -2>, <7.2, -2>, <6.8, -2>, <6.2, -2>
  <6.2, -2>, <6.2, -1.6>, <6.2, -1.2>, <6.2, -0.9>
  Paint(<0.75, 0.76, 0.8>, <0, 1, 1>) }
box { <-60, -3, -60>, <60, -1.5, 60> Paint(<0.8, 0.8, 0.8>, <0, 0, 1>) }
