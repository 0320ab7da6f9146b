// Wedges along curves in space.
//
// The ball's tube is the sphere that is swept along the curve of its centres, which a cubic spline follows. What the tube is
// taken from must end exactly where the tube touches the faces. So it is a sphere that is swept, too, with a varying radius:
// one whose surface holds both curves of contact p(t) and q(t'). A sphere about Q of radius l stays in touch with them where
//     (Q - p).p' = 0,  (Q - q).q' = 0,  |Q - p| = |Q - q| = l,
// which leaves one freedom: how far Q is off the chord, to the side of the edge. As little as possible keeps the sphere small,
// h = |q - p| / 2; but it should meet the faces at 45 degrees or more. Within the body its surface lies inside the tube then, and
// bounds nothing. Where faces meet at an acute angle it does not reach the edge: then copies of it, shrunk towards the edge, and
// last a sphere about the edge take the rest. It is checked that no sphere passes the contacts and that together they leave no gap.
#pragma once

#include "raymo/blends/segment.hpp"

namespace raymo::blends {

/// The wedge of a segment along a curve in space, from parameter lo to hi. Error: where no ball fits.
[[nodiscard]] Result<csg::Solid> tube_wedge(const Body& body, const Segment& segment, double radius,
                                            double lo, double hi, SourceSpan span);

}  // namespace raymo::blends
