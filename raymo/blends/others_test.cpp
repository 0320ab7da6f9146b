// What is known of distances along lines and circles, and what it takes to find the largest radius where faces lie flush, or run
// on close beside the ball.
#include "raymo/blends/others.hpp"

#include <cmath>
#include <cstdio>
#include <random>

#include "raymo/blends/test_blends.hpp"
#include "raymo/curves/build_contour.hpp"

namespace raymo::blends {
namespace {

using namespace test;

csg::Solid prism(double radius, Vec2 centre) {
    auto curve = curves::circle(radius);
    REQUIRE(curve.has_value());
    curves::Outline outline;
    outline.curves.push_back(*std::move(curve));
    return move(
        made("prism", {std::make_shared<const curves::Outline>(std::move(outline)), 8.0, false}),
        {centre.x, centre.y, 0.0});
}

/// One of each kind but the free-form ones, of random size and place.
std::vector<Surface> surfaces(std::mt19937_64& random) {
    const auto number = [&](double a, double b) {
        return std::uniform_real_distribution<double>(a, b)(random);
    };
    std::vector<Surface> out;
    for (const SurfaceKind kind : {SurfaceKind::plane, SurfaceKind::sphere, SurfaceKind::cylinder,
                                   SurfaceKind::cone, SurfaceKind::torus}) {
        Surface s;
        s.kind = kind;
        s.point = {number(-1, 1), number(-1, 1), number(-1, 1)};
        s.axis = unit(Vec3{number(-1, 1), number(-1, 1), number(-1, 1)});
        s.radius = number(0.5, 2);
        s.tube = number(0.1, 0.4);
        s.sine = number(0.1, 0.9);
        s.cosine = std::sqrt(1.0 - s.sine * s.sine);
        out.push_back(s);
    }
    return out;
}

TEST_CASE("others: distances bend no more than the surfaces' parallels") {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    for (int i = 0; i < 2000; ++i) {
        for (const Surface& s : surfaces(random)) {
            const Vec3 p = Vec3{number(random), number(random), number(random)} * 3.0;
            const Vec3 way = unit(Vec3{number(random), number(random), number(random)});
            const double least = s.least_round(p);
            const double h = 1e-3 * std::min(1.0, least);
            if (h < 1e-4) continue;
            const double bend =
                (s.distance(p + way * h) - 2.0 * s.distance(p) + s.distance(p - way * h)) / (h * h);
            CAPTURE(kind_name(s.kind));
            CHECK(std::fabs(bend) <= 1.01 / least + 1e-5);
        }
    }
}

TEST_CASE("others: what runs along with an edge is as far off everywhere") {
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    int along = 0;
    for (int i = 0; i < 400; ++i) {
        for (const Surface& s : surfaces(random)) {
            EdgeCurve edge;
            edge.is_circle = i % 2 == 0;
            // Of every four one that may, and others that do not.
            edge.along = i % 4 < 2 ? s.axis : unit(Vec3{number(random), number(random), 0.5});
            edge.origin = i % 8 < 4 ? s.point + edge.along * number(random)
                                    : Vec3{number(random), number(random), number(random)};
            make_frame(edge.along, edge.across, edge.up);
            const Vec2 section{1.0 + number(random), number(random)};
            const double first = s.distance(edge.place(section, 0.0));
            double most = 0.0;
            for (double t = 0.1; t < 3.0; t += 0.1)
                most = std::max(most, std::fabs(s.distance(edge.place(section, t)) - first));
            CAPTURE(kind_name(s.kind));
            CAPTURE(edge.is_circle);
            CHECK(runs_along(edge, s) == (most < 1e-9));
            along += runs_along(edge, s) ? 1 : 0;
        }
    }
    CHECK(along > 300);
}

TEST_CASE("others: surfaces that are one, and such that are not") {
    std::mt19937_64 random(5);
    for (int i = 0; i < 100; ++i) {
        const auto all = surfaces(random);
        for (const Surface& s : all) {
            for (const Surface& t : all) CHECK(is_one(s, t) == (&s == &t));
            Surface moved = s;
            moved.point = s.point + s.axis;
            CHECK(is_one(s, moved) == (s.kind == SurfaceKind::cylinder));
            Vec3 u;
            Vec3 v;
            make_frame(s.axis, u, v);
            moved.point = s.point + u;
            CHECK(is_one(s, moved) == (s.kind == SurfaceKind::plane));
            Surface wider = s;
            wider.radius *= 1.0 + 1e-6;
            // A plane and a cone have none; only what is used counts.
            if (s.kind != SurfaceKind::plane && s.kind != SurfaceKind::cone)
                CHECK(!is_one(s, wider));
        }
    }
}

/// What the refusal of a radius takes, in units of some 100 ns, and what it tells.
struct Refusal {
    double work = 0.0;
    double told = 0.0;
};
Refusal refusal(const csg::Solid& solid, const Form& form) {
    Refusal out;
    const auto refused = blended_edges(solid, Edges::convex, form, {}, [&](double work) {
        out.work += work;
        return true;
    });
    REQUIRE(!refused.has_value());
    CHECK(refused.error().code == ErrorCode::out_of_range);
    CAPTURE(refused.error().hint);
    std::sscanf(refused.error().hint.c_str(), "the largest radius that works here is %lf",
                &out.told);
    return out;
}

TEST_CASE("others: a radius is refused soon, also where faces lie flush or close beside") {
    // The circles' walls are four faces in one cylinder, and the ends of both prisms lie flush.
    for (const double apart : {0.001, 0.01, 0.1, 0.5, 1.0, 2.0}) {
        for (const double radius : {3.0, 0.5}) {
            const csg::Solid moon =
                csg::boolean(csg::Op::difference, {prism(5.0, {}), prism(5.0, {apart, 0.0})});
            CAPTURE(apart);
            const Refusal refused = refusal(moon, ball(radius));
            CHECK(refused.work < 1e6);
            // Of the thinnest one what works is lost in roundings.
            CHECK((refused.told > 0.0) == (apart > 0.005));
        }
    }
    for (const double apart : {9.9, 9.99}) {
        const csg::Solid lens =
            csg::boolean(csg::Op::intersection, {prism(5.0, {}), prism(5.0, {apart, 0.0})});
        CHECK(refusal(lens, ball(3.0)).work < 1e6);
    }
    for (const double gap : {0.1, 0.001}) {
        const csg::Solid ring =
            csg::boolean(csg::Op::difference, {prism(5.0, {}), prism(5.0 - gap, {})});
        const Refusal refused = refusal(ring, ball(3.0));
        CHECK(refused.work < 1e6);
        CHECK(refused.told == doctest::Approx(0.5 * gap));
        CHECK(blended_edges(ring, Edges::convex, ball(refused.told)).has_value());
        const csg::Solid uneven =
            csg::boolean(csg::Op::difference, {prism(5.0, {}), prism(5.0 - gap, {0.5 * gap, 0.0})});
        CHECK(refusal(uneven, ball(3.0)).work < 1.5e6);
    }
}

TEST_CASE("others: the search for a radius stops when it is told to") {
    const csg::Solid moon =
        csg::boolean(csg::Op::difference, {prism(5.0, {}), prism(5.0, {1.0, 0.0})});
    const double all = refusal(moon, ball(3.0)).work;
    for (const double part : {0.1, 0.5, 0.9, 0.99}) {
        double left = part * all;
        const auto stopped = blended_edges(moon, Edges::convex, ball(3.0), {}, [&](double work) {
            left -= work;
            return left > 0.0;
        });
        REQUIRE(!stopped.has_value());
        CHECK(stopped.error().code == ErrorCode::cancelled);
    }
}

}  // namespace
}  // namespace raymo::blends
