#include "raymo/curves/build_spline.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "raymo/curves/bernstein.hpp"

namespace raymo::curves {
namespace {

using Points = std::vector<Point<2>>;

Points random_points(std::size_t n, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> range(-10.0, 10.0);
    Points points(n);
    for (auto& p : points) p = {range(random), range(random)};
    return points;
}

Bernstein<3> coordinate(const SplineSpan<2>& s, std::size_t k) {
    return {s[0][k], s[1][k], s[2][k], s[3][k]};
}

/// Largest difference of the derivatives of the given order at the joints.
double jump(const Spline<2>& spline, int order) {
    double worst = 0.0;
    const std::size_t n = spline.spans.size();
    for (std::size_t i = 0; i < (spline.closed ? n : n - 1); ++i) {
        for (std::size_t k = 0; k < 2; ++k) {
            const Bernstein<3> a = coordinate(spline.spans[i], k);
            const Bernstein<3> b = coordinate(spline.spans[(i + 1) % n], k);
            const auto da = derivative(a);
            const auto db = derivative(b);
            const double gap = order == 0   ? a[3] - b[0]
                               : order == 1 ? da[2] - db[0]
                                            : derivative(da)[1] - derivative(db)[0];
            worst = std::max(worst, std::fabs(gap));
        }
    }
    return worst;
}

Spline<2> built(const Points& points, const SplineForm& form) {
    auto made = spline<2>(points, form);
    REQUIRE(made.has_value());
    return *made;
}

std::string message(const Points& points, const SplineForm& form) {
    const auto made = spline<2>(points, form);
    return made ? "" : made.error().message;
}

/// A basis function of the B-spline of degree n with these knots, by its definition.
double basis(const std::vector<double>& knots, std::size_t i, int n, double t) {
    if (n == 0) return knots[i] <= t && t < knots[i + 1] ? 1.0 : 0.0;
    const auto m = static_cast<std::size_t>(n);
    const double a = knots[i + m] - knots[i];
    const double b = knots[i + m + 1] - knots[i + 1];
    return (a > 0 ? (t - knots[i]) / a * basis(knots, i, n - 1, t) : 0.0) +
           (b > 0 ? (knots[i + m + 1] - t) / b * basis(knots, i + 1, n - 1, t) : 0.0);
}

TEST_CASE("spans share their end points bit for bit, and are as smooth as their kind promises") {
    struct Promise {
        SplineKind kind;
        int degree;
        int smoothness;
    };
    for (const Promise& p :
         {Promise{SplineKind::linear, 1, 0}, Promise{SplineKind::bspline, 1, 0},
          Promise{SplineKind::bspline, 2, 1}, Promise{SplineKind::bspline, 3, 2},
          Promise{SplineKind::catmull, 3, 1}, Promise{SplineKind::interpolate, 3, 2}}) {
        CAPTURE(static_cast<int>(p.kind));
        CAPTURE(p.degree);
        for (unsigned seed = 0; seed < 20; ++seed) {
            for (const bool closed : {false, true}) {
                const Points points = random_points(4 + seed, seed);
                const Spline<2> s = built(points, {p.kind, p.degree, closed, false});
                CHECK(s.closed == closed);
                CHECK(jump(s, 0) == 0.0);
                if (p.smoothness >= 1) CHECK(jump(s, 1) < 1e-12);
                if (p.smoothness >= 2) CHECK(jump(s, 2) < 1e-12 * 40);
                const std::size_t lost =
                    p.kind == SplineKind::bspline ? static_cast<std::size_t>(p.degree) : 1;
                CHECK(s.spans.size() == points.size() - (closed ? 0 : lost));
            }
        }
    }
}

TEST_CASE("linear, catmull and interpolate run through their points") {
    for (const SplineKind kind :
         {SplineKind::linear, SplineKind::catmull, SplineKind::interpolate}) {
        const Points points = random_points(50, 7);
        for (const bool closed : {false, true}) {
            const Spline<2> s = built(points, {kind, 3, closed, false});
            for (std::size_t i = 0; i < s.spans.size(); ++i) {
                CHECK(s.spans[i][0] == points[i]);
                CHECK(s.spans[i][3] == points[(i + 1) % points.size()]);
            }
        }
    }
}

TEST_CASE("B-splines are sums of their basis functions") {
    for (int degree = 1; degree <= 3; ++degree) {
        for (const bool clamped : {false, true}) {
            for (std::size_t n = static_cast<std::size_t>(degree) + 1; n < 12; ++n) {
                const Points points = random_points(n, static_cast<unsigned>(n));
                const Spline<2> s = built(points, {SplineKind::bspline, degree, false, clamped});
                const std::size_t count = n - static_cast<std::size_t>(degree);
                REQUIRE(s.spans.size() == count);
                std::vector<double> knots;
                for (std::size_t j = 0; j < n + static_cast<std::size_t>(degree) + 1; ++j) {
                    const double knot = static_cast<double>(j) - degree;
                    knots.push_back(clamped ? std::clamp(knot, 0.0, static_cast<double>(count))
                                            : knot);
                }
                for (std::size_t i = 0; i < count; ++i) {
                    for (const double u : {0.0, 0.2, 0.5, 0.9}) {
                        for (std::size_t k = 0; k < 2; ++k) {
                            double sum = 0.0;
                            for (std::size_t j = 0; j < n; ++j)
                                sum += points[j][k] *
                                       basis(knots, j, degree, static_cast<double>(i) + u);
                            CHECK(value_at(coordinate(s.spans[i], k), u) ==
                                  doctest::Approx(sum).epsilon(1e-13).scale(10.0));
                        }
                    }
                }
                if (clamped) {
                    CHECK(s.spans.front()[0] == points.front());
                    CHECK(s.spans.back()[3] == points.back());
                }
            }
        }
    }
}

TEST_CASE("the uniform cubic B-spline is that of the thesis") {
    const Spline<2> s =
        built({{0, 0}, {6, 0}, {6, 6}, {0, 6}}, {SplineKind::bspline, 3, false, false});
    REQUIRE(s.spans.size() == 1);
    CHECK(s.spans[0] == SplineSpan<2>{{{5, 1}, {6, 2}, {6, 4}, {5, 5}}});
}

TEST_CASE("Catmull-Rom derivatives are half the difference of the neighbours") {
    const Points p{{0, 0}, {1, 3}, {4, 5}, {8, 2}, {9, -4}};
    const Spline<2> s = built(p, {SplineKind::catmull, 3, false, false});
    for (std::size_t i = 1; i + 1 < p.size(); ++i) {
        for (std::size_t k = 0; k < 2; ++k) {
            CHECK(derivative(coordinate(s.spans[i], k))[0] ==
                  doctest::Approx(0.5 * (p[i + 1][k] - p[i - 1][k])).epsilon(1e-14));
        }
    }
    CHECK(derivative(coordinate(s.spans[0], 1))[0] == doctest::Approx(3.0).epsilon(1e-14));
}

TEST_CASE("interpolation has no second derivative at open ends, and repeats cubics") {
    const Points p = random_points(9, 3);
    const Spline<2> s = built(p, {SplineKind::interpolate, 3, false, false});
    for (std::size_t k = 0; k < 2; ++k) {
        CHECK(std::fabs(derivative(derivative(coordinate(s.spans.front(), k)))[0]) < 1e-12 * 40);
        CHECK(std::fabs(derivative(derivative(coordinate(s.spans.back(), k)))[1]) < 1e-12 * 40);
    }
    // Two points: a segment.
    const Spline<2> two = built({{0, 0}, {3, 9}}, {SplineKind::interpolate, 3, false, false});
    CHECK(two.spans[0][1][1] == doctest::Approx(3.0).epsilon(1e-15));
    CHECK(two.spans[0][2][1] == doctest::Approx(6.0).epsilon(1e-15));
}

TEST_CASE("a million points are solved in linear time") {
    Points circle(1000000);
    for (std::size_t i = 0; i < circle.size(); ++i) {
        const double a = 2.0 * 3.14159265358979323846 * static_cast<double>(i) / 1e6;
        circle[i] = {std::cos(a), std::sin(a)};
    }
    const Spline<2> s = built(circle, {SplineKind::interpolate, 3, true, false});
    CHECK(s.spans.size() == circle.size());
    double worst = 0.0;
    for (std::size_t i = 0; i < s.spans.size(); i += 997) {
        const double x = value_at(coordinate(s.spans[i], 0), 0.5);
        const double y = value_at(coordinate(s.spans[i], 1), 0.5);
        worst = std::max(worst, std::fabs(std::hypot(x, y) - 1.0));
    }
    CHECK(worst < 1e-15 * 4);
}

TEST_CASE("Bezier chains share their end points") {
    const Points p = random_points(7, 5);
    const Spline<2> cubic = built(p, {SplineKind::bezier, 3, false, false});
    REQUIRE(cubic.spans.size() == 2);
    CHECK(cubic.spans[1] == SplineSpan<2>{{p[3], p[4], p[5], p[6]}});
    CHECK(built(p, {SplineKind::bezier, 2, false, false}).spans.size() == 3);
    CHECK(built(p, {SplineKind::bezier, 1, false, false}).spans.size() == 6);
    Points ring(p.begin(), p.begin() + 6);
    const Spline<2> closed = built(ring, {SplineKind::bezier, 3, true, false});
    CHECK(closed.closed);
    REQUIRE(closed.spans.size() == 2);
    CHECK(closed.spans[1] == SplineSpan<2>{{p[3], p[4], p[5], p[0]}});
    ring.push_back(ring.front());
    CHECK(built(ring, {SplineKind::bezier, 3, false, false}).closed);
    CHECK(built(ring, {SplineKind::bezier, 3, true, false}).spans == closed.spans);
    // A parabola's elevation leaves its values.
    const Spline<2> parabola =
        built({{0, 0}, {1, 2}, {2, 0}}, {SplineKind::bezier, 2, false, false});
    CHECK(value_at(coordinate(parabola.spans[0], 1), 0.5) == doctest::Approx(1.0).epsilon(1e-15));
}

TEST_CASE("the first point may be given once more at the end") {
    const Points p = random_points(5, 11);
    Points again = p;
    again.push_back(p.front());
    for (const SplineKind kind :
         {SplineKind::linear, SplineKind::catmull, SplineKind::interpolate}) {
        CHECK(built(p, {kind, 3, true, false}).spans == built(again, {kind, 3, true, false}).spans);
    }
    CHECK(built(again, {SplineKind::linear, 1, false, false}).closed);
    CHECK(!built(p, {SplineKind::linear, 1, false, false}).closed);
}

TEST_CASE("repeated points: polygons skip them, splines are drawn to them") {
    CHECK(built({{0, 0}, {0, 0}, {1, 0}, {1, 0}, {0, 1}}, {SplineKind::linear, 1, true, false})
              .spans.size() == 3);
    const Points triple{{0, 0}, {4, 0}, {4, 4}, {4, 4}, {4, 4}, {0, 4}};
    const Spline<2> s = built(triple, {SplineKind::bspline, 3, true, false});
    CHECK(s.spans.size() == 6);
    CHECK(jump(s, 0) == 0.0);
    // Nothing is left of a span whose control points are all the same.
    const Points four{{0, 0}, {4, 0}, {4, 4}, {4, 4}, {4, 4}, {4, 4}, {0, 4}};
    CHECK(built(four, {SplineKind::bspline, 3, true, false}).spans.size() == 6);
}

TEST_CASE("what is wrong with the points is said") {
    const SplineForm cubic{SplineKind::bspline, 3, false, false};
    CHECK(message({{0, 0}, {1, 0}, {1, 1}}, cubic) ==
          "a curve of degree 3 needs at least 4 points");
    CHECK(message({{0, 0}, {1, 0}}, {SplineKind::linear, 1, true, false}) ==
          "a closed curve needs at least 3 points");
    CHECK(message({{1, 1}}, {SplineKind::catmull, 3, false, false}) ==
          "a curve needs at least 2 points");
    CHECK(message({}, {SplineKind::catmull, 3, false, false}) == "a curve needs at least 2 points");
    CHECK(message(Points(5, {2, 2}), cubic) == "all points are the same");
    // And so near that no span shows it.
    CHECK(message({{0.3, 1}, {0.3, 1}, {0.3, 1}, {0.1 + 0.2, 1}}, cubic) ==
          "all points are the same");
    CHECK(message({{0, 0}, {1e300, 0}, {1, 1}, {2, 2}}, cubic) ==
          "the coordinates are too large to be computed with");
    CHECK(message({{0, 0}, {std::nan(""), 0}, {1, 1}, {2, 2}}, cubic) ==
          "every coordinate must be a finite number");
    CHECK(message(random_points(4, 1), {SplineKind::bspline, 4, false, false}) ==
          "the degree must be 1, 2 or 3");
    CHECK(message(random_points(5, 1), {SplineKind::bezier, 3, false, false}) ==
          "a chain of Bezier curves of degree 3 needs 4, 7, 10 or more points");
    CHECK(message(random_points(2, 1), {SplineKind::bezier, 2, true, false}) ==
          "a closed chain of Bezier curves of degree 2 needs 4, 6, 8 or more points");
    CHECK(spline<2>(random_points(5, 1), {SplineKind::bspline, 0, false, false}).error().argument ==
          1);
}

TEST_CASE("coordinates of 1e90 stay finite") {
    for (const SplineKind kind : {SplineKind::linear, SplineKind::bspline, SplineKind::bezier,
                                  SplineKind::catmull, SplineKind::interpolate}) {
        const Spline<2> s =
            built({{1e90, 0}, {-1e90, 1e90}, {0, -1e90}, {1e90, 1e90}}, {kind, 3, false, false});
        for (const auto& span : s.spans) {
            for (const auto& p : span) CHECK((std::isfinite(p[0]) && std::isfinite(p[1])));
        }
    }
}

}  // namespace
}  // namespace raymo::curves
