#include "raymo/query/emptiness.hpp"

#include <doctest/doctest.h>

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
