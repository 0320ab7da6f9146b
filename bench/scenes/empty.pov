// Next to nothing: what a process and a picture cost before any scene. The same scene in SML: empty.raymo.
#version 3.7;
global_settings { assumed_gamma 1.0 max_trace_level 8 adc_bailout 1/512 ambient_light rgb 1 }
background { srgb <0.35, 0.38, 0.43> }
light_source { <-30, 50, -40> rgb 1 }
camera { perspective location <0, 0, -20> up y right x*image_width/image_height angle 46 look_at <0, 0, 0> }
sphere { <0, 0, 0>, 0.01 pigment { srgb 0.8 } finish { ambient 0.1 diffuse 0.7 } }
