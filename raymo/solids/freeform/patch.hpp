// A bicubic patch, and places on it.
#pragma once

#include <array>
#include <cstddef>

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
        const CubicWeights by_u(u);
        const CubicWeights by_v(v);
        PatchJet out;
        for (int a = 0; a < 3; ++a) {
            const auto& rows = c[static_cast<std::size_t>(a)];
            std::array<double, 4> value, slope;
            for (std::size_t i = 0; i < 4; ++i) {
                value[i] = (rows[0][i] * by_v.value[0] + rows[1][i] * by_v.value[1]) +
                           (rows[2][i] * by_v.value[2] + rows[3][i] * by_v.value[3]);
                slope[i] = (rows[0][i] * by_v.slope[0] + rows[1][i] * by_v.slope[1]) +
                           (rows[2][i] * by_v.slope[2] + rows[3][i] * by_v.slope[3]);
            }
            out.at[a] = (value[0] * by_u.value[0] + value[1] * by_u.value[1]) +
                        (value[2] * by_u.value[2] + value[3] * by_u.value[3]);
            out.du[a] = (value[0] * by_u.slope[0] + value[1] * by_u.slope[1]) +
                        (value[2] * by_u.slope[2] + value[3] * by_u.slope[3]);
            out.dv[a] = (slope[0] * by_u.value[0] + slope[1] * by_u.value[1]) +
                        (slope[2] * by_u.value[2] + slope[3] * by_u.value[3]);
        }
        return out;
    }
    /// Sets `bend` from the control points.
    void find_bend();
    [[nodiscard]] Aabb control_box() const;
};

/// The same polynomial over a part, on [0, 1]^2 again.
[[nodiscard]] Patch restricted(const Patch& patch, const PatchPart& part);

}  // namespace raymo::solids
