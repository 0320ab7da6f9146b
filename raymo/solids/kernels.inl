// All kernels that are computed within the walk, for several rays at once, to be included inside a namespace of one's own,
// once per instruction set. Needs <limits>, math/tolerance.hpp, solids/span.hpp, and the lane_... functions for the types R
// and M in use.
#include "raymo/solids/interval.inl"
//
#include "raymo/solids/block/kernel.inl"
#include "raymo/solids/cone/kernel.inl"
#include "raymo/solids/cylinder/kernel.inl"
#include "raymo/solids/halfspace/kernel.inl"
#include "raymo/solids/sphere/kernel.inl"
#include "raymo/solids/torus/kernel.inl"
//
#include "raymo/solids/torus/normal.inl"
