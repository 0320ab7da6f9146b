// Boxes of sweeps under affine maps.
//
// In direction n the balls of a span reach to the largest n.r + |n| a, a cubic. Where the half-space m.x >= c of a flat cap
// cuts them, they reach no further than, for any y >= 0,
//     the largest  (n + y m).r + |n + y m| a - y c,
// and the least of these, a convex function of y, is how far the part of their convex hull reaches that is not cut off.
#include <cmath>
#include <limits>

#include "raymo/solids/sweep/sweep.hpp"

namespace raymo::solids {
namespace {

double reach_of(const SweptSpan& span, Vec3 n) { return reach(span.cubics, n, norm(n)); }

/// Least value for y >= 0 of the convex f, by golden sections; `scale`: a first step.
template <class F>
double least(const F& f, double scale, double& y) {
    double lo = 0.0;
    double hi = scale;
    for (int i = 0; i < 60 && f(2.0 * hi) < f(hi); ++i) hi *= 2.0;
    hi *= 2.0;
    constexpr double kGolden = 0.6180339887498949;
    for (int i = 0; i < 90; ++i) {
        const double a = hi - kGolden * (hi - lo);
        const double b = lo + kGolden * (hi - lo);
        if (f(a) < f(b)) {
            hi = b;
        } else {
            lo = a;
        }
    }
    y = 0.5 * (lo + hi);
    const double found = f(y);
    const double none = f(0.0);
    if (none <= found) y = 0.0;
    return std::fmin(found, none);
}

double cut_reach(const SweptSpheres& spheres, const SweptSpan& span, Vec3 n) {
    double y[2] = {0.0, 0.0};
    double most = reach_of(span, n);
    for (int round = 0; round < 3; ++round) {
        for (std::size_t k = 0; k < 2; ++k) {
            if ((span.cut >> k & 1U) == 0) continue;
            const auto f = [&](double at) {
                double w[2] = {y[0], y[1]};
                w[k] = at;
                return reach_of(span, n + spheres.caps[0].n * w[0] + spheres.caps[1].n * w[1]) -
                       w[0] * spheres.caps[0].c - w[1] * spheres.caps[1].c;
            };
            most = std::fmin(most, least(f, norm(n), y[k]));
        }
        if (span.cut != 3) break;
    }
    return most;
}

}  // namespace

Aabb Sweep::Kernel::bounds(const Affine& map) const {
    Aabb box;
    for (int i = 0; i < 3; ++i) {
        const Vec3 n = map.linear.row[static_cast<std::size_t>(i)];
        double high = -std::numeric_limits<double>::infinity();
        double low = high;
        for (const SweptSpan& span : spheres_->spans) {
            high =
                std::fmax(high, span.cut != 0 ? cut_reach(*spheres_, span, n) : reach_of(span, n));
            low =
                std::fmax(low, span.cut != 0 ? cut_reach(*spheres_, span, -n) : reach_of(span, -n));
        }
        box.hi[i] = map.offset[i] + high;
        box.lo[i] = map.offset[i] - low;
    }
    return box;
}

}  // namespace raymo::solids
