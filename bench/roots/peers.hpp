// Two ways to find the zeros of a polynomial among all complex ones, as peers of find_roots. Plainly written; they serve this
// benchmark only.
#pragma once

#include <array>
#include <cmath>
#include <utility>

namespace raymo::bench {

struct Complex {
    double re = 0.0, im = 0.0;

    friend Complex operator+(Complex a, Complex b) { return {a.re + b.re, a.im + b.im}; }
    friend Complex operator-(Complex a, Complex b) { return {a.re - b.re, a.im - b.im}; }
    friend Complex operator*(Complex a, Complex b) {
        return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
    }
    friend Complex operator*(double a, Complex b) { return {a * b.re, a * b.im}; }
    friend Complex operator/(Complex a, Complex b) {
        const double inverse = 1.0 / (b.re * b.re + b.im * b.im);
        return {(a.re * b.re + a.im * b.im) * inverse, (a.im * b.re - a.re * b.im) * inverse};
    }
};
inline double norm2(Complex a) { return a.re * a.re + a.im * a.im; }
inline Complex conjugate(Complex a) { return {a.re, -a.im}; }
inline Complex root_of(Complex a) {
    const double size = std::sqrt(std::sqrt(norm2(a)) * 0.5 + std::fabs(a.re) * 0.5);
    if (size == 0.0) return {};
    const double other = a.im / (2.0 * size);
    if (a.re >= 0.0) return {size, other};
    return {std::fabs(other), a.im < 0.0 ? -size : size};
}

/// Zeros that count as real and lie in [0, 1].
template <int N>
struct RealZeros {
    int count = 0;
    std::array<double, static_cast<std::size_t>(N)> u{};

    void add(Complex z) {
        if (std::fabs(z.im) <= 1e-9 && z.re >= 0.0 && z.re <= 1.0)
            u[static_cast<std::size_t>(count++)] = z.re;
    }
};

/// Laguerre's method from 0, one zero after another, each divided out.
template <int N>
RealZeros<N> laguerre_roots(const std::array<double, static_cast<std::size_t>(N) + 1>& f) {
    std::array<Complex, static_cast<std::size_t>(N) + 1> a;
    for (std::size_t i = 0; i <= N; ++i) a[i] = {f[i], 0.0};
    RealZeros<N> out;
    for (std::size_t n = N; n > 0; --n) {
        Complex x;
        const double degree = static_cast<double>(n);
        for (int round = 0; round < 60; ++round) {
            Complex p = a[n], d, h;  // p, p', p'' / 2
            for (std::size_t i = n; i-- > 0;) {
                h = h * x + d;
                d = d * x + p;
                p = p * x + a[i];
            }
            if (norm2(p) == 0.0) break;
            const Complex g = d / p;
            const Complex g2 = g * g;
            const Complex hh = g2 - 2.0 * (h / p);
            const Complex s = root_of((degree - 1.0) * (degree * hh - g2));
            const Complex plus = g + s, minus = g - s;
            const Complex denominator = norm2(plus) > norm2(minus) ? plus : minus;
            const Complex step =
                norm2(denominator) > 0.0 ? Complex{degree, 0.0} / denominator : Complex{0.5, 0.5};
            x = x - step;
            if (norm2(step) <= 0x1p-100 * norm2(x)) break;
        }
        out.add(x);
        Complex carry = a[n];
        for (std::size_t i = n; i-- > 0;) {
            const Complex next = a[i] + x * carry;
            a[i] = carry;
            carry = next;
        }
    }
    return out;
}

/// Eigenvalues of the companion matrix, by QR steps with Wilkinson's shift on its Hessenberg form.
template <int N>
RealZeros<N> companion_roots(const std::array<double, static_cast<std::size_t>(N) + 1>& f) {
    constexpr auto kSize = static_cast<std::size_t>(N);
    std::array<std::array<Complex, kSize>, kSize> m{};
    for (std::size_t i = 0; i < kSize; ++i) m[0][i] = {-f[kSize - 1 - i] / f[kSize], 0.0};
    for (std::size_t i = 1; i < kSize; ++i) m[i][i - 1] = {1.0, 0.0};
    RealZeros<N> out;
    std::size_t n = kSize;
    for (int round = 0; n > 0 && round < 60 * N;) {
        if (n == 1) {
            out.add(m[0][0]);
            break;
        }
        std::size_t start = n - 1;
        while (start > 0) {
            const double beside = norm2(m[start][start]) + norm2(m[start - 1][start - 1]);
            if (norm2(m[start][start - 1]) <= 0x1p-104 * beside) break;
            --start;
        }
        if (start == n - 1) {
            out.add(m[n - 1][n - 1]);
            --n;
            continue;
        }
        ++round;
        const Complex a = m[n - 2][n - 2], b = m[n - 2][n - 1], c = m[n - 1][n - 2],
                      d = m[n - 1][n - 1];
        const Complex half = 0.5 * (a - d);
        const Complex s = root_of(half * half + b * c);
        const Complex middle = 0.5 * (a + d);
        const Complex one = middle + s, two = middle - s;
        Complex shift = norm2(one - d) < norm2(two - d) ? one : two;
        if (round % 11 == 10) shift = shift + Complex{std::sqrt(norm2(c)), 0.0};  // out of a cycle
        for (std::size_t i = start; i < n; ++i) m[i][i] = m[i][i] - shift;
        std::array<std::pair<Complex, Complex>, kSize> turns;
        for (std::size_t i = start; i + 1 < n; ++i) {
            const Complex x = m[i][i], y = m[i + 1][i];
            const double length = std::sqrt(norm2(x) + norm2(y));
            const double inverse = length > 0.0 ? 1.0 / length : 0.0;
            const Complex p = length > 0.0 ? inverse * x : Complex{1.0, 0.0}, q = inverse * y;
            turns[i] = {p, q};
            for (std::size_t k = i; k < n; ++k) {
                const Complex u = m[i][k], v = m[i + 1][k];
                m[i][k] = conjugate(p) * u + conjugate(q) * v;
                m[i + 1][k] = p * v - q * u;
            }
        }
        for (std::size_t i = start; i + 1 < n; ++i) {
            const auto [p, q] = turns[i];
            for (std::size_t k = start; k <= i + 1; ++k) {
                const Complex u = m[k][i], v = m[k][i + 1];
                m[k][i] = u * p + v * q;
                m[k][i + 1] = v * conjugate(p) - u * conjugate(q);
            }
        }
        for (std::size_t i = start; i < n; ++i) m[i][i] = m[i][i] + shift;
    }
    return out;
}

}  // namespace raymo::bench
