// Real roots of polynomials on [0, 1], isolated with proof.
//
// A polynomial in Bernstein form without sign changes among its coefficients has no root; with one it has exactly one;
// otherwise it is halved [Lane81]. A value of 0 counts as positive. So the number of crossings that are found has always the
// parity that the signs at both ends ask for, and neighbouring pieces of a closed curve, which share their end values bit
// for bit, never lose or repeat one.
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

/// Appends the roots of p, ascending. `noise` (>= 0) bounds the error of each coefficient: what comes closer to zero without
/// crossing it is told as a touch. Pairs of crossings closer than 2^-40 are told as a touch, too. Defined for N = 1..10.
/// Cost: a filter of N comparisons for most polynomials without roots; about 100 ns a root.
template <int N>
void find_roots(const Bernstein<N>& p, double noise, RootList<N>& out);

/// The one place in [0, 1] where p, which has different signs at 0 and 1 and one crossing between them, crosses zero; to
/// the last bit that its values allow.
template <int N>
[[nodiscard]] double crossing_of(const Bernstein<N>& p);

}  // namespace raymo::curves
