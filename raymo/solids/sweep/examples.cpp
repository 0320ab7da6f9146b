// Sweeps that the laws are tried on.
#include <cmath>
#include <numbers>

#include "raymo/solids/sweep/sweep.hpp"

namespace raymo::solids {
namespace {

using curves::Path;
using curves::PathSpan;

struct Ball {
    Vec3 p;
    double r;
};

Ball between(const Ball& a, const Ball& b, double t) {
    return {a.p * (1.0 - t) + b.p * t, a.r * (1.0 - t) + b.r * t};
}

PathSpan bezier(const Ball& a, const Ball& b, const Ball& c, const Ball& d) {
    return {{a.p.x, b.p.x, c.p.x, d.p.x},
            {a.p.y, b.p.y, c.p.y, d.p.y},
            {a.p.z, b.p.z, c.p.z, d.p.z},
            {a.r, b.r, c.r, d.r}};
}
PathSpan straight(const Ball& a, const Ball& b) {
    return bezier(a, between(a, b, 1.0 / 3.0), between(a, b, 2.0 / 3.0), b);
}
PathSpan quadratic(const Ball& a, const Ball& b, const Ball& c) {
    return bezier(a, between(a, b, 2.0 / 3.0), between(c, b, 2.0 / 3.0), c);
}

/// A uniform cubic B-spline round in a ring.
Path ring(const std::vector<Ball>& points) {
    Path out;
    out.closed = true;
    const std::size_t n = points.size();
    for (std::size_t i = 0; i < n; ++i) {
        const Ball& before = points[(i + n - 1) % n];
        const Ball& a = points[i];
        const Ball& b = points[(i + 1) % n];
        const Ball& after = points[(i + 2) % n];
        const Ball first = between(between(before, a, 2.0 / 3.0), between(a, b, 1.0 / 3.0), 0.5);
        const Ball last = between(between(a, b, 2.0 / 3.0), between(b, after, 1.0 / 3.0), 0.5);
        out.spans.push_back(
            bezier(first, between(a, b, 1.0 / 3.0), between(a, b, 2.0 / 3.0), last));
    }
    return out;
}

/// Quarter turns about the z axis.
Path spring(int quarters, double radius, double pitch, double wire) {
    Path out;
    const double handle = 4.0 / 3.0 * std::tan(std::numbers::pi / 8.0);
    const auto at = [&](int i) {
        const double c[4] = {1, 0, -1, 0};
        return Ball{{radius * c[i % 4], radius * c[(i + 3) % 4], 0.25 * pitch * i}, wire};
    };
    const auto tangent = [&](int i) {
        const double c[4] = {1, 0, -1, 0};
        return Vec3{-radius * c[(i + 3) % 4] * handle, radius * c[i % 4] * handle, pitch / 12.0};
    };
    for (int i = 0; i < quarters; ++i) {
        const Ball a = at(i);
        const Ball d = at(i + 1);
        out.spans.push_back(bezier(a, {a.p + tangent(i), wire}, {d.p - tangent(i + 1), wire}, d));
    }
    return out;
}

std::vector<Argument> sweep(Path path, bool flat = false) {
    return {std::make_shared<const Path>(std::move(path)), std::size_t{flat ? 1U : 0U}};
}

std::vector<std::vector<Argument>> make() {
    std::vector<std::vector<Argument>> out;
    const Ball a{{0, 0, 0}, 1};
    const Ball b{{10, 0, 5}, 3};
    const Ball c{{20, 5, 0}, 1};
    const Ball d{{25, 0, 0}, 2};
    // A capsule.
    out.push_back(sweep({{straight({{0, 0, 0}, 1}, {{0, 0, 4}, 1})}, false}));
    // Two cubics with radii that change.
    out.push_back(sweep(
        {{bezier(a, b, c, d), bezier(d, between(c, d, 2.0), {{40, 0, 10}, 3}, {{30, 10, 10}, 1})},
         false}));
    // A cone-sphere with a tip.
    out.push_back(sweep({{straight({{1, 2, 3}, 2}, {{4, 2, 3}, 0})}, false}));
    // A parabola thick enough to meet itself.
    out.push_back(
        sweep({{quadratic({{-1, 1, 0}, 0.8}, {{0, -1, 0}, 0.8}, {{1, 1, 0}, 0.8})}, false}));
    // A loop that crosses itself (q^2 - 1, q (q^2 - 1), 0), -1.5 <= q <= 1.5.
    out.push_back(sweep({{bezier({{1.25, -1.875, 0}, 0.1}, {{-3.25, 3.875, 0}, 0.1},
                                 {{-3.25, -3.875, 0}, 0.1}, {{1.25, 1.875, 0}, 0.1})},
                         false}));
    // A ring.
    out.push_back(sweep(ring(
        {{{3, 0, 0}, 1}, {{2, 2, 1}, 0.5}, {{0, 3, 0}, 1}, {{-3, 0, 1}, 0.7}, {{0, -3, 0}, 1}})));
    // It stands still at both ends; and turns back in a cusp.
    out.push_back(
        sweep({{bezier({{0, 0, 0}, 1}, {{0, 0, 0}, 1}, {{0, 0, 4}, 1}, {{0, 0, 4}, 1})}, false}));
    out.push_back(sweep(
        {{bezier({{0, 0, 0}, 0.2}, {{4, 4, 0}, 0.3}, {{0, 4, 0}, 0.2}, {{4, 0, 0}, 0.1})}, false}));
    // A ball that holds all others, and one that grows as fast as it moves.
    out.push_back(sweep({{straight({{0, 0, 0}, 1}, {{0, 0, 1}, 3})}, false}));
    out.push_back(sweep({{straight({{0, 0, 0}, 1}, {{0, 0, 2}, 3})}, false}));
    // Very small and very large; a long thin wire.
    const auto scaled = [&](double s) {
        return sweep({{bezier({a.p * s, a.r * s}, {b.p * s, b.r * s}, {c.p * s, c.r * s},
                              {d.p * s, d.r * s})},
                      false});
    };
    out.push_back(scaled(1e-9));
    out.push_back(scaled(1e9));
    out.push_back(
        sweep({{bezier({{0, 0, 0}, 0.2}, {{4, 1, 0}, 0.2}, {{8, -1, 2}, 0.2}, {{9, 0, 9}, 0.2})},
               false}));
    out.push_back(sweep(spring(20, 10, 4, 1)));
    // Flat ends; of a cone, and of an arch whose planes the other leg crosses.
    out.push_back(sweep({{straight({{0, 0, 0}, 2}, {{0, 0, 5}, 1})}, false}, true));
    out.push_back(sweep(
        {{bezier({{0, 0, 0}, 0.5}, {{0, 0, 4}, 0.7}, {{3, 0, 4}, 0.5}, {{3, 0, -2}, 0.5})}, false},
        true));
    out.push_back(sweep(spring(6, 3, 2, 0.5), true));
    return out;
}

}  // namespace

std::span<const std::vector<Argument>> Sweep::examples() {
    static const std::vector<std::vector<Argument>> kExamples = make();
    return kExamples;
}

}  // namespace raymo::solids
