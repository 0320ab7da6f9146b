#include "raymo/blends/path.hpp"

#include <algorithm>
#include <cmath>

#include "raymo/blends/least_squares.hpp"

namespace raymo::blends {
namespace {

/// Zeros and extrema of the stretched Chebyshev polynomial: (1 +- cos(3 pi / 10) / cos(pi / 10)) / 2 and 1/2, and
/// (1 +- cos(k pi / 5) / cos(pi / 10)) / 2.
constexpr double kMet[] = {0.19098300562505258, 0.5, 0.80901699437494742};
constexpr double kOff[] = {0.07467459582398, 0.3375401518835468, 0.6624598481164532,
                           0.9253254041760199};
constexpr int kNewtonSteps = 3;
/// A span is not longer than this many times the one before; lengths are tried with some room.
constexpr double kMostGrowth = 2.0;
constexpr double kRoom = 0.95;
constexpr int kMostTries = 40;
constexpr std::size_t kMostSpans = 16384;
/// The tangent turns by less than 60 degrees over a span.
constexpr double kLeastCosine = 0.5;

curves::PathSpan path_span(const Cubic& c, double radius) {
    curves::PathSpan out;
    for (std::size_t i = 0; i < 4; ++i) {
        out.x[i] = c[i].x;
        out.y[i] = c[i].y;
        out.z[i] = c[i].z;
        out.r[i] = radius;
    }
    return out;
}

/// Whether a cubic runs ahead all the way.
bool runs_ahead(const Cubic& c) {
    const Vec3 chord = c[3] - c[0];
    return dot(c[1] - c[0], chord) > 0.0 && dot(c[2] - c[1], chord) > 0.0 &&
           dot(c[3] - c[2], chord) > 0.0;
}

/// The cubic through both ends and three places between.
std::optional<Cubic> through_path(const Spine& spine, const Station& from, const Station& to) {
    Cubic cubic = path_between(from, to);
    const double length = norm(to.centre - from.centre);
    for (int step = 0; step < kNewtonSteps; ++step) {
        LeastSquares<6> conditions;
        double worst = 0.0;
        for (const double u : kMet) {
            const Vec3 at = value_at(cubic, u);
            const Vec3 way = unit(slope_at(cubic, u));
            const auto on_path = spine.beside(at, way);
            if (!on_path || !(norm(*on_path - at) < 0.25 * length)) return std::nullopt;
            const double b1 = 3.0 * (1.0 - u) * (1.0 - u) * u;
            const double b2 = 3.0 * (1.0 - u) * u * u;
            Vec3 across[2];
            make_frame(way, across[0], across[1]);
            for (const Vec3 n : across) {
                const double off = dot(n, *on_path - at);
                worst = std::max(worst, std::fabs(off));
                conditions.add({n.x * b1, n.y * b1, n.z * b1, n.x * b2, n.y * b2, n.z * b2, off});
            }
        }
        if (worst <= spine.rounding()) break;
        const std::array<double, 6> x = conditions.solved();
        cubic[1] = cubic[1] + Vec3{x[0], x[1], x[2]};
        cubic[2] = cubic[2] + Vec3{x[3], x[4], x[5]};
        if (!is_finite(cubic[1]) || !is_finite(cubic[2]) || !runs_ahead(cubic)) return std::nullopt;
    }
    return cubic;
}

double off_by(const Spine& spine, const Cubic& cubic) {
    double most = 0.0;
    const auto look = [&](double u) {
        const double off = spine.off(value_at(cubic, u));
        most = std::max(most, std::isfinite(off) ? off : Aabb::kInf);
    };
    for (const double u : kOff) look(u);
    for (const double u : kMet) look(u);
    return most;
}

}  // namespace

bool append_path(const Spine& spine, const Station& first, const Station& last, double tolerance,
                 double radius, std::vector<curves::PathSpan>& out) {
    const double allowed = std::max(tolerance, spine.rounding());
    Station from = first;
    double step = 0.25 * spine.radius();
    int tries = 0;
    while (from.t < last.t) {
        const auto to = from.t + step >= last.t ? std::optional(last) : spine.at(from.t + step);
        if (!to) return false;
        const double tried = to->t - from.t;
        double change = 0.5;
        if (dot(from.tangent, to->tangent) > kLeastCosine) {
            if (const auto cubic = through_path(spine, from, *to)) {
                const double off = off_by(spine, *cubic);
                change = std::clamp(kRoom * std::pow(allowed / off, 0.2), 0.25, kMostGrowth);
                if (off <= allowed) {
                    if (out.size() >= kMostSpans) return false;
                    out.push_back(path_span(*cubic, radius));
                    from = *to;
                    step = tried * change;
                    tries = 0;
                    continue;
                }
            }
        }
        if (++tries == kMostTries) return false;
        step = tried * std::min(change, 0.9);
    }
    return true;
}

}  // namespace raymo::blends
