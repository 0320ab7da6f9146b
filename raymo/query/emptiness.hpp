// Whether anything is left of a solid.
//
// Four means, from cheap to thorough:
//   1. the graph: a leaf that only unions, maps and paint lie above is there as it is, and every
//      primitive has inner points;
//   2. rays through the model's box and through its first leaf: a model that is there is nearly
//      always hit by the first few;
//   3. cells: the boxes in which each leaf can matter (its active zones) are halved again and
//      again. A cell in which the Locator finds all points in proves that the solid is there; cells
//      all of whose points are out are dropped. When none are left the solid is proved empty;
//   4. rays at growing resolutions through the zones, along the canonical axes of the leaves in
//      them (along a needle, in a sheet, however it is turned), and through every cell that is left.
//      A span counts when it is longer than its own error, so one hit proves that the solid is
//      there.
// Strength: "empty" is proved when it comes from 3 (or from boxes alone); from 4 it means that no
// ray of the grids met the solid, which a sliver thinner than the grid (1/16 of a leaf's zone) could
// escape. "Not empty" is proved, but for very large models: 3 and 4 meet a limited number of nodes
// and boxes (millions), counted over all instances, and a model for which that does not suffice
// counts as not empty; its picture shows what there is.
#pragma once

#include "raymo/core/progress.hpp"
#include "raymo/core/result.hpp"
#include "raymo/scene/scene.hpp"
#include "raymo/trace/compiled_scene.hpp"

namespace raymo::query {

/// True when the solid has no inner point, as `a - a`. False when that is not decided within the
/// work allowed (see above). Unbounded solids are looked at within 1000 times the size of their
/// finite leaves. Errors: cancelled; those of trace::compile. Cost: microseconds beyond compiling
/// for a solid that is there, up to about a second for one that is not.
[[nodiscard]] Result<bool> is_empty(const csg::Solid& solid, Progress* progress = nullptr);

/// The same for all parts of a scene that is compiled already.
[[nodiscard]] Result<bool> is_empty(const scene::Scene& scene, const trace::CompiledScene& compiled,
                                    Progress* progress = nullptr);

}  // namespace raymo::query
