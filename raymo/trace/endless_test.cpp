// Solids that reach to infinity, where a model cuts a piece out of them.
#include <doctest/doctest.h>

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

}  // namespace raymo::trace
