// Chamfers and conics along curves in space, against their definition.
#include <random>

#include "raymo/blends/test_blends.hpp"

namespace raymo::blends {
namespace {

using namespace test;

constexpr double kPost = 10.0, kBore = 6.0;

Form form_of(Profile profile, double radius, double shape = 0.0) {
    Form form;
    form.radius = radius;
    form.profile = profile;
    form.shape = shape;
    return form;
}
csg::Solid pipe(double radius, double degrees) {
    return turn(made("cylinder", {radius, 60.0, true}), {1, 0, 0}, degrees);
}
/// A post along z with a bore along y.
std::vector<csg::Solid> bored_post() { return {pipe(kPost, 0), pipe(kBore, 90)}; }

/// The distances from the post and from the bore, with their gradients.
double from_post(Vec3 p) { return std::hypot(p.x, p.y) - kPost; }
double from_bore(Vec3 p) { return std::hypot(p.x, p.z) - kBore; }
Vec3 away_from_post(Vec3 p) { return unit({p.x, p.y, 0}); }
Vec3 away_from_bore(Vec3 p) { return unit({p.x, 0, p.z}); }

struct Section {
    Vec3 centre, a, b;
};
/// The ball of radius r within the bored post in whose plane across the path a point is, by Newton's method with differences.
Section section_of(Vec3 p, double r) {
    const auto residual = [&](Vec3 c) {
        return Vec3{from_post(c) + r, from_bore(c) - r,
                    dot(p - c, cross(away_from_post(c), away_from_bore(c)))};
    };
    // Next to the edge, deeper in the material.
    Vec3 c = p - away_from_post(p) * r + away_from_bore(p) * r;
    for (int i = 0; i < 20; ++i) {
        const Vec3 f = residual(c);
        Mat3 columns;
        for (int k = 0; k < 3; ++k) {
            Vec3 h;
            h[k] = 1e-6;
            const Vec3 d = (residual(c + h) - residual(c - h)) / 2e-6;
            for (int row = 0; row < 3; ++row)
                columns.row[static_cast<std::size_t>(row)][k] = d[row];
        }
        c = c - inverse(columns) * f;
    }
    CHECK(norm(residual(c)) < 1e-12);
    return {c, c + away_from_post(c) * r, c - away_from_bore(c) * r};
}

/// Calls `use` for random points of a blend's patches.
template <class Use>
void at_blend(const csg::Solid& solid, int count, Use&& use) {
    std::mt19937_64 engine(5);
    const auto uniform = [&](double lo, double hi) {
        return lo + (hi - lo) * static_cast<double>(engine() >> 11) * 0x1p-53;
    };
    Traced traced(solid);
    int found = 0;
    for (int i = 0; i < 200 * count && found < count; ++i) {
        // Towards the rim.
        const double angle = uniform(0.0, 2.0 * kPi);
        const Vec3 on_bore{kBore * std::cos(angle), 0, kBore * std::sin(angle)};
        const Vec3 edge{on_bore.x, std::sqrt(kPost * kPost - on_bore.x * on_bore.x), on_bore.z};
        const Vec3 from{uniform(-3, 3), 25, uniform(-3, 3)};
        const Vec3 way = unit(edge + Vec3{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)} - from);
        const double t = traced.first(from, way);
        const Vec3 p = from + way * t;
        if (std::isnan(t) || std::fabs(from_post(p)) < 1e-6 || std::fabs(from_bore(p)) < 1e-6)
            continue;
        // Not the far side's rim, nor within.
        if (p.y < 5.0 || from_bore(p) > 3.0) continue;
        ++found;
        use(p);
    }
    CHECK(found == count);
}

}  // namespace

