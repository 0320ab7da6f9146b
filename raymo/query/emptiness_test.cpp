#include "raymo/query/emptiness.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "raymo/query/test_solids.hpp"

namespace raymo::query {
namespace {

using namespace test;

bool empty(const csg::Solid& solid) {
    const Result<bool> answer = is_empty(solid);
    REQUIRE(answer.has_value());
    return *answer;
}

TEST_CASE("is_empty: what is there is there, however small or hidden") {
    CHECK_FALSE(empty(sphere(1)));
    CHECK_FALSE(empty(sphere(1e-6) + move(sphere(1e-6), {1e6, 0, 0})));
    CHECK_FALSE(empty(block(1, 1, 1) - block(1, 1, 0.999999)));
    CHECK_FALSE(empty((sphere(1000) - sphere(1000)) + move(sphere(1e-3), {12, 34, 56})));
    CHECK_FALSE(empty(halfspace({0, 0, 1}, 0)));
    CHECK_FALSE(empty(halfspace({0, 0, 1}, 0) & halfspace({0, 0, -1}, 1e-3)));
}

TEST_CASE("is_empty: nothing is left of a solid without itself") {
    const csg::Solid s = move(sphere(3), {0.1, 0.2, 0.3});
    CHECK(empty(s - s));
    CHECK(empty(s - move(sphere(3), {0.1, 0.2, 0.3})));
    CHECK(empty(block(1, 2, 3) - block(1, 2, 3)));
    CHECK(empty(block(1, 1, 1) - block(2, 2, 2)));
    CHECK(empty(cylinder(1, 2) - cylinder(2, 2)));
}

TEST_CASE("is_empty: solids that only touch share nothing") {
    CHECK(empty(block(1, 1, 1) & move(block(1, 1, 1), {1, 0, 0})));
    CHECK(empty(sphere(1) & move(sphere(1), {2, 0, 0})));
    CHECK(empty(sphere(1) & move(sphere(1), {30, 0, 0})));
    CHECK(empty(halfspace({0, 0, 1}, 0) & halfspace({0, 0, -1}, 0)));
    CHECK(empty(halfspace({0, 0, 1}, 0) & halfspace({0, 0, -1}, -5)));
}

TEST_CASE("is_empty: the intersection of two balls, thin as it may be") {
    CHECK_FALSE(empty(sphere(1) & move(sphere(1), {1.999, 0, 0})));
    CHECK_FALSE(empty(sphere(1) & move(sphere(1), {1.999999, 0, 0})));
}

csg::Solid turned(const csg::Solid& s) {
    return mapped(s, rotation({0, 0, 1}, 30) * rotation({1, 0, 0}, 50));
}

bool scene_empty(const csg::Solid& solid, Progress* progress = nullptr) {
    scene::Scene scene;
    scene.materials.resize(1);  // for paint
    scene.parts.push_back({"a", solid, {}});
    const Result<trace::CompiledScene> compiled = trace::compile(scene, nullptr);
    REQUIRE(compiled.has_value());
    const Result<bool> answer = is_empty(scene, *compiled, progress);
    REQUIRE(answer.has_value());
    return *answer;
}

TEST_CASE("is_empty: one primitive is there, however thin and however turned") {
    const csg::Solid needle = turned(cylinder(1e-5, 100));
    CHECK_FALSE(empty(needle));
    CHECK_FALSE(scene_empty(needle));
    CHECK_FALSE(scene_empty(csg::paint(needle, 0)));
    CHECK_FALSE(scene_empty((sphere(1) - sphere(1)) + needle));
}

TEST_CASE("is_empty: rays run along needles and in sheets that something is taken from") {
    const csg::Solid room = move(block(400, 400, 400), {-200, -200, -200});
    const csg::Solid needle = turned(cylinder(1e-5, 100));
    CHECK_FALSE(scene_empty(needle & room));
    CHECK_FALSE(scene_empty(needle & sphere(1)));
    CHECK_FALSE(scene_empty(needle - sphere(99)));
    CHECK_FALSE(scene_empty(turned(block(100, 100, 1e-5)) - sphere(99)));
    CHECK_FALSE(empty(needle - sphere(99)));
    // Two needles that cross at a point.
    CHECK_FALSE(scene_empty(needle & mapped(needle, rotation({1, 1, 1}, 77))));
    CHECK(scene_empty(needle - room));
    CHECK(scene_empty(needle - needle));
}

/// 2^26 copies of a solid in a row, each step of the doubling as made by `join`.
template <class Join>
csg::Solid doubled(csg::Solid s, Join join) {
    for (int i = 0; i < 26; ++i) s = join(s, move(s, {std::ldexp(3.0, i), 0, 0}));
    return s;
}

TEST_CASE("is_empty: a shared model of 2^26 solids is not walked through") {
    const auto unite = [](const csg::Solid& a, const csg::Solid& b) { return a + b; };
    CHECK_FALSE(scene_empty(doubled(sphere(1), unite)));
    CHECK_FALSE(scene_empty(doubled(sphere(1) - sphere(0.5), unite)));
    // Nothing is left of these, which is not decided; what matters is that there is an answer.
    const csg::Solid gone = doubled(sphere(1) - sphere(1), unite);
    static_cast<void>(scene_empty(gone));
    const csg::Solid many = doubled(sphere(1) - move(sphere(1), {1.9, 0, 0}), unite);
    CHECK_FALSE(scene_empty(many - many));
}

TEST_CASE("is_empty: a user who stops it is heard") {
    struct Stopped final : Progress {
        [[nodiscard]] bool cancelled() const override { return true; }
    } stopped;
    const Result<bool> answer = is_empty(sphere(3) - sphere(3), &stopped);
    if (!answer) CHECK(answer.error().code == ErrorCode::cancelled);
    if (answer) CHECK(*answer);  // proved before anyone could stop it
}

}  // namespace
}  // namespace raymo::query
