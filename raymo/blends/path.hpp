// The path of a ball's centre as cubics.
//
// A cubic that meets its ends has six numbers left, its inner control points. On the path are of each place two: what it is
// off by, across the path. So it can be made to meet the path in three more places, wherever on it these are, and is off by
// the fifth power of its length: u (u - u1) (u - u2) (u - u3) (u - 1) times a vector across that hardly changes. The places are
// chosen so that this polynomial is the Chebyshev polynomial of degree 5, stretched until its outermost zeros are the ends;
// then the largest of its four extrema is least. Cubics that have the path's tangents at their ends, or meet it at given
// parameters, are off by the fourth power, and take three times as many pieces for 2^-30 of the radius.
//
// The inner control points are found by Newton's method from the cubic with the path's tangents and curvatures. Where the
// path does not leave a plane, or is straight, some of its equations tell nothing; of all solutions it takes the one that is
// nearest (so that planar pieces are off by even less), by Tikhonov's term.
//
// Each piece is as long as the tolerance allows, by what the one before was off by. What it is off by is measured at the
// extrema and between.
#pragma once

#include "raymo/blends/spine.hpp"
#include "raymo/curves/path.hpp"

namespace raymo::blends {

/// Appends the ball's way from one place to another, as spans of the given radius that are off by no more than `tolerance`.
/// False: it can not be followed, or takes more spans than it may.
[[nodiscard]] bool append_path(const Spine& spine, const Station& first, const Station& last,
                               double tolerance, double radius, std::vector<curves::PathSpan>& out);

}  // namespace raymo::blends