TEST_CASE("crossing profiles: points of a chamfer are between the contacts") {
    const double r = 1.0;
    const csg::Solid solid =
        blended(csg::Op::difference, bored_post(), form_of(Profile::chamfer, r), 2);
    at_blend(solid, 400, [&](Vec3 p) {
        const Section s = section_of(p, r);
        const Vec3 chord = s.b - s.a;
        const double part = dot(p - s.a, chord) / dot(chord, chord);
        CHECK(part > -1e-9);
        CHECK(part < 1.0 + 1e-9);
        CHECK(norm(p - s.a - chord * part) < 4e-9 * r);
    });
}

TEST_CASE("crossing profiles: points of a conic obey its equation") {
    const double r = 1.0;
    // (R + e)^2 - R^2
    const auto of_post = [](Vec3 p) { return from_post(p) * (2.0 * kPost + from_post(p)); };
    const auto of_bore = [](Vec3 p) { return from_bore(p) * (2.0 * kBore + from_bore(p)); };
    for (const double shape : {-0.6, 0.7}) {
        CAPTURE(shape);
        const csg::Solid solid =
            blended(csg::Op::difference, bored_post(), form_of(Profile::conic, r, shape), 2);
        at_blend(solid, 200, [&](Vec3 p) {
            const Section s = section_of(p, r);
            const double g = of_post(p) / of_post(s.b);
            const double h = of_bore(p) / of_bore(s.a);
            CHECK(g + h <= 1.0 + 1e-6);
            // In parts of the chord's length; the gradient is about 2.
            CHECK(std::fabs((g + h - 1.0) * (g + h - 1.0) - 2.0 * (1.0 - shape) * g * h) < 4e-8);
        });
    }
}

TEST_CASE("crossing profiles: in the plane of both axes faces are at right angles") {
    const double r = 1.0;
    Traced chamfer(blended(csg::Op::difference, bored_post(), form_of(Profile::chamfer, r), 2));
    for (double z = kBore + 0.01; z < kBore + r; z += 0.07) {
        for (const double side : {-1.0, 1.0}) {
            CHECK(chamfer.first({0, side * 20, z}, {0, -side, 0}) == near(kPost + kBore + r - z));
            CHECK(chamfer.first({0, side * 20, -z}, {0, -side, 0}) == near(kPost + kBore + r - z));
        }
    }
}

