// Blends of two surfaces, and corners of three, against closed forms to 1e-9.
#include "raymo/blends/test_blends.hpp"

namespace raymo::blends {
namespace {

using namespace test;

/// Between two planes that enclose an empty wedge of that angle, in degrees.
struct Wedge {
    double angle;
    csg::Solid left, right;

    explicit Wedge(double degrees)
        : angle(degrees * kPi / 180.0),
          // Both have an edge along y in the origin; the wedge opens along x, up from z = 0.
          left(move(block(40, 40, 20), {-20, -20, -20})),
          right(turn(move(block(40, 40, 20), {-20, -20, 0}), {0, -1, 0}, degrees)) {}

    /// The area of the section that a fillet adds, by rays against the direction in which the wedge opens.
    double fillet_area(Form form, double contact) const {
        form.near = Vec3{};
        Traced solid(blended(csg::Op::unite, {left, right}, form, 1));
        const double half = 0.5 * angle;
        const Vec3 out{std::cos(half), 0, std::sin(half)};
        const Vec3 across{-std::sin(half), 0, std::cos(half)};
        const double width = contact * std::sin(half);
        const auto added = [&](double s) {
            const double sharp = std::fabs(s) / std::tan(half);
            return 8.0 - sharp - solid.first(out * 8.0 + across * s, -out);
        };
        return integral(-width, 0.0, added) + integral(0.0, width, added);
    }
};

TEST_CASE("closed forms: the section of a fillet between planes (B1, B2)") {
    const double r = 0.7;
    for (const double degrees : {40.0, 60.0, 90.0, 120.0, 150.0}) {
        CAPTURE(degrees);
        const Wedge wedge(degrees);
        const double half = 0.5 * wedge.angle;
        const double contact = r / std::tan(half);
        CHECK(wedge.fillet_area(ball(r), contact) ==
              near(r * r * (1.0 / std::tan(half) - 0.5 * (kPi - wedge.angle))));
        Form chamfer = ball(r);
        chamfer.profile = Profile::chamfer;
        CHECK(wedge.fillet_area(chamfer, contact) ==
              near(0.5 * contact * contact * std::sin(wedge.angle)));
    }
    CHECK(Wedge(90).fillet_area(ball(r), r) == near(r * r * (1.0 - 0.25 * kPi)));
}

TEST_CASE("closed forms: the section of a conic of any shape (B12)") {
    const double r = 0.7;
    for (const double degrees : {60.0, 90.0, 130.0}) {
        const Wedge wedge(degrees);
        const double contact = r / std::tan(0.5 * wedge.angle);
        for (const double shape : {-0.9, -0.5, 0.0, 0.5, 0.8}) {
            CAPTURE(degrees);
            CAPTURE(shape);
            Form form = ball(r);
            form.profile = Profile::conic;
            form.shape = shape;
            // The part of the triangle between the contacts, 2 k, in which (g + h - 1)^2 >= 2 (1 - shape) g h.
            const double phi = std::acos(-shape);
            const double k =
                ((1.0 + shape) - 0.5 * phi * std::sin(phi)) / ((1.0 + shape) * (1.0 + shape));
            CHECK(wedge.fillet_area(form, contact) ==
                  near(contact * contact * std::sin(wedge.angle) * k));
        }
    }
}

TEST_CASE("closed forms: planes at an angle have a round fillet as conic of the right shape (B7)") {
    for (const double degrees : {45.0, 60.0, 100.0}) {
        CAPTURE(degrees);
        const Wedge wedge(degrees);
        const double r = 1.3;
        Form form = ball(r);
        form.profile = Profile::conic;
        // The cosine between the normals, which point into the wedge; shape = -cos.
        form.shape = std::cos(wedge.angle);
        form.near = Vec3{};
        Traced conic(blended(csg::Op::unite, {wedge.left, wedge.right}, form, 1));
        const double half = 0.5 * wedge.angle;
        const Vec3 out{std::cos(half), 0, std::sin(half)};
        const Vec3 across{-std::sin(half), 0, std::cos(half)};
        const Vec3 centre = out * (r / std::sin(half));
        for (double s = -0.95; s < 1.0; s += 0.1) {
            const Vec3 from = centre + across * (s * r * std::cos(half));
            const Vec3 hit = from - out * conic.first(from, -out);
            CHECK(norm(hit - centre) == doctest::Approx(r).scale(0.0).epsilon(1e-12));
        }
    }
}

TEST_CASE("closed forms: a peg on a plate (B3)") {
    const double big = 2.0, r = 1.0;
    const csg::Solid plate = move(block(12, 12, 1), {-6, -6, -1});
    const csg::Solid peg = move(cylinder(big, 4), {0, 0, -0.5});
    Traced solid(blended(csg::Op::unite, {plate, peg}, ball(r), 1));
    const auto radius = [&](double z) { return 0.5 * solid.chord({-20, 0, z}, {1, 0, 0}); };
    const double volume =
        integral(0.0, r, [&](double z) { return kPi * (radius(z) * radius(z) - big * big); });
    const double exact =
        2.0 * kPi * (big * r * r * (1.0 - 0.25 * kPi) + r * r * r * (5.0 / 6.0 - 0.25 * kPi));
    CHECK(exact == doctest::Approx(2.997952).epsilon(1e-6));
    CHECK(volume == near(exact));

    const auto& spans = solid.along({10, 0, 0.5}, {-1, 0, 0});
    REQUIRE(spans.size() == 1);
    CHECK(spans[0].enter.point.x == near(3.0 - std::sqrt(0.75)));
    CHECK(spans[0].enter.normal.x == near(std::sqrt(0.75)));
    CHECK(std::fabs(spans[0].enter.normal.y) < 1e-12);
    CHECK(spans[0].enter.normal.z == near(0.5));
}

TEST_CASE("closed forms: the rim of a cylinder rounded") {
    const double big = 2.0, r = 0.5, h = 3.0;
    Traced solid(blended(cylinder(big, h), Edges::convex, ball(r), 2));
    const auto area = [&](double z) {
        const double radius = 0.5 * solid.chord({-20, 0, z}, {1, 0, 0});
        return kPi * radius * radius;
    };
    // By Pappus: the corner r^2 (1 - pi/4) of the section turns about the axis, at its centroid.
    const double lost =
        2.0 * kPi * (big * r * r * (1.0 - 0.25 * kPi) - r * r * r * (5.0 / 6.0 - 0.25 * kPi));
    CHECK(integral(0.0, r, area) + integral(r, h - r, area) + integral(h - r, h, area) ==
          near(kPi * big * big * h - 2.0 * lost));
}

TEST_CASE("closed forms: a sphere on a plate (B8)") {
    const csg::Solid plate = move(block(12, 12, 1), {-6, -6, -1});
    Traced solid(blended(csg::Op::unite, {plate, move(sphere(2), {0, 0, 1})}, ball(0.5), 1));
    const double ring = std::sqrt(2.5 * 2.5 - 0.5 * 0.5);
    CHECK(ring == doctest::Approx(2.4494897428));
    // The ball touches the sphere at four fifths of the way between the centres.
    const double top = 1.0 + 0.8 * (0.5 - 1.0);
    for (const double z : {0.001, 0.1, 0.2, 0.4, top - 0.001}) {
        CAPTURE(z);
        const auto& spans = solid.along({10, 0, z}, {-1, 0, 0});
        REQUIRE(spans.size() == 1);
        const double x = ring - std::sqrt(0.25 - (z - 0.5) * (z - 0.5));
        CHECK(spans[0].enter.point.x == near(x));
        CHECK(spans[0].enter.normal.x == near((ring - x) / 0.5));
        CHECK(spans[0].enter.normal.z == near((0.5 - z) / 0.5));
    }
}

TEST_CASE("closed forms: a corner of three concave planes (B6)") {
    const double r = 0.8;
    const csg::Solid room = csg::boolean(
        csg::Op::unite, {move(block(10, 10, 1), {-1, -1, -1}), move(block(1, 10, 10), {-1, -1, -1}),
                         move(block(10, 1, 10), {-1, -1, -1})});
    Traced solid(blended(room, Edges::concave, ball(r), 3));
    // Height of the floor, up to r.
    const auto floor = [&](double x, double y) {
        const auto& spans = solid.along({x, y, 0}, {0, 0, 1});
        REQUIRE(!spans.empty());
        return std::min(spans[0].exit.t, r);
    };
    const double volume = integral(0.0, r, [&](double x) {
        const double y = r - std::sqrt(r * r - (r - x) * (r - x));
        return integral(0.0, y, [&](double at) { return floor(x, at); }) +
               integral(y, r, [&](double at) { return floor(x, at); });
    });
    CHECK(volume == near(r * r * r * (1.0 - kPi / 6.0)));
}

TEST_CASE("closed forms: a block with all edges and corners rounded (B5)") {
    const double side = 2.0, r = 0.4, s = side - 2.0 * r;
    Traced solid(blended(centred_block(side, side, side), Edges::convex, ball(r), 12));
    const auto chord = [&](double x, double y) { return solid.chord({x, y, -5}, {0, 0, 1}); };
    const double in = 0.5 * s, out = 0.5 * side;
    const auto column = [&](double x) {
        const double beyond = std::max(std::fabs(x) - in, 0.0);
        const double edge = in + std::sqrt(std::max(r * r - beyond * beyond, 0.0));
        const auto at = [&](double y) { return chord(x, y); };
        return integral(-edge, -in, at) + integral(-in, in, at) + integral(in, edge, at);
    };
    const double volume =
        integral(-out, -in, column) + integral(-in, in, column) + integral(in, out, column);
    const double exact =
        s * s * s + 6.0 * s * s * r + 3.0 * kPi * s * r * r + 4.0 / 3.0 * kPi * r * r * r;
    CHECK(exact == doctest::Approx(7.26163994));
    CHECK(volume == near(exact));
}

TEST_CASE("closed forms: the complement of a blended union is the blended intersection (B9)") {
    const csg::Solid world = centred_block(40, 40, 40);
    Traced whole(world);
    const auto outside = [&](const csg::Solid& s) {
        return csg::boolean(csg::Op::difference, {world, s});
    };
    struct Two {
        csg::Solid a, b;
    };
    for (const Two& two :
         {Two{move(sphere(3), {0, 0, 1}), move(cylinder(1.5, 12), {0, 0, -6})},
          Two{sphere(3), move(sphere(2), {2, 1.5, 1})},
          Two{torus(3, 1), move(cone(4, 1, 6), {0, 0, -3})},
          Two{cylinder(2, 5), turn(move(block(9, 9, 3), {-4, -4, 1}), {0, 0, 1}, 30)}}) {
        const Form form = ball(0.3);
        auto joined = blends::blended(csg::Op::unite, {two.a, two.b}, form);
        auto met = blends::blended(csg::Op::intersection, {outside(two.a), outside(two.b)}, form);
        REQUIRE(joined.has_value());
        REQUIRE(met.has_value());
        CHECK(joined->edges > 0);
        CHECK(joined->edges == met->edges);
        Traced solid(joined->solid);
        Traced rest(met->solid);
        for (int i = 1; i <= 4000; ++i) {
            // Points of a lattice that has nothing to do with the axes.
            const auto part = [&](double x) { return 2.0 * std::fmod(i * x + 0.5, 1.0) - 1.0; };
            const Vec3 p{4.0 * part(0.8191725134), 4.0 * part(0.6710436067),
                         4.0 * part(0.5497004779)};
            const Vec3 d = unit({part(0.7548776662), part(0.5698402910), part(0.3247179572)});
            CHECK(solid.chord(p, d) + rest.chord(p, d) ==
                  doctest::Approx(whole.chord(p, d)).epsilon(1e-11));
        }
    }
}

}  // namespace
}  // namespace raymo::blends
