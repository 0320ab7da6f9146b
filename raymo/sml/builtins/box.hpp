// Boxes of values.
#pragma once

#include "raymo/sml/builtins/call.hpp"

namespace raymo::sml {

/// The box of argument `i`: of a solid, which must have a finite size; of a contour, with z from 0 to 0; of all balls of a
/// path; of the points of a mesh. False, with an error: it is none of these, empty or endless. Cost: as csg::bounds() for a
/// solid, linear for the others.
bool box_of(Call& call, std::size_t i, Aabb& out);

}  // namespace raymo::sml
