// The stories: numbers that can be checked by eye, and what is refused.
#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <string>

#include "raymo/solids/inventory.hpp"

namespace raymo::solids {
namespace {

constexpr double kError = 0x1p-50;

LocalRay<double> line(Vec3 o, Vec3 d) {
    return {o.x, o.y, o.z, d.x, d.y, d.z, kError, kError, kError, dot(d, d), kFromTheBeginning};
}

template <class K>
SpanList spans_of(const K& kernel, Vec3 o, Vec3 d) {
    SpanList spans;
    kernel.spans(line(o, d), spans);
    return spans;
}

template <class P>
Error refusal(std::vector<Argument> arguments) {
    for (const Entry& entry : inventory()) {
        if (entry.schema != &P::schema()) continue;
        auto made = entry.make(arguments);
        REQUIRE_FALSE(made.has_value());
        return made.error();
    }
    return {};
}

TEST_CASE("block: a ray along x crosses left and right") {
    const auto spans = spans_of(Block::Kernel(), {0, 0.5, 0.25}, {2, 0, 0});
    REQUIRE(spans.size() == 1);
    CHECK(spans[0].enter.s == -0.5);
    CHECK(spans[0].exit.s == 0.5);
    CHECK(Block::Kernel().faces()[spans[0].enter.face] == "left");
    CHECK(Block::Kernel().faces()[spans[0].exit.face] == "right");
}

TEST_CASE("block: a ray in a face is degenerate, one in the face's plane but elsewhere is not") {
    CHECK(spans_of(Block::Kernel(), {1, 0, 0}, {0, 1, 0}).degenerate());
    CHECK(spans_of(Block::Kernel(), {1, 1, 0}, {0, 0, -3}).degenerate());
    const auto aside = spans_of(Block::Kernel(), {1, 0, 1.5}, {0, 1, 0});
    CHECK_FALSE(aside.degenerate());
    CHECK(aside.size() == 0);
}

TEST_CASE("block: corners touched by a ray leave no span") {
    CHECK(spans_of(Block::Kernel(), unit({1, -1, 0}) * std::sqrt(2.0), {1, 1, 0}).size() == 0);
}

TEST_CASE("cylinder: along its axis, along its side, and tangent") {
    const Cylinder::Kernel k;
    const auto along = spans_of(k, {0.5, 0.5, 0}, {0, 0, 1});
    REQUIRE(along.size() == 1);
    CHECK(along[0].enter.s == -1.0);
    CHECK(k.faces()[along[0].exit.face] == "top");
    CHECK(spans_of(k, {1, 0, 0}, {0, 0, 1}).degenerate());
    const auto tangent = spans_of(k, {1, 0, 0.5}, {0, 1, 0});
    CHECK(tangent.size() == 0);
    CHECK_FALSE(tangent.degenerate());
    CHECK(spans_of(k, {1.5, 0, 0}, {0, 0, 1}).size() == 0);
}

TEST_CASE(
    "cone: a ray along a generator is degenerate; through the tip there is only the lower nappe") {
    const Cone::Kernel k(0.0, false);
    const Vec3 generator{-1, 0, 2};  // from (1, 0, -1) to the tip (0, 0, 1)
    Vec3 o{1, 0, -1};
    o -= generator * (dot(o, generator) / dot(generator, generator));
    CHECK(spans_of(k, o, generator).degenerate());
    const auto axis = spans_of(k, {0, 0, 0}, {0, 0, 1});
    REQUIRE(axis.size() == 1);
    CHECK(axis[0].enter.s == -1.0);
    CHECK(std::fabs(axis[0].exit.s - 1.0) <= axis[0].exit.error);
    // Above the tip the equation has a second nappe; the solid has not.
    CHECK(spans_of(k, {0, 0, 1.5}, {1, 0, 0}).size() == 0);
}

TEST_CASE("cone: crossings next to the tip are known as well as others") {
    const Cone::Kernel k(0.0, false);
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> any(-1, 1);
    for (int i = 0; i < 20000; ++i) {
        // Level lines past the axis, at most 1e-9 to 1 from the tip, tilted a little.
        const double off = std::pow(10.0, -4.5 + 4.5 * any(random));
        const double turn = 4 * any(random);
        const Vec3 d = unit({std::cos(turn), std::sin(turn), 0.3 * any(random)});
        const Vec3 by{0.3 * off * any(random), 0.3 * off * any(random), 1 - off};
        const Vec3 o = by - d * dot(d, by);
        const auto spans = spans_of(k, o, d);
        // The same equation in more digits, for the line that was asked for.
        using Real = long double;
        const Real q = (1 - Real{o.z}) / 2;
        const Real dq = Real{d.z} / 2;
        const Real a = Real{d.x} * d.x + Real{d.y} * d.y - dq * dq;
        const Real b = Real{o.x} * d.x + Real{o.y} * d.y + dq * q;
        const Real px = o.y * dq + q * d.y;
        const Real py = o.x * dq + q * d.x;
        const Real pz = Real{o.x} * d.y - Real{o.y} * d.x;
        const Real root = px * px + py * py - pz * pz;
        if (root < 0) {
            CHECK(spans.size() == 0);
            continue;
        }
        if (spans.size() == 0) {
            CHECK(std::sqrt(root) / a < 1e-12L);
            continue;
        }
        const Real enter = (-b - std::sqrt(root)) / a;
        const Real exit = (-b + std::sqrt(root)) / a;
        CHECK(std::fabs(spans[0].enter.s - enter) <= spans[0].enter.error);
        if (spans[0].exit.face == 0)
            CHECK(std::fabs(spans[0].exit.s - exit) <= spans[0].exit.error);
        if (root > 0.01L * off * off) CHECK(spans[0].enter.error < 1e-11);
    }
}

TEST_CASE("cone: next to generators and their tangent planes crossings are where they should be") {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> any(-1, 1);
    const auto tiny = [&] { return any(random) * std::pow(10.0, -9 + 7 * any(random)); };
    for (const double ratio : {0.0, 1e-9, 0.3, 0.9, 1 - 1e-12, 1.0}) {
        const Cone::Kernel k(ratio, false);
        const double g = (1 - ratio) / 2;
        for (int i = 0; i < 20000; ++i) {
            // Along a generator, shifted in its tangent plane and, by less, out of it.
            const double turn = 4 * any(random);
            const Vec3 out{std::cos(turn), std::sin(turn), 0};
            const Vec3 across{-std::sin(turn), std::cos(turn), 0};
            const Vec3 along = Vec3{0, 0, 1} - out * g;
            const Vec3 d = along + across * tiny() + out * tiny();
            const Vec3 through =
                out * ((1 + ratio) / 2) + along * any(random) + across * any(random) + out * tiny();
            const Vec3 o = through - d * (dot(d, through) / dot(d, d));
            const auto spans = spans_of(k, o, d);
            if (spans.degenerate()) continue;
            for (int m = 0; m <= 20; ++m) {
                const double s = 0.95 * (m / 10.0 - 1);
                using Real = long double;
                const Real z = o.z + Real{s} * d.z;
                if (std::fabs(z) > 0.999L) continue;
                const Real x = o.x + Real{s} * d.x;
                const Real y = o.y + Real{s} * d.y;
                const Real off = std::sqrt(x * x + y * y) - (Real{1} + ratio) / 2 + Real{g} * z;
                // By more than the line's own error, and not where an end is near.
                if (std::fabs(off) < 1e-14L) continue;
                bool is_in = false;
                bool is_unclear = spans.touched();
                for (std::size_t n = 0; n < spans.size(); ++n) {
                    is_in = is_in || (s > spans[n].enter.s && s < spans[n].exit.s);
                    is_unclear = is_unclear ||
                                 std::fabs(s - spans[n].enter.s) <= spans[n].enter.error ||
                                 std::fabs(s - spans[n].exit.s) <= spans[n].exit.error;
                }
                if (!is_unclear) CHECK(is_in == (off < 0));
            }
        }
    }
}

TEST_CASE("cone: wider at the top is the same cone turned over, with its faces' names") {
    const auto up = Cone::prepare(std::vector<Argument>{2.0, 4.0, 6.0, false});
    REQUIRE(up.has_value());
    CHECK(up->kernel.ratio() == 0.5);
    // The wide end is at z = 6.
    CHECK(up->to_object({0, 0, -1}) == Vec3{0, 0, 6});
    CHECK(up->kernel.faces()[1] == "top");
    CHECK(up->kernel.bounds(up->to_object) == Aabb{{-4, -4, 0}, {4, 4, 6}});
}

TEST_CASE("torus: through the ring there are two spans, through the hole none") {
    const Torus::Kernel k(0.75, 0.25);
    const auto through = spans_of(k, {0, 0, 0}, {1, 0, 0});
    REQUIRE(through.size() == 2);
    CHECK(through[0].enter.s == doctest::Approx(-1.0));
    CHECK(through[0].exit.s == doctest::Approx(-0.5));
    CHECK(through[1].enter.s == doctest::Approx(0.5));
    CHECK(through[1].exit.s == doctest::Approx(1.0));
    CHECK(spans_of(k, {0, 0, 0}, {0, 0, 1}).size() == 0);
    CHECK(spans_of(k, {0.25, 0, 0}, {0, 0, 1}).size() == 0);
}

TEST_CASE("torus: a spindle is filled") {
    const Torus::Kernel k(0.25, 0.75);
    const auto axis = spans_of(k, {0, 0, 0}, {0, 0, 1});
    REQUIRE(axis.size() == 1);
    const double pole = std::sqrt(0.75 * 0.75 - 0.25 * 0.25);
    CHECK(axis[0].enter.s == doctest::Approx(-pole));
    CHECK(axis[0].exit.s == doctest::Approx(pole));
    // Over the dimple around the pole: in, out and in again.
    CHECK(spans_of(k, {0, 0, 0.73}, {1, 0, 0}).size() == 2);
    CHECK(k.where({0, 0, 0}, {}) == Where::in);
}

TEST_CASE("torus: along the circle in the middle of the tube") {
    // There the extrema of the equation meet in one place.
    for (const Vec3 d : {Vec3{0, 1, 0}, Vec3{0, -3, 0}, Vec3{0, 1, 1e-9}}) {
        const auto spans = spans_of(Torus::Kernel(0.75, 0.25), {0.75, 0, 0}, d);
        REQUIRE(spans.size() == 1);
        CHECK(spans[0].exit.s * norm(d) == doctest::Approx(std::sqrt(0.4375)));
        CHECK(spans[0].exit.error * norm(d) < 0x1p-45);
    }
}

TEST_CASE("torus: a gap opens where a line comes nearer to the axis than the hole") {
    const Torus::Kernel k(0.75, 0.25);
    const auto past = spans_of(k, {0, 0.501, 0}, {1, 0, 0});
    REQUIRE(past.size() == 1);
    CHECK(past[0].exit.s == doctest::Approx(std::sqrt(1.0 - 0.501 * 0.501)));
    const auto across = spans_of(k, {0, 0.499, 0}, {1, 0, 0});
    REQUIRE(across.size() == 2);
    CHECK(across[0].exit.s == doctest::Approx(-std::sqrt(0.25 - 0.499 * 0.499)));
    CHECK(across[1].enter.s == doctest::Approx(std::sqrt(0.25 - 0.499 * 0.499)));
}

TEST_CASE("torus: a thin ring touched from above by a line that hardly descends") {
    // Which of the two places it touches lies deeper is less than what |o.d| leaves.
    const Torus::Kernel k(0.99999900000100006, 9.9999900000100006e-07);
    const Vec3 d{309557.83582966664, 80116.981442718883, 6.5473518190018279e-06};
    SpanList spans;
    k.spans({0.25055503106318622, -0.96810029254046082, 9.9999900000100091e-07, d.x, d.y, d.z,
             6.79e-16, 2.38e-16, 2.99e-16, dot(d, d), kFromTheBeginning},
            spans);
    REQUIRE(spans.size() == 1);
    CHECK(spans[0].enter.s == doctest::Approx(-4.4232972726739e-09).epsilon(1e-6));
    CHECK(spans[0].exit.s == doctest::Approx(-4.4222329113949e-09).epsilon(1e-6));
}

TEST_CASE("halfspace: spans reach to infinity") {
    const Halfspace::Kernel k;
    const auto down = spans_of(k, {0, 0, -5}, {1, 0, 0});
    REQUIRE(down.size() == 1);
    CHECK(std::isinf(down[0].enter.s));
    CHECK(std::isinf(down[0].exit.s));
    CHECK(spans_of(k, {0, 0, 5}, {1, 0, 0}).size() == 0);
    const auto into = spans_of(k, {0, 0, 0}, {0, 0, -2});
    REQUIRE(into.size() == 1);
    CHECK(into[0].enter.s == 0.0);
    CHECK(std::isinf(into[0].exit.s));
    CHECK(spans_of(k, {0, 0, 0}, {1, 1, 0}).degenerate());
}

TEST_CASE("halfspace: normals along an axis are placed exactly") {
    const auto placed = Halfspace::prepare(std::vector<Argument>{Vec3{0, -2, 0}, 3.0});
    REQUIRE(placed.has_value());
    CHECK(placed->to_object.offset == Vec3{0, -1.5, 0});
    CHECK(placed->kernel.bounds(placed->to_object).lo.y == -1.5);
    CHECK(std::isinf(placed->kernel.bounds(placed->to_object).hi.y));
    CHECK(std::isinf(placed->kernel.bounds(placed->to_object).lo.x));
}

TEST_CASE("quadric: kinds and their boxes") {
    const auto box = [](Matrix4 m) {
        const auto placed = Quadric::prepare(std::vector<Argument>{m});
        REQUIRE(placed.has_value());
        return placed->kernel.bounds(placed->to_object);
    };
    const Aabb ellipsoid = box({1, 0, 0, 0, 0, 4, 0, 0, 0, 0, 9, 0, 0, 0, 0, -36});
    CHECK(ellipsoid.hi.x == doctest::Approx(6));
    CHECK(ellipsoid.hi.y == doctest::Approx(3));
    CHECK(ellipsoid.lo.z == doctest::Approx(-2));
    // (x - 10)^2 + y^2 <= 4, any z.
    const Aabb cylinder = box({1, 0, 0, -10, 0, 1, 0, 0, 0, 0, 0, 0, -10, 0, 0, 96});
    CHECK(cylinder.lo.x == doctest::Approx(8));
    CHECK(cylinder.hi.x == doctest::Approx(12));
    CHECK(std::isinf(cylinder.hi.z));
    // x^2 + y^2 <= 4 z - 5.
    const Aabb paraboloid = box({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, -2, 0, 0, -2, 5});
    CHECK(paraboloid.lo.z == doctest::Approx(1.25));
    CHECK(std::isinf(paraboloid.hi.z));
    CHECK(std::isinf(paraboloid.lo.x));
    // The whole space but a ball.
    CHECK_FALSE(box({-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 9}).bounded());
    // Everything.
    CHECK_FALSE(box({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1}).bounded());
}

TEST_CASE("quadric: hyperboloid of two sheets has two spans, its complement one gap") {
    const auto sheets = Quadric::prepare(
        std::vector<Argument>{Matrix4{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1}});
    REQUIRE(sheets.has_value());
    const auto spans = spans_of(sheets->kernel, {0, 0, 0}, {0, 0, 1});
    REQUIRE(spans.size() == 2);
    CHECK(spans[0].exit.s == -1.0);
    CHECK(spans[1].enter.s == 1.0);
    CHECK(std::isinf(spans[1].exit.s));
}

TEST_CASE("quadric: what has no inside is refused, whatever its units") {
    for (const double unit : {1e-9, 1.0, 1e9}) {
        const double one = unit * unit;
        CAPTURE(unit);
        // all zero, x^2 + 1, a plane counted twice, a line, a point
        CHECK(refusal<Quadric>({Matrix4{}}).code == ErrorCode::bad_argument);
        CHECK(refusal<Quadric>({Matrix4{1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, one}})
                  .argument == 0);
        CHECK(refusal<Quadric>({Matrix4{1, 1, 1, -unit, 1, 1, 1, -unit, 1, 1, 1, -unit, -unit,
                                        -unit, -unit, one}})
                  .argument == 0);
        CHECK(
            refusal<Quadric>({Matrix4{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}}).argument ==
            0);
        CHECK(refusal<Quadric>({Matrix4{1, 0, 0, -unit, 0, 1, 0, 0, 0, 0, 1, 0, -unit, 0, 0, one}})
                  .argument == 0);
        // A ball of radius `unit` is fine.
        CHECK(Quadric::prepare(
                  std::vector<Argument>{Matrix4{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -one}})
                  .has_value());
    }
    const Error skewed =
        refusal<Quadric>({Matrix4{1, 2, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1}});
    CHECK(skewed.message == "quadric: matrix must be symmetric");
    CHECK(skewed.hint == "make row 2, column 1 equal to row 1, column 2");
}

TEST_CASE("sizes that are no sizes are refused with the argument and its value") {
    const Error zero = refusal<Block>({Vec3{1, 0, 1}, false});
    CHECK(zero.code == ErrorCode::out_of_range);
    CHECK(zero.argument == 0);
    CHECK(zero.label == "this is 0");
    CHECK(refusal<Cylinder>({-1.0, 2.0, false}).message ==
          "cylinder: radius must be greater than 0");
    CHECK(refusal<Cylinder>({1.0, std::nan(""), false}).argument == 1);
    CHECK(refusal<Cone>({1.0, -0.5, 1.0, false}).message == "cone: top radius must be at least 0");
    CHECK(refusal<Cone>({0.0, 0.0, 1.0, false}).message ==
          "cone: one of its radii must be greater than 0");
    CHECK(refusal<Torus>({1.0, 0.0}).argument == 1);
    CHECK(refusal<Torus>({1.0, 1e-320}).argument == 1);
    CHECK(refusal<Sphere>({std::numeric_limits<double>::infinity()}).label == "this is inf");
    CHECK(refusal<Halfspace>({Vec3{}, 1.0}).argument == 0);
    CHECK(refusal<Halfspace>({Vec3{1e-300, 0, 0}, 1e300}).argument == 1);
}

}  // namespace
}  // namespace raymo::solids
