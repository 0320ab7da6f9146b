// Solids that touch without crossing: where they touch is known by how they are placed.
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "raymo/blends/test_blends.hpp"

namespace raymo::blends {
namespace {

using namespace test;

class Placing {
public:
    explicit Placing(unsigned seed) : random_(seed) {}

    double number(double a, double b) {
        return std::uniform_real_distribution<double>(a, b)(random_);
    }
    Vec3 direction() { return unit(Vec3{number(-1.0, 1.0), number(-1.0, 1.0), number(-1.0, 1.0)}); }
    Affine similarity() {
        return translation(direction() * number(0.0, 10.0)) *
               (rotation(direction(), number(0.0, 360.0)) *
                scaling(Vec3{1.0, 1.0, 1.0} * std::exp2(number(-3.0, 3.0))));
    }
    /// A sphere, a cylinder, a cone, a torus or a block (0 to 4) below the plane z = 0, which it touches in the origin, alone or along
    /// a line, or with a face.
    csg::Solid below(int kind) {
        if (kind == 0) {
            const double r = number(0.5, 3.0);
            return move(sphere(r), {0.0, 0.0, -r});
        }
        if (kind == 1) {
            const double h = number(2.0, 6.0);
            const double r = number(0.5, 3.0);
            return laid(cylinder(r, h), {r, 0.0, h * number(0.2, 0.8)}, 0.0);
        }
        if (kind == 2) {
            const double h = number(2.0, 6.0);
            const double r = number(1.0, 3.0);
            const double top = number(0.2, 0.9) * r;
            const double part = number(0.2, 0.8);
            return laid(cone(r, top, h), {r + (top - r) * part, 0.0, h * part},
                        std::atan2(r - top, h));
        }
        if (kind == 3) {
            const double ring = number(2.0, 4.0);
            const double tube = number(0.3, 1.5);
            const double turn = number(-1.4, 1.4);
            return laid(torus(ring, tube),
                        {ring + tube * std::cos(turn), 0.0, tube * std::sin(turn)}, turn);
        }
        return move(centred_block(6.0, 7.0, 8.0), {number(-2.0, 2.0), number(-2.0, 2.0), -4.0});
    }

private:
    /// Turns a solid so that its point p comes to the origin, and its normal there, at an angle to x towards z, to z.
    static csg::Solid laid(csg::Solid s, Vec3 p, double normal) {
        const double degrees = 90.0 - normal * 180.0 / std::numbers::pi;
        return mapped(std::move(s), rotation({0.0, 1.0, 0.0}, -degrees) * translation(-p));
    }

