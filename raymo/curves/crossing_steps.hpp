// Steps to a zero of a polynomial of which there is one between two places.
//
// The polynomial is g(s) = sum over i of a[i] s^i with a[i] = binomial(n, i) c[i] and s in [0, 1] (crossing.hpp tells why).
// Near a place s let n = g / g', z = n g'' / (2 g') and w = n^2 g''' / (6 g'). The series of the inverse of g gives the zero as
//     s - n (1 + z + (2 z^2 - w) + ...),                                                          (1)
// whose terms of order k are as large as the k-th power of the distance to the zero. Degrees up to 4 take steps without the
// bracket, which is Chebyshev's method, of third order at simple zeros; crossings.inl takes the same in lanes. Higher degrees
// take all of (1), of fourth order.
//
// All derivatives are computed side by side. A step that leaves the bracket, or is not half as long as the one before it, is
// replaced by a halving of the bracket. So each round halves the bracket or the step, and what is found lies within the
// bracket whatever the coefficients are.
#pragma once

#include "raymo/curves/bernstein.hpp"
#include "raymo/math/pair.hpp"

namespace raymo::curves {

/// Sum of b[i] s^i, even and odd powers side by side; t = s^2.
template <std::size_t M>
RAYMO_INLINE double power_sum(const std::array<double, M>& b, double s, double t) {
    static_assert(M > 0);
    constexpr std::size_t kEven = (M - 1) / 2 * 2;
    double even = b[kEven];
    for (std::size_t i = kEven; i > 0; i -= 2) even = even * t + b[i - 2];
    if constexpr (M == 1) {
        return even;
    } else {
        constexpr std::size_t kOdd = M / 2 * 2 - 1;
        double odd = b[kOdd];
        for (std::size_t i = kOdd; i > 1; i -= 2) odd = odd * t + b[i - 2];
        return even + s * odd;
    }
}

/// Coefficients of the derivative of a sum of powers.
template <std::size_t M>
RAYMO_INLINE std::array<double, M - 1> slope_of(const std::array<double, M>& b) {
    std::array<double, M - 1> d;
    for (std::size_t i = 0; i + 1 < M; ++i) d[i] = static_cast<double>(i + 1) * b[i + 1];
    return d;
}

/// The zero of g between lo and hi, where g is negative at lo and not at hi, by steps of third order. Costs some 20 ns a
/// round, four rounds for most.
template <int N>
RAYMO_INLINE double zero_of(const Bernstein<N>& a, double lo, double hi, double s) {
    constexpr int kMostRounds =
        200;  // each halves a bracket or a step of 53 bits; a few more at first
    double last = hi - lo;
    double before = 0.0;  // the last step, if it was one
    const auto a1 = slope_of(a);
    const auto a2 = slope_of(a1);
    if (!(s > lo && s < hi)) s = 0.5 * (lo + hi);
    for (int round = 0; round < kMostRounds; ++round) {
        const double t = s * s;
        const double g = power_sum(a, s, t);
        const double dg = power_sum(a1, s, t);
        const double ddg = power_sum(a2, s, t);
        // Chosen without branches, which would be mistaken every other time.
        lo = g < 0.0 ? s : lo;
        hi = g < 0.0 ? hi : s;
        const double inverse = 1.0 / dg;
        const double newton = g * inverse;
        double z = newton * (ddg * inverse);
        z = z > 0.5 ? 0.5 : z;
        z = z < -0.5 ? -0.5 : z;
        const double step = newton * (1.0 + 0.5 * z);
        const double next = s - step;
        const double size = std::fabs(step);
        // What is left is z^2 / 2 and a term of third order, known from the last step, times this one.
        const double shrinks = size / before;
        const double rest = size * (z * z + shrinks * shrinks * shrinks);
        // Where g falls, steps lead to another zero: one at an end, which does not count.
        const bool arrives = (rest <= 0x1p-56 * next) | (size <= 0x1p-53 * next);
        if (arrives & (dg > 0.0)) return std::min(std::max(next, lo), hi);
        if ((size <= 0.5 * last) & (next > lo) & (next < hi) & (dg > 0.0)) {
            last = size;
            before = size;
            s = next;
        } else {
            last = 0.5 * (hi - lo);
            before = 0.0;
            s = lo + last;
            if (!(s > lo && s < hi)) break;
        }
    }
    return s;
}

/// Up to here steps are of third order.
inline constexpr int kThirdOrder = 4;

/// Sum of b[i] s^i, in pairs, and pairs of pairs.
template <std::size_t M>
RAYMO_INLINE Pair power_sums(const std::array<Pair, M>& b, Pair s) {
    if constexpr (M == 1) {
        return b[0];
    } else {
        std::array<Pair, (M + 1) / 2> sums;
        for (std::size_t i = 0; i < M / 2; ++i) sums[i] = b[2 * i] + s * b[2 * i + 1];
        if constexpr (M % 2 == 1) sums[M / 2] = b[M - 1];
        return power_sums(sums, s * s);
    }
}

/// What c[k + i] counts for in the coefficient i of g^(k) / k!, and c[k + 1 + i] in that of g^(k + 1) / (k + 1)!.
template <int N>
constexpr auto taylor_weights(int k) {
    std::array<std::array<double, 2>, static_cast<std::size_t>(N) + 1> out{};
    for (int i = 0; i + k <= N; ++i) {
        const int next = i + k + 1;
        out[static_cast<std::size_t>(i)] = {
            binomial(N, i + k) * binomial(i + k, k),
            next <= N ? binomial(N, next) * binomial(next, k + 1) : 0.0};
    }
    return out;
}

/// The coefficients of g^(K) / K! and g^(K + 1) / (K + 1)!.
template <std::size_t K, std::size_t M>
RAYMO_INLINE auto taylor_pairs(const std::array<double, M>& c) {
    static constexpr auto kWeights = taylor_weights<static_cast<int>(M) - 1>(static_cast<int>(K));
    std::array<Pair, M - K> out;
    for (std::size_t i = 0; i + K < M; ++i) {
        out[i] = Pair{c[i + K], i + K + 1 < M ? c[i + K + 1] : 0.0} *
                 Pair{kWeights[i][0], kWeights[i][1]};
    }
    return out;
}

/// The zero between lo and hi of g as c gives it, by steps of fourth order; g is negative at lo and not at hi. Costs some
/// 20 ns a round.
template <int N>
RAYMO_INLINE double zero_by_fourth_order(const Bernstein<N>& c, double lo, double hi, double s) {
    constexpr int kMostRounds = 200;  // as in zero_of
    const auto a = taylor_pairs<0>(c);
    const auto b = taylor_pairs<2>(c);
    Pair in{lo, hi};
    double last = hi - lo;
    double before = 0.0;  // the last step, if it was one
    if (!(s > lo && s < hi)) s = 0.5 * (lo + hi);
    for (int round = 0; round < kMostRounds; ++round) {
        const Pair g = power_sums(a, pair_of(s));
        const Pair ddg = power_sums(b, pair_of(s));
        in = pair_of(g[0]) < pair_of(0.0) ? Pair{s, in[1]} : Pair{in[0], s};
        const double inverse = 1.0 / g[1];
        const double n = g[0] * inverse;
        const double z = n * (ddg[0] * inverse);
        const double w = n * (n * (ddg[1] * inverse));
        const double zz = z * z;
        const double bend = lane_max(lane_min(z + (zz + zz) - w, 0.5), -0.25);
        const double step = n + n * bend;
        const double next = s - step;
        const double size = std::fabs(step);
        // What is left is the next term of (1), 5 z^3 - 5 z w and one that is known from the last step, times this step.
        const double shrinks = size / before;
        const double squared = shrinks * shrinks;
        const double rest = size * (5.0 * std::fabs(z) * (zz + std::fabs(w)) + squared * squared);
        // Where g falls, steps lead to another zero: one at an end, which does not count.
        const bool rises = inverse > 0.0;
        const bool arrives = (rest <= 0x1p-56 * next) | (size <= 0x1p-53 * next);
        if (arrives & rises) return lane_min(lane_max(next, in[0]), in[1]);
        if ((size <= 0.5 * last) & (next > in[0]) & (next < in[1]) & rises) {
            last = size;
            before = size;
            s = next;
        } else {
            last = 0.5 * (in[1] - in[0]);
            before = 0.0;
            s = in[0] + last;
            if (!(s > in[0] && s < in[1])) break;
        }
    }
    return s;
}

/// The zero between lo and hi of g as c gives it.
template <int N>
RAYMO_INLINE double zero_of_bernstein(const Bernstein<N>& c, double lo, double hi, double s) {
    if constexpr (N <= kThirdOrder) {
        Bernstein<N> a;
        for (std::size_t i = 0; i <= N; ++i) a[i] = binomial(N, static_cast<int>(i)) * c[i];
        return zero_of<N>(a, lo, hi, s);
    } else {
        return zero_by_fourth_order<N>(c, lo, hi, s);
    }
}

}  // namespace raymo::curves
