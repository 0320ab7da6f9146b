// Halves of polynomials in Bernstein form.
//
// De Casteljau's construction at 1/2 without its factors of 1/2: rows of sums of neighbours, each shorter by one, of which the
// first and the last number belong to the left and the right half. The power of two that brings a row to the scale of the
// others is exact. In all the halves are 2^N times as large as p is there.
//
// Rows are folded in the middle: a number and its mirror image are a pair, and one sum of pairs serves both halves. What is
// stored number by number is not loaded in pairs soon after, since loads wait for such stores. Wider registers than those of
// two numbers bring nothing: the rows wait for each other.
#pragma once

#include <utility>

#include "raymo/curves/bernstein.hpp"
#include "raymo/math/pair.hpp"

namespace raymo::curves {

/// Least and most of c: no value of p lies outside.
template <int N>
RAYMO_INLINE void extremes(const Bernstein<N>& c, double& least, double& most) {
    constexpr std::size_t kPairs = N / 2 + 1;
    std::array<Pair, kPairs> low, high;
    for (std::size_t i = 0; i < kPairs; ++i) {
        const std::size_t k = std::min<std::size_t>(2 * i, N - 1);
        low[i] = high[i] = Pair{c[k], c[k + 1]};
    }
    for (std::size_t n = kPairs; n > 1; n = (n + 1) / 2) {
        for (std::size_t i = 0; i < n / 2; ++i) {
            low[i] = pair_min(low[i], low[n - 1 - i]);
            high[i] = pair_max(high[i], high[n - 1 - i]);
        }
    }
    least = lane_min(low[0][0], low[0][1]);
    most = lane_max(high[0][0], high[0][1]);
}

constexpr double power_of_two(std::size_t n) { return static_cast<double>(1U << n); }

/// The halves of a polynomial, times 2^N, and least and most of the left and the right one.
template <int N>
struct Halves {
    Bernstein<N>& left;
    Bernstein<N>& right;
    Pair least, most;

    RAYMO_INLINE void put(std::size_t i, Pair ends) {
        left[i] = ends[0];
        right[N - i] = ends[1];
        least = pair_min(ends, least);
        most = pair_max(ends, most);
    }
};

/// The next row, of M sums: rows[i] holds the sums i and M - 1 - i.
template <int N, std::size_t M>
RAYMO_INLINE void halve_row(std::array<Pair, N / 2 + 1>& row, Halves<N>& out) {
    [&]<std::size_t... I>(std::index_sequence<I...>) RAYMO_INLINE_BODY {
        ((row[I] += row[I + 1]), ...);
    }
    (std::make_index_sequence<M / 2>());
    if constexpr (M % 2 == 1) row[M / 2] += swapped(row[M / 2]);
    out.put(N + 1 - M, row[0] * pair_of(power_of_two(M - 1)));
    if constexpr (M > 1) halve_row<N, M - 1>(row, out);
}

/// `right` may be c.
template <int N>
RAYMO_INLINE void halve(const Bernstein<N>& c, Halves<N>& out) {
    std::array<Pair, N / 2 + 1> row;
    for (std::size_t i = 0; i <= N / 2; ++i) row[i] = Pair{c[i], c[N - i]};
    out.least = out.most = row[0] * pair_of(power_of_two(N));
    out.put(0, out.least);
    halve_row<N, N>(row, out);
}

}  // namespace raymo::curves
