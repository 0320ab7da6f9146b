// Tree of boxes over the leaves of one solid, eight children a node.
//
// Built from the top by the surface area heuristic: of the pieces that a node is split into, the
// one with the largest surface is split again until there are eight. A split is the cheapest of the
// planes between bins of box centres on three axes [MacDonald90], [Wald07].
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "raymo/math/aabb.hpp"

namespace raymo::trace {

/// A box in floats, rounded outwards.
struct Boxf {
    std::array<float, 3> lo;
    std::array<float, 3> hi;
};
[[nodiscard]] Boxf hull(const Boxf& a, const Boxf& b);
/// Smallest Boxf that contains `box` grown by `margin`.
[[nodiscard]] Boxf outward(const Aabb& box, double margin);

/// Eight boxes side by side, so that one ray is tested against all in one go. Unused children have
/// lo > hi.
struct alignas(64) BvhNode {
    static constexpr int kWidth = 8;
    float lo[3][kWidth];
    float hi[3][kWidth];
    std::uint32_t ref[kWidth];   ///< index of the child node, or of the first leaf
    std::uint8_t count[kWidth];  ///< number of leaves of a child that is a leaf range; 0 for a
                                 ///< child that is a node
};

struct Bvh {
    std::vector<BvhNode> nodes;        ///< nodes[0] is the root
    std::vector<std::uint32_t> order;  ///< order[i]: which of the given boxes stands at place i
};

/// At most `kMaxRange` leaves in a range. Cost O(n log n). boxes.size() may be 0 (one empty node).
inline constexpr int kMaxRange = 4;
[[nodiscard]] Bvh build_bvh(const std::vector<Boxf>& boxes);

}  // namespace raymo::trace
