// Corners of more than three faces: one ball and several, hollows, planes that miss a point, errors.
#include <algorithm>
#include <random>

#include "raymo/blends/body.hpp"
#include "raymo/blends/segment.hpp"
#include "raymo/blends/test_polyhedra.hpp"

namespace raymo::blends {
namespace {

using namespace test;

/// The half-spaces of the planes with all edges rounded are what balls of radius r in them reach: at `count` points.
template <class Place>
void check_rounded(const std::vector<Plane>& planes, double size, double r, int count,
                   const Place& place) {
    const auto made = blended_edges(within(planes, size), Edges::convex, ball(r));
    if (!made) FAIL(made.error().message);
    Traced solid(made->solid);
    for (int i = 0; i < count; ++i) {
        const Vec3 p = place();
        const double d = from_centres(planes, r, p);
        if (std::fabs(d - r) < 1e-8) continue;
        CHECK((solid.where(p) == solids::Where::in) == (d < r));
    }
}

TEST_CASE("corners: a hollow's bottom is what the rounded solid of its shape leaves") {
    const double r = 0.5;
    const std::vector<Vec2> skew{{-3, -2}, {4, -1}, {3, 3}, {0, 4}, {-2, 2}};
    const csg::Solid inner = move(pyramid(skew, 5), {0, 0, -2});
    Traced round(blended(inner, Edges::convex, ball(r), 10));
    Traced hollow(blended(csg::boolean(csg::Op::difference, {centred_block(12, 12, 12), inner}),
                          Edges::concave, ball(r), 10));
    // With its mouth open: upside down, through the top.
    const csg::Solid down = mapped(inner, reflection({0, 0, 1}));
    Traced open(blended(
        csg::boolean(csg::Op::difference, {move(centred_block(12, 12, 12), {0, 0, -5}), down}),
        Edges::concave, ball(r), 5));
    std::mt19937_64 random(5);
    const auto number = [&](double a) {
        return std::uniform_real_distribution<double>(-a, a)(random);
    };
    for (int i = 0; i < 20000; ++i) {
        const Vec3 p{number(4), number(4), number(3)};
        const bool is_in = round.where(p) == solids::Where::in;
        CHECK((hollow.where(p) == solids::Where::in) != is_in);
        if (p.z > -2.0 + 3.0 * r)
            CHECK((open.where({p.x, p.y, -p.z}) == solids::Where::in) == (!is_in && -p.z < 1.0));
    }
}

TEST_CASE("corners: in every frame alike, and as a Boolean of many operands") {
    const std::vector<Vec2> skew{{-3, -2}, {4, -1}, {3, 3}, {-2, 2}};
    const double r = 0.4;
    Traced here(blended(pyramid(skew, 5), Edges::convex, ball(r), 8));
    const Affine maps[] = {
        reflection({1, 0, 0}),          reflection({1, 2, 3}),
        scaling({1e-5, 1e-5, 1e-5}),    scaling({1e5, 1e5, 1e5}),
        rotation(unit({1, 2, -1}), 77), translation({1e4, -1e4, 3e3}) * rotation({0, 0, 1}, 90)};
    std::mt19937_64 random(3);
    const auto number = [&](double a, double b) {
        return std::uniform_real_distribution<double>(a, b)(random);
    };
    const auto compare = [&](Traced& there, const Affine& map) {
        std::size_t differences = 0;
        for (int i = 0; i < 20000; ++i) {
            // Mostly about the tip.
            const Vec3 p{number(-1, 1), number(-1, 1), number(3, 5)};
            differences += here.where(p) != there.where(map(p)) ? 1 : 0;
        }
        CHECK(differences == 0);
    };
    for (const Affine& map : maps) {
        const double scale = norm(map.linear.column(0));
        Traced there(blended(mapped(pyramid(skew, 5), map), Edges::convex, ball(r * scale), 8));
        compare(there, map);
    }
    // A plane for each operand; of the block nothing is left.
    std::vector<csg::Solid> operands{halfspace({0, 0, -1}, 0), centred_block(20, 20, 20)};
    for (std::size_t i = 0; i < skew.size(); ++i) {
        const Vec2 a = skew[i];
        const Vec2 b = skew[(i + 1) % skew.size()];
        const Vec3 n = unit(cross(Vec3{b.x - a.x, b.y - a.y, 0}, Vec3{-a.x, -a.y, 5}));
        operands.push_back(halfspace(n, dot(n, Vec3{0, 0, 5})));
    }
    Traced joined(blended(csg::Op::intersection, operands, ball(r), 8));
    compare(joined, {});
}

TEST_CASE("corners: one ball for four spheres") {
    // The centres of balls within: those within four smaller spheres.
    const double big = 5.0, off = 2.0, r = 0.8;
    std::vector<csg::Solid> operands;
    for (const Vec3 at : {Vec3{off, 0, 0}, Vec3{0, off, 0}, Vec3{-off, 0, 0}, Vec3{0, -off, 0}})
        operands.push_back(move(sphere(big), at));
    Traced solid(blended(csg::Op::intersection, operands, ball(r), 4));
    const double tip = std::sqrt((big - r) * (big - r) - off * off);
    CHECK(0.5 * solid.chord({0, 0, -9}, {0, 0, 1}) == near(tip + r));
    // About the tip: the ball over the cone of its contacts, the tubes over their circles of centres.
    std::size_t judged = 0;
    for (double x = -1.007; x < 1.0; x += 0.0301) {
        for (double y = -1.003; y < 1.0; y += 0.0303) {
            const double u = std::fabs(x);
            const double v = std::fabs(y);
            // By symmetry the nearest centre is the tip, or on the circle between the spheres at (-off, 0), (0, -off).
            const auto height = [&] {
                // Of the sharp solid where a ball touches one sphere only.
                const double a = std::max(u, v) + off;
                const double b = std::min(u, v);
                return std::sqrt(big * big - a * a - b * b);
            };
            // A circle in the plane x = y, through the tip, about the middle of both centres.
            const double away = (u + v) * std::sqrt(0.5) + off * std::sqrt(0.5);
            const double across = (u - v) * std::sqrt(0.5);
            const double ring = std::sqrt((big - r) * (big - r) - 0.5 * off * off);
            const double chord = solid.chord({x, y, -9}, {0, 0, 1});
            CAPTURE(x);
            CAPTURE(y);
            CHECK(0.5 * chord <= height() + 1e-12);
            // On the torus of that circle, or on the ball at its end, whichever it is.
            const double z = 0.5 * chord;
            const double on_ball = std::sqrt(u * u + v * v + (z - tip) * (z - tip)) - r;
            const double on_tube = std::hypot(std::hypot(away, z) - ring, across) - r;
            const double on_sphere = z - height();
            CHECK(std::min({std::fabs(on_ball), std::fabs(on_tube), std::fabs(on_sphere)}) < 1e-9);
            // Nothing is beyond the ball where that is the nearest.
            if (std::max(u, v) < 0.05) {
                ++judged;
                CHECK(on_ball == doctest::Approx(0.0).epsilon(1e-9));
            }
        }
    }
    CHECK(judged > 4);
}

TEST_CASE("corners: a cone of a hundred planes has one ball, one of an ellipse many") {
    const double r = 0.5;
    Traced round(blended(pyramid(regular(100, 3), 4), Edges::convex, ball(r), 200));
    // Contacts are those of the cone within.
    const double sine = std::sin(std::atan(3.0 * std::cos(kPi / 100) / 4.0));
    CHECK(round.chord({0, 0, -9}, {0, 0, 1}) == near(4.0 - r / sine + r));
    std::vector<Vec2> oval = regular(60, 1.0);
    for (Vec2& p : oval) p = {4.0 * p.x, 2.0 * p.y};
    std::vector<Plane> planes{{{0, 0, -1}, 0.0}};
    for (std::size_t i = 0; i < oval.size(); ++i) {
        const Vec3 a{oval[i].x, oval[i].y, 0};
        const Vec2 b = oval[(i + 1) % oval.size()];
        const Vec3 n = unit(cross(Vec3{b.x, b.y, 0} - a, Vec3{0, 0, 4} - a));
        planes.push_back({n, dot(n, a)});
    }
    Traced flat(blended(pyramid(oval, 4), Edges::convex, ball(r), 120));
    std::mt19937_64 random(2);
    const auto number = [&](double a, double b) {
        return std::uniform_real_distribution<double>(a, b)(random);
    };
    for (int i = 0; i < 200; ++i) {
        const Vec3 p{number(-2, 2), number(-0.8, 0.8), number(2.0, 3.6)};
        const double d = from_centres(planes, r, p);
        if (std::fabs(d - r) > 1e-7) CHECK((flat.where(p) == solids::Where::in) == (d < r));
    }
}

TEST_CASE("corners: the largest radius, where an edge is used up") {
    // Of a regular pyramid that of the ball within it.
    const double high = 4.0, wide = 3.0;
    const double slope = wide * std::cos(kPi / 5);
    const double most = slope * high / (slope + std::hypot(slope, high));
    const csg::Solid five = pyramid(regular(5, wide), high);
    CHECK(blended_edges(five, Edges::convex, ball(most * 0.9999)).has_value());
    const auto refused = blended_edges(five, Edges::convex, ball(most * 1.0001));
    REQUIRE(!refused.has_value());
    CHECK(refused.error().code == ErrorCode::out_of_range);
    CHECK(refused.error().message.find("is in its way") != std::string::npos);
    const std::string hint = "the largest radius that works here is ";
    REQUIRE(refused.error().hint.rfind(hint, 0) == 0);
    const double told = std::stod(refused.error().hint.substr(hint.size()));
    CHECK(told <= most);
    CHECK(told > 0.99 * most);
    CHECK(blended_edges(five, Edges::convex, ball(told)).has_value());
}

TEST_CASE("corners: planes that miss one point by little or more make one corner") {
    // Moved in or out by so much, one side of the tip leaves a short edge, along which no ball of this size rolls; which two
    // planes the ball is passed on between does not depend on that.
    const double r = 0.4;
    const std::vector<Vec2> skew{{-3, -2}, {4, -1}, {3, 3}, {-2, 2}};
    std::mt19937_64 random(8);
    const auto number = [&](double a, double b) {
        return std::uniform_real_distribution<double>(a, b)(random);
    };
    for (int exponent = -15; exponent < 0; ++exponent) {
        for (const double sign : {-1.0, 1.0}) {
            CAPTURE(exponent);
            CAPTURE(sign);
            std::vector<Plane> planes = planes_of(skew, 5, 0.0);
            planes[1].offset += sign * std::pow(10.0, exponent);
            check_rounded(planes, 9, r, 2000, [&] {
                return Vec3{number(-0.7, 0.7), number(-0.7, 0.7), number(3.5, 5)};
            });
        }
    }
}

TEST_CASE("corners: short edges in the tip of a needle, where balls rest far below") {
    std::mt19937_64 random(12);
    const auto number = [&](double a, double b) {
        return std::uniform_real_distribution<double>(a, b)(random);
    };
    const double wide = 0.116, high = 2.5, r = 0.0912;
    for (int trial = 0; trial < 20; ++trial) {
        CAPTURE(trial);
        const std::vector<Vec2> base = regular(10, wide);
        std::vector<Plane> planes = planes_of(base, high, 0.0);
        for (std::size_t i = 1; i < planes.size(); ++i) planes[i].offset += number(-0.002, 0.002);
        check_rounded(planes, 4, r, 1000, [&] {
            return Vec3{number(-0.1, 0.1), number(-0.1, 0.1), number(0.2, 0.6)};
        });
    }
}

TEST_CASE("corners: the bottom of a pit between many operands") {
    // Large blocks beyond the sides of a pyramid that stands on its tip.
    const double r = 0.4;
    const std::vector<Vec2> skew{{-3, -2}, {4, -1}, {3, 3}, {-2, 2}};
    Traced tip(blended(pyramid(skew, 5), Edges::convex, ball(r), 8));
    std::vector<csg::Solid> walls;
    for (std::size_t i = 0; i < skew.size(); ++i) {
        const Vec3 a{skew[i].x, skew[i].y, 0};
        const Vec2 b = skew[(i + 1) % skew.size()];
        const Vec3 n = unit(cross(Vec3{b.x, b.y, 0} - a, Vec3{0, 0, 5} - a));
        walls.push_back(csg::boolean(csg::Op::intersection,
                                     {centred_block(14, 14, 14), halfspace(-n, -dot(n, a))}));
    }
    Form form = ball(r);
    // Without the edges that they have beyond each other.
    form.where = move(block(12, 12, 9), {-6, -6, -3});
    Traced pit(blended(csg::Op::unite, walls, form, 4));
    std::mt19937_64 random(6);
    const auto number = [&](double a, double b) {
        return std::uniform_real_distribution<double>(a, b)(random);
    };
    for (int i = 0; i < 20000; ++i) {
        const Vec3 p{number(-1.5, 1.5), number(-1.5, 1.5), number(2.5, 5.5)};
        CHECK((pit.where(p) == solids::Where::in) != (tip.where(p) == solids::Where::in));
    }
}

TEST_CASE("corners: what can not be rolled is refused with its place") {
    const csg::Solid four = move(pyramid(regular(4, 3), 4), {1, 2, 3});
    Form some = ball(0.3);
    some.where = move(block(9, 9, 9), {0.5, -3, 4});
    const auto part = blended_edges(four, Edges::convex, some);
    REQUIRE(!part.has_value());
    CHECK(part.error().code == ErrorCode::bad_argument);
    CHECK(part.error().message.find("along 3 edges of the corner at (1, 2, 7)") !=
          std::string::npos);
    // All of them, or two, can.
    some.where = move(block(9, 9, 9), {-4, -3, 4});
    CHECK(blended_edges(four, Edges::convex, some).has_value());
    some.where = move(block(9, 9, 9), {1.5, 1.5, 4});
    CHECK(blended_edges(four, Edges::convex, some).has_value());
    // Straight from contact to contact there is no ball to fit.
    some.where = {};
    some.profile = Profile::chamfer;
    CHECK(blended_edges(four, Edges::convex, some).has_value());
    // Spheres in no order: no ball touches all four.
    std::vector<csg::Solid> operands;
    for (const Vec3 at : {Vec3{2, 0, 0}, Vec3{0, 2, 0}, Vec3{-1, 0, 0}, Vec3{0, -1.5, 0}})
        operands.push_back(move(sphere(std::hypot(4.0, norm(at))), at));
    const auto none = blends::blended(csg::Op::intersection, operands, ball(0.5));
    REQUIRE(!none.has_value());
    CHECK(none.error().message.find("no ball touches all faces of the corner at (0, 0, ") !=
          std::string::npos);
}

TEST_CASE("edges between planes that meet at a small angle are found, turned in any way") {
    std::mt19937_64 random(3);
    const auto number = [&](double a, double b) {
        return std::uniform_real_distribution<double>(a, b)(random);
    };
    for (int i = 0; i < 400; ++i) {
        const double angle = std::pow(10.0, number(-4.5, -1.0));
        const Vec3 axis = unit(Vec3{number(-1, 1), number(-1, 1), number(-1, 1)});
        const Affine map =
            translation(axis * number(0.0, 20.0)) * rotation(axis, number(0.0, 360.0));
        const csg::Solid roof = csg::boolean(
            csg::Op::intersection,
            {centred_block(4, 6, 4), halfspace({std::sin(angle), 0.0, std::cos(angle)}, 1.0),
             halfspace({-std::sin(angle), 0.0, std::cos(angle)}, 1.0)});
        CAPTURE(angle);
        auto body = Body::make(csg::Op::unite, {mapped(roof, map)});
        REQUIRE(body.has_value());
        const auto edges = find_segments(*body, true, 0.5);
        REQUIRE(edges.has_value());
        // Those of a block, whose top has become two faces.
        CHECK(edges->size() == 15);
        CHECK(std::any_of(edges->begin(), edges->end(), [&](const Segment& edge) {
            const auto leaf = [&](std::size_t face) { return body->faces()[face].leaf; };
            return leaf(edge.face_a) == 1 && leaf(edge.face_b) == 2 &&
                   std::fabs(edge.hi - edge.lo - 6.0) < 1e-6;
        }));
    }
}

}  // namespace
}  // namespace raymo::blends
