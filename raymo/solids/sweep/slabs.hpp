// A line against the boxes of a sweep's tree.
#pragma once

#include "raymo/solids/slabs.hpp"
#include "raymo/solids/sweep/swept_spheres.hpp"

namespace raymo::solids {

/// Nodes of a tree that wait for a line, at most: of each level but the first seven, of 2^32 pieces.
inline constexpr std::size_t kMostWaiting = 8 * 11;

}  // namespace raymo::solids
