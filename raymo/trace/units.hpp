// What stands together in the tree of boxes.
//
// A unit is a leaf, or a product: a difference or an intersection of leaves, right below the root of a part. A small product
// stands in the tree as a whole. Of a product with more leaves only the core does, the leaves whose inside counts; those
// that are taken away, the cutters, have a tree of their own, which is searched about one place of a ray at a time. What is
// taken away from a union is taken away from each of its leaves, and of its small products, which are cores that share
// their cutters.
// Single rays go through all trees, from a node above them.
#pragma once

#include <vector>

#include "raymo/trace/data.hpp"

namespace raymo::trace {

/// Puts `solid`.leaves, with groups made and in the order of the model, in the order of the trees of boxes, and fills in what
/// follows from that: nodes, units, simple, and of leaves unit, cutters, alone and apart. `boxes`: one for each leaf.
/// Cost: O(n log n).
void plant_trees(CompiledSolid& solid, const std::vector<Boxf>& boxes,
                 const CompiledScene::Data& data);

}  // namespace raymo::trace
