// Where blended edges end: corners of balls, mitres, chains of tangent edges, blends of blends.
#include <random>

#include "raymo/blends/section.hpp"
#include "raymo/blends/test_polyhedra.hpp"

namespace raymo::blends {
namespace {

using namespace test;

csg::Solid unite(std::vector<csg::Solid> s) { return csg::boolean(csg::Op::unite, std::move(s)); }
csg::Solid cut(csg::Solid a, csg::Solid b) {
    return csg::boolean(csg::Op::difference, {std::move(a), std::move(b)});
}

/// Height of a fillet, and depth of a round, at a distance u from the edge on a face; at right angles.
double rise(double r, double u) { return u >= r ? 0.0 : r - std::sqrt(r * r - (r - u) * (r - u)); }

/// Top of the solid on an upright line.
double top(Traced& solid, double x, double y) {
    const auto& spans = solid.along({x, y, 0}, {0, 0, 1});
    REQUIRE(!spans.empty());
    return spans.back().exit.t;
}

TEST_CASE("vertices: a boss on a plate has a fillet around it, mitred at its edges") {
    const double r = 0.5;
    const csg::Solid plate = move(block(10, 10, 1), {-5, -5, -1});
    const csg::Solid boss = move(block(2, 4, 2), {-1, -2, -0.5});
    Traced solid(blended(csg::Op::unite, {plate, boss}, ball(r), 4));
    for (double u = -0.25; u < 0.7; u += 0.0499) {
        for (double v = -0.25; v < 0.7; v += 0.0497) {
            CAPTURE(u);
            CAPTURE(v);
            const double expected = u < 0.0 && v < 0.0 ? 1.5 : rise(r, std::max(u, v));
            for (const double x : {-1.0, 1.0}) {
                for (const double y : {-1.0, 1.0})
                    CHECK(top(solid, x * (1 + u), y * (2 + v)) == near(expected));
            }
        }
    }
}

TEST_CASE("vertices: the rim of a pocket is rounded, mitred in its corners") {
    const double r = 0.5;
    const csg::Solid body = move(block(10, 10, 3), {-5, -5, -3});
    const csg::Solid pocket = move(block(2, 4, 2), {-1, -2, -1});
    Traced solid(blended(csg::Op::difference, {body, pocket}, ball(r), 4));
    for (double u = -0.25; u < 0.7; u += 0.0499) {
        for (double v = -0.25; v < 0.7; v += 0.0497) {
            CAPTURE(u);
            CAPTURE(v);
            const double expected = u < 0.0 && v < 0.0 ? -1.0 : -rise(r, std::max(u, v));
            CHECK(top(solid, 1 + u, 2 + v) == near(expected));
            CHECK(top(solid, -1 - u, 2 + v) == near(expected));
        }
    }
}

TEST_CASE("vertices: a pocket's own edges are filled up to a ball") {
    const double r = 0.4;
    const csg::Solid pocketed =
        cut(move(block(10, 10, 3), {-5, -5, -3}), move(block(2, 4, 2), {-1, -2, -1}));
    Traced solid(blended(pocketed, Edges::concave, ball(r), 8));
    // The pocket is what balls in it cover: those with their centres in the smaller block.
    for (double x = -1.09; x < 1.1; x += 0.0501) {
        for (double y = -2.09; y < -1.4; y += 0.0499) {
            for (double z = -1.09; z < -0.4; z += 0.0503) {
                const Vec3 p{x, y, z};
                const Vec3 c{std::clamp(x, -1 + r, 1 - r), std::clamp(y, -2 + r, 2 - r),
                             std::max(z, -1 + r)};
                const double off = norm(p - c) - r;
                if (std::fabs(off) < 1e-9) continue;
                CAPTURE(p.x);
                CAPTURE(p.y);
                CAPTURE(p.z);
                CHECK((solid.where(p) == solids::Where::out) == (off < 0.0));
            }
        }
    }
}

TEST_CASE("vertices: an angle bar, filled, and rounded all around") {
    const double r = 0.3;
    const csg::Solid bar = unite({block(4, 1, 3), block(1, 4, 3)});
    {
        Traced solid(blended(bar, Edges::concave, ball(r), 1));
        for (double u = 0.013; u < 0.5; u += 0.05) {
            for (double v = 0.011; v < 0.5; v += 0.05) {
                const double chord = solid.chord({1 + u, 1 + v, -9}, {0, 0, 1});
                CHECK(chord == near(v < rise(r, u) ? 3.0 : 0.0));
            }
        }
    }
    // Convex: at both ends 6 edges, and 5 upright.
    Traced solid(blended(bar, Edges::convex, ball(r), 17));
    for (double u = -0.513; u < 0.5; u += 0.05) {
        for (double v = -0.511; v < 0.5; v += 0.05) {
            // From the inner corner, which stays sharp, into the bar.
            if (u > 0.0 && v > 0.0) continue;
            const double into = u > 0.0 ? -v : v > 0.0 ? -u : std::max(-u, -v);
            CAPTURE(u);
            CAPTURE(v);
            CHECK(top(solid, 1 + u, 1 + v) == near(3.0 - rise(r, into)));
        }
    }
    // At the outer corner a ball.
    for (double x = 0.01; x < 0.4; x += 0.03) {
        for (double y = 0.01; y < 0.4; y += 0.03) {
            const double dx = std::max(r - x, 0.0);
            const double dy = std::max(r - y, 0.0);
            const double square = r * r - dx * dx - dy * dy;
            const double chord = solid.chord({x, y, -9}, {0, 0, 1});
            CHECK(chord == near(square > 0 ? 3.0 - 2 * r + 2 * std::sqrt(square) : 0.0));
        }
    }
}

TEST_CASE("vertices: blends of blends: a peg with a rounded rim and a fillet") {
    const double big = 2.0, r = 0.5, rim = 0.7, h = 3.0;
    const csg::Solid plate = move(block(12, 12, 1), {-6, -6, -1});
    const csg::Solid peg = move(cylinder(big, h + 0.5), {0, 0, -0.5});
    Form only_top = ball(rim);
    only_top.near = Vec3{0, 0, h};
    const csg::Solid round_peg = blended(peg, Edges::convex, only_top, 1);
    Form base = ball(r);
    const csg::Solid first = blended(csg::Op::unite, {plate, round_peg}, base, 1);
    only_top.near = Vec3{big, 0, h};
    const csg::Solid second =
        blended(blended(csg::Op::unite, {plate, peg}, base, 1), Edges::convex, only_top, 1);
    for (const csg::Solid& s : {first, second}) {
        Traced solid(s);
        for (double z = 0.0123; z < h; z += 0.0456) {
            double expected = big;
            if (z < r) expected += rise(r, z);
            if (z > h - rim) expected -= rise(rim, h - z);
            CHECK(0.5 * solid.chord({-20, 0, z}, {1, 0, 0}) == near(expected));
        }
    }
}

TEST_CASE("vertices: a fillet follows a chain of tangent edges") {
    const double r = 0.4, corner = 0.6;
    const csg::Solid plate = move(block(10, 10, 1), {-5, -5, -1});
    const csg::Solid boss = move(block(3, 4, 2.5), {-1.5, -2, -0.5});
    Form upright = ball(corner);
    upright.where = move(block(9, 9, 0.5), {-4.5, -4.5, 0.6});
    const csg::Solid pill = blended(boss, Edges::convex, upright, 4);
    Traced solid(blended(csg::Op::unite, {plate, pill}, ball(r), 8));
    for (double x = 0.507; x < 2.2; x += 0.0613) {
        for (double y = 1.003; y < 2.7; y += 0.0617) {
            CAPTURE(x);
            CAPTURE(y);
            // Distance from the rounded rectangle.
            const double dx = std::max(x - (1.5 - corner), 0.0);
            const double dy = std::max(y - (2.0 - corner), 0.0);
            const double d = std::hypot(dx, dy) - corner;
            CHECK(top(solid, x, y) == near(d < 0.0 ? 2.0 : rise(r, d)));
        }
    }
    // And the rim of it all.
    Form rim = ball(0.3);
    rim.where = move(block(9, 9, 0.5), {-4.5, -4.5, 1.9});
    Traced both(blended(blended(csg::Op::unite, {plate, pill}, ball(r), 8), Edges::convex, rim, 8));
    for (double x = 0.507; x < 1.5; x += 0.0613) {
        for (double y = 1.003; y < 2.0; y += 0.0617) {
            const double dx = std::max(x - (1.5 - corner), 0.0);
            const double dy = std::max(y - (2.0 - corner), 0.0);
            const double d = corner - std::hypot(dx, dy);
            if (d < 0.0) continue;
            CAPTURE(x);
            CAPTURE(y);
            CHECK(top(both, x, y) == near(2.0 - rise(0.3, d)));
        }
    }
}

TEST_CASE("vertices: three operands meet in a ball, of space and of material") {
    const double r = 0.8;
    const auto slab = [](int axis) {
        const csg::Solid s = move(block(14, 14, 4), {-4, -4, -4});
        return axis == 2 ? s : turn(s, Vec3{1, 1, 1} / std::sqrt(3.0), axis == 0 ? 120 : 240);
    };
    const std::vector<csg::Solid> slabs{slab(0), slab(1), slab(2)};
    Traced inner(blended(csg::Op::unite, slabs, ball(r), 3));
    // The other edges are edges of the slabs themselves.
    Traced outer(blended(csg::Op::intersection, slabs, ball(r), 3));
    for (double x = 0.013; x < 1.2; x += 0.0601) {
        for (double y = 0.011; y < 1.2; y += 0.0603) {
            for (double z = 0.017; z < 1.2; z += 0.0607) {
                const Vec3 p{x, y, z};
                const double d = norm(p - max(p, Vec3{r, r, r}));
                if (std::fabs(d - r) < 1e-9) continue;
                CAPTURE(x);
                CAPTURE(y);
                CAPTURE(z);
                CHECK((inner.where(p) == solids::Where::in) == (d > r));
                CHECK((outer.where(-p) == solids::Where::in) == (d < r));
            }
        }
    }
}

TEST_CASE("vertices: a ball in a corner of oblique planes, in any frame") {
    // A floor, and walls that lean inwards by 20 and outwards by 15 degrees.
    const double r = 0.8;
    const csg::Solid floor = move(block(20, 20, 2), {-10, -10, -2});
    const csg::Solid inward = turn(move(block(2, 20, 20), {-2, -10, -10}), {0, 1, 0}, 20);
    const csg::Solid outward = turn(move(block(20, 2, 20), {-10, -2, -10}), {1, 0, 0}, 15);
    const Vec3 normals[] = {{0, 0, 1},
                            {std::cos(kPi / 9), 0, -std::sin(kPi / 9)},
                            {0, std::cos(kPi / 12), std::sin(kPi / 12)}};
    const Affine map = rotation(unit({1, -2, 3}), 40);
    std::vector<csg::Solid> operands;
    for (const csg::Solid& s : {floor, inward, outward}) operands.push_back(mapped(s, map));
    Form form = ball(r);
    // Only in the room.
    form.where = mapped(move(block(8, 8, 9), {-0.3, -1.5, -1}), map);
    Traced solid(blended(csg::Op::unite, operands, form, 3));
    // The centre is r away from all planes, and from two of them along the edges.
    const Mat3 planes{{normals[0], normals[1], normals[2]}};
    const Vec3 centre = inverse(planes) * Vec3{r, r, r};
    std::size_t judged = 0;
    for (double x = -1.0; x < 1.0; x += 0.0601) {
        for (double y = -1.0; y < 1.0; y += 0.0603) {
            for (double z = -1.0; z < 1.0; z += 0.0607) {
                // Within the cone of the three contacts, seen from the centre, and in the room.
                const Vec3 d{x, y, z};
                const Vec3 share = transposed_times(inverse(planes), -d);
                if (share.x < 1e-6 || share.y < 1e-6 || share.z < 1e-6) continue;
                if (std::fabs(norm(d) - r) < 1e-9) continue;
                ++judged;
                CHECK((solid.where(map(centre + d)) == solids::Where::in) == (norm(d) > r));
            }
        }
    }
    CHECK(judged > 1000);
}

TEST_CASE("vertices: a rim of more than half a turn is rounded all along") {
    const double r = 0.3, big = 3.0;
    const csg::Solid disc = cylinder(big, 2);
    const csg::Solid arm = move(block(8, 2, 2), {0, -1, 0});
    const csg::Solid keyhole = unite({disc, arm});
    Traced sharp(blended(keyhole, Edges::convex, ball(r), 10));
    Traced filled(
        blended(blended(csg::Op::unite, {disc, arm}, ball(0.5), 2), Edges::convex, ball(r), 14));
    for (double angle = 25.0; angle < 336.0; angle += 7.0) {
        for (const double d : {0.01, 0.1, 0.2, 0.29, 0.31}) {
            CAPTURE(angle);
            CAPTURE(d);
            const double x = (big - d) * std::cos(angle * kPi / 180);
            const double y = (big - d) * std::sin(angle * kPi / 180);
            if (angle > 31.0 && angle < 329.0) CHECK(top(filled, x, y) == near(2.0 - rise(r, d)));
            CHECK(top(sharp, x, y) == near(2.0 - rise(r, d)));
        }
    }
}

/// A prism over a rectangle with round corners, between -a and a, -b and b.
csg::Solid slot(double a, double b, double corner, double z, double h) {
    curves::Curve curve;
    const Vec2 middles[] = {{a - corner, b - corner},
                            {corner - a, b - corner},
                            {corner - a, corner - b},
                            {a - corner, corner - b}};
    Vec2 out{corner, 0.0};
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec2 next{-out.y, out.x};
        append_arc(curve, middles[i], middles[i] + out, middles[i] + next);
        curve.spans.push_back(curves::segment(middles[i] + next, middles[(i + 1) % 4] + next));
        out = next;
    }
    curve.closed = true;
    curves::Outline outline;
    outline.curves.push_back(std::move(curve));
    return move(made("prism", {std::make_shared<const curves::Outline>(outline), h, false}),
                {0, 0, z});
}

TEST_CASE("vertices: tangent edges leave no fins between their blends") {
    const double r = 0.8;
    Traced solid(blended(csg::Op::difference,
                         {move(block(60, 30, 10), {-30, -15, -10}), slot(10, 4.5, 4, -4, 6)},
                         ball(r), 8));
    for (int i = -100; i <= 100; ++i) {
        // About where the arc begins, a little beyond the rim.
        const double along = 1e-8 * i;
        for (const double d : {0.1, 0.3, 0.7}) {
            CAPTURE(i);
            CHECK(top(solid, 6 + along, 4.5 + d) == near(-rise(r, d)));
            CHECK(top(solid, 10 + d, 0.5 + along) == near(-rise(r, d)));
        }
    }
}

/// A cube with a filleted boss and a rounded notch, so that the fillet's corner and the round's are one.
csg::Solid meeting(const Affine& map, double scale, std::size_t& edges) {
    const auto placed = [&](csg::Solid s) { return mapped(std::move(s), map); };
    Form form = ball(0.25 * scale);
    auto bossed = blends::blended(
        csg::Op::unite, {placed(block(4, 4, 4)), placed(move(block(1.5, 1.5, 1.5), {1, 1, 3.5}))},
        form);
    REQUIRE(bossed.has_value());
    form.radius = 0.2 * scale;
    auto notched =
        blends::blended(csg::Op::difference,
                        {bossed->solid, placed(move(block(2, 2, 1), {2.95, 2.95, 3.25}))}, form);
    if (!notched) FAIL(notched.error().message << notched.error().hint);
    edges = bossed->edges + notched->edges;
    return notched->solid;
}

/// Whether a point lies in the fillet of radius r between two planes, however long.
bool is_in_fillet(const Plane& a, const Plane& b, double r, Vec3 p) {
    const double u = dot(a.normal, p) - a.offset;
    const double v = dot(b.normal, p) - b.offset;
    const double c = dot(a.normal, b.normal);
    // From the centre, which is at u = v = r, by the dual basis of the two normals.
    const double x = ((u - r) - c * (v - r)) / (1 - c * c);
    const double y = ((v - r) - c * (u - r)) / (1 - c * c);
    return u >= 0 && v >= 0 && x <= 0 && y <= 0 && x * x + y * y + 2 * x * y * c >= r * r;
}

TEST_CASE("vertices: a groove that ends at a tip is cut there by the walls next to it") {
    const Vec3 tip{0, 0, 14};
    const double r = 1.5;
    for (const Vec2 notch : {Vec2{3, 3}, Vec2{2.5, 3.5}, Vec2{3.5, 3}}) {
        const std::vector<Vec2> base{{10, 0}, notch, {0, 10}, {-10, 0}, {0, -10}};
        std::vector<Plane> others = planes_of(base, tip.z, 0.0);
        const Plane a = others[1];
        const Plane b = others[2];
        others.erase(others.begin() + 1, others.begin() + 3);
        const csg::Solid sharp = test::pyramid(base, tip.z);
        const csg::Solid around = cut(centred_block(60, 60, 60), sharp);
        Traced pyramid(blended(sharp, Edges::concave, ball(r), 1));
        Form only = ball(r);
        only.near = Vec3{notch.x / 2, notch.y / 2, 7};
        Traced mould(blended(around, Edges::convex, only, 1));
        std::mt19937_64 random(4);
        std::uniform_real_distribution<double> any(-1, 1);
        std::size_t filled = 0;
        std::size_t wrong = 0;
        for (int i = 0; i < 40000; ++i) {
            const double size = i % 2 == 0 ? 11 : 1.5;  // half of them about the tip
            const Vec3 middle = i % 2 == 0 ? Vec3{0, 0, 6} : tip;
            const Vec3 p = middle + Vec3{any(random), any(random), any(random)} * size;
            bool is_in = true;
            for (const Plane& wall : others) is_in = is_in && dot(wall.normal, p) < wall.offset;
            const bool is_solid = dot(a.normal, p) < a.offset || dot(b.normal, p) < b.offset;
            const bool is_filled = is_in_fillet(a, b, r, p);
            filled += is_in && !is_solid && is_filled ? 1 : 0;
            is_in = is_in && (is_solid || is_filled);
            wrong += (pyramid.where(p) != solids::Where::out) != is_in ? 1 : 0;
            wrong += (mould.where(p) != solids::Where::out) != !is_in ? 1 : 0;
        }
        CHECK(filled > 20);
        CHECK(wrong == 0);
    }
}

TEST_CASE("vertices: a filleted boss and a rounded notch meet; in every frame alike") {
    std::size_t edges = 0;
    Traced here(meeting({}, 1, edges));
    CHECK(edges > 4);
    const Affine maps[] = {
        reflection({1, 0, 0}),          reflection({1, 2, 3}),
        scaling({1e-3, 1e-3, 1e-3}),    scaling({1e3, 1e3, 1e3}),
        rotation(unit({1, 2, -1}), 77), translation({1e4, -1e4, 3e3}) * rotation({0, 0, 1}, 90),
    };
    for (const Affine& map : maps) {
        const double scale = norm(map.linear.column(0));
        std::size_t there_edges = 0;
        Traced there(meeting(map, scale, there_edges));
        CHECK(edges == there_edges);
        std::size_t differences = 0;
        for (int i = 0; i < 20000; ++i) {
            const auto part = [&](double x) { return std::fmod(i * x + 0.5, 1.0); };
            const Vec3 p = Vec3{1.5, 1.5, 2.5} +
                           2.5 * Vec3{part(0.8191725134), part(0.6710436067), part(0.5497004779)};
            differences += here.where(p) != there.where(map(p)) ? 1 : 0;
        }
        CHECK(differences == 0);
    }
}

}  // namespace
}  // namespace raymo::blends
