// Closed surfaces of bicubic patches.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "raymo/math/vec.hpp"

namespace raymo::meshes {

/// The numbers of the control points b_ij of a bicubic Bezier patch
///     S(u, v) = sum B_i(u) B_j(v) b_ij,  0 <= u, v <= 1,
/// at 4 i + j. S_u x S_v faces outwards.
using Net = std::array<std::uint32_t, 16>;

/// Patches that close up: each curve of their borders belongs to two patches, which share its control points, or has
/// shrunk to a point. Points are stored once.
struct Shell {
    std::vector<Vec3> points;
    std::vector<Net> patches;

    friend bool operator==(const Shell&, const Shell&) = default;
};
using ShellPtr = std::shared_ptr<const Shell>;

/// What the surface bounds, exact but for rounding; parts that it winds around twice count twice.
[[nodiscard]] double volume_of(const Shell& shell);
[[nodiscard]] double bytes_of(const Shell& shell);

}  // namespace raymo::meshes
