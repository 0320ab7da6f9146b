// Sweeps whose spans, normals and volumes are known in closed form, and what is refused.
#include "raymo/solids/sweep/sweep.hpp"

#include <doctest/doctest.h>

#include <numbers>
#include <random>

#include "raymo/solids/inventory.hpp"
#include "raymo/solids/sweep/test_paths.hpp"

namespace raymo::solids {
namespace {

using namespace test;
using curves::Path;

constexpr double kPi = std::numbers::pi;

doctest::Approx near(double x) { return doctest::Approx(x).epsilon(1e-12); }

/// Volume of what a ball of radius a keeps beyond the plane at height -q a.
double cap(double a, double q) { return kPi * a * a * a * (2.0 / 3.0 + q - q * q * q / 3.0); }

Path capsule() { return {{straight({{0, 0, 0}, 1}, {{0, 0, 4}, 1})}, false}; }

TEST_CASE("sweep: a capsule is met at its side and through its caps") {
    const Asked sweep(capsule());
    const auto across = sweep.spans({-5, 0, 2}, {1, 0, 0});
    REQUIRE(across.size() == 1);
    CHECK(across[0].enter.s == near(4));
    CHECK(across[0].exit.s == near(6));
    CHECK(sweep.normal({-1, 0, 2}, across[0].enter.face).x == near(-1));
    CHECK(sweep.normal({1, 0, 2}, across[0].exit.face).x == near(1));
    const auto beside = sweep.spans({-5, 0.6, 2}, {1, 0, 0});
    REQUIRE(beside.size() == 1);
    CHECK(beside[0].enter.s == near(4.2));
    CHECK(beside[0].exit.s == near(5.8));
    const auto along = sweep.spans({0, 0, -5}, {0, 0, 1});
    REQUIRE(along.size() == 1);
    CHECK(along[0].enter.s == near(4));
    CHECK(along[0].exit.s == near(10));
    CHECK(sweep.kernel().faces()[along[0].enter.face] == "start");
    CHECK(sweep.kernel().faces()[along[0].exit.face] == "end");
    CHECK(sweep.normal({0, 0, -1}, 1).z == near(-1));
    CHECK(sweep.normal({0, 0, 5}, 2).z == near(1));
    CHECK(sweep.volume({1, 0, 0}, 400) == doctest::Approx(16 * kPi / 3).epsilon(1e-3));
    CHECK(sweep.volume(unit({1, 2, 3}), 400) == doctest::Approx(16 * kPi / 3).epsilon(1e-3));
}

TEST_CASE("sweep: a cone between two balls of different size") {
    const Asked sweep(Path{{straight({{0, 0, 0}, 2}, {{0, 0, 3}, 1})}, false});
    const auto spans = sweep.spans({-5, 0, 1.5}, {1, 0, 0});
    REQUIRE(spans.size() == 1);
    const double half = (2.0 - 0.5) / std::sqrt(1.0 - 1.0 / 9.0);
    CHECK(spans[0].enter.s == near(5 - half));
    CHECK(spans[0].exit.s == near(5 + half));
    // The normal leans by the cone's angle.
    CHECK(sweep.normal({half, 0, 1.5}, 0).z == near(1.0 / 3.0));
    const double s = 1.0 / 3.0;
    const double frustum = kPi * 3.0 * (1 - s * s) * (1 - s * s) * 7.0 / 3.0;
    CHECK(sweep.volume({0, 1, 0}, 400) ==
          doctest::Approx(frustum + cap(2, s) + cap(1, -s)).epsilon(1e-3));
}

TEST_CASE("sweep: of balls that hold each other only the largest is left") {
    const Asked sweep(Path{{straight({{0, 0, 0}, 1}, {{0, 0, 1}, 3})}, false});
    for (const Vec3 d : {Vec3{1, 0, 0}, Vec3{0, 0, 1}, unit({1, 1, 1})}) {
        const auto spans = sweep.spans({0, 0, 1}, d);
        REQUIRE(spans.size() == 1);
        CHECK(spans[0].enter.s == near(-3));
        CHECK(spans[0].exit.s == near(3));
    }
    CHECK(sweep.volume({0, 0, 1}, 400) == doctest::Approx(36 * kPi).epsilon(1e-3));
}

TEST_CASE("sweep: a parabola, thin and thick") {
    const auto parabola = [](double a) {
        // (2 u - 1, (2 u - 1)^2, 0)
        return Path{{of_powers({{{-1, 1, 0}, a}, {{2, -4, 0}, 0}, {{0, 4, 0}, 0}, {{}, 0}})},
                    false};
    };
    const auto thin = Asked(parabola(0.25)).spans({0, 0.1, 5}, {0, 0, -1});
    REQUIRE(thin.size() == 1);
    CHECK(0.5 * (thin[0].exit.s - thin[0].enter.s) == near(std::sqrt(0.0625 - 0.01)));
    // Two balls are nearest, and the one between them is not.
    const auto thick = Asked(parabola(0.8)).spans({0, 0.75, 5}, {0, 0, -1});
    REQUIRE(thick.size() == 1);
    CHECK(0.5 * (thick[0].exit.s - thick[0].enter.s) == near(std::sqrt(0.64 - 0.5)));
}

TEST_CASE("sweep: a thin tube is met along its way, nearly tangent to it") {
    curves::Path path;
    path.spans.push_back(bezier(
        {{0.458813838502121, 0.5982450430389743, -0.32294701883082455}, 7.238256780441938e-05},
        {{-0.3884029701608187, 0.05295040837129772, 0.7305386203393447}, 0.00012560047722121032},
        {{-0.5871820238332148, -0.9840107082043204, -0.997515700904904}, 8.46642065763567e-05},
        {{0.6861567600481921, -0.5271417748949789, 0.039641876380597685}, 0.00011020711254274813}));
    const Asked tube(path);
    const Vec3 within{-0.047476210014878936, 0.12038073768250201, 0.032297398498792734};
    REQUIRE(tube.where(within) == Where::in);
    const Vec3 along{-0.5717119623574586, -0.8204531663086503, -0.0014261807367980806};
    const auto first = tube.spans(within, along);
    REQUIRE(first.size() == 1);
    CHECK(first[0].enter.s == doctest::Approx(-0.014425275531723).epsilon(1e-9));
    CHECK(first[0].exit.s == doctest::Approx(0.014295185808923).epsilon(1e-9));
    // Tilted, and along other thin tubes: a point of the middle line is within the tube.
    std::mt19937_64 random(31);
    const auto number = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
    int lost = 0;
    const auto ask = [&](const Asked& asked, Vec3 p, Vec3 way) {
        bool is_held = false;
        for (const Span& span : asked.spans(p, way))
            is_held = is_held || (span.enter.s < 0.0 && span.exit.s > 0.0);
        if (!is_held) ++lost;
    };
    for (int i = 0; i < 3000; ++i) {
        const double tilt = std::pow(10.0, -2.0 - 0.75 * (1.0 + number()));
        ask(tube, within, unit(along + Vec3{number(), number(), number()} * tilt));
    }
    CHECK(lost == 0);
    for (int k = 0; k < 200; ++k) {
        const double thick = std::pow(10.0, -4.3 + 0.7 * number());
        const auto ball = [&] {
            return Ball{{number(), number(), number()}, thick * (1.0 + 0.3 * number())};
        };
        curves::Path other;
        other.spans.push_back(bezier(ball(), ball(), ball(), ball()));
        const curves::PathSpan& s = other.spans.front();
        const Asked asked(other);
        for (int i = 0; i < 100; ++i) {
            const double u = 0.5 + 0.45 * number();
            const auto at = [&](const std::array<double, 4>& c) { return curves::value_at(c, u); };
            const auto slope = [&](const std::array<double, 4>& c) {
                return curves::value_at(curves::derivative(c), u);
            };
            const Vec3 p{at(s.x), at(s.y), at(s.z)};
            const Vec3 d{slope(s.x), slope(s.y), slope(s.z)};
            if (asked.where(p) != Where::in) continue;  // thinner than rounding
            const double tilt = std::pow(10.0, -3.0 + number());
            ask(asked, p, unit(unit(d) + Vec3{number(), number(), number()} * tilt));
        }
    }
    CHECK(lost == 0);
}

TEST_CASE("sweep: volumes of curved tubes") {
    const double length = std::sqrt(2.0) + std::asinh(1.0);
    const Asked parabola(
        Path{{of_powers({{{-1, 0.5, 0}, 0.5}, {{2, -2, 0}, 0}, {{0, 2, 0}, 0}, {{}, 0}})}, false});
    CHECK(parabola.volume({0, 0, 1}, 500) ==
          doctest::Approx(kPi * 0.25 * length + kPi / 6.0).epsilon(2e-3));
    const Asked planar(Path{
        {of_powers({{{}, 0.25}, {{1, 0, 0}, 0}, {{0, 1, 0}, 0}, {{-1.0 / 3.0, 0, 0}, 0}})}, false});
    CHECK(planar.volume({0, 0, 1}, 500) == doctest::Approx(5.0 * kPi / 48.0).epsilon(2e-3));
    const Asked spatial(
        Path{{of_powers({{{}, 1}, {{6, 0, 0}, 0}, {{0, 6, 0}, 0}, {{0, 0, 4}, 0}})}, false});
    CHECK(spatial.volume({0, 0, 1}, 500) == doctest::Approx(34.0 * kPi / 3.0).epsilon(2e-3));
    const Asked growing(
        Path{{of_powers({{{}, 1}, {{6, 0, 0}, 0.5}, {{0, 6, 0}, 0}, {{0, 0, 4}, 0}})}, false});
    CHECK(growing.volume({0, 0, 1}, 500) == doctest::Approx(63.013899).epsilon(2e-3));
}

TEST_CASE("sweep: a path that stands still at its ends is swept like any other") {
    const Asked still(
        Path{{of_powers({{{}, 1}, {{}, 0}, {{0, 0, 12}, 0}, {{0, 0, -8}, 0}})}, false});
    const Asked plain(capsule());
    for (const auto& [o, d] : {std::pair{Vec3{-5, 0, 2}, Vec3{1, 0, 0}},
                               {Vec3{-5, 0.6, 2}, Vec3{1, 0, 0}},
                               {Vec3{0, 0, -5}, Vec3{0, 0, 1}},
                               {Vec3{0.3, 0, -5}, Vec3{0, 0, 1}},
                               {Vec3{-4, 0.2, -1}, Vec3{1, 0.1, 0.9}}}) {
        const auto a = still.spans(o, d);
        const auto b = plain.spans(o, d);
        REQUIRE(a.size() == 1);
        REQUIRE(b.size() == 1);
        CHECK(a[0].enter.s == near(b[0].enter.s));
        CHECK(a[0].exit.s == near(b[0].exit.s));
    }
}

TEST_CASE("sweep: where the path crosses itself there is one span") {
    // (q^2 - 1, q (q^2 - 1), 0) with q = 3 u - 1.5
    const Asked loop(Path{
        {of_powers(
            {{{1.25, -1.875, 0}, 0.1}, {{-9, 17.25, 0}, 0}, {{9, -40.5, 0}, 0}, {{0, 27, 0}, 0}})},
        false});
    const auto spans = loop.spans({0, 0, 3}, {0, 0, -1});
    REQUIRE(spans.size() == 1);
    CHECK(spans[0].enter.s == near(2.9));
    CHECK(spans[0].exit.s == near(3.1));
    // Across both branches, away from the crossing.
    CHECK(loop.spans({0.6, -3, 0}, {0, 1, 0}).size() == 2);
    CHECK(loop.spans({-0.5, -3, 0}, {0, 1, 0}).size() == 2);
}

TEST_CASE("sweep: a ring has no ends") {
    std::vector<Ball> points;
    for (int i = 0; i < 6; ++i)
        points.push_back({{3 * std::cos(i * kPi / 3), 3 * std::sin(i * kPi / 3), 0}, 0.5});
    const Asked ring(b_spline(points, true));
    CHECK(ring.kernel().faces().size() == 1);
    CHECK(ring.spans({0, 0, 5}, {0, 0, -1}).empty());
    for (int i = 0; i < 360; ++i) {
        const double angle = i * kPi / 180.0;
        const auto spans = ring.spans({0, 0, 0}, {std::cos(angle), std::sin(angle), 0});
        REQUIRE(spans.size() == 2);
        // Half of the wire's width is on either side of the path, which keeps to the ring between its corners.
        CHECK(spans[1].exit.s - spans[1].enter.s == doctest::Approx(1.0).epsilon(0.01));
        CHECK(spans[1].enter.s == doctest::Approx(-spans[0].exit.s).epsilon(1e-9));
    }
}

TEST_CASE("sweep: flat caps stand where the envelope meets the end's ball") {
    const Asked rod(Path{{straight({{0, 0, 0}, 1}, {{0, 0, 4}, 1})}, false}, true);
    const auto along = rod.spans({0.5, 0, -5}, {0, 0, 1});
    REQUIRE(along.size() == 1);
    CHECK(along[0].enter.s == near(5));
    CHECK(along[0].exit.s == near(9));
    CHECK(rod.kernel().faces()[along[0].enter.face] == "start");
    CHECK(rod.normal({0.5, 0, 0}, 1).z == -1.0);
    CHECK(rod.normal({0.5, 0, 4}, 2).z == 1.0);
    CHECK(rod.volume(unit({1, 2, 3}), 400) == doctest::Approx(4 * kPi).epsilon(2e-3));
    const Aabb box = rod.kernel().bounds(scaling({rod.unit(), rod.unit(), rod.unit()}));
    CHECK(box.hi.z == near(2));
    CHECK(box.lo.z == near(-2));
    // A frustum: with radii that shrink by s the circles stand s a ahead of the centres.
    const Asked cone(Path{{straight({{0, 0, 0}, 2}, {{0, 0, 3}, 1})}, false}, true);
    const double s = 1.0 / 3.0;
    CHECK(cone.volume(unit({1, 2, 3}), 400) ==
          doctest::Approx(kPi * 3 * (1 - s * s) * (1 - s * s) * 7.0 / 3.0).epsilon(2e-3));
    // The plane of one leg's end does not cut the other leg.
    const Asked arch(
        Path{{bezier({{0, 0, 0}, 0.5}, {{0, 0, 4}, 0.5}, {{3, 0, 4}, 0.5}, {{3, 0, -2}, 0.5})},
             false},
        true);
    CHECK(arch.spans({3, -5, -1}, {0, 1, 0}).size() == 1);
    CHECK(arch.spans({0, -5, -0.1}, {0, 1, 0}).empty());
    CHECK(arch.spans({0, -5, 0.1}, {0, 1, 0}).size() == 1);
}

TEST_CASE("sweep: what has no part of the path with a radius is nothing there") {
    const Asked wire(
        Path{{straight({{0, 0, 0}, 0}, {{4, 0, 0}, 0}), straight({{4, 0, 0}, 0}, {{8, 0, 0}, 2})},
             false});
    CHECK(wire.spans({2, 0, 5}, {0, 0, -1}).empty());
    CHECK(wire.spans({2, 0, 5}, {0.001, 0, -1}).empty());
    CHECK(wire.spans({8, 0, 5}, {0, 0, -1}).size() == 1);
    CHECK(wire.where({2, 0, 0}) != Where::in);
    CHECK(wire.where({8, 0, 1}) == Where::in);
    CHECK(wire.where({8, 0, 2.1}) == Where::out);
    // A point is a ball.
    const Asked ball(Path{{straight({{1, 2, 3}, 2}, {{1, 2, 3}, 2})}, false});
    const auto spans = ball.spans({1, 2, 3}, {0, 3, 4});
    REQUIRE(spans.size() == 1);
    CHECK(spans[0].exit.s == near(0.4));
}

TEST_CASE("sweep: kernels of equal paths are equal, and share what they hold") {
    const Asked a(capsule());
    const Asked b(capsule());
    const Sweep::Kernel copy = a.kernel();
    CHECK(a.kernel() == b.kernel());
    CHECK(&copy.spheres() == &a.kernel().spheres());
    CHECK_FALSE(a.kernel() == Asked(capsule(), true).kernel());
}

TEST_CASE("sweep: paths that cannot be swept are refused") {
    const auto refusal = [](Path path, bool flat = false) {
        for (const Entry& entry : inventory()) {
            if (entry.schema != &Sweep::schema()) continue;
            auto made = entry.make(arguments(std::move(path), flat));
            REQUIRE_FALSE(made.has_value());
            return made.error();
        }
        return Error{};
    };
    const double inf = std::numeric_limits<double>::infinity();
    CHECK(refusal({}).message == "sweep: its path has no spans");
    CHECK(refusal({{straight({{0, 0, 0}, 0}, {{1, 0, 0}, 0})}, false}).code ==
          ErrorCode::out_of_range);
    CHECK(refusal({{straight({{0, 0, 0}, 1}, {{1, 0, 0}, -1})}, false}).message ==
          "sweep: the radius must be at least 0 everywhere");
    // Its ends are positive, but not the middle.
    CHECK(
        refusal({{bezier({{0, 0, 0}, 1}, {{1, 0, 0}, -2}, {{2, 0, 0}, -2}, {{3, 0, 0}, 1})}, false})
            .argument == 0);
    CHECK(
        refusal({{bezier({{0, 0, 0}, 1}, {{inf, 0, 0}, 1}, {{2, 0, 0}, 1}, {{3, 0, 0}, 1})}, false})
            .argument == 0);
    CHECK(refusal({{straight({{0, 0, 0}, 1}, {{1, std::nan(""), 0}, 1})}, false}).argument == 0);
    CHECK(refusal({{straight({{-1e308, 0, 0}, 1}, {{1e308, 0, 0}, 1})}, false}).argument == 0);
    CHECK(refusal({{straight({{0, 0, 0}, 1e300}, {{1, 0, 0}, 1})}, false}).message ==
          "sweep: its path is too large or too small to be computed with");
    CHECK(refusal({{straight({{0, 0, 0}, 1e-300}, {{1e-300, 0, 0}, 0})}, false}).label ==
          "this path is too small");
    const Error grows = refusal({{straight({{0, 0, 0}, 1}, {{1, 0, 0}, 3})}, false}, true);
    CHECK(
        grows.message ==
        "sweep: its start cannot be flat, for the radius changes there as fast as the path moves");
    CHECK(grows.argument == 1);
    CHECK(refusal({{straight({{0, 0, 0}, 1}, {{0, 0, 0}, 1})}, false}, true).argument == 1);
}

}  // namespace
}  // namespace raymo::solids
