// The bodies and lids of eight of Martin Newell's teapots, of 28 bicubic patches each, over a floor. The same scene in
// SML: teapot.raymo.
// POV-Ray is left-handed with y up, RAYMO right-handed with z up: <a, b, c> here is (a, c, b) there, and a rotation by
// an angle here is one by the opposite angle there.
// Declare=Flat=1 leaves out light and shading: every surface then shows the pure colour of its class.
// Declare=Steps=N halves each patch N times both ways, into 2 * 4^N triangles.
// Declare=Depths=1 writes, in place of a picture, how far the nearest pot is away along 200 x 200 rays of the picture.
#version 3.7;
#ifndef (Flat) #declare Flat = 0; #end
#ifndef (Steps) #declare Steps = 5; #end
#ifndef (Depths) #declare Depths = 0; #end
global_settings { assumed_gamma 1.0 max_trace_level 8 adc_bailout 1/512 ambient_light rgb 1 }
#if (Flat)
  #default { finish { ambient 1 diffuse 0 specular 0 } }
  background { rgb 0 }
#else
  #default { finish { ambient 0.1 diffuse 0.7 specular 0.3 roughness 0.02 } }
  background { srgb <0.35, 0.38, 0.43> }
  light_source { <-30, 50, -40> rgb 1 }
#end
camera { perspective location <0, 9, -16> up y right x*image_width/image_height angle 44 look_at <0, 1.4, 0> }

#macro Paint(Colour, Class) pigment { #if (Flat) srgb Class #else srgb Colour #end } #end

// Edges that are turned about y: radii and heights of control points.
#declare Edges = array[7][4] {
  { <0, 3.15>, <0.8, 3.15>, <0, 2.85>, <0.2, 2.7> }
  { <0.2, 2.7>, <0.4, 2.55>, <1.3, 2.55>, <1.3, 2.4> }
  { <1.3, 2.4>, <1.335, 2.4>, <1.365, 2.4>, <1.4, 2.4> }
  { <1.4, 2.4>, <1.3375, 2.53125>, <1.4375, 2.53125>, <1.5, 2.4> }
  { <1.5, 2.4>, <1.75, 1.875>, <2, 1.35>, <2, 0.9> }
  { <2, 0.9>, <2, 0.45>, <1.5, 0.225>, <1.5, 0.15> }
  { <1.5, 0.15>, <1.5, 0.075>, <1.425, 0>, <0, 0> } }
#declare Arc = array[4] { <1, 0>, <1, 0.56>, <0.56, 1>, <0, 1> }
// K quarter turns.
#macro Turned(P, K)
  #local X = P.x;
  #local Z = P.z;
  #for (I, 1, K) #local T = X; #local X = -Z; #local Z = T; #end
  <X, P.y, Z>
#end

#declare Pot = union {
  #for (E, 0, 6)
    #for (K, 0, 3)
      bicubic_patch { type 1 flatness 0 u_steps Steps v_steps Steps
        #for (I, 0, 3)
          #for (J, 0, 3)
            Turned(<Edges[E][J].u*Arc[I].u, Edges[E][J].v, Edges[E][J].u*Arc[I].v>, K) #if (I+J < 6) , #end
          #end
        #end }
    #end
  #end }

#macro Placed(I, J) rotate z*(-8*I) rotate y*(20*I+35*J) translate <-6+4*I+J, 0.35*I, 3-5*J> #end
#declare Pots = union {
  #for (I, 0, 3)
    #for (J, 0, 1)
      object { Pot Placed(I, J) Paint(<0.9-0.15*I, 0.6, 0.3+0.3*J>, <mod(I, 2), 1-mod(I, 2), J>) }
    #end
  #end }

#if (Depths)
  #fopen File "depths.txt" write
  #for (J, 0, 199)
    #for (I, 0, 199)
      #local N = <0, 0, 0>;
      #local Eye = <0, 9, -16>;
      #local D = <((2*I+1)/200-1)*0.4, -7.6/16+((2*J+1)/200-1)*0.3, 1>;
      #local P = trace(Pots, Eye, D, N);
      #if (vlength(N) > 0) #write (File, str(P.z+16, 0, 15), "\n") #else #write (File, "-\n") #end
    #end
  #end
  #fclose File
#else
  object { Pots }
  box { <-60, -3, -60>, <60, -2, 60> Paint(<0.8, 0.8, 0.8>, <0, 0, 1>) }
#end
