#include "raymo/query/locate.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "raymo/query/test_solids.hpp"

namespace raymo::query {
namespace {

using namespace test;

TEST_CASE("locate: a ball knows its inside, its surface and its outside") {
    Locator ball(sphere(2.0));
    CHECK(ball.where({0, 0, 0}) == Where::in);
    CHECK(ball.where({1.999999999, 0, 0}) == Where::in);
    CHECK(ball.where({2, 0, 0}) == Where::on);
    CHECK(ball.where({2.000000001, 0, 0}) == Where::out);
    CHECK(ball.where({1e300, -1e300, 0}) == Where::out);
}

TEST_CASE("locate: abutting blocks are one solid") {
    Locator two(block(1, 1, 1) + move(block(1, 1, 1), {1, 0, 0}));
    CHECK(two.where({1, 0.5, 0.5}) == Where::in);  // on the shared face
    CHECK(two.where({1, 0, 0.5}) == Where::on);    // at the face's edge
    CHECK(two.where({1, 1, 1}) == Where::on);      // at its corner
    CHECK(two.where({2, 0.5, 0.5}) == Where::on);
    CHECK(two.where({0, 0, 0}) == Where::on);
    CHECK(two.where({2.1, 0.5, 0.5}) == Where::out);
}

TEST_CASE("locate: a thirds' step abuts as a whole one does") {
    const csg::Solid b =
        move(move(move(block(1, 1, 1), {1.0 / 3, 0, 0}), {1.0 / 3, 0, 0}), {1.0 / 3, 0, 0});
    Locator two(block(1, 1, 1) + b);
    CHECK(two.where({1, 0.25, 0.75}) == Where::in);
}

TEST_CASE("locate: two halves make a whole on their common plane, far from its origin too") {
    const csg::Solid half = halfspace({1, 2, 2}, 3);
    const csg::Solid block = move(test::block(4000, 4000, 4000), {-2000, -2000, -2000});
    Locator halves((block & half) + (block - half));
    Locator one(block & half);
    for (const Vec3 p :
         {Vec3{1, 1, 0}, Vec3{1001, -999, 500}, Vec3{-1999, 1001, 0}, Vec3{3, -1500, 1500}}) {
        CHECK(halves.where(p) == Where::in);
        CHECK(one.where(p) == Where::on);
    }
}

TEST_CASE("locate: a common plane is none, whatever it was written in") {
    const csg::Solid block = move(test::block(8, 8, 8), {-4, -4, -4});
    const auto scaled = [](const csg::Solid& s, Vec3 by) { return mapped(s, scaling(by)); };
    for (const csg::Solid& half :
         {scaled(halfspace({1, 2, 2}, 3e11), {1e-11, 1e-11, 1e-11}), halfspace({1, 2, 2}, 3),
          move(halfspace({1, 2, 2}, 0), {1e12 + 1, -5e11 + 1, 0}),
          scaled(halfspace({1, 2, 2}, 3e-11), {1e11, 1e11, 1e11})}) {
        Locator halves((block & half) + (block - half));
        CHECK(halves.where({1, 1, 0}) == Where::in);
        CHECK(halves.where({3, -3, 1.5}) == Where::in);
    }
    const csg::Solid flat = scaled(halfspace({0, 0, 1}, 0), {1, 1, 1e13});
    CHECK(Locator((block & flat) + (block - flat)).where({1, 1, 0}) == Where::in);
}

TEST_CASE("locate: a solid without itself is nothing, with itself the same") {
    const csg::Solid s = move(sphere(1.0), {0.1, 0.2, 0.3});
    Locator none(s - s);
    Locator both(s + s);
    for (const Vec3 p : {Vec3{0.1, 0.2, 0.3}, Vec3{1.1, 0.2, 0.3}, Vec3{0.1, 0.2, 1.3}}) {
        CHECK(none.where(p) == Where::out);
    }
    CHECK(both.where({1.1, 0.2, 0.3}) == Where::on);
    CHECK(both.where({0.1, 0.2, 0.3}) == Where::in);
}

TEST_CASE("locate: a plug in its bore leaves no seam") {
    const csg::Solid bore = cylinder(1, 4);
    Locator plate((move(block(6, 6, 2), {-3, -3, 1}) - bore) +
                  (cylinder(1, 3) & move(block(6, 6, 2), {-3, -3, 1})));
    CHECK(plate.where({1, 0, 1.5}) == Where::in);
    CHECK(plate.where({0.6, 0.8, 2}) == Where::in);
    CHECK(plate.where({0, 0, 3}) == Where::on);
    CHECK(plate.where({1, 0, 3}) == Where::on);
}

TEST_CASE("locate: a needle's point is on it, and so is that of two needles") {
    const csg::Solid needle = cone(0.01, 0, 10);
    CHECK(Locator(needle).where({0, 0, 10}) == Where::on);
    const csg::Solid other = move(mirror(needle, {0, 0, 1}), {0, 0, 20});
    Locator both(needle + other);
    CHECK(both.where({0, 0, 10}) == Where::on);
    CHECK(both.where({0.001, 0, 10}) == Where::out);
}

TEST_CASE("locate: two balls that touch keep their surface at the point") {
    Locator pair(sphere(1.0) + move(sphere(1.0), {2, 0, 0}));
    CHECK(pair.where({1, 0, 0}) == Where::on);
    CHECK(pair.where({1, 0.01, 0}) == Where::out);
}

TEST_CASE("locate: a face cut away and covered again") {
    const csg::Solid a = block(2, 2, 2);
    const csg::Solid cut = move(block(2, 2, 2), {0, 0, 1});
    Locator cut_only(a - cut);
    CHECK(cut_only.where({1, 1, 1}) == Where::on);
    CHECK(cut_only.where({1, 1, 1.5}) == Where::out);
    CHECK(cut_only.where({1, 1, 2}) == Where::out);  // the old top is gone
    Locator covered((a - cut) + cut);
    CHECK(covered.where({1, 1, 1}) == Where::in);
    CHECK(covered.where({1, 1, 3}) == Where::on);
}

TEST_CASE("locate: unions and differences with many operands answer as few do") {
    std::vector<csg::Solid> balls;
    for (int i = 0; i < 10; ++i) {
        for (int j = 0; j < 10; ++j) balls.push_back(move(sphere(0.25), {1.0 * i, 1.0 * j, 0}));
    }
    Locator all(csg::boolean(csg::Op::unite, balls));
    CHECK(all.where({3, 7, 0}) == Where::in);
    CHECK(all.where({3.25, 7, 0}) == Where::on);
    CHECK(all.where({3.5, 7, 0}) == Where::out);
    balls.insert(balls.begin(), move(block(12, 12, 1), {-1, -1, -0.5}));
    Locator plate(csg::boolean(csg::Op::difference, balls));
    CHECK(plate.where({3, 7, 0}) == Where::out);
    CHECK(plate.where({3.25, 7, 0}) == Where::on);
    CHECK(plate.where({3.5, 7, 0}) == Where::in);
    CHECK(plate.where({3.5, 7, 0.5}) == Where::on);
}

TEST_CASE("locate: half-spaces, and a wedge of two") {
    const csg::Solid below = halfspace({0, 0, 1}, 0);
    const csg::Solid left = halfspace({1, 0, 0}, 0);
    Locator wedge(below & left);
    CHECK(wedge.where({-1e6, 3, -5}) == Where::in);
    CHECK(wedge.where({-1, 3, 0}) == Where::on);
    CHECK(wedge.where({0, 3, 0}) == Where::on);
    CHECK(wedge.where({1, 3, -5}) == Where::out);
    Locator all(below + mirror(below, {0, 0, 1}));
    CHECK(all.where({12, 7, 0}) == Where::in);
}

TEST_CASE("locate: a chain of a million moves is followed without recursion") {
    csg::Solid s = sphere(1.0);
    for (int i = 0; i < 1'000'000; ++i) s = move(s, {1, 0, 0});
    Locator far(s);
    CHECK(far.where({1e6, 0, 0}) == Where::in);
    CHECK(far.where({1e6 - 2, 0, 0}) == Where::out);
}

TEST_CASE("locate: an instance of an instance of an instance costs what is near") {
    csg::Solid s = sphere(0.25);
    double pitch = 1.0;
    for (int level = 0; level < 24; ++level) {  // 2^24 balls, 49 nodes
        s = s + move(s, {pitch, 0, 0});
        pitch *= 2.0;
    }
    Locator row(s);
    CHECK(row.where({123456, 0, 0}) == Where::in);
    CHECK(row.where({123456.5, 0, 0}) == Where::out);
    CHECK(row.where({16777215.25, 0, 0}) == Where::on);
}

TEST_CASE("locate: parts are asked one by one or together") {
    scene::Scene scene;
    scene.parts.push_back({"a", block(1, 1, 1), {}});
    scene.parts.push_back({"b", move(block(1, 1, 1), {1, 0, 0}), {}});
    Locator parts(scene);
    CHECK(parts.where(0, {1, 0.5, 0.5}) == Where::on);
    CHECK(parts.where(1, {1, 0.5, 0.5}) == Where::on);
    CHECK(parts.where({1, 0.5, 0.5}) == Where::in);
}

TEST_CASE("locate: a box of points is in, out, or cut by the surface") {
    Locator ball(sphere(1.0));
    CHECK(ball.where_all({0, 0, 0}, {0.5, 0.5, 0.5}) == Where::in);
    CHECK(ball.where_all({3, 0, 0}, {0.5, 0.5, 0.5}) == Where::out);
    CHECK(ball.where_all({1, 0, 0}, {0.5, 0.5, 0.5}) == Where::on);
}

TEST_CASE("locate: work is limited to what is allowed") {
    csg::Solid row = sphere(1);
    for (int i = 0; i < 26; ++i) row = row + move(row, {std::ldexp(3.0, i), 0, 0});
    Locator many(row);
    const Vec3 all{1e9, 1e9, 1e9};
    many.allow(10'000, nullptr);
    CHECK(many.where_all({0, 0, 0}, all) == Where::on);
    CHECK(many.exhausted());
    CHECK(many.where({0, 0, 0}) == Where::on);  // nothing is left to answer with
    many.allow(10'000, nullptr);
    CHECK(many.where({0, 0, 0}) == Where::in);
    CHECK_FALSE(many.exhausted());

    struct Stopped final : Progress {
        [[nodiscard]] bool cancelled() const override { return true; }
    } stopped;
    many.allow(~std::uint64_t{0}, &stopped);
    static_cast<void>(many.where_all({0, 0, 0}, all));
    CHECK(many.exhausted());
}

TEST_CASE("graph: boxes of unions leave out operands that are nothing") {
    const csg::Solid unit_block = block(1, 1, 1);
    const auto apart = [&](double at) {
        return move(unit_block, {at, 0, 0}) & move(unit_block, {at + 50, 0, 0});
    };
    Graph graph;
    const csg::Solid nothing = apart(0) + apart(100);
    const csg::Solid something = (unit_block + apart(100)) + apart(-300);
    const std::uint32_t none = graph.add(nothing);
    CHECK(graph[none].box.empty());
    const std::uint32_t one = graph.add(something);
    CHECK(graph[one].box.hi.x == doctest::Approx(1));
    CHECK(graph[one].box.lo.x == doctest::Approx(0));
}

}  // namespace
}  // namespace raymo::query
