// Four cubics side by side, in Bernstein form: a centre in some frame and a radius.
#pragma once

#include <array>
#include <cstddef>

#include "raymo/curves/path.hpp"

namespace raymo::solids {

/// c[i][k] is coefficient i of cubic k. The first three are coordinates, the last is the radius.
struct Cubics {
    std::array<std::array<double, 4>, 4> c;

    [[nodiscard]] double coordinate(std::size_t i, std::size_t k) const { return c[i][k]; }
    [[nodiscard]] double radius(std::size_t i) const { return c[i][3]; }
    friend bool operator==(const Cubics&, const Cubics&) = default;
};

/// Values and derivatives of four cubics at one place.
struct CubicsJet {
    std::array<double, 4> value, first, second;
};

/// By de Casteljau's construction: means only. An error of at most 9 roundings of the largest coefficient.
[[nodiscard]] inline CubicsJet jet_at(const Cubics& q, double u) {
    CubicsJet out;
    const double v = 1.0 - u;
    for (std::size_t k = 0; k < 4; ++k) {
        const double a0 = v * q.c[0][k] + u * q.c[1][k];
        const double a1 = v * q.c[1][k] + u * q.c[2][k];
        const double a2 = v * q.c[2][k] + u * q.c[3][k];
        const double b0 = v * a0 + u * a1;
        const double b1 = v * a1 + u * a2;
        out.value[k] = v * b0 + u * b1;
        out.first[k] = 3.0 * (b1 - b0);
        out.second[k] = 6.0 * ((a2 - a1) - (a1 - a0));
    }
    return out;
}

/// Cuts at u; the halves share their value there bit for bit.
inline void split(const Cubics& q, double u, Cubics& left, Cubics& right) {
    const double v = 1.0 - u;
    for (std::size_t k = 0; k < 4; ++k) {
        const double a0 = v * q.c[0][k] + u * q.c[1][k];
        const double a1 = v * q.c[1][k] + u * q.c[2][k];
        const double a2 = v * q.c[2][k] + u * q.c[3][k];
        const double b0 = v * a0 + u * a1;
        const double b1 = v * a1 + u * a2;
        const double middle = v * b0 + u * b1;
        left.c[0][k] = q.c[0][k];
        left.c[1][k] = a0;
        left.c[2][k] = b0;
        left.c[3][k] = right.c[0][k] = middle;
        right.c[1][k] = b1;
        right.c[2][k] = a2;
        right.c[3][k] = q.c[3][k];
    }
}

/// Adds `factor` times the square of cubic k to the sextic `out`.
inline void add_square(const Cubics& q, std::size_t k, double factor, std::array<double, 7>& out) {
    const double a = q.c[0][k];
    const double b = q.c[1][k];
    const double c = q.c[2][k];
    const double d = q.c[3][k];
    out[0] += factor * (a * a);
    out[1] += factor * (a * b);
    out[2] += factor * (0.4 * (a * c) + 0.6 * (b * b));
    out[3] += factor * (0.1 * (a * d) + 0.9 * (b * c));
    out[4] += factor * (0.4 * (b * d) + 0.6 * (c * c));
    out[5] += factor * (c * d);
    out[6] += factor * (d * d);
}

[[nodiscard]] inline Cubics cubics_of(const curves::PathSpan& span) {
    Cubics out;
    for (std::size_t i = 0; i < 4; ++i) out.c[i] = {span.x[i], span.y[i], span.z[i], span.r[i]};
    return out;
}

}  // namespace raymo::solids
