// Real roots of polynomials on [0, 1], isolated with proof.
//
// A polynomial in Bernstein form without sign changes among its coefficients has no root; with one it has exactly one;
// otherwise it is halved [Lane81]. A value of 0 counts as positive. So the number of crossings that are found has always the
// parity that the signs at both ends ask for, and neighbouring pieces of a closed curve, which share their end values bit
// for bit, never lose or repeat one. Signs that noise or rounding could change are not relied on: where one is needed, a touch
// is told. roots.cpp proves this; crossings.inl decides the simple cases for several polynomials at a time.
#pragma once

#include "raymo/curves/bernstein.hpp"

namespace raymo::curves {

struct Root {
    double u;  ///< its place; the middle of [lo, hi] for a touch
    /// Where it was isolated: the signs at both are different for a crossing and equal for a touch.
    double lo, hi;
    /// False: p comes within `noise` of zero in [lo, hi], and whether it crosses (twice) is not known.
    bool crosses;
    bool rises;  ///< a crossing from negative to positive
};

template <int N>
struct RootList {
    int count = 0;
    std::array<Root, static_cast<std::size_t>(2 * N + 2)> root;

    [[nodiscard]] const Root* begin() const { return root.data(); }
    [[nodiscard]] const Root* end() const { return root.data() + count; }
};

/// Puts the roots of p into `out`, ascending, in place of what it held; their intervals do not overlap. `noise` (>= 0) bounds
/// the error of each coefficient. With what halvings add to it, some N^2 u times the largest coefficient at most,
/// - crossings alternate, and between lo and hi of each p changes its sign for certain, or it is told so by p[0] or p[N];
/// - where nothing is told p has no zero, and does not come within `noise` of one, but towards 0 or 1 where it is monotone:
///   there the sign of p[0] or p[N] is taken as it stands, and what is beyond is for the caller to know;
/// - a touch is told where p comes too near to zero for its sign to be known, and has the same sign on both sides.
/// There are at most N crossings and N + 2 touches. If a coefficient or `noise` is NaN or infinite or noise < 0, all of
/// [0, 1] is one crossing or touch, or nothing. Defined for N = 1..10.
/// Cost, of degree 6: 5 ns for most polynomials without roots, some 100 ns a root, 280 ns a near-double pair.
template <int N>
void find_roots(const Bernstein<N>& p, double noise, RootList<N>& out);

/// The one place in [0, 1] where p, which has different signs at 0 and 1 and one crossing between them, crosses zero; to
/// the last bit that its values allow. In [0, 1] unless a coefficient is NaN. Cost: 60 to 90 ns.
template <int N>
[[nodiscard]] double crossing_of(const Bernstein<N>& p);

}  // namespace raymo::curves
