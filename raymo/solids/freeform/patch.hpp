// A bicubic patch, and places on it.
#pragma once

#include <array>
#include <cstddef>
#include <cstring>

#include "raymo/math/aabb.hpp"

namespace raymo::solids {

/// Rectangle of a patch's parameters.
struct PatchPart {
    double u0, u1, v0, v1;
};
inline constexpr PatchPart kWholePatch{0.0, 1.0, 0.0, 1.0};

struct PatchJet {
    Vec3 at, du, dv;
};

/// Values and derivatives of the four cubic Bernstein polynomials.
struct CubicWeights {
    std::array<double, 4> value, slope;
    explicit CubicWeights(double u) {
        const double w = 1.0 - u;
        const double uu = u * u;
        const double ww = w * w;
        const double uw = 2.0 * (u * w);
        value = {ww * w, 3.0 * (ww * u), 3.0 * (uu * w), uu * u};
        slope = {-3.0 * ww, 3.0 * (ww - uw), 3.0 * (uw - uu), 3.0 * uu};
    }
};

/// c[axis][j][i] is a coordinate of b_ij: u runs along i, v along j.
struct Patch {
    std::array<std::array<std::array<double, 4>, 4>, 3> c;
    double bend = 0.0;  ///< no second derivative is larger on [0, 1]^2

    [[nodiscard]] Vec3 point(std::size_t i, std::size_t j) const {
        return {c[0][j][i], c[1][j][i], c[2][j][i]};
    }
    void set(std::size_t i, std::size_t j, Vec3 p) {
        for (int a = 0; a < 3; ++a) c[static_cast<std::size_t>(a)][j][i] = p[a];
    }
    [[nodiscard]] PatchJet at(double u, double v) const {
        // Two rows of control points side by side: what every processor computes at once, written so that the compiler
        // sees it.
        using Two = double __attribute__((vector_size(16)));
        const CubicWeights by_u(u);
        const CubicWeights by_v(v);
        const auto two = [](const double* from) {
            Two out;
            std::memcpy(&out, from, sizeof out);
            return out;
        };
        const Two value_u[2] = {two(&by_u.value[0]), two(&by_u.value[2])};
        const Two slope_u[2] = {two(&by_u.slope[0]), two(&by_u.slope[2])};
        const std::array<double, 4>& f = by_v.value;
        const std::array<double, 4>& g = by_v.slope;
        PatchJet out;
        for (int a = 0; a < 3; ++a) {
            const auto& rows = c[static_cast<std::size_t>(a)];
            Two at[2], du[2], dv[2];
            for (std::size_t k = 0; k < 2; ++k) {
                const Two r0 = two(&rows[0][2 * k]), r1 = two(&rows[1][2 * k]);
                const Two r2 = two(&rows[2][2 * k]), r3 = two(&rows[3][2 * k]);
                const Two value = (r0 * f[0] + r1 * f[1]) + (r2 * f[2] + r3 * f[3]);
                const Two slope = (r0 * g[0] + r1 * g[1]) + (r2 * g[2] + r3 * g[3]);
                at[k] = value * value_u[k];
                du[k] = value * slope_u[k];
                dv[k] = slope * value_u[k];
            }
            out.at[a] = (at[0][0] + at[0][1]) + (at[1][0] + at[1][1]);
            out.du[a] = (du[0][0] + du[0][1]) + (du[1][0] + du[1][1]);
            out.dv[a] = (dv[0][0] + dv[0][1]) + (dv[1][0] + dv[1][1]);
        }
        return out;
    }
    /// Sets `bend` from the control points.
    void find_bend();
    [[nodiscard]] Aabb control_box() const;
};

/// Control vectors of the derivatives of a bicubic patch: the derivatives lie in their convex hulls.
template <class Vec>
struct PatchSlopes {
    std::array<Vec, 12> du, dv;
};
/// `point(i, j)` is b_ij.
template <class Point>
[[nodiscard]] auto slopes_of(const Point& point) {
    PatchSlopes<decltype(point(std::size_t{0}, std::size_t{0}))> out;
    std::size_t n = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            out.du[n] = (point(i + 1, j) - point(i, j)) * 3.0;
            out.dv[n] = (point(j, i + 1) - point(j, i)) * 3.0;
            ++n;
        }
    }
    return out;
}

/// The same polynomial over a part, on [0, 1]^2 again.
[[nodiscard]] Patch restricted(const Patch& patch, const PatchPart& part);

}  // namespace raymo::solids
