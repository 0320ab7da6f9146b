// Edges between the walls of one contour, some of them free-form: upright in a prism, circles about the axis of a revolve.
#include "raymo/blends/test_blends.hpp"

namespace raymo::blends {
namespace {

using namespace test;

csg::Solid over(const char* sweep, std::vector<curves::Span2> spans, double size) {
    curves::Outline outline;
    outline.curves.push_back({std::move(spans), true});
    auto shared = std::make_shared<const curves::Outline>(std::move(outline));
    return std::string_view(sweep) == "prism" ? made("prism", {std::move(shared), size, false})
                                              : made(sweep, {std::move(shared), size});
}

/// Depth of a round at the distance u from the edge, at right angles.
double rise(double r, double u) { return u >= r ? 0.0 : r - std::sqrt(r * r - (r - u) * (r - u)); }

constexpr double kHigh = 5.0;
constexpr double kRadius = 0.8;

/// The cubic (0,0), (3,3), (7,3), (10,0): what the tests know of it they work out from its polynomials.
struct Bow {
    static Vec2 at(double u) { return {9 * u + 3 * u * u - 2 * u * u * u, 9 * u - 9 * u * u}; }
    static Vec2 way(double u) { return {9 + 6 * u - 6 * u * u, 9 - 18 * u}; }
    /// Unit, upwards.
    static Vec2 normal(double u) {
        const Vec2 w = way(u);
        return Vec2{-w.y, w.x} * (1.0 / norm(w));
    }
    /// How far a point is above it.
    static double above(Vec2 p) {
        double lo = 0.0;
        double hi = 1.0;
        for (int i = 0; i < 60; ++i) {
            const double u = 0.5 * (lo + hi);
            (dot(p - at(u), way(u)) > 0.0 ? lo : hi) = u;
        }
        return dot(p - at(lo), normal(lo));
    }
};
/// A square of side 10, whose lower side is the bow.
std::vector<curves::Span2> bowed() {
    return {curves::cubic({0, 0}, {3, 3}, {7, 3}, {10, 0}), curves::segment({10, 0}, {10, 10}),
            curves::segment({10, 10}, {0, 10}), curves::segment({0, 10}, {0, 0})};
}
/// The circle of radius r that touches the bow at u and the left side of the square.
struct Corner {
    Vec2 centre, on_bow, on_side;
};
Corner left_corner(double r) {
    double lo = 0.0;
    double hi = 0.5;
    for (int i = 0; i < 60; ++i) {
        const double u = 0.5 * (lo + hi);
        ((Bow::at(u) + Bow::normal(u) * r).x < r ? lo : hi) = u;
    }
    const Vec2 c = Bow::at(lo) + Bow::normal(lo) * r;
    return {c, Bow::at(lo), {0.0, c.y}};
}
/// Whether a point is past the circle, towards the corner.
bool is_past(const Corner& corner, Vec2 p) {
    const Vec2 d = p - corner.centre;
    const double turn = cross(corner.on_side - corner.centre, corner.on_bow - corner.centre);
    return cross(corner.on_side - corner.centre, d) * turn > 0.0 &&
           cross(d, corner.on_bow - corner.centre) * turn > 0.0;
}

TEST_CASE("walls: upright edges of a free-form prism") {
    Form form = ball(kRadius);
    form.where = move(centred_block(30, 30, 0.5), {5, 5, 0.5 * kHigh});
    Traced solid(blended(over("prism", bowed(), kHigh), Edges::convex, form, 4));
    const Corner left = left_corner(kRadius);
    std::size_t cut_off = 0;
    for (double x = 0.0017; x < 5.0; x += 0.0411) {
        for (double y = 0.0023; y < 5.0; y += 0.0407) {
            const Vec2 p{x, y};
            if (std::fabs(Bow::above(p)) < 1e-9) continue;
            const bool is_off = is_past(left, p) && norm(p - left.centre) > kRadius;
            const bool is_in = Bow::above(p) > 0.0 && !is_off;
            CAPTURE(x);
            CAPTURE(y);
            cut_off += is_off && Bow::above(p) > 0.0 ? 1 : 0;
            CHECK(solid.chord({x, y, 0}, {0, 0, 1}) == near(is_in ? kHigh : 0.0));
        }
    }
    CHECK(cut_off > 50);
    // The wall goes over into the blend without a step or a bend.
    for (const double h : {-1e-4, 1e-4}) {
        const double x = left.on_bow.x + h;
        const auto& spans = solid.along({x, 0, 2}, {0, 1, 0});
        REQUIRE(!spans.empty());
        const Vec2 there{x, spans.front().enter.t};
        CHECK(std::fabs(Bow::above(there)) < 2.0 * h * h);
    }
}

TEST_CASE("walls: all edges of a free-form prism, with balls in its corners") {
    Traced solid(blended(over("prism", bowed(), kHigh), Edges::convex, ball(kRadius), 12));
    const Corner left = left_corner(kRadius);
    const double r = kRadius;
    std::size_t balls = 0;
    for (double x = 0.0117; x < 5.0; x += 0.0911) {
        for (double y = 0.0123; y < 5.0; y += 0.0907) {
            const Vec2 p{x, y};
            const double above = Bow::above(p);
            if (std::fabs(above) < 1e-6) continue;
            CAPTURE(x);
            CAPTURE(y);
            double half = 0.0;
            if (is_past(left, p)) {
                const double d = norm(p - left.centre);
                if (std::fabs(d - r) < 1e-6) continue;
                balls += d < r ? 1 : 0;
                half = d < r ? 0.5 * kHigh - r + std::sqrt(r * r - d * d) : 0.0;
            } else if (above > 0.0) {
                const double d = std::min(std::min(x, above), r);
                half = 0.5 * kHigh - r + std::sqrt(r * r - (r - d) * (r - d));
            }
            CHECK(solid.chord({x, y, 0}, {0, 0, 1}) == doctest::Approx(2.0 * half).epsilon(1e-7));
        }
    }
    CHECK(balls > 20);
}

/// The same in every frame, with other surfaces' wedges made of other frames' curves.
TEST_CASE("walls: a pocket, two walls of free form, and in other frames") {
    const std::vector<curves::Span2> lens{curves::cubic({0, 0}, {3, -3}, {7, -3}, {10, 0}),
                                          curves::cubic({10, 0}, {7, 3}, {3, 3}, {0, 0})};
    const Affine maps[] = {{},
                           reflection({1, 0, 0}),
                           rotation(unit({1, 2, -1}), 77),
                           scaling({7, 7, 7}),
                           translation({1e3, -1e3, 3e2}) * rotation({0, 0, 1}, 90)};
    for (const Affine& map : maps) {
        const double scale = norm(map.linear.column(0));
        const csg::Solid prism = mapped(over("prism", lens, 4), map);
        Traced lone(blended(prism, Edges::convex, ball(0.5 * scale), 6));
        const csg::Solid plate = mapped(move(block(20, 20, 4), {-5, -10, -3}), map);
        const csg::Solid pocket = csg::boolean(csg::Op::difference, {plate, prism});
        Traced hollow(blended(pocket, Edges::concave, ball(0.5 * scale), 4));
        // The circle that touches both walls of the tip is on the axis.
        double lo = 0.0;
        double hi = 0.5;
        const auto wall = [](double u) {
            return Vec2{9 * u + 3 * u * u - 2 * u * u * u, 9 * u * u - 9 * u};
        };
        const auto inner = [](double u) {
            const Vec2 w{9 + 6 * u - 6 * u * u, 18 * u - 9};
            return Vec2{-w.y, w.x} * (1.0 / norm(w));
        };
        for (int i = 0; i < 60; ++i) {
            const double u = 0.5 * (lo + hi);
            ((wall(u) + inner(u) * 0.5).y > 0.0 ? lo : hi) = u;
        }
        const double centre = (wall(lo) + inner(lo) * 0.5).x;
        std::size_t judged = 0;
        for (int i = 0; i < 4000; ++i) {
            const auto part = [&](double x) { return std::fmod(i * x + 0.5, 1.0); };
            // About the tip, and between bottom (z = 0) and half way up.
            const Vec3 p{centre * part(0.8191725134), 0.8 * part(0.6710436067) - 0.4,
                         0.9 * part(0.5497004779)};
            // Past the centre towards the tip: between the contacts of the ball.
            const Vec2 d{p.x - centre, p.y};
            const Vec2 contact = wall(lo) - Vec2{centre, 0.0};
            if (!(d.x < 0.0 && std::fabs(d.y) * -contact.x < -contact.y * -d.x)) continue;
            // Within the lens.
            double a = 0.0;
            double b = 0.5;
            for (int k = 0; k < 60; ++k) {
                const double u = 0.5 * (a + b);
                (wall(u).x < p.x ? a : b) = u;
            }
            if (!(std::fabs(p.y) < -wall(a).y - 1e-6)) continue;
            const double from_axis = norm(d);
            const double up = std::min(p.z - 0.5, 0.0);
            const double off = std::hypot(from_axis, up) - 0.5;
            if (std::fabs(off) < 1e-6) continue;
            ++judged;
            CAPTURE(p.x);
            CAPTURE(p.y);
            CAPTURE(p.z);
            CHECK((lone.where(map(p)) == solids::Where::in) == (off < 0.0));
            CHECK((hollow.where(map(p)) == solids::Where::in) == (off > 0.0));
        }
        CHECK(judged > 500);
    }
}

TEST_CASE("walls: circles of a turned free-form contour") {
    // The bow is turned about the axis at the distance 5 from its left corner.
    std::vector<curves::Span2> spans = bowed();
    for (curves::Span2& span : spans) span = curves::mapped(span, {.x = 5.0});
    Traced solid(blended(over("revolve", spans, 360), Edges::convex, ball(kRadius), 4));
    const Corner left = left_corner(kRadius);
    for (double x = 0.0117; x < 5.0; x += 0.0911) {
        for (double y = 0.0123; y < 5.0; y += 0.0907) {
            const Vec2 p{x, y};
            const bool is_off = is_past(left, p) && norm(p - left.centre) > kRadius;
            if (std::fabs(Bow::above(p)) < 1e-6) continue;
            CAPTURE(x);
            CAPTURE(y);
            const double angle = 40.0 * x + y;
            const Vec3 at{(x + 5) * std::cos(angle), (x + 5) * std::sin(angle), y};
            CHECK((solid.where(at) == solids::Where::in) == (Bow::above(p) > 0.0 && !is_off));
        }
    }
}

TEST_CASE("walls: chamfers and conics between walls of free form") {
    Form form = ball(kRadius);
    form.near = Vec3{0, 0, 2};
    const Corner left = left_corner(kRadius);
    form.profile = Profile::chamfer;
    Traced flat(blended(over("prism", bowed(), kHigh), Edges::convex, form, 1));
    form.profile = Profile::conic;
    Traced bent(blended(over("prism", bowed(), kHigh), Edges::convex, form, 1));
    const Vec2 chord = left.on_bow - left.on_side;
    for (double part = 0.1; part < 0.95; part += 0.1) {
        const Vec2 p = left.on_side + chord * part;
        // From the corner's side, across the chord.
        const Vec2 in = Vec2{chord.y, -chord.x} * (1.0 / norm(chord));
        const double side = dot(in, left.centre - p) > 0.0 ? 1.0 : -1.0;
        const Vec3 way{side * in.x, side * in.y, 0};
        const double depth = flat.first({p.x - way.x, p.y - way.y, 2}, way);
        CHECK(depth == near(1.0));
        const double before = bent.first({p.x - way.x, p.y - way.y, 2}, way);
        CHECK(before < 1.0);
    }
    // Tangent to the wall at the contact.
    for (const double h : {-1e-4, 1e-4}) {
        const auto& found = bent.along({left.on_bow.x + h, 0, 2}, {0, 1, 0});
        REQUIRE(!found.empty());
        CHECK(std::fabs(Bow::above({left.on_bow.x + h, found.front().enter.t})) < 10.0 * h * h);
    }
}

TEST_CASE("walls: a curve that meets itself in a corner") {
    // The drop (0,0), (12,12), (-12,12), (0,0): x = 36 u (1 - u) (1 - 2 u), y = 36 u (1 - u).
    const std::vector<curves::Span2> drop{curves::cubic({0, 0}, {12, 12}, {-12, 12}, {0, 0})};
    const double r = 0.5;
    Traced solid(blended(over("prism", drop, 5), Edges::convex, ball(r), 5));
    double lo = 0.0;
    double hi = 0.2;
    const auto wall = [](double u) {
        return Vec2{36 * u * (1 - u) * (1 - 2 * u), 36 * u * (1 - u)};
    };
    const auto inner = [](double u) {
        const Vec2 w{36 * (1 - 6 * u + 6 * u * u), 36 * (1 - 2 * u)};
        return Vec2{-w.y, w.x} * (1.0 / norm(w));
    };
    for (int i = 0; i < 60; ++i) {
        const double u = 0.5 * (lo + hi);
        ((wall(u) + inner(u) * r).x < 0.0 ? lo : hi) = u;
    }
    // On the axis the tip ends with the ball, in all heights from ball to ball, and on both rims.
    const double centre = (wall(lo) + inner(lo) * r).y;
    for (const double z : {0.1, 0.3, 0.6, 2.0, 4.4, 4.7, 4.9}) {
        CAPTURE(z);
        const double up = std::max(std::max(r - z, z - (5 - r)), 0.0);
        CHECK(solid.first({0, -1, z}, {0, 1, 0}) - 1.0 ==
              doctest::Approx(centre - std::sqrt(r * r - up * up)).epsilon(1e-9));
        // Where its two halves go over into each other, and beside it.
        for (const double u : {0.45, 0.499, 0.5, 0.501, 0.57}) {
            const double in = r - std::sqrt(r * r - up * up);
            const Vec2 p = wall(u) + inner(u) * in;
            const Vec2 n = inner(u);
            CAPTURE(u);
            CHECK(solid.first({p.x - n.x, p.y - n.y, z}, {n.x, n.y, 0}) ==
                  doctest::Approx(1.0).epsilon(1e-7));
        }
    }
}

TEST_CASE("walls: rims in a corner that is hollow go on into each other") {
    const std::vector<curves::Span2> heart{
        curves::cubic({0, 0}, {2, 3}, {4, 3}, {5, 0}),
        curves::cubic({5, 0}, {6, 3}, {8, 3}, {10, 0}), curves::segment({10, 0}, {10, -8}),
        curves::segment({10, -8}, {0, -8}), curves::segment({0, -8}, {0, 0})};
    const double r = 0.4;
    std::vector<curves::Span2> spans(heart.rbegin(), heart.rend());
    for (curves::Span2& span : spans) span = curves::reversed(span);
    Traced solid(blended(over("prism", spans, 5), Edges::convex, ball(r), 14));
    // How far inside of a lobe, straight on beyond its ends: the nearest place by trying.
    const auto from_lobe = [](const curves::Span2& s, Vec2 p) {
        const auto at = [&](double u) {
            const double v = 1.0 - u;
            const double b[] = {v * v * v, 3 * v * v * u, 3 * v * u * u, u * u * u};
            Vec2 q;
            for (std::size_t i = 0; i < 4; ++i) q += s.point(i) * b[i];
            return q;
        };
        double best = 0.0;
        for (int i = 0; i <= 200; ++i) {
            if (norm(at(i / 200.0) - p) < norm(at(best) - p)) best = i / 200.0;
        }
        for (double h = 1.0 / 200; h > 1e-9; h *= 0.5) {
            for (const double u : {best - h, best + h}) {
                if (u >= 0.0 && u <= 1.0 && norm(at(u) - p) < norm(at(best) - p)) best = u;
            }
        }
        const double h = 1e-6;
        const Vec2 w = at(std::min(best + h, 1.0)) - at(std::max(best - h, 0.0));
        return dot(p - at(best), Vec2{w.y, -w.x} * (1.0 / norm(w)));
    };
    std::size_t judged = 0;
    for (double x = 4.1; x < 5.9; x += 0.0511) {
        for (double y = -0.9; y < 0.9; y += 0.0513) {
            const double h = solid.chord({x, y, 0}, {0, 0, 1});
            const double left = from_lobe(heart[0], {x, y});
            const double right = from_lobe(heart[1], {x, y});
            // The rounds of both walls, run on beyond the corner, are mitred: the nearer one is the other's end.
            const double d = std::max(left, right);
            if (std::fabs(d) < 1e-3) continue;
            CAPTURE(x);
            CAPTURE(y);
            ++judged;
            CHECK(h == doctest::Approx(d > 0.0 ? 5.0 - 2.0 * rise(r, d) : 0.0).epsilon(1e-5));
        }
    }
    CHECK(judged > 200);
}

}  // namespace
}  // namespace raymo::blends
