#include "tests/laws/contour.hpp"

#include <array>
#include <cmath>

#include "raymo/curves/samples.hpp"

namespace raymo::laws {
namespace {

struct RealSpan {
    std::array<Real, 4> x, y, w;
};

void halve(const std::array<Real, 4>& c, std::array<Real, 4>& left, std::array<Real, 4>& right) {
    const Real a = (c[0] + c[1]) / 2, b = (c[1] + c[2]) / 2, d = (c[2] + c[3]) / 2;
    const Real e = (a + b) / 2, f = (b + d) / 2;
    left = {c[0], a, e, (e + f) / 2};
    right = {(e + f) / 2, f, d, c[3]};
}

/// Crossings of the half-line from (x, y) to the right, upwards less downwards; false: the curve comes too near.
bool count(const RealSpan& whole, Real x, Real y, Real margin, int& winding) {
    std::vector<RealSpan> open{whole};
    while (!open.empty()) {
        const RealSpan span = open.back();
        open.pop_back();
        Real x0 = 1e300L, x1 = -1e300L, y0 = 1e300L, y1 = -1e300L;
        for (std::size_t i = 0; i < 4; ++i) {
            x0 = std::min(x0, span.x[i] / span.w[i]);
            x1 = std::max(x1, span.x[i] / span.w[i]);
            y0 = std::min(y0, span.y[i] / span.w[i]);
            y1 = std::max(y1, span.y[i] / span.w[i]);
        }
        if (y0 > y + margin || y1 < y - margin || x1 < x - margin) continue;
        if (x0 > x + margin) {
            // Right of the point: what matters is from which side of y to which it goes.
            const bool below = span.y[0] / span.w[0] < y;
            if (below != (span.y[3] / span.w[3] < y)) winding += below ? 1 : -1;
            continue;
        }
        if (x1 - x0 <= margin && y1 - y0 <= margin) return false;
        RealSpan left, right;
        halve(span.x, left.x, right.x);
        halve(span.y, left.y, right.y);
        halve(span.w, left.w, right.w);
        open.push_back(right);
        open.push_back(left);
    }
    return true;
}

Vec2 in_disc(Random& random, double r) { return {random.uniform(-r, r), random.uniform(-r, r)}; }

}  // namespace

curves::OutlinePtr random_outline(Random& random, bool beside_axis) {
    curves::Outline outline;
    const Vec2 centre =
        beside_axis ? Vec2{random.uniform(2.5, 3), random.uniform(-1, 1)} : in_disc(random, 1.0);
    const double r = random.uniform(1, 2.4);
    const auto star = [&](std::size_t n, double inner) {
        std::vector<Vec2> points;
        for (std::size_t i = 0; i < n; ++i) {
            const double angle =
                6.283185307179586 * static_cast<double>(i) / static_cast<double>(n);
            const double size = r * (i % 2 == 0 ? 1.0 : inner);
            points.push_back(centre + size * Vec2{std::cos(angle), std::sin(angle)});
        }
        return points;
    };
    switch (random.below(6)) {
        case 0:
            outline.curves.push_back(curves::full_circle(centre, r));
            break;
        case 1:  // points anywhere: mostly crossing itself
            outline.curves.push_back(curves::closed_polygon(
                std::array<Vec2, 5>{centre + in_disc(random, r), centre + in_disc(random, r),
                                    centre + in_disc(random, r), centre + in_disc(random, r),
                                    centre + in_disc(random, r)}));
            outline.fill = random.chance(0.5) ? curves::Fill::even_odd : curves::Fill::non_zero;
            break;
        case 2:
            outline.curves.push_back(curves::closed_bspline(star(10, random.uniform(0.1, 1))));
            break;
        case 3:
            outline.curves.push_back(curves::full_circle(centre, r));
            outline.curves.push_back(curves::closed_polygon(std::array<Vec2, 3>{
                centre + Vec2{0.3, 0}, centre + Vec2{-0.3, 0.2}, centre + Vec2{-0.3, -0.3}}));
            break;
        case 4:
            outline.curves.push_back(curves::closed_polygon(star(8, random.uniform(0.1, 1))));
            break;
        default: {
            // With level and upright sides, and beside an axis one side on it.
            const double left = beside_axis ? 0.0 : -r;
            outline.curves.push_back(curves::closed_polygon(
                std::array<Vec2, 5>{Vec2{left, -1}, {r, -1}, {r, 0.5}, {0.5 * r, 1}, {left, 1}}));
        }
    }
    return std::make_shared<const curves::Outline>(std::move(outline));
}

Side classify(const curves::Outline& outline, Real x, Real y, Real margin, bool beside_axis) {
    int winding = 0;
    for (const curves::Curve& curve : outline.curves) {
        for (const curves::Span2& span : curve.spans) {
            // On the axis, beside which lie all points that are asked about.
            if (beside_axis && span.x == std::array<double, 4>{}) continue;
            RealSpan real;
            for (std::size_t i = 0; i < 4; ++i) {
                real.x[i] = static_cast<Real>(span.x[i]);
                real.y[i] = static_cast<Real>(span.y[i]);
                real.w[i] = static_cast<Real>(span.w[i]);
            }
            if (!count(real, x, y, margin, winding)) return Side::unclear;
        }
    }
    const bool in = outline.fill == curves::Fill::even_odd ? winding % 2 != 0 : winding != 0;
    return in ? Side::in : Side::out;
}

}  // namespace raymo::laws
