// Polynomials on [0, 1] in Bernstein form: p(u) = sum over i of c[i] binomial(n, i) u^i (1 - u)^(n - i).
//
// The coefficients are as large as the values (p lies within their hull), so errors in them are errors in the values; the
// first and the last are the values at the ends, exactly. Ref: [Farin02 5], [Farouki87].
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace raymo::curves {

/// Coefficients of a polynomial of degree N.
template <int N>
using Bernstein = std::array<double, static_cast<std::size_t>(N) + 1>;

/// Largest degree in use: the stationary chords of a swept sphere.
inline constexpr int kMostDegree = 10;

[[nodiscard]] constexpr double binomial(int n, int k) {
    double b = 1.0;
    for (int i = 1; i <= k; ++i) b = b * (n - k + i) / i;
    return b;
}

/// p(u), by de Casteljau's construction: means only, so no cancellation. Cost: N^2 / 2 means.
template <std::size_t M>
[[nodiscard]] constexpr double value_at(const std::array<double, M>& c, double u) {
    std::array<double, M> b = c;
    const double v = 1.0 - u;
    for (std::size_t n = M - 1; n > 0; --n) {
        for (std::size_t i = 0; i < n; ++i) b[i] = v * b[i] + u * b[i + 1];
    }
    return b[0];
}

/// A cubic and its derivative at one place.
struct Jet {
    double value, slope;
};
[[nodiscard]] constexpr Jet jet_at(const std::array<double, 4>& c, double u) {
    const double v = 1.0 - u;
    const double a = v * c[0] + u * c[1];
    const double b = v * c[1] + u * c[2];
    const double d = v * c[2] + u * c[3];
    const double first = v * a + u * b;
    const double second = v * b + u * d;
    return {v * first + u * second, 3.0 * (second - first)};
}

/// p'.
template <std::size_t M>
[[nodiscard]] constexpr std::array<double, M - 1> derivative(const std::array<double, M>& c) {
    static_assert(M > 1);
    std::array<double, M - 1> d{};
    for (std::size_t i = 0; i + 1 < M; ++i) d[i] = static_cast<double>(M - 1) * (c[i + 1] - c[i]);
    return d;
}

/// What p[i] q[j] counts for in the coefficient i + j of the product of polynomials of degrees M and K.
template <int M, int K>
[[nodiscard]] constexpr auto product_weights() {
    std::array<std::array<double, static_cast<std::size_t>(K) + 1>, static_cast<std::size_t>(M) + 1>
        weights{};
    for (int i = 0; i <= M; ++i) {
        for (int j = 0; j <= K; ++j) {
            weights[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] =
                binomial(M, i) * binomial(K, j) / binomial(M + K, i + j);
        }
    }
    return weights;
}

/// p q.
template <std::size_t M, std::size_t K>
[[nodiscard]] constexpr std::array<double, M + K - 1> product(const std::array<double, M>& p,
                                                              const std::array<double, K>& q) {
    constexpr auto kWeights = product_weights<static_cast<int>(M) - 1, static_cast<int>(K) - 1>();
    std::array<double, M + K - 1> out{};
    for (std::size_t i = 0; i < M; ++i) {
        for (std::size_t j = 0; j < K; ++j) out[i + j] += kWeights[i][j] * p[i] * q[j];
    }
    return out;
}

/// The same polynomial, as one of one degree more.
template <std::size_t M>
[[nodiscard]] constexpr std::array<double, M + 1> elevated(const std::array<double, M>& c) {
    std::array<double, M + 1> out{};
    out[0] = c[0];
    for (std::size_t i = 1; i < M; ++i) {
        const double part = static_cast<double>(i) / static_cast<double>(M);
        out[i] = part * c[i - 1] + (1.0 - part) * c[i];
    }
    out[M] = c[M - 1];
    return out;
}

/// Cuts p at u: `left` gets the part on [0, u] and `right` that on [u, 1], each on [0, 1] again. They share the value at u.
template <std::size_t M>
constexpr void split(const std::array<double, M>& c, double u, std::array<double, M>& left,
                     std::array<double, M>& right) {
    std::array<double, M> b = c;
    const double v = 1.0 - u;
    for (std::size_t n = M; n-- > 0;) {
        left[M - 1 - n] = b[0];
        right[n] = b[n];
        for (std::size_t i = 0; i < n; ++i) b[i] = v * b[i] + u * b[i + 1];
    }
}

/// a + factor b.
template <std::size_t M>
[[nodiscard]] constexpr std::array<double, M> sum_of(const std::array<double, M>& a,
                                                     const std::array<double, M>& b,
                                                     double factor) {
    std::array<double, M> out{};
    for (std::size_t i = 0; i < M; ++i) out[i] = a[i] + factor * b[i];
    return out;
}

/// Largest |c[i]|: no value is larger.
template <std::size_t M>
[[nodiscard]] constexpr double size_of(const std::array<double, M>& c) {
    double size = 0.0;
    for (const double x : c) size = std::max(size, x < 0 ? -x : x);
    return size;
}

/// How often the signs of the coefficients change, 0 counting as positive: p has as many zeros in (0, 1) or an even number
/// less (Descartes' rule in Bernstein form).
template <std::size_t M>
[[nodiscard]] constexpr int sign_changes(const std::array<double, M>& c) {
    int changes = 0;
    for (std::size_t i = 0; i + 1 < M; ++i) changes += (c[i] < 0.0) != (c[i + 1] < 0.0) ? 1 : 0;
    return changes;
}

}  // namespace raymo::curves
