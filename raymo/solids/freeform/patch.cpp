#include "raymo/solids/freeform/patch.hpp"

#include <cmath>

namespace raymo::solids {
namespace {

/// Four control points of a cubic over [0, 1], over [a, b].
void restrict_cubic(double& c0, double& c1, double& c2, double& c3, double a, double b) {
    // Blossoms: f(a, a, a), f(a, a, b), f(a, b, b), f(b, b, b).
    const auto mix = [](double p, double q, double t) { return p * (1.0 - t) + q * t; };
    const double a01 = mix(c0, c1, a), a12 = mix(c1, c2, a), a23 = mix(c2, c3, a);
    const double b01 = mix(c0, c1, b), b12 = mix(c1, c2, b), b23 = mix(c2, c3, b);
    const double aa0 = mix(a01, a12, a), aa1 = mix(a12, a23, a);
    const double bb0 = mix(b01, b12, b), bb1 = mix(b12, b23, b);
    c0 = mix(aa0, aa1, a);
    c1 = mix(aa0, aa1, b);
    c2 = mix(bb0, bb1, a);
    c3 = mix(bb0, bb1, b);
}

}  // namespace

void Patch::find_bend() {
    double uu = 0.0, uv = 0.0, vv = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            const Vec3 p = point(i, j);
            if (i < 2) uu = std::max(uu, norm(p - point(i + 1, j) * 2.0 + point(i + 2, j)));
            if (j < 2) vv = std::max(vv, norm(p - point(i, j + 1) * 2.0 + point(i, j + 2)));
            if (i < 3 && j < 3) {
                uv = std::max(
                    uv, norm((point(i + 1, j + 1) - point(i + 1, j)) - (point(i, j + 1) - p)));
            }
        }
    }
    bend = std::max(6.0 * uu, std::max(9.0 * uv, 6.0 * vv));
}

Aabb Patch::control_box() const {
    Aabb box;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) box.include(point(i, j));
    }
    return box;
}

Patch restricted(const Patch& patch, const PatchPart& part) {
    Patch out = patch;
    for (auto& rows : out.c) {
        for (auto& row : rows) restrict_cubic(row[0], row[1], row[2], row[3], part.u0, part.u1);
        for (std::size_t i = 0; i < 4; ++i)
            restrict_cubic(rows[0][i], rows[1][i], rows[2][i], rows[3][i], part.v0, part.v1);
    }
    return out;
}

}  // namespace raymo::solids
