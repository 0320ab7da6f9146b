// The walk of rays through the tree of boxes, compiled for each instruction set and chosen at run
// time.
#pragma once

#include "raymo/trace/walker.hpp"

namespace raymo::trace {

/// Traces all active rays of `walker` from its context 0 to the end. `walker.lanes` hold the
/// answers.
void walk(Walker<1>& walker);
void walk(Walker<kRays>& walker);
/// The nearest surfaces of a simple solid for the active rays: answers, or defers rays, in walker.nearest. `hits`: where to
/// put what is met; may be null.
void walk_simple(Walker<kRays>& walker, const RayPacket& rays, HitPacket* hits);
/// The same in mode through: walker.nearest.found are the rays that meet something opaque, `out` is what the others pass.
void walk_through(Walker<kRays>& walker, const RayPacket& rays, PassagePacket& out);

}  // namespace raymo::trace
