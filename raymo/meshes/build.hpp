// Meshes of common shapes, to be smoothed.
#pragma once

#include "raymo/math/vec2.hpp"
#include "raymo/meshes/mesh.hpp"

namespace raymo::meshes {

/// A box with one corner in the origin, each side cut into so many faces. Sizes > 0, 1 <= cuts.
[[nodiscard]] Mesh box_mesh(Vec3 size, std::array<Index, 3> cuts);

/// A polygon moved from z = 0 to h, its sides cut into `cuts` rings, its ends faces of as many sides as it has points. The
/// points may run either way round. Error, with `argument` 0: less than three points, a point twice in a row, no area.
[[nodiscard]] Result<Mesh> extrude_mesh(std::vector<Vec2> points, double h, Index cuts);

/// How the ends of a grid of points are closed: not at all, its rows to rings, or both ways (as a torus).
enum class Closing : std::uint8_t { none, rows, both };

/// Faces between rows of points. Rows that are rings become a closed mesh with the first and the last as faces; where all
/// points of such a row are the same, it is a tip of triangles. Error, with `argument` 0: rows too short, too few, of
/// different lengths.
[[nodiscard]] Result<Mesh> grid_mesh(const std::vector<std::vector<Vec3>>& rows, Closing closing);

}  // namespace raymo::meshes
