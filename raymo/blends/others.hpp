// What else there is about a ball that rolls along a segment.
//
// A distance from a surface changes by no more than the way, so that a stretch of the segment is settled where in its middle all
// else is further off than half of it. On lines and circles more is known. Let p(s) run along one, by its length, with tangent T
// and curvature k, and let n be the normal of a surface and 1/m the least radius of curvature that parallels of the surface
// have about p: its distance f has
//     f' = n.T,   |f''| <= k + m,   |f(s)| >= |f(0)| - |n.T| s - (k + m) s^2 / 2.
// And a surface that is moved into itself along the segment, as the other quarters of a cylinder's wall about the same axis, is
// as far off everywhere.
#pragma once

#include "raymo/blends/wedge.hpp"

namespace raymo::blends {

/// What is solid next to the contacts: the ball may touch a face only where it bounds the body.
[[nodiscard]] Fitting at_contacts(const Body& body, const Segment& segment, const Touch& touch,
                                  double radius);

/// Whether third faces come into the ball, or end one of its own faces under it, anywhere from parameter lo to hi: as deep as
/// 2^-13 of it, or over 2^-5. `margin`: how far from the segment's ends that is another's concern; `first`: with which face to
/// begin. Cost: about 1 us for each face, and where one runs on close beside the ball as many times more as it is closer than
/// the way is long, up to 2^13.
[[nodiscard]] Fitting among_others(const Body& body, const Segment& segment, double radius,
                                   double lo, double hi, double margin, const Spend& spend,
                                   std::size_t first);

}  // namespace raymo::blends
