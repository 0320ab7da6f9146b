#include "raymo/curves/samples.hpp"

#include <array>
#include <cmath>

#include "raymo/math/affine.hpp"

namespace raymo::curves {
namespace {

OutlinePtr shared(std::vector<Curve> curves, Fill fill = Fill::even_odd) {
    return std::make_shared<const Outline>(Outline{std::move(curves), fill});
}

Vec2 on_circle(double radius, double degrees) {
    const SinCos at = sin_cos_degrees(degrees);
    return radius * Vec2{at.cos, at.sin};
}

}  // namespace

Curve closed_polygon(std::span<const Vec2> points) {
    Curve curve;
    for (std::size_t i = 0; i < points.size(); ++i)
        curve.spans.push_back(segment(points[i], points[(i + 1) % points.size()]));
    curve.closed = true;
    return curve;
}

Curve full_circle(Vec2 centre, double radius) {
    Curve curve;
    for (int i = 0; i < 4; ++i)
        curve.spans.push_back(arc(centre, radius, 90.0 * i, 90.0 * (i + 1)));
    curve.closed = true;
    return curve;
}

Curve closed_bspline(std::span<const Vec2> points) {
    const std::size_t n = points.size();
    Curve curve;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec2 a = points[i];
        const Vec2 b = points[(i + 1) % n];
        const Vec2 c = points[(i + 2) % n];
        const Vec2 d = points[(i + 3) % n];
        constexpr double kSixth = 1.0 / 6.0;
        constexpr double kThird = 1.0 / 3.0;
        curve.spans.push_back(cubic((a + 4.0 * b + c) * kSixth, (2.0 * b + c) * kThird,
                                    (b + 2.0 * c) * kThird, (b + 4.0 * c + d) * kSixth));
    }
    curve.closed = true;
    return curve;
}

OutlinePtr sample_rectangle() {
    const std::array<Vec2, 4> points{Vec2{1, -2}, {4, -2}, {4, 1}, {1, 1}};
    return shared({closed_polygon(points)});
}

OutlinePtr sample_disc() { return shared({full_circle({0, 0}, 5)}); }

OutlinePtr sample_washer() {
    const std::array<Vec2, 4> hole{Vec2{-6, -2}, {-2, -2}, {-2, 2}, {-6, 2}};
    return shared({full_circle({0, 0}, 10), closed_polygon(hole), full_circle({4, 0}, 3),
                   full_circle({4, 0}, 1)});
}

OutlinePtr sample_pentagram(Fill fill) {
    std::array<Vec2, 5> points;
    for (std::size_t i = 0; i < 5; ++i)
        points[i] = on_circle(3.0, 90.0 + 144.0 * static_cast<double>(i));
    return shared({closed_polygon(points)}, fill);
}

OutlinePtr sample_rosette() {
    std::array<Vec2, 24> points;
    for (std::size_t i = 0; i < points.size(); ++i)
        points[i] = Vec2{20, 7} + on_circle(i % 3 == 0 ? 9.0 : 4.0, 15.0 * static_cast<double>(i));
    return shared({closed_bspline(points)});
}

OutlinePtr sample_loop() {
    Curve curve;
    curve.spans.push_back(cubic({0, 0}, {6, 4}, {-3, 4}, {3, 0}));   // crosses itself
    curve.spans.push_back(cubic({3, 0}, {5, -2}, {3, -2}, {5, 0}));  // a cusp
    curve.spans.push_back(segment({5, 0}, {5, -4}));
    curve.spans.push_back(cubic({5, -4}, {5, -4}, {2, -4 - 1e-9}, {2, -4}));
    curve.spans.push_back(quadratic({2, -4}, {0, -4}, {0, 0}));
    curve.closed = true;
    return shared({std::move(curve)});
}

OutlinePtr sample_half_disc() {
    Curve curve;
    curve.spans = {arc({0, 1}, 2.0, -90.0, 0.0), arc({0, 1}, 2.0, 0.0, 90.0),
                   segment({0, 3}, {0, -1})};
    curve.closed = true;
    return shared({std::move(curve)});
}

OutlinePtr sample_goblet() {
    Curve curve;
    curve.spans = {segment({0, 0}, {3, 0}),
                   segment({3, 0}, {3, 0.25}),
                   segment({3, 0.25}, {0.4, 0.25 + 1e-7}),
                   cubic({0.4, 0.25 + 1e-7}, {0.1, 2}, {0.9, 3}, {0.5, 4}),
                   cubic({0.5, 4}, {4, 5}, {4, 7}, {2.5, 9}),
                   segment({2.5, 9}, {2.25, 9}),
                   cubic({2.25, 9}, {3.5, 7}, {3.5, 5}, {0, 4.5})};
    return shared({std::move(curve)});
}

}  // namespace raymo::curves
