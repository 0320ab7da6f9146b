#include "raymo/curves/build_contour.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "raymo/curves/bernstein.hpp"

namespace raymo::curves {
namespace {

Vec2 at(const Span2& s, double u) {
    return {value_at(s.x, u) / value_at(s.w, u), value_at(s.y, u) / value_at(s.w, u)};
}

/// The spans join, and the curve is closed just where it comes back.
void check_joined(const Curve& c) {
    for (std::size_t i = 0; i + 1 < c.spans.size(); ++i)
        CHECK(c.spans[i].point(3) == c.spans[i + 1].point(0));
    CHECK((c.spans.back().point(3) == c.spans.front().point(0)) == c.closed);
}

/// Twice the area inside, by the fan of 1000 chords a span.
double twice_area(const Curve& c) {
    double sum = 0.0;
    for (const Span2& s : c.spans) {
        for (int i = 0; i < 1000; ++i) sum += cross(at(s, i / 1000.0), at(s, (i + 1) / 1000.0));
    }
    return sum;
}

std::string message(const Result<Curve>& made) { return made ? "" : made.error().message; }

constexpr double kUlp = std::numeric_limits<double>::epsilon();

TEST_CASE("a circle has its radius everywhere, to a few units in the last place") {
    for (const double r : {1.0, 0.1, 12345.678, 1e-60, 1e90}) {
        const Curve c = *circle(r);
        CHECK(c.spans.size() == 4);
        CHECK(c.closed);
        check_joined(c);
        for (const Span2& s : c.spans) {
            for (int i = 0; i <= 64; ++i)
                CHECK(std::fabs(norm(at(s, i / 64.0)) / r - 1.0) <= 4.0 * kUlp);
        }
        CHECK(c.spans[0].point(0) == Vec2{r, 0.0});
        CHECK(c.spans[1].point(0) == Vec2{0.0, r});
    }
}

TEST_CASE("rectangles, sharp and rounded") {
    const Curve sharp = *rectangle(30, 20, 0, false);
    CHECK(sharp.spans.size() == 4);
    check_joined(sharp);
    CHECK(twice_area(sharp) == doctest::Approx(1200));
    const Curve centred = *rectangle(30, 20, 0, true);
    CHECK(centred.spans[0].point(0) == Vec2{-15, -10});
    for (const bool is_centred : {false, true}) {
        const Curve round = *rectangle(30, 20, 3, is_centred);
        CHECK(round.spans.size() == 8);
        CHECK(round.closed);
        check_joined(round);
        CHECK(twice_area(round) ==
              doctest::Approx(2.0 * (600 - (4 - 3.14159265358979) * 9)).epsilon(1e-6));
    }
    const Curve slot = *rectangle(30, 20, 10, true);
    CHECK(slot.spans.size() == 6);
    check_joined(slot);
    const Curve disc = *rectangle(0.3, 0.3, 0.15, false);
    CHECK(disc.spans.size() == 4);
    check_joined(disc);
}

TEST_CASE("regular polygons") {
    const Curve hexagon = *regular(6, 2);
    CHECK(hexagon.spans.size() == 6);
    check_joined(hexagon);
    CHECK(hexagon.spans[0].point(0) == Vec2{2, 0});
    CHECK(hexagon.spans[3].point(0) == Vec2{-2, 0});
    CHECK(twice_area(hexagon) == doctest::Approx(12.0 * std::sqrt(3.0)));
}

TEST_CASE("arcs by angles") {
    const Curve half = *arc_curve(5, 0, 180, {1, 2});
    CHECK(half.spans.size() == 2);
    check_joined(half);
    CHECK(half.spans.front().point(0) == Vec2{6, 2});
    CHECK(half.spans.back().point(3) == Vec2{-4, 2});
    for (const Span2& s : half.spans) {
        for (int i = 0; i <= 16; ++i) {
            CHECK(norm(at(s, i / 16.0) - Vec2{1, 2}) == doctest::Approx(5).epsilon(1e-15));
            CHECK(at(s, i / 16.0).y >= 2);
        }
    }
    CHECK(arc_curve(5, 90, 0, {})->spans[0].point(3) == Vec2{5, 0});
    const Curve full = *arc_curve(5, 30, 390, {0.1, 0.7});
    CHECK(full.closed);
    check_joined(full);
    CHECK(arc_curve(1, 3600000, 3600090, {})->spans[0].point(3) == Vec2{0, 1});
    CHECK(message(arc_curve(1, 1e17, 1e17 + 352, {})) == "the angle must be within 1e9 degrees");
}

TEST_CASE("arcs through three points end at them exactly") {
    const Vec2 a{0.3, 0.1};
    const Vec2 b{5.1, 2.2};
    const Vec2 c{3.7, -8.9};
    for (const auto& [p, q, r] : {std::array<Vec2, 3>{a, b, c}, std::array<Vec2, 3>{b, a, c},
                                  std::array<Vec2, 3>{c, b, a}}) {
        const Curve made = *arc_through(p, q, r);
        check_joined(made);
        CHECK(made.spans.front().point(0) == p);
        CHECK(made.spans.back().point(3) == r);
        double nearest = 1e9;
        for (const Span2& s : made.spans) {
            for (int i = 0; i <= 20000; ++i)
                nearest = std::min(nearest, norm(at(s, i / 20000.0) - q));
        }
        CHECK(nearest < 1e-3);
    }
    CHECK(message(arc_through({0, 0}, {1, 1}, {2, 2})) ==
          "the three points lie on a line, which no arc does");
    CHECK(message(arc_through({0.1, 0.1}, {0.2, 0.2}, {0.3, 0.3})) ==
          "the three points lie on a line, which no arc does");
    CHECK(message(arc_through({1, 1}, {1, 1}, {2, 2})) ==
          "the three points lie on a line, which no arc does");
}

TEST_CASE("chains join ends that meet, either way round, and close") {
    const std::vector<Vec2> floor{{-5, 0}, {-5, -10}, {5, -10}, {5, 0}};
    const Curve u = *spline_curve(floor, {SplineKind::linear, 1, false, false});
    const std::vector<Vec2> turned(floor.rbegin(), floor.rend());
    const Curve v = *spline_curve(turned, {SplineKind::linear, 1, false, false});
    const Curve half = *arc_curve(5, 0, 180, {});
    for (const auto& curves : {std::array<Curve, 2>{half, u}, std::array<Curve, 2>{half, v},
                               std::array<Curve, 2>{u, half}, std::array<Curve, 2>{v, half}}) {
        const auto made = chain(curves, false);
        REQUIRE(made.has_value());
        CHECK(made->closed);
        CHECK(made->spans.size() == 5);
        check_joined(*made);
        CHECK(std::fabs(twice_area(*made)) ==
              doctest::Approx(200 + 25 * 3.14159265358979).epsilon(1e-5));
    }
    // The first may have to be turned, too.
    const Curve first = *spline_curve(std::vector<Vec2>{{0, 0}, {9, 9}}, {SplineKind::linear, 1});
    const Curve second = *spline_curve(std::vector<Vec2>{{0, 0}, {5, 1}}, {SplineKind::linear, 1});
    const auto both = chain(std::array<Curve, 2>{first, second}, false);
    REQUIRE(both.has_value());
    CHECK(both->spans.front().point(0) == Vec2{9, 9});
    check_joined(*both);
    // Ends that differ by rounding are made one.
    const Curve a = *arc_curve(7, 10, 53.3, {100, 3});
    const Curve b = *arc_curve(7, 53.3, 170, {100 + 1e-14, 3});
    const auto ab = chain(std::array<Curve, 2>{a, b}, true);
    REQUIRE(ab.has_value());
    check_joined(*ab);
    CHECK(ab->closed);
}

TEST_CASE("what is wrong with contours is said") {
    CHECK(message(circle(0)) == "the radius must be greater than 0");
    CHECK(message(circle(-1)) == "the radius must be greater than 0");
    CHECK(message(circle(std::nan(""))) == "the radius must be greater than 0");
    CHECK(message(circle(1e200)) == "the radius is too large to be computed with");
    CHECK(message(rectangle(0, 1, 0, false)) == "the width must be greater than 0");
    CHECK(rectangle(1, -1, 0, false).error().argument == 1);
    CHECK(rectangle(10, 4, 2.5, false).error().hint == "the largest is 2");
    CHECK(message(rectangle(10, 4, -1, false)) == "the radius of the corners must be at least 0");
    CHECK(message(regular(2, 1)) ==
          "the number of corners must be a whole number from 3 to 1000000");
    CHECK(regular(5, 0).error().argument == 1);
    CHECK(arc_curve(1, 5, 5, {}).error().argument == 2);
    CHECK(message(arc_curve(1, 0, 400, {})) == "the arc must be at most a full turn");
    CHECK(message(polygon(std::vector<Vec2>{{0, 0}, {1, 0}})) ==
          "a closed curve needs at least 3 points");
    const Curve ring = *circle(1);
    const Curve line = *spline_curve(std::vector<Vec2>{{5, 0}, {9, 0}}, {SplineKind::linear, 1});
    CHECK(chain(std::array<Curve, 2>{line, ring}, false).error().argument == 1);
    CHECK(message(chain({}, false)) == "there are no curves to join");
    const Curve away = *spline_curve(std::vector<Vec2>{{9.5, 0}, {9, 7}}, {SplineKind::linear, 1});
    CHECK(message(chain(std::array<Curve, 2>{line, away}, false)) ==
          "the curves do not meet: one ends at (9, 0) and the next begins at (9.5, 0)");
}

}  // namespace
}  // namespace raymo::curves
