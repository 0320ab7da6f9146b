// Polynomials whose coefficients of one sign outweigh the few of the other: they have no zero.
//
// For the polynomials B[i](u) = binomial(N, i) u^i (1 - u)^(N - i)
//     B[i]^2 = r B[i - 1] B[i + 1],   r = (1 + 1 / i) (1 + 1 / (N - i)) <= 2 N / (N - 1),                    (1)
// and as the geometric mean is no more than the arithmetic one, B[i] <= 0.8 (B[i - 1] + B[i + 1]) from N = 5 on. Let p(0) be
// positive (else -p is meant), n[i] = max(-c[i], 0), and d[i] = |c[i]| - n[i - 1] - n[i + 1] > 0 for all i, with n[N] for
// n[N + 1]. Then p(1) is positive, and of two neighbours one is positive: else d of the lesser one were not. Each negative
// term of p is outweighed by parts of its neighbours, and what is left of the positive terms is
//     p >= sum of d[i] B[i] where c[i] > 0 >= min d / 2.6,                                                   (2)
// since the other B[i] add up to no more than 1.6 times these. Rounding is small against the difference of 0.8 and 1.
//
// This needs no branch and settles 9 of 10 polynomials with few negative coefficients but no zero, where a processor would
// have been mistaken about the next branch.
#pragma once

#include "raymo/curves/bernstein.hpp"
#include "raymo/math/pair.hpp"

namespace raymo::curves {

/// The first degree for which outweighed polynomials are looked for. A halving of lower ones costs as much.
inline constexpr int kOutweighedFrom = 5;

/// Whether p is outweighed, by more than `noise` (see (2)); nearly all that are clear are outweighed, too. Where a
/// coefficient is NaN or infinite either may be said. Cost: 5 ns (degree 6) to 7 ns (degree 10).
template <int N>
RAYMO_INLINE bool is_outweighed(const Bernstein<N>& p, double noise) {
    constexpr std::size_t kPairs = N / 2 + 1;
    const Pair minus = pair_of(std::copysign(1.0, -p[0]));
    std::array<Pair, kPairs> n, d;
    for (std::size_t i = 0; i < kPairs; ++i) {
        const Pair c{p[2 * i], p[std::min<std::size_t>(2 * i + 1, N)]};
        n[i] = pair_max(minus * c, pair_of(0.0));
        d[i] = pair_abs(c);
    }
    Pair before{0.0, n[0][0]};
    for (std::size_t i = 0; i < kPairs; ++i) {
        const double last = N % 2 == 0 ? 0.0 : n[i][1];
        const Pair after = i + 1 < kPairs ? Pair{n[i][1], n[i + 1][0]} : pair_of(last);
        d[i] -= before + after;
        before = after;
    }
    for (std::size_t m = kPairs; m > 1; m = (m + 1) / 2) {
        for (std::size_t i = 0; i < m / 2; ++i) d[i] = pair_min(d[i], d[m - 1 - i]);
    }
    return lane_min(d[0][0], d[0][1]) > 3.0 * noise;
}

}  // namespace raymo::curves
