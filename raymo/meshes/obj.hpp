// Meshes that others have made, in Wavefront's OBJ.
#pragma once

#include <functional>
#include <string_view>

#include "raymo/meshes/mesh.hpp"

namespace raymo::meshes {

/// Asked before memory is taken, and now and then: whether to go on.
using GoOn = std::function<bool(double bytes)>;

/// The points (`v`) and faces (`f`) of an OBJ file; all else in it is passed over: normals, textures, groups, lines. Points
/// have the file's numbers as they are, which are taken for millimetres.
/// Error: a line that can not be read, with its number; or those of make_mesh; `cancelled` when told to stop.
/// Cost: linear in the text.
[[nodiscard]] Result<Mesh> read_obj(std::string_view text, const GoOn& go_on);

}  // namespace raymo::meshes
