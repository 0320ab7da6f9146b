#include "raymo/curves/outline.hpp"

#include <algorithm>
#include <numbers>

#include "raymo/core/assert.hpp"
#include "raymo/math/affine.hpp"

namespace raymo::curves {

Span2 segment(Vec2 a, Vec2 b) {
    const Vec2 third = (b - a) * (1.0 / 3.0);
    return cubic(a, a + third, b - third, b);
}

Span2 cubic(Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
    Span2 out;
    out.x = {a.x, b.x, c.x, d.x};
    out.y = {a.y, b.y, c.y, d.y};
    return out;
}

Span2 quadratic(Vec2 a, Vec2 b, Vec2 c) {
    constexpr double kThird = 1.0 / 3.0;
    return cubic(a, a + (b - a) * (2.0 * kThird), c + (b - c) * (2.0 * kThird), c);
}

// The rational quadratic with control points a, b, c, where b is the corner of the tangents, has weights 1, cos(half the
// angle), 1 [Farin02 12]; here it is raised to a cubic.
Span2 arc(Vec2 centre, double radius, double from, double to) {
    RAYMO_ASSERT(std::fabs(to - from) <= 90.0 + 1e-9);
    const SinCos first = sin_cos_degrees(from);
    const SinCos last = sin_cos_degrees(to);
    const SinCos middle = sin_cos_degrees(0.5 * (from + to));
    const double w = sin_cos_degrees(0.5 * (to - from)).cos;
    const Vec2 a = centre + radius * Vec2{first.cos, first.sin};
    const Vec2 c = centre + radius * Vec2{last.cos, last.sin};
    // w times the corner, which is centre + radius / w (cos, sin) of the middle.
    const Vec2 b = centre * w + radius * Vec2{middle.cos, middle.sin};
    constexpr double kThird = 1.0 / 3.0;
    Span2 out;
    out.x = {a.x, (a.x + 2.0 * b.x) * kThird, (2.0 * b.x + c.x) * kThird, c.x};
    out.y = {a.y, (a.y + 2.0 * b.y) * kThird, (2.0 * b.y + c.y) * kThird, c.y};
    out.w = {1.0, (1.0 + 2.0 * w) * kThird, (1.0 + 2.0 * w) * kThird, 1.0};
    return out;
}

Span2 mapped(const Span2& span, const Affine2& map) {
    Span2 out = span;
    for (std::size_t i = 0; i < 4; ++i) {
        out.x[i] = map.xx * span.x[i] + map.xy * span.y[i] + map.x * span.w[i];
        out.y[i] = map.yx * span.x[i] + map.yy * span.y[i] + map.y * span.w[i];
    }
    return out;
}

Span2 reversed(const Span2& span) {
    Span2 out = span;
    std::reverse(out.x.begin(), out.x.end());
    std::reverse(out.y.begin(), out.y.end());
    std::reverse(out.w.begin(), out.w.end());
    return out;
}

}  // namespace raymo::curves
