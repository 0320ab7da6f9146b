// Wedges along curves in space.
//
// The ball's tube is the sphere that is swept along the path of its centres (spine.hpp), which cubics follow. The wedge is what
// the tube leaves of the sectors between the path and the edge (sector.hpp), on the faces' own side.
#pragma once

#include "raymo/blends/segment.hpp"

namespace raymo::blends {

/// The wedge of a segment along a curve in space, from parameter lo to hi. Error: out_of_range where the path is lost, or bends
/// too sharply.
[[nodiscard]] Result<csg::Solid> tube_wedge(const Body& body, const Segment& segment, double radius,
                                            double lo, double hi, SourceSpan span);

}  // namespace raymo::blends
