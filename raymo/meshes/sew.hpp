// Patches that are given one by one, as a closed surface.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "raymo/core/result.hpp"
#include "raymo/meshes/shell.hpp"

namespace raymo::meshes {

/// Control points b_ij at 4 i + j.
using GivenNet = std::array<Vec3, 16>;
using NetsPtr = std::shared_ptr<const std::vector<GivenNet>>;

/// The Bezier control points of a patch of a uniform bicubic B-spline.
[[nodiscard]] GivenNet bezier_of_bspline(const GivenNet& net);

/// Joins nets at the borders that they share: those whose four points are the same to within 2^-40 of the size of all. The nets
/// may face either side: neighbours are turned alike, and all of them so that the volume is positive.
/// Error, with `argument` 0: no nets; a border that belongs to one net or more than two; a surface that has one side only;
/// nothing within it; points that are not finite or too far away. Cost: n log n.
[[nodiscard]] Result<Shell> sew(const std::vector<GivenNet>& nets);

}  // namespace raymo::meshes