TEST_CASE("crossing profiles: a chamfer takes more than a ball") {
    std::mt19937_64 engine(3);
    const auto uniform = [&](double lo, double hi) {
        return lo + (hi - lo) * static_cast<double>(engine() >> 11) * 0x1p-53;
    };
    const double r = 1.0;
    for (const csg::Op op : {csg::Op::difference, csg::Op::unite}) {
        const std::size_t edges = 2;
        const bool adds = op == csg::Op::unite;
        Traced sharp(csg::boolean(op, bored_post()));
        Traced ball(blended(op, bored_post(), form_of(Profile::ball, r), edges));
        Traced chamfer(blended(op, bored_post(), form_of(Profile::chamfer, r), edges));
        int differ[2] = {0, 0};
        for (int i = 0; i < 4000; ++i) {
            const double angle = uniform(0.0, 2.0 * kPi);
            const double x = kBore * std::cos(angle);
            const Vec3 p = Vec3{x, std::sqrt(kPost * kPost - x * x), kBore * std::sin(angle)} +
                           Vec3{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
            const auto in = [&](Traced& solid) { return solid.where(p) == solids::Where::in; };
            // From less to more.
            bool s[3] = {in(chamfer), in(ball), in(sharp)};
            if (adds) std::swap(s[0], s[2]);
            CHECK(s[0] <= s[1]);
            CHECK(s[1] <= s[2]);
            differ[0] += s[0] != s[1] ? 1 : 0;
            differ[1] += s[1] != s[2] ? 1 : 0;
        }
        CHECK(differ[0] > 50);
        CHECK(differ[1] > 50);
    }
}

TEST_CASE("crossing profiles: flat conics are chamfers but for the bends of the faces") {
    const double r = 0.4;
    Traced chamfer(blended(csg::Op::difference, bored_post(), form_of(Profile::chamfer, r), 2));
    Traced conic(blended(csg::Op::difference, bored_post(), form_of(Profile::conic, r, 0.999), 2));
    double most = 0.0;
    for (double angle = 0.05; angle < 6.2; angle += 0.1) {
        for (const double part : {0.2, 0.5, 0.8}) {
            const double out = kBore + part * r;
            const Vec3 from{out * std::cos(angle), 20, out * std::sin(angle)};
            const double a = chamfer.first(from, {0, -1, 0});
            const double b = conic.first(from, {0, -1, 0});
            most = std::max(most, std::fabs(a - b));
        }
    }
    // A chord of 1.4 r is off an arc of the radius 6 by 0.04 r^2, and the conic's middle off its own by some hundredths of r.
    CHECK(most < 0.1 * r * r + 0.06 * r);
    CHECK(most > 0.005 * r);
}

TEST_CASE("crossing profiles: a ring that is nearly a circle has nearly the circle's blend") {
    // A peg on a plate, tilted by as much as makes a difference to what is a circle.
    const double tilt = 1e-3;
    const csg::Solid plate = move(block(40, 40, 2), {-20, -20, -2});
    const auto peg = [&](double degrees) {
        return turn(move(cylinder(4, 20), {0, 0, -1}), {1, 0, 0}, degrees);
    };
    for (const Profile profile : {Profile::chamfer, Profile::conic}) {
        const Form form = form_of(profile, 1.0, 0.3);
        Traced exact(blended(csg::Op::unite, {plate, peg(0)}, form, 1));
        Traced along_space(blended(csg::Op::unite, {plate, peg(tilt)}, form, 1));
        for (double angle = 0.1; angle < 6.0; angle += 0.37) {
            for (const double height : {0.1, 0.3, 0.5, 0.7, 0.9}) {
                const Vec3 out{std::cos(angle), std::sin(angle), 0};
                const Vec3 from = out * 15.0 + Vec3{0, 0, height};
                const double a = exact.first(from, -out);
                const double b = along_space.first(from, -out);
                CHECK(std::fabs(a - b) < 20.0 * tilt * kPi / 180.0);
                CHECK(a != b);
            }
        }
    }
}

TEST_CASE("crossing profiles: similar bodies have similar blends, mirrored ones mirrored") {
    const auto operands = [] {
        return std::vector<csg::Solid>{move(block(30, 24, 8), {-15, -12, -4}), pipe(4, 35)};
    };
    for (const Profile profile : {Profile::chamfer, Profile::conic}) {
        for (const csg::Op op : {csg::Op::difference, csg::Op::unite}) {
            Traced plain(blended(op, operands(), form_of(profile, 0.8, -0.4), 2));
            Affine map = translation({3, -2, 5}) * rotation(unit(Vec3{1, 2, 3}), 40.0);
            for (Vec3& row : map.linear.row) row = row * 2.5;
            Affine mirror;
            mirror.linear.row[0] = {-1, 0, 0};
            map = map * mirror;
            auto images = operands();
            for (csg::Solid& s : images) s = mapped(std::move(s), map);
            Traced image(blended(op, std::move(images), form_of(profile, 2.0, -0.4), 2));
            for (double x = -6.0; x < 6.0; x += 0.51) {
                for (double y = -8.0; y < 8.0; y += 0.53) {
                    const Vec3 from{x, y, 60}, to{x, y, 59};
                    const Vec3 p = map.linear * from + map.offset;
                    const Vec3 way = map.linear * (to - from);
                    const double t = plain.first(from, to - from);
                    if (std::isnan(t)) continue;
                    CHECK(image.first(p, way) == near(t));
                }
            }
        }
    }
}

TEST_CASE("crossing profiles: edges of all kinds of one body") {
    // A block with an oblique bore: lines, and two ellipses.
    const csg::Solid body =
        csg::boolean(csg::Op::difference, {move(block(30, 24, 8), {-15, -12, -4}), pipe(4, 35)});
    for (const Profile profile : {Profile::chamfer, Profile::conic}) {
        const csg::Solid solid = blended(body, Edges::convex, form_of(profile, 0.8), 14);
        Traced sharp(body), traced(solid);
        // On the bore's rim and on the block's edges nothing is left, farther away all is.
        for (double angle = 0.05; angle < 6.2; angle += 0.3) {
            const double x = 4.0 * std::cos(angle);
            const double v = 4.0 * std::sin(angle);
            // Points of the bore are v across its axis, in the plane of y and z.
            const double c = std::cos(35.0 * kPi / 180.0), s = std::sin(35.0 * kPi / 180.0);
            const double along = (4.0 - v * s) / c;
            const Vec3 rim{x, v * c - along * s, 4.0};
            const Vec3 out = unit(Vec3{x, v, 0});
            const Vec3 deeper = rim + Vec3{out.x, out.y * c, out.y * s} * 0.02 - Vec3{0, 0, 0.02};
            CHECK(sharp.where(deeper) == solids::Where::in);
            CHECK(traced.where(deeper) == solids::Where::out);
        }
        CHECK(traced.where({14.95, 11.95, 0}) == solids::Where::out);
        CHECK(traced.where({14, 11, 0}) == solids::Where::in);
        CHECK(traced.where({9, 0, 3.9}) == solids::Where::in);
    }
}

TEST_CASE("crossing profiles: stretches end where the face does") {
    // The long ellipse in the plate's top leaves it over both of its sides.
    const csg::Solid plate = move(block(20, 2, 10), {-10, -1, -10});
    for (const Profile profile : {Profile::chamfer, Profile::conic}) {
        Form form = form_of(profile, 0.1, 0.2);
        form.where = made("block", {Vec3{40, 40, 0.2}, true});
        const csg::Solid solid = blended(csg::Op::unite, {plate, pipe(1.0, 70)}, form, 2);
        Traced traced(solid), sharp(csg::boolean(csg::Op::unite, {plate, pipe(1.0, 70)}));
        int more = 0;
        for (double x = -1.4; x < 1.4; x += 0.0173) {
            for (double y = -1.4; y < 1.4; y += 0.0511) {
                const double a = sharp.first({x, y, 20}, {0, 0, -1});
                const double b = traced.first({x, y, 20}, {0, 0, -1});
                if (std::isnan(a)) {
                    CHECK(std::isnan(b));
                    continue;
                }
                CHECK(b <= a + 1e-9);
                // Nothing beside the plate.
                if (std::fabs(y) > 1.0) CHECK(b == near(a));
                more += b < a - 1e-6 ? 1 : 0;
            }
        }
        CHECK(more > 20);
    }
}

TEST_CASE("crossing profiles: a conic closer to a sharp bend than its ball is refused") {
    // At its acute side the conic runs where the planes across the path cross each other.
    const std::vector<csg::Solid> operands{move(block(60, 60, 6), {-30, -30, -6}), pipe(1.0, 70)};
    Form form = form_of(Profile::conic, 0.3, -0.8);
    form.near = Vec3{};
    const auto out = blends::blended(csg::Op::unite, operands, form);
    REQUIRE(!out);
    CHECK(out.error().message.find("bends too sharply for a conic of radius 0.3") !=
          std::string::npos);
    CHECK(out.error().hint == "a radius of 0.075 works here");
    form.radius = 0.075;
    blended(csg::Op::unite, operands, form, 1);
}

TEST_CASE("crossing profiles: the rim of a bore is cut off by one solid") {
    const csg::Solid solid =
        blended(csg::Op::difference, bored_post(), form_of(Profile::chamfer, 1.0), 2);
    const auto& operands = csg::as_boolean(solid.node()).operands;
    REQUIRE(operands.size() == 3);
    CHECK(operands[1].node().kind == csg::NodeKind::leaf);
    CHECK(operands[2].node().kind == csg::NodeKind::leaf);
}

}  // namespace raymo::blends
