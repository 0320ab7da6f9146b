#include "raymo/drawings/svg_path.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "raymo/curves/region.hpp"

namespace raymo::drawings {
namespace {

using curves::Outline;
using curves::Span2;

bool always(double) { return true; }

Outline path(std::string_view d) {
    auto out = read_path(d, &always);
    REQUIRE_MESSAGE(out.has_value(), out.error().what);
    return *out;
}

double area(const Outline& outline) {
    return (*curves::Region::make(outline, {}, 1.0))->signed_area();
}

bool is_equal(const Outline& a, const Outline& b) { return a.curves == b.curves; }

TEST_CASE("commands: absolute, relative, repeated, with as few signs as can be") {
    const Outline square = path("M1 1 L3 1 L3 3 L1 3 Z");
    CHECK(area(square) == doctest::Approx(4.0));
    CHECK(is_equal(path("M1,1,3,1,3,3,1,3"), square));
    CHECK(is_equal(path("m1 1 2 0 0 2-2 0z"), square));
    CHECK(is_equal(path(" M 1 1 H 3 V 3 H 1 V 1 "), square));
    CHECK(is_equal(path("M1 1h2v2h-2v-2z"), square));
    CHECK(is_equal(path("M.1e1+1 3 1L3 3\n1\t3z"), square));
    CHECK(path("M.5.5.75.5.5.75").curves[0].spans[0].point(3) == Vec2{0.75, 0.5});
    CHECK(path("").curves.empty());
    CHECK(path("M1 2").curves.empty());
    CHECK(path("M1 2Z").curves.empty());
    CHECK(path("M1 2L1 2 1 2z").curves.empty());
}

TEST_CASE("what follows a closed curve begins where that began") {
    const Outline two = path("M1 1h2v2zl-1 0 0-1z");
    REQUIRE(two.curves.size() == 2);
    CHECK(two.curves[1].spans[0].point(0) == Vec2{1, 1});
    CHECK(two.curves[1].spans[0].point(3) == Vec2{0, 1});
    const Outline moved = path("M1 1h2v2zm5 5h1v1z");
    CHECK(moved.curves[1].spans[0].point(0) == Vec2{6, 6});
}

TEST_CASE("curves: cubics and parabolas keep their control points, and go on smoothly") {
    const Outline cubics = path("M0 0C1 2 3 4 5 5S7 4 8 0s3 4 4 0");
    const auto& s = cubics.curves[0].spans;
    CHECK(s[0] == curves::cubic({0, 0}, {1, 2}, {3, 4}, {5, 5}));
    CHECK(s[1] == curves::cubic({5, 5}, {7, 6}, {7, 4}, {8, 0}));
    CHECK(s[2] == curves::cubic({8, 0}, {9, -4}, {11, 4}, {12, 0}));
    const Outline parabolas = path("M0 0Q1 2 4 0T8 0t4 0");
    const auto& q = parabolas.curves[0].spans;
    CHECK(q[0] == curves::quadratic({0, 0}, {1, 2}, {4, 0}));
    CHECK(q[1] == curves::quadratic({4, 0}, {7, -2}, {8, 0}));
    CHECK(q[2] == curves::quadratic({8, 0}, {9, 2}, {12, 0}));
    // Behind another command the control point is where the pen is.
    CHECK(path("M0 0L5 5S7 4 8 0").curves[0].spans[1] ==
          curves::cubic({5, 5}, {5, 5}, {7, 4}, {8, 0}));
    CHECK(path("M0 0C1 2 3 4 5 5T9 1").curves[0].spans[1] ==
          curves::quadratic({5, 5}, {5, 5}, {9, 1}));
}

/// How far a point is from the ellipse, as a part of its size: |M^-1 p| - 1.
double off(const Span2& span, double u, Vec2 radii, double turn, Vec2 centre) {
    const Vec2 p = curves::point_at(span, u) - centre;
    const double c = std::cos(turn * std::numbers::pi / 180),
                 s = std::sin(turn * std::numbers::pi / 180);
    return std::hypot((c * p.x + s * p.y) / radii.x, (c * p.y - s * p.x) / radii.y) - 1.0;
}

TEST_CASE("arcs lie on their ellipse to 1e-15, whichever of the four they are") {
    for (const char* flags : {"0 0", "0 1", "1 0", "1 1"}) {
        CAPTURE(flags);
        // About (0, 0) or (6, 0): both circles of radius 5 through (3, 4) and (3, -4).
        const Outline arc = path(std::string("M3 4A5 5 0 ") + flags + " 3 -4");
        const bool is_large = flags[0] == '1', is_positive = flags[2] == '1';
        // Towards y from x, from (3, 4) to (3, -4): the longer way about (0, 0), the shorter about (6, 0).
        const Vec2 centre{is_large == is_positive ? 0.0 : 6.0, 0.0};
        double turned = 0.0;
        for (std::size_t i = 0; i + 1 < arc.curves[0].spans.size(); ++i) {
            const Span2& span = arc.curves[0].spans[i];
            for (double u = 0.0; u <= 1.0; u += 0.125)
                CHECK(std::fabs(off(span, u, {5, 5}, 0, centre)) <= 1e-15);
            const Vec2 a = span.point(0) - centre, b = span.point(3) - centre;
            turned += std::atan2(cross(a, b), dot(a, b));
        }
        const double half = std::atan2(4.0, 3.0);
        const double whole = is_large ? 2 * std::numbers::pi - 2 * half : 2 * half;
        CHECK(turned == doctest::Approx(is_positive ? whole : -whole).epsilon(1e-14));
    }
}

TEST_CASE("random arcs end where they are told, and stay on their ellipses") {
    std::mt19937_64 bits(7);
    const auto uniform = [&](double lo, double hi) {
        return std::uniform_real_distribution<double>(lo, hi)(bits);
    };
    for (int i = 0; i < 2000; ++i) {
        const Vec2 radii{uniform(0.1, 4), uniform(0.1, 4)};
        const double turn = uniform(-400, 400);
        const Vec2 from{uniform(-3, 3), uniform(-3, 3)}, to{uniform(-3, 3), uniform(-3, 3)};
        PathPen pen;
        pen.move(from);
        const bool is_large = i % 2 == 0, is_positive = i % 4 < 2;
        pen.arc(radii, turn, is_large, is_positive, to);
        const Outline drawn = pen.take();
        std::vector<Span2> arc = drawn.curves[0].spans;
        arc.pop_back();  // the chord that closes it
        CHECK(arc.front().point(0) == from);
        CHECK(arc.back().point(3) == to);
        // Its centre and size, by the middle of the longest span: what is mapped back must be a circle through all points.
        const double c = std::cos(turn * std::numbers::pi / 180),
                     s = std::sin(turn * std::numbers::pi / 180);
        const auto flat = [&](Vec2 p) {
            return Vec2{(c * p.x + s * p.y) / radii.x, (c * p.y - s * p.x) / radii.y};
        };
        const Vec2 a = flat(from), b = flat(curves::point_at(arc[arc.size() / 2], 0.5)),
                   d = flat(to);
        const Vec2 p = b - a, q = d - a;
        const double twice = 2.0 * cross(p, q);
        const Vec2 m{(dot(p, p) * q.y - dot(q, q) * p.y) / twice,
                     (dot(q, q) * p.x - dot(p, p) * q.x) / twice};
        const double radius = norm(m);
        const double chord = 0.5 * norm(q);
        CHECK(radius == doctest::Approx(std::max(1.0, chord)).epsilon(1e-7));
        for (const Span2& span : arc) {
            for (const double u : {0.25, 0.5, 0.75}) {
                const double away = norm(flat(curves::point_at(span, u)) - a - m);
                CHECK(away == doctest::Approx(radius).epsilon(1e-7));
            }
        }
        // Which way round, and whether it is the longer one.
        CHECK((cross(b - a, d - b) > 0.0) == is_positive);
        if (chord < 0.999) CHECK((dot(a - b, d - b) > 0.0) == is_large);
    }
}

TEST_CASE("arcs that can not be: of no radius a line, of one too small the half of an ellipse") {
    CHECK(is_equal(path("M0 0A0 5 0 0 1 4 0L4 4z"), path("M0 0L4 0L4 4z")));
    CHECK(is_equal(path("M0 0A5 5 0 0 1 0 0L4 0L4 4z"), path("M0 0L4 0L4 4z")));
    const Outline half = path("M-4 0A1 2 0 0 1 4 0z");
    CHECK(area(half) == doctest::Approx(0.5 * std::numbers::pi * 4 * 8).epsilon(1e-14));
    CHECK(is_equal(path("M-4 0A-1-2 0 0 1 4 0z"), half));
    // Flags may touch what follows.
    CHECK(is_equal(path("M0 0a25,25 -30 0150,-25"), path("M0 0a25,25 -30 0 1 50,-25")));
}

TEST_CASE("a flat arc keeps its digits") {
    // A chord of 1 on a circle of radius 1e6 rises by r - sqrt(r^2 - 1/4) = 1 / (4 (r + sqrt(r^2 - 1/4))).
    const Outline arc = path("M0 0A1e6 1e6 0 0 1 1 0");
    const Vec2 top = curves::point_at(arc.curves[0].spans[0], 0.5);
    CHECK(top.x == 0.5);
    CHECK(-top.y == doctest::Approx(0.25 / (1e6 + std::sqrt(1e12 - 0.25))).epsilon(1e-14));
}

TEST_CASE("shapes: areas of rectangles, rounded ones and ellipses") {
    const auto drawn = [](auto&& draw) {
        PathPen pen;
        draw(pen);
        return pen.take();
    };
    const Outline sharp = drawn([](PathPen& p) { draw_rectangle(p, {1, 2}, {4, 3}, {}); });
    CHECK(area(sharp) == doctest::Approx(12.0));
    const Outline round = drawn([](PathPen& p) { draw_rectangle(p, {1, 2}, {4, 3}, {1, 0.5}); });
    CHECK(area(round) == doctest::Approx(12.0 - 4 * 0.5 + std::numbers::pi * 0.5).epsilon(1e-14));
    // Larger radii than half the sides are half the sides.
    const Outline full = drawn([](PathPen& p) { draw_rectangle(p, {1, 2}, {4, 3}, {9, 9}); });
    CHECK(area(full) == doctest::Approx(std::numbers::pi * 2 * 1.5).epsilon(1e-14));
    const Outline ellipse = drawn([](PathPen& p) { draw_ellipse(p, {7, 8}, {2, 5}); });
    CHECK(area(ellipse) == doctest::Approx(10 * std::numbers::pi).epsilon(1e-14));
    CHECK(ellipse.curves[0].spans.size() == 4);
    CHECK(area(*read_polygon("0,0 4,0 4,3", &always)) == doctest::Approx(6.0));
    CHECK(read_polygon("1 2 3 4", &always)->curves.empty());
    CHECK(read_polygon("", &always)->curves.empty());
    std::string many;
    for (int i = 0; i < 10000; ++i) many += std::to_string(i) + "," + std::to_string(i * i) + " ";
    CHECK(read_polygon(many, &always)->curves[0].spans.size() == 10000);
    double most = 0.0;
    const auto stopped = read_polygon(many, [&](double bytes) {
        most = bytes;
        return bytes < 1e5;
    });
    CHECK(stopped.error().what.empty());
    CHECK(most >= 1e5);
    CHECK(most < 1e6);
}

TEST_CASE("misfits say where and what") {
    const auto misfit = [](std::string_view d) {
        const auto out = read_path(d, &always);
        REQUIRE_FALSE(out.has_value());
        return std::to_string(out.error().at) + ": " + out.error().what;
    };
    CHECK(misfit("L1 2") == "0: \"M\", with which a path begins, is missing before \"L1 2\"");
    CHECK(misfit("M1") == "2: a number is missing at the end");
    CHECK(misfit("M1 2L3") == "6: a number is missing at the end");
    CHECK(misfit("M1 2 L") == "6: a number is missing at the end");
    CHECK(misfit("M1 2 L x") == "7: a number is missing before \"x\"");
    CHECK(misfit("M1 2 B 3") == "5: one of the commands MLHVCSQTAZ is missing before \"B 3\"");
    CHECK(misfit("M1 2Z3 4") == "5: one of the commands MLHVCSQTAZ is missing before \"3 4\"");
    CHECK(misfit("M1 2,") == "5: a number is missing at the end");
    CHECK(misfit("M1 2 A1 1 0 2 0 3 3") == "12: a flag, 0 or 1, is missing before \"2 0 3 3\"");
    CHECK(misfit("M1 2e999") == "3: the number is too large");
    CHECK(misfit("M1 nan") == "3: a number is missing before \"nan\"");
    CHECK(misfit("M1 -inf") == "3: a number is missing before \"-inf\"");
    CHECK(path("M1e-999 0 L2 0 L2 2z").curves[0].spans[0].point(0) == Vec2{0, 0});
    CHECK(read_polygon("1 2 3", &always).error().what == "the last point has no y");
    std::string endless = "M0 0";
    for (int i = 0; i < 10000; ++i) endless += "l1 1";
    const auto stopped = read_path(endless, [](double) { return false; });
    REQUIRE_FALSE(stopped.has_value());
    CHECK(stopped.error().what.empty());
}

}  // namespace
}  // namespace raymo::drawings