    std::mt19937_64 random_;
};

/// The error of a blend, if there is one; else "blended", or "no edge".
std::string answer(csg::Op op, std::vector<csg::Solid> operands, const Form& form) {
    const auto made = blends::blended(op, std::move(operands), form);
    if (!made) return made.error().message;
    return made->edges > 0 ? "blended" : "no edge";
}

bool tells(const std::string& message) {
    return message.find(" touch each other at (") != std::string::npos;
}

TEST_CASE("touching: solids on both sides of a plane that touch in one of its points") {
    Placing placing(7);
    const Affine over = rotation({1.0, 0.0, 0.0}, 180.0);
    for (int i = 0; i < 1500; ++i) {
        const int kind_a = i % 5;
        const int kind_b = i / 5 % 5;
        // Planes that touch are flush.
        if (kind_a == 4 && kind_b == 4) continue;
        const Affine frame = placing.similarity();
        const double spin = placing.number(0.0, 360.0);
        const double up = i % 3 == 0 ? 0.0 : placing.number(1e-6, 1e-2);
        const csg::Solid a = mapped(placing.below(kind_a), frame);
        const csg::Solid b = mapped(
            placing.below(kind_b),
            frame * (translation({0.0, 0.0, up}) * (rotation({0.0, 0.0, 1.0}, spin) * over)));
        CAPTURE(i);
        CAPTURE(kind_a);
        CAPTURE(kind_b);
        const std::string told =
            answer(csg::Op::unite, {a, b}, ball(0.01 * norm(frame.linear.row[0])));
        CAPTURE(told);
        // Where they keep clear of each other there is nothing to tell.
        CHECK((up > 0.0 ? told == "no edge" : tells(told)));
    }
}

TEST_CASE("touching: the point is told, and both faces") {
    CHECK(answer(csg::Op::unite, {sphere(1.0), move(sphere(2.0), {0.0, 3.0, 0.0})}, ball(0.1)) ==
          "the surface of the sphere and the surface of the sphere touch each other at (0, 1, 0)");
}

TEST_CASE("touching: walls that end in nothing") {
    const csg::Solid plate = centred_block(4.0, 4.0, 4.0);
    CHECK(tells(answer(csg::Op::difference, {plate, sphere(2.0)}, ball(0.1))));
    CHECK(tells(
        answer(csg::Op::difference, {sphere(3.0), move(sphere(1.0), {0.0, 0.0, 2.0})}, ball(0.1))));
    // A bore along a side, whose rims are edges.
    CHECK(tells(answer(csg::Op::difference, {plate, move(cylinder(1.0, 8.0), {1.0, 0.0, -4.0})},
                       ball(0.1))));
    CHECK(tells(answer(csg::Op::unite, {sphere(2.0), torus(3.0, 1.0)}, ball(0.1))));
}

TEST_CASE("touching: what goes on smoothly, lies flush or does not show") {
    const csg::Solid plate = centred_block(4.0, 4.0, 4.0);
    const auto none = [](csg::Op op, std::vector<csg::Solid> operands) {
        return answer(op, std::move(operands), ball(0.1)) == "no edge";
    };
    // A rod with a round end; a ball in a block; a ring about a rod of the same width.
    CHECK(none(csg::Op::unite, {cylinder(2.0, 6.0), move(sphere(2.0), {0.0, 0.0, 6.0})}));
    CHECK(none(csg::Op::unite, {plate, sphere(2.0)}));
    CHECK(none(csg::Op::intersection, {plate, sphere(2.0)}));
    CHECK(none(csg::Op::unite, {cylinder(3.0, 6.0), move(torus(2.0, 1.0), {0.0, 0.0, 3.0})}));
    // Rods one on the other.
    CHECK(none(csg::Op::unite, {cylinder(2.0, 6.0), move(cylinder(2.0, 6.0), {0.0, 0.0, 6.0})}));
    CHECK(none(csg::Op::unite, {sphere(2.0), sphere(2.0)}));
    // Where balls touch a third one is all about them.
    CHECK(none(csg::Op::unite, {sphere(1.0), move(sphere(1.0), {2.0, 0.0, 0.0}), sphere(4.0)}));
}

TEST_CASE("touching: a cutter that is flush with what it touches takes all of that away") {
    const auto half = [](csg::Solid s, Vec3 size, Vec3 at) {
        return answer(csg::Op::difference, {std::move(s), move(block(size.x, size.y, size.z), at)},
                      ball(0.4));
    };
    CHECK(half(sphere(5.0), {10, 10, 5}, {-5, -5, -5}) == "blended");
    CHECK(half(cylinder(5.0, 20.0), {2, 10, 10}, {3, -5, 10}) == "blended");
    CHECK(half(cylinder(5.0, 20.0), {5, 10, 20}, {0, -5, 0}) == "blended");
    CHECK(half(torus(10.0, 3.0), {26, 26, 3}, {-13, -13, -3}) == "blended");
    // And a rib that reaches to the outside of the pipe, which is solid there.
    const csg::Solid pipe = csg::boolean(
        csg::Op::difference, {cylinder(10.0, 20.0), move(cylinder(8.0, 30.0), {0, 0, -5})});
    CHECK(answer(csg::Op::unite, {pipe, move(block(16, 2, 10), {-8, -1, 0})}, ball(0.3)) ==
          "blended");
}

TEST_CASE("touching: parts that are small beside the body, and far from the origin") {
    Placing placing(5);
    for (int i = 0; i < 100; ++i) {
        CAPTURE(i);
        const Affine frame = placing.similarity();
        const double size = norm(frame.linear.row[0]);
        const csg::Solid plate = move(block(300 * size, 300 * size, size), {0, 0, -100 * size});
        const csg::Solid a = mapped(placing.below(i % 4), frame);
        const csg::Solid b = mapped(placing.below(1), frame * rotation({1.0, 0.0, 0.0}, 180.0));
        const std::string told = answer(csg::Op::unite, {plate, a, b}, ball(0.01 * size));
        CAPTURE(told);
        CHECK(tells(told));
    }
    CHECK(tells(answer(csg::Op::unite,
                       {move(sphere(1.1), {1e5 + 0.1, 0, 0}), move(sphere(2.3), {1e5 + 3.5, 0, 0})},
                       ball(0.2))));
    CHECK(tells(
        answer(csg::Op::unite, {sphere(1e5), move(sphere(1.0), {100001.0, 0, 0})}, ball(0.1))));
}

TEST_CASE("touching: with the blend of another operand") {
    const csg::Solid drum = blended(cylinder(10.0, 10.0), Edges::convex, ball(3.0), 2);
    const double at = 7.0 + 7.0 / std::numbers::sqrt2;
    CHECK(tells(answer(csg::Op::unite, {drum, move(sphere(4.0), {at, 0.0, at})}, ball(0.3))));
}

TEST_CASE("touching: of what is chosen") {
    const std::vector<csg::Solid> balls{sphere(1.0), move(sphere(1.0), {2.0, 0.0, 0.0})};
    Form form = ball(0.1);
    form.where = move(sphere(0.5), {1.0, 0.0, 0.0});
    CHECK(tells(answer(csg::Op::unite, balls, form)));
    form.where = move(sphere(0.5), {2.0, 0.0, 0.0});
    CHECK(answer(csg::Op::unite, balls, form) == "no edge");

    // Where there is no edge, the nearest can not be meant.
    form = ball(0.1);
    form.near = Vec3{1.0, 0.0, 0.0};
    CHECK(tells(answer(csg::Op::unite, balls, form)));

    const csg::Solid both = csg::boolean(csg::Op::unite, balls);
    CHECK(!blended_edges(both, Edges::concave, ball(0.1)).has_value());
    CHECK(blended_edges(both, Edges::convex, ball(0.1)).has_value());
}

}  // namespace
}  // namespace raymo::blends
