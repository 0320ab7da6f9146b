// The judge of sweeps: the least F(p, u) over all u, by samples and local search; nothing of the kernel's own search.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "raymo/solids/sweep/sweep.hpp"
#include "raymo/solids/test_quad.hpp"

namespace raymo::solids::conformance {

/// F, F_u / 2 and F_uu / 2 of a span at u.
template <class R>
struct SweepField {
    R f, f1, f2;
};

template <class R>
SweepField<R> sweep_field(const Cubics& q, const R (&p)[3], R u) {
    const R v = 1 - u;
    SweepField<R> out{};
    for (std::size_t k = 0; k < 4; ++k) {
        R c[4];
        for (std::size_t i = 0; i < 4; ++i) c[i] = R(q.c[i][k]) - (k < 3 ? p[k] : R(0));
        const R x =
            v * v * v * c[0] + 3 * v * v * u * c[1] + 3 * v * u * u * c[2] + u * u * u * c[3];
        const R x1 =
            3 * (v * v * (c[1] - c[0]) + 2 * u * v * (c[2] - c[1]) + u * u * (c[3] - c[2]));
        const R x2 = 6 * (v * (c[2] - 2 * c[1] + c[0]) + u * (c[3] - 2 * c[2] + c[1]));
        const R sign = k < 3 ? 1 : -1;
        out.f += sign * x * x;
        out.f1 += sign * x * x1;
        out.f2 += sign * (x1 * x1 + x * x2);
    }
    return out;
}

/// The least F of a span in the neighbourhood of u, exactly where its sign is not clear in doubles.
inline Quad least_near(const Cubics& q, const QuadPoint& p, double u) {
    const double point[3] = {static_cast<double>(p.x), static_cast<double>(p.y),
                             static_cast<double>(p.z)};
    const double rough = sweep_field<double>(q, point, u).f;
    if (std::fabs(rough) > 1e-8) return rough;
    const Quad exact[3] = {p.x, p.y, p.z};
    Quad at = u;
    SweepField<Quad> field = sweep_field<Quad>(q, exact, at);
    for (int i = 0; i < 4; ++i) {
        if (!(field.f2 > 0)) break;
        Quad next = at - field.f1 / field.f2;
        next = next < 0 ? Quad(0) : (next > 1 ? Quad(1) : next);
        const SweepField<Quad> moved = sweep_field<Quad>(q, exact, next);
        if (!(moved.f < field.f)) break;
        at = next;
        field = moved;
    }
    return field.f;
}

inline Quad least_of_span(const Cubics& q, const QuadPoint& p) {
    constexpr int kSamples = 48;
    const double point[3] = {static_cast<double>(p.x), static_cast<double>(p.y),
                             static_cast<double>(p.z)};
    const auto slope = [&](double u) { return sweep_field<double>(q, point, u).f1; };
    Quad least = std::min(least_near(q, p, 0.0), least_near(q, p, 1.0));
    double u0 = 0.0;
    double f0 = slope(u0);
    for (int i = 1; i <= kSamples; ++i) {
        const double u1 = static_cast<double>(i) / kSamples;
        const double f1 = slope(u1);
        if (f0 <= 0.0 && f1 >= 0.0) {
            double lo = u0;
            double hi = u1;
            for (int k = 0; k < 60 && lo < hi; ++k) {
                const double u = 0.5 * (lo + hi);
                (slope(u) < 0.0 ? lo : hi) = u;
            }
            least = std::min(least, least_near(q, p, 0.5 * (lo + hi)));
        }
        u0 = u1;
        f0 = f1;
    }
    return least;
}

inline Quad field(const Sweep::Kernel& k, const QuadPoint& p) {
    const SweptSpheres& spheres = k.spheres();
    const double x[3] = {static_cast<double>(p.x), static_cast<double>(p.y),
                         static_cast<double>(p.z)};
    Quad least = 1;
    for (const SweptSpan& span : spheres.spans) {
        // Balls about the control points hold the span's balls in their hull.
        bool near = true;
        for (std::size_t a = 0; a < 3; ++a) {
            double lo = std::numeric_limits<double>::infinity();
            double hi = -lo;
            for (const auto& c : span.cubics.c) {
                lo = std::min(lo, c[a] - std::fabs(c[3]));
                hi = std::max(hi, c[a] + std::fabs(c[3]));
            }
            near = near && x[a] > lo - 1e-6 && x[a] < hi + 1e-6;
        }
        if (!near) continue;
        Quad value = least_of_span(span.cubics, p);
        for (std::size_t i = 0; i < 2; ++i) {
            if ((span.cut >> i & 1U) == 0) continue;
            const CapPlane& cap = spheres.caps[i];
            const Quad beyond =
                Quad(cap.c) - Quad(cap.n.x) * p.x - Quad(cap.n.y) * p.y - Quad(cap.n.z) * p.z;
            value = std::max(value, beyond);
        }
        least = std::min(least, value);
    }
    return least;
}

}  // namespace raymo::solids::conformance
