// From a mesh to patches.
#pragma once

#include "raymo/meshes/mesh.hpp"
#include "raymo/meshes/shell.hpp"

namespace raymo::meshes {

/// Patches of a smoothed mesh, at most.
inline constexpr std::size_t kMostSmoothPatches = 0x40000;

/// The closed surface that a closed mesh describes: uniform bicubic B-splines where four faces of four sides meet in each
/// point, and patches with the same tangent planes across all of their borders elsewhere; creases stay sharp. The faces may all
/// be listed clockwise; they are turned. A crease may end where the surface is smooth: its sides become one there.
/// Error, with `argument` 0: those of close(); the mesh bounds no volume; too many patches come of it.
/// Cost: linear in the number of patches: one for each face of a mesh that is regular everywhere, else four for each corner of
/// a face.
[[nodiscard]] Result<Shell> smooth(const Mesh& mesh);

}  // namespace raymo::meshes
