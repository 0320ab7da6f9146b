// One zero of a polynomial in Bernstein form, between two places where its signs are different.
//
// On the half where u <= 1/2 let s = u / (1 - u) in [0, 1] and a[i] = binomial(n, i) c[i]. Then
//     p(u) (1 + s)^n = g(s) = sum over i of a[i] s^i,                                            (1)
// so p and g have the same signs, and g costs n multiplications and additions where de Casteljau's construction costs n^2. As
// s >= 0 its terms are those of p times one positive number: Horner's rule (up to degree 4 one for even and one for odd
// powers, which do not wait for each other; above, sums of pairs) is as accurate for g as the construction is for p,
//     |error of g| <= 2 n u sum over i of |a[i]| s^i   (u: the unit roundoff)          [Higham02 5.1], [Farouki87].
// The other half is done from its end: 1 - u takes the place of u and the coefficients are read backwards.
//
// Up to degree 4 the steps of crossing_steps.hpp begin at the zero of a parabola through three values of p. For higher degrees
// they begin within an eighth of [0, 1]: five values tell which, and the line through its ends, bent as a third value asks for,
// is wrong by some thousandths. Two steps are enough then for 98 of 100 polynomials with random coefficients, so that a
// processor foresees the end.
#pragma once

#include "raymo/curves/crossing_steps.hpp"

namespace raymo::curves {

/// A part of [0, 1] and the values at its ends; what is known of p when its zero is looked for.
struct Bracket {
    double lo, hi;
    double at_lo, at_hi;
    double guess;  ///< of the zero; any number
};

/// The zero of p in a bracket whose ends have different signs, 0 counting as positive.
template <int N>
RAYMO_INLINE double zero_within(const Bernstein<N>& c, Bracket in) {
    if constexpr (N == 1) {
        return std::min(std::max(c[0] / (c[0] - c[1]), in.lo), in.hi);
    } else {
        const bool rises = in.at_lo < 0.0;
        double guess = in.guess;
        if (in.lo < 0.5 && in.hi > 0.5) {
            double sum = 0.0;
            for (std::size_t i = 0; i <= N; ++i) sum += binomial(N, static_cast<int>(i)) * c[i];
            const double middle = sum * (1.0 / (1 << N));
            const bool above = (middle < 0.0) == rises;
            (above ? in.lo : in.hi) = 0.5;
            (above ? in.at_lo : in.at_hi) = middle;
            if (!(guess > in.lo && guess < in.hi))
                guess = in.lo + (in.hi - in.lo) * (in.at_lo / (in.at_lo - in.at_hi));
        }
        // Negative before the zero, as seen from the end where s = 0.
        const bool from_start = in.hi <= 0.5;
        Bernstein<N> d = c;
        if (rises != from_start) {
            for (double& x : d) x = -x;
        }
        if (from_start) {
            const double s = zero_of_bernstein<N>(d, in.lo / (1.0 - in.lo), in.hi / (1.0 - in.hi),
                                                  guess / (1.0 - guess));
            return std::min(std::max(s / (1.0 + s), in.lo), in.hi);
        }
        std::reverse(d.begin(), d.end());
        const double s = zero_of_bernstein<N>(d, (1.0 - in.hi) / in.hi, (1.0 - in.lo) / in.lo,
                                              (1.0 - guess) / guess);
        return std::min(std::max(1.0 / (1.0 + s), in.lo), in.hi);
    }
}

/// The values at 1/8, 1/4, 3/8 and 1/2 are sums of the coefficients times these.
template <int N>
constexpr auto eighth_weights() {
    std::array<Bernstein<N>, 4> out{};
    for (std::size_t k = 0; k < 4; ++k) {
        const double u = 0.125 * static_cast<double>(k + 1);
        for (std::size_t i = 0; i <= N; ++i) {
            double weight = binomial(N, static_cast<int>(i));
            for (std::size_t n = 0; n < N; ++n) weight *= n < i ? u : 1.0 - u;
            out[k][i] = weight;
        }
    }
    return out;
}

/// Sum of a[I], ..., in pairs, which do not wait for each other.
template <std::size_t I, std::size_t Count, class T, std::size_t M>
RAYMO_INLINE T sum_of_part(const std::array<T, M>& a) {
    if constexpr (Count == 1) {
        return a[I];
    } else {
        return sum_of_part<I, Count / 2>(a) + sum_of_part<I + Count / 2, Count - Count / 2>(a);
    }
}

/// zero_across of the higher degrees; without branches, which would be mistaken every other time.
template <int N>
RAYMO_INLINE double zero_from_eighths(const Bernstein<N>& c) {
    static constexpr auto kWeights = eighth_weights<N>();
    static constexpr std::array<double, 5> kPlaces{0.0, 1.0 / 7.0, 1.0 / 3.0, 3.0 / 5.0, 1.0};
    static constexpr std::array<double, 2> kSigns{1.0, -1.0};
    Bernstein<N> term;
    for (std::size_t i = 0; i <= N; ++i) term[i] = kWeights[3][i] * c[i];
    const double half = sum_of_part<0, N + 1>(term);
    // Negative before the zero, as seen from the end where s = 0.
    const bool falls = !(c[0] < 0.0);
    const auto from_end = static_cast<std::size_t>((half < 0.0) != falls);
    const double sign = kSigns[from_end ^ static_cast<std::size_t>(falls)];
    const double* const first = c.data() + from_end * N;
    const std::ptrdiff_t next = 1 - 2 * static_cast<std::ptrdiff_t>(from_end);
    Bernstein<N> d;
    std::array<Pair, static_cast<std::size_t>(N) + 1> terms;
    for (std::size_t i = 0; i <= N; ++i) {
        d[i] = sign * first[next * static_cast<std::ptrdiff_t>(i)];
        terms[i] = pair_of(d[i]) * Pair{kWeights[0][i], kWeights[1][i]};
        term[i] = d[i] * kWeights[2][i];
    }
    const Pair two = sum_of_part<0, N + 1>(terms);
    const std::array<double, 5> y{d[0], two[0], two[1], sum_of_part<0, N + 1>(term), sign * half};
    const auto beyond1 = static_cast<std::size_t>(y[1] < 0.0);
    const std::size_t beyond2 = beyond1 & static_cast<std::size_t>(y[2] < 0.0);
    const std::size_t beyond3 = beyond2 & static_cast<std::size_t>(y[3] < 0.0);
    const std::size_t k = beyond1 + beyond2 + beyond3;  // y[k] is negative and y[k + 1] is not
    const std::size_t j = k - beyond3;                  // three values begin here
    const double inverse = 1.0 / (y[k + 1] - y[k]);
    const double x = -y[k] * inverse;
    const double bend = 0.5 * ((y[j] - 2.0 * y[j + 1] + y[j + 2]) * inverse);
    const double guess = 0.125 * (static_cast<double>(k) + (x + bend * (x * (1.0 - x))));
    const double s = zero_by_fourth_order<N>(d, kPlaces[k], kPlaces[k + 1], guess / (1.0 - guess));
    return std::array<double, 2>{s, 1.0}[from_end] / (1.0 + s);
}

/// The zero of p in [0, 1], at whose ends it has different signs, 0 counting as positive.
template <int N>
RAYMO_INLINE double zero_across(const Bernstein<N>& c) {
    if constexpr (N == 1) {
        return zero_within<1>(c, {0.0, 1.0, c[0], c[1], 0.0});
    } else if constexpr (N > kThirdOrder) {
        return zero_from_eighths<N>(c);
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
