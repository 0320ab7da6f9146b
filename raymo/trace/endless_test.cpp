// Solids that reach to infinity, where a model cuts a piece out of them.
#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "raymo/csg/model.hpp"
#include "raymo/trace/test_ends.hpp"

namespace raymo::trace {
namespace {

using test::check_ends;
using test::ends;
using test::primitive;

csg::Solid within_block(const csg::Solid& endless) {
    const csg::Solid block = primitive("block", {Vec3{8, 8, 8}, true});
    return csg::boolean(csg::Op::intersection, {block, endless});
}

}  // namespace

TEST_CASE("trace: a quadric with its vertex far away is met where the user looks") {
    // A paraboloid of so little slope that it is nearly a cylinder; its vertex lies thousands of units away.
    const csg::Solid saddle =
        primitive("quadric", {solids::Matrix4{-0.25, 0.5, -0.75, 0, 0.5, 0, 0, 0.6, -0.75, 0, 0,
                                              -0.9002, 0, 0.6, -0.9002, -1}});
    check_ends(ends(within_block(saddle), {{-0.5, -2, -10}, {0, 0, 1}}),
               {10 - 2.4625 / 1.0504, 14});
}

TEST_CASE("trace: a line that is nearly a generator ends where the block does") {
    // (x - y)^2 + 2 e z <= 4: such lines stay inside, and where they would leave is not known.
    const auto wall = [](double e) {
        return within_block(primitive(
            "quadric", {solids::Matrix4{1, -1, 0, 0, -1, 1, 0, 0, 0, 0, 0, e, 0, 0, e, -4}}));
    };
    for (const double rise : {1e-3, 1e-6, 1e-8, 1e-10}) {
        check_ends(ends(wall(1e-5), {{-10, -9.5, 0}, {1, 1, rise}}), {6, 13.5});
    }
    for (const double e : {1e-8, 1e-10, 1e-12}) {
        check_ends(ends(wall(e), {{-10, -9.5, -10}, {1, 1, 1}}), {6, 13.5});
        check_ends(ends(wall(e), {{-5, -4.5, -10}, {0.5, 0.5, 1}}), {6, 14});
    }
}

TEST_CASE("trace: a quadric that is next to a cylinder is met as one") {
    for (const double bend : {0.0, 1e-9, 1e-12}) {
        CAPTURE(bend);
        // x^2 + y^2 + bend z^2 - 2e-6 z <= 4
        const csg::Solid pole = within_block(primitive(
            "quadric",
            {solids::Matrix4{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, bend, -1e-6, 0, 0, -1e-6, -4}}));
        check_ends(ends(pole, {{0.5, 0.3, -10}, {0, 0, 1}}), {6, 14});
        const double half = std::sqrt(4 + 2e-6 - 0.09 - bend);
        check_ends(ends(pole, {{-10, 0.3, 1}, {1, 0, 0}}), {10 - half, 10 + half});
    }
}

TEST_CASE("trace: a plane that a ray meets far away at a small angle does not trouble it here") {
    // The crossing lies four thousand lengths of the block away; all of the ray that meets the block is outside.
    const csg::Solid half = primitive(
        "halfspace", {Vec3{0.54424908151325657, 0.49962008841690431, -0.67392336695076949},
                      -0.53119605940995385});
    Affine map;
    map.linear.row = {Vec3{-326519.03626310249, -85161.543824666267, 437186.39723420743},
                      Vec3{333181.02033084375, 421716.70011307835, 42554.130047611172},
                      Vec3{364425.91216565185, -387995.94702835608, 118241.24285620671}};
    map.offset = {929343.60763005703, 1009305.3699705368, 39723.840288136271};
    const csg::Solid piece = csg::transform(within_block(half), map).value();
    check_ends(ends(piece, {{-70258.69568594638, -190430.3545748894, 2661281.1123111886},
                            {3704916.440808069, 7678129.132679497, -3651613.05191077}}),
               {});
}

TEST_CASE("trace: a plane is met alike however far from the model it was written") {
    const csg::Solid block = primitive("block", {Vec3{8, 8, 8}, true});
    for (const double far : {0.0, 30.0, 1e3}) {
        CAPTURE(far);
        // 3 x + 4 z <= 0 about a point of its plane, and about another that is `far` away.
        const csg::Solid half = csg::transform(primitive("halfspace", {Vec3{3, 0, 4}, -10 * far}),
                                               translation({2 * far, 0, far}))
                                    .value();
        const csg::Solid piece = csg::boolean(csg::Op::intersection, {block, half});
        check_ends(ends(piece, {{1, 2, -10}, {0, 0, 1}}), {6, 9.25});
        check_ends(ends(piece, {{-10, 1, 0.5}, {1, 0, 0}}), {6, 10 - 2.0 / 3.0});
    }
}

TEST_CASE("trace: neither the size that a plane was written in nor its distance matters") {
    const auto half = [](Vec3 normal, double offset, const Affine& map) {
        return csg::transform(primitive("halfspace", {normal, offset}), map).value();
    };
    const auto scaled = [](double x, double y, double z) { return scaling({x, y, z}); };
    const Ray down{{-0.5, -2, -10}, {0, 0, 1}};
    for (const double scale : {1e-13, 1e-6, 1e6, 1e13}) {
        CAPTURE(scale);
        check_ends(ends(within_block(half({1, 2, 2}, 0, scaled(scale, scale, scale))), down),
                   {6, 12.25});
        const Affine flat = rotation({1, 0, 0}, 30) * scaled(1, 1, scale);
        check_ends(ends(within_block(half({0, 0, 1}, 0, flat)), down),
                   {6, 10 - 2 / std::sqrt(3.0)});
    }
    check_ends(ends(within_block(half({1, 2, 2}, 0, scaled(1e80, 1e80, 1e80))), down), {6, 12.25});
    check_ends(ends(within_block(half({1, 2, 2}, 1e60, {})), down), {6, 14});
    check_ends(ends(within_block(half({1, 2, 2}, -1e60, {})), down), {});
    // Many of them, so that there is a tree.
    std::vector<csg::Solid> row;
    for (int i = 0; i < 16; ++i) {
        row.push_back(
            csg::transform(within_block(half({1, 2, 2}, 1e60, {})), translation({10.0 * i, 0, 0}))
                .value());
    }
    check_ends(ends(csg::boolean(csg::Op::unite, row), down), {6, 14});
}

}  // namespace raymo::trace
