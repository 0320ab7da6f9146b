// A prism of a spline outline with ten round holes and ten of splines. The same scene in SML: prism_holes.raymo.
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
camera { perspective location <3, 19, -17> up y right x*image_width/image_height angle 44 look_at <0, 0, -0.2> }

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

#declare Outline = array[12];
#for (I, 0, 11)
  #local R = (mod(I, 2) ? <8.6, 6.6> : <11, 8>);
  #declare Outline[I] = <R.u*cos(radians(30*I)), R.v*sin(radians(30*I))>;
#end
// Four Bezier curves that make a circle to 0.03 %.
#macro Round(X, Y, R)
  #local K = 0.5523*R;
  <X+R, Y>, <X+R, Y+K>, <X+K, Y+R>, <X, Y+R>, <X, Y+R>, <X-K, Y+R>, <X-R, Y+K>, <X-R, Y>,
  <X-R, Y>, <X-R, Y-K>, <X-K, Y-R>, <X, Y-R>, <X, Y-R>, <X+K, Y-R>, <X+R, Y-K>, <X+R, Y>
#end
#macro Leaf(X, Y, Turn)
  #local P = array[6];
  #for (J, 0, 5)
    #local R = (mod(J, 3) ? 0.75 : 1.9);
    #local P[J] = <X+R*cos(radians(60*J+Turn)), Y+R*sin(radians(60*J+Turn))>;
  #end
  #for (J, 0, 5) Span(P, J) #if (J < 5) , #end #end
#end

prism {
  bezier_spline linear_sweep -1.2, 0, 4*12+10*16+10*24, #for (I, 0, 11) Span(Outline, I) , #end
  #for (I, 0, 19)
    #local A = (I < 12 ? 30*I+15 : 45*I);
    #local X = (I < 12 ? 7.8 : 4)*cos(radians(A));
    #local Y = (I < 12 ? 5.3 : 2.4)*sin(radians(A));
    #if (mod(I, 2)) Leaf(X, Y, A) #else Round(X, Y, 0.8) #end
    #if (I < 19) , #end
  #end
  Paint(<0.45, 0.6, 0.8>, <1, 0, 0>) }
box { <-60, -4, -60>, <60, -3, 60> Paint(<0.8, 0.8, 0.8>, <0, 0, 1>) }
