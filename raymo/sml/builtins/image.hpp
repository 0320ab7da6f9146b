// Images of values under affine maps.
#pragma once

#include "raymo/sml/builtins/call.hpp"

namespace raymo::sml {

/// The image of a solid, a contour, a path, a transformation (first it, then the map) or a list of shapes. Contours stay in
/// their plane and paths keep their spheres round, or else an error points at the argument `blame`, of which the map was made.
/// `shape` may be left missing.
bool apply(Call& call, Value& shape, const Affine& map, std::size_t blame, Value& out);

}  // namespace raymo::sml
