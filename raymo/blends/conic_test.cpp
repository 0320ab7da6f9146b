// Conics between curved surfaces against closed forms to 1e-9.
#include "raymo/blends/test_blends.hpp"

namespace raymo::blends {
namespace {

using namespace test;

Form conic(double radius, double shape) {
    Form form;
    form.radius = radius;
    form.profile = Profile::conic;
    form.shape = shape;
    return form;
}

/// The part of the box of both functions' ranges that the conic fills.
double filled(double shape) {
    const double phi = std::acos(-shape);
    return ((1.0 + shape) - 0.5 * phi * std::sin(phi)) / ((1.0 + shape) * (1.0 + shape));
}

/// The volume that is added around an axis from height 0 to `top` to what has the radius sharp(z).
double added(Traced& solid, double top, const Function& sharp) {
    return integral(0.0, top, [&](double z) {
        const double radius = 0.5 * solid.chord({-20, 0, z}, {1, 0, 0});
        return kPi * (radius * radius - sharp(z) * sharp(z));
    });
}

TEST_CASE("conics: a peg on a plate, of any shape (B4, B12)") {
    const double big = 2.0, r = 1.0;
    const csg::Solid plate = move(block(16, 16, 1), {-8, -8, -1});
    const csg::Solid peg = move(cylinder(big, 4), {0, 0, -0.5});
    // g = x^2 + y^2 - R^2 and h = z reach as far as the ball's contacts: (R + r)^2 - R^2 and r.
    for (const double shape : {-0.9, -0.5, 0.0, 0.5, 0.8}) {
        CAPTURE(shape);
        Traced solid(blended(csg::Op::unite, {plate, peg}, conic(r, shape), 1));
        CHECK(added(solid, r, [&](double) { return big; }) == near(kPi * 5.0 * r * filled(shape)));
    }
    Traced solid(blended(csg::Op::unite, {plate, peg}, conic(r, 0.0), 1));
    CHECK(added(solid, r, [&](double) { return big; }) == doctest::Approx(3.370958).epsilon(1e-6));
    CHECK(10.0 - solid.first({10, 0, 0.5}, {-1, 0, 0}) ==
          near(std::sqrt(4.0 + 5.0 * (1.0 - std::sqrt(0.75)))));
}

TEST_CASE("conics: half a ball on a plate (B13)") {
    const double big = 2.0, r = 1.0;
    const csg::Solid plate = move(block(16, 16, 1), {-8, -8, -1});
    // The ball of radius 1 touches the plate at sqrt(3^2 - 1^2) and the sphere at the height 2 / 3.
    const double a = 8.0 - big * big;
    const double b = 2.0 / 3.0;
    for (const double shape : {-0.6, 0.0, 0.7}) {
        CAPTURE(shape);
        Form form = conic(r, shape);
        form.near = Vec3{big, 0, 0};
        Traced solid(blended(csg::Op::unite, {plate, sphere(big)}, form, 1));
        const auto sharp = [&](double z) { return std::sqrt(big * big - z * z); };
        CHECK(added(solid, b, sharp) == near(kPi * a * b * filled(shape)));
    }
}

TEST_CASE("conics: the rim of a bore, from within") {
    const double big = 2.0, r = 0.5;
    const csg::Solid plate = move(block(16, 16, 3), {-8, -8, -3});
    Traced solid(blended(
        csg::Op::difference, {plate, move(cylinder(big, 6), {0, 0, -5})},
        [&] {
            Form form = conic(r, 0.3);
            form.near = Vec3{big, 0, 0};
            return form;
        }(),
        1));
    // Round from z = -r up: what is taken away has the volume of the box of g and h times the part that the conic cuts off.
    const double a = (big + r) * (big + r) - big * big;
    const double taken = integral(0.0, r, [&](double z) {
        const double hole = 0.5 * (16.0 - solid.chord({-20, 0, -z}, {1, 0, 0}));
        return kPi * (hole * hole - big * big);
    });
    CHECK(taken == near(kPi * a * r * filled(0.3)));
}

}  // namespace
}  // namespace raymo::blends
