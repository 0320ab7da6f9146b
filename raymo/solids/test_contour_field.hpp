// Membership of a region's points in 113 bits, for the judges of conformance.hpp: winding numbers by crossings that are
// polished in that precision.
#pragma once

#include <cmath>

#include "raymo/curves/region.hpp"
#include "raymo/curves/roots.hpp"
#include "raymo/solids/test_quad.hpp"

namespace raymo::solids::conformance {

inline Quad quad_value(const std::array<double, 4>& c, Quad u) {
    const Quad v = 1 - u;
    return v * v * (v * c[0] + 3 * u * c[1]) + u * u * (3 * v * c[2] + u * c[3]);
}
inline Quad quad_slope(const std::array<double, 4>& c, Quad u) {
    const Quad v = 1 - u;
    return 3 * (v * v * (Quad(c[1]) - c[0]) + 2 * u * v * (Quad(c[2]) - c[1]) +
                u * u * (Quad(c[3]) - c[2]));
}

/// Whether the half-line from p towards larger x meets the piece, which is monotone: +1 or -1, and 0 if not.
inline int quad_turn(const curves::Piece& piece, Quad px, Quad py) {
    const Quad first = piece.y[0] - py * piece.w[0];
    const Quad last = piece.y[3] - py * piece.w[3];
    const bool rises = first < 0;
    if (rises == (last < 0)) return 0;
    const int turn = rises ? 1 : -1;
    const Box2 box = curves::box_of(piece);
    if (px < box.lo.x) return turn;
    if (px > box.hi.x) return 0;
    // Newton's method, kept within the bracket; halvings see to the rest.
    Quad lo = 0, hi = 1;
    Quad u = first / (first - last);
    for (int i = 0; i < 200; ++i) {
        const Quad f = quad_value(piece.y, u) - py * quad_value(piece.w, u);
        if ((f < 0) == rises) {
            lo = u;
        } else {
            hi = u;
        }
        const Quad slope = quad_slope(piece.y, u) - py * quad_slope(piece.w, u);
        Quad next = slope != 0 ? u - f / slope : lo;
        if (!(next > lo && next < hi)) next = (lo + hi) / 2;
        const Quad step = next > u ? next - u : u - next;
        u = next;
        if (step < Quad(0x1p-106)) break;
    }
    const Quad x = quad_value(piece.x, u) / quad_value(piece.w, u);
    return x > px ? turn : 0;
}

inline bool quad_inside(const curves::Region& region, Quad px, Quad py) {
    int winding = 0;
    const auto y = static_cast<double>(py);
    const double margin = 0x1p-50 * (1.0 + std::fabs(y));
    region.walk([&](const Box2& box) { return box.lo.y <= y + margin && box.hi.y >= y - margin; },
                [&](std::uint32_t i) { winding += quad_turn(region.pieces()[i], px, py); });
    return region.encloses(winding);
}

}  // namespace raymo::solids::conformance
