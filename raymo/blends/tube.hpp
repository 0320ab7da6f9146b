// Wedges along curves in space.
//
// The ball's tube is the sphere that is swept along the path of its centres (spine.hpp), which cubics follow. The wedge is what
// the tube leaves of the sectors between the path and the edge (sector.hpp), on the faces' own side. The sectors of a chamfer
// or a conic end there by themselves: such a wedge is all of them on that side.
//
// A body B is rounded by taking the wedge away. Of a ring of its edge this can be put another way: with sectors S and the tube T,
//     B - (S - T)  =  (B - S) + T,
// since the ball rolls within B. Rays find the first surface of the right side much sooner: it is a union of plain products. But S
// goes on beyond the faces, and no other part of B may be there. A chamfer or a conic has no T, and its wedge may be all of S then. (S stays whole: near the edge its surface may fold, and what
// two stretches of it hold at their common end need not be what the whole does.)
#pragma once

#include <optional>

#include "raymo/blends/segment.hpp"

namespace raymo::blends {

/// The wedge of a segment along a curve in space, from parameter lo to hi. Error: out_of_range where the path is lost, or bends
/// too sharply.
[[nodiscard]] Result<csg::Solid> tube_wedge(const Body& body, const Segment& segment,
                                            const Form& form, double lo, double hi,
                                            SourceSpan span);

/// A convex edge that runs back into itself, rounded by a ball: what is taken away from the body, and what is joined to the rest.
struct RoundedRing {
    csg::Solid sectors;
    csg::Solid tube;
};
/// Of a segment along a curve in space. Empty where it is no such edge, or something may be beyond its faces: there is only the
/// wedge then. Errors as of the wedge.
[[nodiscard]] Result<std::optional<RoundedRing>> rounded_ring(const Body& body,
                                                              const Segment& segment, double radius,
                                                              SourceSpan span);

}  // namespace raymo::blends
