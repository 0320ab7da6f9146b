// One zero of a polynomial in Bernstein form, between two places where its signs are different.
//
// On the half where u <= 1/2 let s = u / (1 - u) in [0, 1] and a[i] = binomial(n, i) c[i]. Then
//     p(u) (1 + s)^n = g(s) = sum over i of a[i] s^i,                                            (1)
// so p and g have the same signs, and g costs n multiplications and additions where de Casteljau's construction costs n^2. As
// s >= 0 its terms are those of p times one positive number: Horner's rule (here one for even and one for odd powers, which
// do not wait for each other) is as accurate for g as the construction is for p,
//     |error of g| <= 2 n u sum over i of |a[i]| s^i   (u: the unit roundoff)          [Higham02 5.1], [Farouki87].
// The other half is done from its end: 1 - u takes the place of u and the coefficients are read backwards.
//
// The steps are those of Chebyshev's method, x - n (1 + z / 2) with n = g / g' and z = g g'' / g'^2, of third order at simple
// zeros; g, g' and g'' are computed side by side. A step that leaves the bracket, or is not half as long as the one before it,
// is replaced by a halving of the bracket. So each round halves the bracket or the step, and what is found lies within the
// bracket whatever the coefficients are.
#pragma once

#include "raymo/curves/bernstein.hpp"
#include "raymo/math/lanes.hpp"

namespace raymo::curves {

/// A part of [0, 1] and the values at its ends; what is known of p when its zero is looked for.
struct Bracket {
    double lo, hi;
    double at_lo, at_hi;
    double guess;  ///< of the zero; any number
};

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

/// The zero of g between lo and hi, where g is negative at lo and not at hi. Costs some 20 ns a round, four rounds for most.
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

/// The zero of p in a bracket whose ends have different signs, 0 counting as positive.
template <int N>
RAYMO_INLINE double zero_within(const Bernstein<N>& c, Bracket in) {
    if constexpr (N == 1) {
        return std::min(std::max(c[0] / (c[0] - c[1]), in.lo), in.hi);
    } else {
        const bool rises = in.at_lo < 0.0;
        Bernstein<N> a;
        double sum = 0.0;
        for (std::size_t i = 0; i <= N; ++i) {
            a[i] = binomial(N, static_cast<int>(i)) * c[i];
            sum += a[i];
        }
        double guess = in.guess;
        if (in.lo < 0.5 && in.hi > 0.5) {
            const double middle = sum * (1.0 / (1 << N));
            const bool above = (middle < 0.0) == rises;
            (above ? in.lo : in.hi) = 0.5;
            (above ? in.at_lo : in.at_hi) = middle;
            if (!(guess > in.lo && guess < in.hi))
                guess = in.lo + (in.hi - in.lo) * (in.at_lo / (in.at_lo - in.at_hi));
        }
        // Negative before the zero, as seen from the end where s = 0.
        const bool from_start = in.hi <= 0.5;
        if (rises != from_start) {
            for (double& x : a) x = -x;
        }
        if (from_start) {
            const double s =
                zero_of<N>(a, in.lo / (1.0 - in.lo), in.hi / (1.0 - in.hi), guess / (1.0 - guess));
            return std::min(std::max(s / (1.0 + s), in.lo), in.hi);
        }
        std::reverse(a.begin(), a.end());
        const double s =
            zero_of<N>(a, (1.0 - in.hi) / in.hi, (1.0 - in.lo) / in.lo, (1.0 - guess) / guess);
        return std::min(std::max(1.0 / (1.0 + s), in.lo), in.hi);
    }
}

/// The zero of p in [0, 1], at whose ends it has different signs, 0 counting as positive.
template <int N>
RAYMO_INLINE double zero_across(const Bernstein<N>& c) {
    if constexpr (N == 1) {
        return zero_within<1>(c, {0.0, 1.0, c[0], c[1], 0.0});
    } else {
        Bernstein<N> a;
        double sum = 0.0;  // 2^N p(1/2)
        for (std::size_t i = 0; i <= N; ++i) {
            a[i] = binomial(N, static_cast<int>(i)) * c[i];
            sum += a[i];
        }
        // Negative before the zero, as seen from the end where s = 0.
        const bool rises = c[0] < 0.0;
        const bool from_start = (sum < 0.0) != rises;
        if (!from_start) std::reverse(a.begin(), a.end());
        if (rises != from_start) {
            for (double& x : a) x = -x;
            sum = -sum;
        }
        // Of the parabola through p at 0, 1/2 and 1.
        const double middle = sum * (1.0 / (1 << N));
        const double bend = 2.0 * (a[0] + a[N]) - 4.0 * middle;
        const double slope = 4.0 * middle - 3.0 * a[0] - a[N];
        const double root = std::sqrt(std::max(slope * slope - 4.0 * bend * a[0], 0.0));
        const double guess = -2.0 * a[0] / (slope + root + 2.0 * a[0]);
        const double s = zero_of<N>(a, 0.0, 1.0, guess);
        return (from_start ? s : 1.0) / (1.0 + s);
    }
}

}  // namespace raymo::curves
