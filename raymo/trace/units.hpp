// What stands together in the tree of boxes.
//
// A unit is a leaf, or a product: a difference or an intersection of leaves, right below the root of a part. A small product
// stands in the tree as a whole. Of a product with more leaves only the core does, the leaves whose inside counts; those
// that are taken away, the cutters, have a tree of their own below it, which is searched about one place of a ray at a time.
#pragma once

#include <vector>

#include "raymo/trace/data.hpp"

namespace raymo::trace {

/// Puts `solid`.leaves, with groups made and in the order of the model, in the order of the trees of boxes, and fills in what
/// follows from that: nodes, simple, and of leaves unit, cutters and alone. `boxes`: one for each leaf.
/// Cost: O(n log n).
void plant_trees(CompiledSolid& solid, const std::vector<Boxf>& boxes,
                 const CompiledScene::Data& data);

}  // namespace raymo::trace
