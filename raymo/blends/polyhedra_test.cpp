// Convex polyhedra with all edges rounded: what balls within them reach, by its definition.
//
// The centres of balls of radius r within { n_i.x <= k_i } are those with n_i.x <= k_i - r, and a point is reached when it is
// no farther than r from these: from its own place, or from its foot on the planes of one, two or three of the faces.
#include <random>

#include "raymo/blends/test_polyhedra.hpp"
#include "raymo/curves/samples.hpp"

namespace raymo::blends {
namespace {

using namespace test;

/// `upright`: the solid within the planes. `size`: a cube about the origin that holds it.
void check(const csg::Solid& upright, const std::vector<Plane>& planes, double size, double r,
           std::size_t edges) {
    std::mt19937_64 random(7);
    const auto number = [&](double lo, double hi) {
        return std::uniform_real_distribution<double>(lo, hi)(random);
    };
    for (int frame = 0; frame < 3; ++frame) {
        Affine map;
        if (frame > 0) {
            map = translation({number(-9, 9), number(-9, 9), number(-9, 9)}) *
                  rotation(unit({number(-1, 1), number(-1, 1), number(0.1, 1)}), number(0, 360));
        }
        Traced traced(blended(mapped(upright, map), Edges::convex, ball(r), edges));
        std::size_t judged = 0;
        for (int i = 0; i < 20000; ++i) {
            const Vec3 p{number(-size, size), number(-size, size), number(-size, size)};
            const double d = from_centres(planes, r, p);
            if (std::fabs(d - r) < 1e-8) continue;
            ++judged;
            const bool is_in = traced.where(map(p)) == solids::Where::in;
            if (is_in != (d < r)) {
                CAPTURE(p.x);
                CAPTURE(p.y);
                CAPTURE(p.z);
                CAPTURE(d);
                FAIL_CHECK("frame " << frame << (is_in ? ": in" : ": out"));
                break;
            }
        }
        CHECK(judged > 10000);
    }
}

void check(const std::vector<Plane>& planes, double size, double r, std::size_t edges) {
    check(within(planes, size), planes, size, r, edges);
}

TEST_CASE("polyhedra: a conic sweep of a polygon") {
    const std::vector<Vec2> tapered{{-3, -2}, {3, -2}, {3, 2}, {-3, 2}};
    check(leaning(tapered, 4, 0.7), planes_of(tapered, 4, 0.7), 5, 0.5, 12);
    const std::vector<Vec2> pointed{{-3, -2}, {4, -1}, {-1, 4}};
    check(leaning(pointed, 5, 0.0), planes_of(pointed, 5, 0.0), 6, 0.4, 6);
    // Four faces and more in its tip, and not one ball for all of them.
    const std::vector<Vec2> four{{-3, -2}, {4, -1}, {3, 3}, {-2, 2}};
    check(leaning(four, 5, 0.0), planes_of(four, 5, 0.0), 6, 0.4, 8);
    const std::vector<Vec2> seven{{1, 0}, {4, -1}, {7, 1}, {8, 4}, {6, 6}, {3, 6}, {0, 3}};
    check(leaning(seven, 6, 0.0), planes_of(seven, 6, 0.0), 9, 0.5, 14);
    // Its axis needs not go through it.
    const std::vector<Vec2> aside{{2, 1}, {7, 1}, {7, 4}, {3, 5}};
    check(leaning(aside, 6, 0.6), planes_of(aside, 6, 0.6), 8, 0.3, 12);
}

TEST_CASE("polyhedra: two that meet flush, whose edges and balls lie in the plane between them") {
    const std::vector<Vec2> base{{4, 0}, {0, 4}, {-4, 0}, {0, -4}};
    const csg::Solid upper = leaning(base, 6, 0.0);
    std::vector<Plane> planes = planes_of(base, 6, 0.0);
    planes.erase(planes.begin());
    const std::size_t count = planes.size();
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 n = planes[i].normal;
        planes.push_back({Vec3{n.x, n.y, -n.z}, planes[i].offset});
    }
    const csg::Solid lower = mapped(upper, reflection({0, 0, 1}));
    check(csg::boolean(csg::Op::unite, {upper, lower}), planes, 7, 0.5, 12);
}

TEST_CASE("polyhedra: a conic sweep of a circle is a cone") {
    curves::Outline outline;
    outline.curves.push_back(curves::full_circle({}, 3.0));
    const csg::Solid swept = made(
        "conic", {std::make_shared<const curves::Outline>(std::move(outline)), 4.0, 0.5, false});
    const Form form = ball(0.6);
    Traced one(blended(swept, Edges::convex, form, 2));
    Traced other(blended(cone(3.0, 1.5, 4.0), Edges::convex, form, 2));
    std::mt19937_64 random(11);
    const auto number = [&] { return std::uniform_real_distribution<double>(-4, 4)(random); };
    for (int i = 0; i < 2000; ++i) {
        const Vec3 from{number(), number(), number() + 2.0};
        const Vec3 way = unit({number(), number(), number()});
        CHECK(one.chord(from, way) == near(other.chord(from, way)));
    }
}

TEST_CASE("polyhedra: a tetrahedron") {
    const double k = 1.0 / std::sqrt(3.0);
    const std::vector<Plane> planes{
        {Vec3{k, k, k}, 2}, {Vec3{-k, -k, k}, 2}, {Vec3{-k, k, -k}, 2}, {Vec3{k, -k, -k}, 2}};
    check(planes, 6, 0.7, 6);
}

TEST_CASE("polyhedra: an octahedron, and one that leans") {
    std::vector<Plane> planes;
    for (const double x : {-1.0, 1.0}) {
        for (const double y : {-1.0, 1.0}) {
            for (const double z : {-1.0, 1.0}) planes.push_back({unit({x, y, z}), 2.0});
        }
    }
    check(planes, 4, 0.7, 12);
    // Under a map that takes planes to planes, and its corners along.
    const Mat3 lean{{Vec3{1, 0.3, 0.1}, Vec3{-0.2, 0.8, 0.4}, Vec3{0, 0.2, 1.1}}};
    for (Plane& plane : planes) {
        const Vec3 n = transposed_times(lean, plane.normal);
        plane = {unit(n), plane.offset / norm(n)};
    }
    check(planes, 6, 0.6, 12);
}

TEST_CASE("polyhedra: a leaning prism with a sharp edge") {
    const std::vector<Plane> planes{{unit({0, 0.2, 1}), 3},
                                    {unit({0.1, 0, -1}), 2},
                                    {unit({0, -1, 0}), 2},
                                    {unit({-1, 0.6, 0}), 2.5},
                                    {unit({1, 1, 0.1}), 3}};
    check(planes, 9, 0.6, 9);
}

TEST_CASE("polyhedra: a block with its corner cut off") {
    const std::vector<Plane> planes{
        {Vec3{1, 0, 0}, 3}, {Vec3{-1, 0, 0}, 3}, {Vec3{0, 1, 0}, 3},        {Vec3{0, -1, 0}, 3},
        {Vec3{0, 0, 1}, 3}, {Vec3{0, 0, -1}, 3}, {unit({1, 1.2, 0.9}), 3.2}};
    check(planes, 4, 0.5, 15);
}

TEST_CASE("polyhedra: the corners of a thin plate are rounded by a larger ball") {
    // Only its upright edges: a rectangle with round corners, swept up.
    const double r = 3.0;
    Form form = ball(r);
    form.where = move(block(40, 40, 0.5), {-20, -20, 0.75});
    Traced solid(blended(move(block(16, 10, 2), {-8, -5, 0}), Edges::convex, form, 4));
    for (double x = 4.03; x < 8.5; x += 0.103) {
        for (double y = 1.01; y < 5.5; y += 0.101) {
            const double d = std::hypot(std::max(x - (8 - r), 0.0), std::max(y - (5 - r), 0.0));
            if (std::fabs(d - r) < 1e-9) continue;
            const double chord = solid.chord({x, y, -3}, {0, 0, 1});
            CHECK(chord == near(d < r ? 2.0 : 0.0));
        }
    }
}

TEST_CASE("polyhedra: a radius that is too large names the largest") {
    const auto refused = blended_edges(centred_block(4, 6, 8), Edges::convex, ball(2.5));
    REQUIRE(!refused.has_value());
    CHECK(refused.error().code == ErrorCode::out_of_range);
    CHECK(refused.error().hint == "the largest radius that works here is 2");
    CHECK(blended_edges(centred_block(4, 6, 8), Edges::convex, ball(2.0)).has_value());
    CHECK(!blended_edges(centred_block(4, 6, 8), Edges::convex, ball(2.01)).has_value());
}

}  // namespace
}  // namespace raymo::blends
