// Edges along curves in space: that all are found, and that what is in a ball's way is seen wherever it is.
#include "raymo/blends/segment.hpp"
#include "raymo/blends/test_blends.hpp"

namespace raymo::blends {
namespace {

using test::ball;
using test::blended;
using test::block;
using test::cone;
using test::cylinder;
using test::kPi;
using test::made;
using test::mapped;
using test::move;
using test::near;
using test::Traced;
using test::turn;

std::vector<Segment> segments_of(const std::vector<csg::Solid>& operands, double reach) {
    const auto body = Body::make(csg::Op::unite, operands);
    REQUIRE(body.has_value());
    auto found = find_segments(*body, false, reach);
    REQUIRE(found.has_value());
    return *std::move(found);
}

csg::Solid steep_cylinder(double radius, double degrees) {
    return turn(made("cylinder", {radius, 60.0, true}), {1, 0, 0}, degrees);
}

}  // namespace

TEST_CASE("crossings: two stretches of one curve are two edges") {
    // The long ellipse in the plate's top leaves it over both of its sides.
    const csg::Solid plate = move(block(20, 2, 10), {-10, -1, -10});
    std::size_t on_top = 0;
    for (const Segment& s : segments_of({plate, steep_cylinder(1.0, 70)}, 0.1)) {
        if (s.space && std::fabs(s.centre.z) < 1e-12) ++on_top;
    }
    CHECK(on_top == 2);
}

TEST_CASE("crossings: the tip of a cone through a wall makes an edge, however small") {
    const Vec3 axis = unit(Vec3{1, 1, 0.3});
    const csg::Solid pipe = turn(steep_cylinder(5, 90), axis, 77);
    for (const double out : {0.5, 0.1, 0.01, 0.002}) {
        CAPTURE(out);
        // Not quite at right angles, so that the ring is no circle.
        const csg::Solid tip =
            turn(turn(move(cone(3, 0, 6), {0, 0, 5 + out - 6}), {1, 0, 0}, 0.2), axis, 77);
        CHECK(segments_of({test::sphere(5), tip}, 0.1 * out).size() == 1);
        const auto found = segments_of({pipe, tip}, 0.1 * out);
        REQUIRE(found.size() == 1);
        CHECK(found[0].space);
        CHECK(found[0].is_closed);
    }
}

TEST_CASE("crossings: a fillet round the sharp bend where a plane cuts a cone next to its tip") {
    // In the plane of symmetry the ball touches two lines that meet at 30 degrees.
    const double angle = kPi / 6.0, deep = 0.01, r = 0.3;
    const csg::Solid plate = move(block(30, 30, 2), {-15, -15, -2});
    const double length = 12.0;
    // The tip in (0, 0, -deep), opening along y.
    const csg::Solid spike =
        move(turn(cone(0, length * std::tan(angle), length), {1, 0, 0}, -90), {0, 0, -deep});
    Form form = ball(r);
    form.near = Vec3{0, deep / std::tan(angle), 0};
    Traced solid(blended(csg::Op::unite, {plate, spike}, form, 1));
    const double edge = deep / std::tan(angle);
    const double centre = edge - r * std::tan(0.5 * angle);
    for (double y = centre + 0.003; y < centre + r * std::sin(angle); y += 0.00567) {
        CAPTURE(y);
        const double height = 5.0 - solid.first({0, y, 5}, {0, 0, -1});
        CHECK(std::hypot(y - centre, r - height) == near(r));
    }
    // All round the bend, too, there is something of it.
    CHECK(solid.where({0.01, edge - 0.02, 0.003}) == solids::Where::in);
}

TEST_CASE("crossings: a pin in the way is seen wherever it stands") {
    const csg::Solid plate = move(block(1000, 40, 1), {0, -20, -1});
    const csg::Solid wall = move(block(1000, 5, 5), {0, -5, 0});
    for (const double x : {10.0, 123.4, 777.7, 801.0}) {
        CAPTURE(x);
        const csg::Solid pin = move(cylinder(0.05, 5), {x, 0.5, -0.5});
        Form form = ball(2.0);
        form.near = Vec3{400, 0, 0};
        const auto out = blends::blended(csg::Op::unite, {plate, wall, pin}, form);
        REQUIRE(!out);
        CHECK(out.error().message.find("the cylinder is in its way") != std::string::npos);
    }
}

TEST_CASE("crossings: a hole under the ball is seen wherever it is") {
    const csg::Solid wall = move(block(1000, 5, 5), {0, -5, 0});
    for (const double x : {10.0, 123.4, 777.7, 801.0}) {
        CAPTURE(x);
        const csg::Solid plate = csg::boolean(
            csg::Op::difference,
            {move(block(1000, 40, 1), {0, -20, -1}), move(cylinder(0.3, 5), {x, 2.0, -3.0})});
        Form form = ball(2.0);
        form.near = Vec3{400, 0, 0};
        const auto out = blends::blended(csg::Op::unite, {plate, wall}, form);
        REQUIRE(!out);
        CHECK(out.error().message.find("reaches beyond the top of the block") != std::string::npos);
    }
}

namespace {

/// A post with a bore that is rounded at both ends, and what that is: sectors are taken away, and the tubes joined to the rest.
bool is_rounded_off(const csg::Solid& solid) {
    const csg::Node& node = solid.node();
    if (node.kind != csg::NodeKind::boolean || node.op != csg::Op::unite) return false;
    const auto& operands = csg::as_boolean(node).operands;
    return operands.size() > 1 && operands[0].node().kind == csg::NodeKind::boolean &&
           operands[0].node().op == csg::Op::difference &&
           operands[1].node().kind != csg::NodeKind::boolean;
}

}  // namespace

TEST_CASE("crossings: the rims of a bore are rounded by joining the tubes") {
    const double r = 1.0, b = 6.0;
    const csg::Solid post = made("cylinder", {10.0, 60.0, true});
    const csg::Solid solid =
        blended(csg::Op::difference, {post, steep_cylinder(b, 90)}, ball(r), 2);
    CHECK(is_rounded_off(solid));
    Traced traced(solid);
    // In the plane through both axes the ball touches two lines at right angles; the bore runs along y.
    for (const double side : {-1.0, 1.0}) {
        for (double z = b + 0.01; z < b + r; z += 0.07) {
            const double depth = r - std::sqrt(r * r - (b + r - z) * (b + r - z));
            CHECK(traced.first({0, side * 20, z}, {0, -side, 0}) == near(10.0 + depth));
            CHECK(traced.first({0, side * 20, -z}, {0, -side, 0}) == near(10.0 + depth));
        }
    }
    // At the sides the walls meet at an angle; there the tube is as far from the ball's centre.
    const double out = std::sqrt((10.0 - r) * (10.0 - r) - (b + r) * (b + r));
    const Vec3 centre{b + r, out, 0};
    for (double part = 0.1; part < 1.0; part += 0.1) {
        const Vec3 to_post = unit(Vec3{centre.x, centre.y, 0});
        const Vec3 way = unit(to_post * part + Vec3{-1, 0, 0} * (1.0 - part));
        CHECK(traced.first(centre + way * (3.0 * r), -way) == near(2.0 * r));
    }
}

TEST_CASE("crossings: no sliver stays where sectors fold") {
    // Of 1,000 random pairs; sectors cut into stretches leave one here.
    const Affine pipe{Mat3{{Vec3{0.28070230260849482, -0.78884074695385853, -0.54675085117040978},
                            Vec3{0.85739701222289577, 0.46211435512129451, -0.22654069440628488},
                            Vec3{0.43136594759153224, -0.40519205166946304, 0.80606626310890284}}},
                      {0.51279319562827674, -0.19727181763329149, -0.72554646884883578}};
    const Affine ring{Mat3{{Vec3{0.63976985060297342, -0.4305940868573358, -0.63661862258572521},
                            Vec3{0.3136179869002188, 0.90248149649913334, -0.29524719603975741},
                            Vec3{0.70166822398631046, -0.010764796337222882, 0.71242250287853404}}},
                      {-0.25205003728089581, -0.84315257002428834, 0.4222225646434743}};
    const csg::Solid solid =
        blended(csg::Op::difference,
                {mapped(made("cylinder", {1.6346178158851319, 64.0, true}), pipe),
                 mapped(test::torus(0.87913174779802006, 0.6014380761825141), ring)},
                ball(0.15490477804240296), 1);
    CHECK(is_rounded_off(solid));
    const Vec3 at{-1.4568861465080367, -0.27218079788969235, -0.26798050611087665};
    Traced traced(solid);
    CHECK(traced.where(at) == solids::Where::out);
    const Vec3 way = unit(Vec3{0.7023, 0.04796, -0.7103});
    CHECK(traced.along(at - way, way).size() == 2);
}

TEST_CASE("crossings: nothing else is taken away where a rim is rounded") {
    // A sleeve stands around the post, nearer to it than the sectors of its rims reach.
    const csg::Solid post = made("cylinder", {10.0, 60.0, true});
    const csg::Solid sleeve =
        csg::boolean(csg::Op::difference,
                     {made("cylinder", {12.0, 60.0, true}), made("cylinder", {10.01, 62.0, true})});
    Form form = ball(1.0);
    form.where = made("cylinder", {10.005, 60.0, true});
    const csg::Solid solid =
        blended(csg::Op::difference,
                {csg::boolean(csg::Op::unite, {post, sleeve}), steep_cylinder(6, 90)}, form, 2);
    CHECK(!is_rounded_off(solid));
    Traced traced(solid);
    for (double z = 6.002; z < 8.0; z += 0.013) {
        CAPTURE(z);
        CHECK(traced.where({0, 10.015, z}) == solids::Where::in);
        CHECK(traced.where({0, 10.005, z}) == solids::Where::out);
    }
}

TEST_CASE("crossings: a rim shows the material that its wedge would show") {
    const csg::Solid post = made("cylinder", {10.0, 60.0, true});
    const csg::Solid red = csg::paint(steep_cylinder(6, 90), 1);
    const csg::Solid solid = blended(csg::Op::difference, {post, red}, ball(1.0), 2);
    // The post has no material of its own: what cuts it borrows.
    CHECK(!is_rounded_off(solid));
    CHECK(is_rounded_off(blended(csg::Op::difference, {csg::paint(post, 2), red}, ball(1.0), 2)));
}

TEST_CASE("crossings: what has been rounded has no more edges") {
    const csg::Solid once = blended(block(10, 20, 30), Edges::convex, ball(2), 12);
    blended(once, Edges::convex, ball(1), 0);
    const csg::Solid crossed =
        blended(csg::Op::unite, {steep_cylinder(5, 90), steep_cylinder(3.5, 20)}, ball(0.5), 2);
    CHECK(Traced(crossed).where({}) == solids::Where::in);
}

}  // namespace raymo::blends
