// Paths of balls as cubics: how far these are off, and how many there are.
#include "raymo/blends/path.hpp"

#include "raymo/blends/test_blends.hpp"

namespace raymo::blends {
namespace {

using test::cone;
using test::cylinder;
using test::made;
using test::move;
using test::turn;

csg::Solid steep_cylinder(double radius, double degrees) {
    return turn(made("cylinder", {radius, 60.0, true}), {1, 0, 0}, degrees);
}

/// Follows all closed edges of two solids with a ball; returns the number of cubics of the longest.
std::size_t most_spans(csg::Op op, const std::vector<csg::Solid>& operands, double radius) {
    const auto body = Body::make(op, operands);
    REQUIRE(body.has_value());
    const auto found = find_segments(*body, false, radius);
    REQUIRE(found.has_value());
    std::size_t most = 0;
    for (const Segment& segment : *found) {
        if (!segment.space || !segment.is_closed) continue;
        const Spine spine(*body, segment, radius);
        const auto first = spine.at(segment.lo);
        REQUIRE(first.has_value());
        Station last = *first;
        last.t = segment.hi;
        const double tolerance = 0x1p-30 * radius;
        std::vector<curves::PathSpan> spans;
        REQUIRE(append_path(spine, *first, last, tolerance, radius, spans));
        most = std::max(most, spans.size());
        double off = 0.0;
        for (std::size_t i = 0; i < spans.size(); ++i) {
            Cubic cubic;
            for (std::size_t k = 0; k < 4; ++k)
                cubic[k] = {spans[i].x[k], spans[i].y[k], spans[i].z[k]};
            for (int k = 0; k <= 50; ++k) off = std::max(off, spine.off(value_at(cubic, k / 50.0)));
            // They are joined without a gap, the last to the first.
            const curves::PathSpan& next = spans[(i + 1) % spans.size()];
            CHECK(spans[i].x[3] == next.x[0]);
            CHECK(spans[i].y[3] == next.y[0]);
            CHECK(spans[i].z[3] == next.z[0]);
        }
        CHECK(off <= 1.01 * tolerance);
    }
    REQUIRE(most > 0);
    return most;
}

}  // namespace

TEST_CASE("paths: cubics of the fifth order are off by what they may, and few") {
    // Those that meet the path at given parameters were 570, 496, 666 and 617.
    const csg::Solid post = made("cylinder", {10.0, 60.0, true});
    CHECK(most_spans(csg::Op::unite, {post, steep_cylinder(7, 90)}, 1.5) < 180);
    CHECK(most_spans(csg::Op::unite, {post, steep_cylinder(8, 90)}, 4.0) < 180);
    CHECK(most_spans(csg::Op::difference, {post, steep_cylinder(6, 75)}, 1.0) < 200);
    CHECK(most_spans(csg::Op::unite, {post, turn(cone(9, 3, 40), {1, 0, 0}, 80)}, 2.0) < 200);
}

TEST_CASE("paths: where the ball's way lies in a plane, too") {
    // Two pipes of different sizes whose axes miss each other, and a sphere off a pipe's axis; symmetry makes torsions vanish.
    const csg::Solid pipe = made("cylinder", {3.0, 60.0, true});
    CHECK(most_spans(csg::Op::unite, {pipe, move(test::sphere(4), {1.5, 0, 0})}, 0.3) < 300);
    CHECK(most_spans(csg::Op::unite, {pipe, move(steep_cylinder(1.5, 90), {1, 0, 0})}, 0.2) < 300);
}

}  // namespace raymo::blends
