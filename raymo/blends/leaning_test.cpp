// Blends at the walls of conic sweeps, whose rulings run to an apex.
#include "raymo/blends/section.hpp"
#include "raymo/blends/surface.hpp"
#include "raymo/blends/test_blends.hpp"

namespace raymo::blends {
namespace {

using namespace test;

/// A closed curve without a corner, convex but for one side, that runs counter-clockwise.
std::vector<curves::Span2> blob() {
    return {curves::cubic({6, 0}, {6, 3}, {4, 5}, {0, 4}),
            curves::cubic({0, 4}, {-4, 3}, {-5, 3}, {-6, 0}),
            curves::cubic({-6, 0}, {-7, -3}, {-3, -5}, {0, -4}),
            curves::cubic({0, -4}, {3, -3}, {6, -3}, {6, 0})};
}
/// A circle about (x, 0), by quarters.
std::vector<curves::Span2> circle(double radius, double x) {
    std::vector<curves::Span2> out;
    const double k = std::sqrt(0.5);
    Vec2 from{1, 0};
    for (int i = 0; i < 4; ++i) {
        const Vec2 to{-from.y, from.x};
        curves::Span2 span = conic_arc(from, from + to, to, k);
        out.push_back(curves::mapped(span, {.xx = radius, .x = x, .yy = radius}));
        from = to;
    }
    return out;
}
Vec2 point_of(const curves::Span2& s, double u) {
    const double v = 1.0 - u;
    const double b[4] = {v * v * v, 3 * v * v * u, 3 * v * u * u, u * u * u};
    Vec2 p;
    double w = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
        p += Vec2{s.x[i], s.y[i]} * b[i];
        w += s.w[i] * b[i];
    }
    return p * (1.0 / w);
}

/// A rectangle with round corners, whose lower left corner is at (x, y).
std::vector<curves::Span2> rounded_rectangle(double x, double y) {
    const std::vector<curves::Span2> arcs = circle(1.0, 0.0);
    const Vec2 centres[] = {{x + 7, y + 5}, {x + 1, y + 5}, {x + 1, y + 1}, {x + 7, y + 1}};
    std::vector<curves::Span2> out;
    for (std::size_t i = 0; i < 4; ++i) {
        out.push_back(
            curves::mapped(arcs[i], {.xx = 1, .x = centres[i].x, .yy = 1, .y = centres[i].y}));
        const Vec2 next = point_of(arcs[(i + 1) % 4], 0.0) + centres[(i + 1) % 4];
        out.push_back(curves::segment(point_of(out.back(), 1.0), next));
    }
    return out;
}
csg::Solid conic(std::vector<curves::Span2> spans, double height, double top) {
    curves::Outline outline;
    outline.curves.push_back({std::move(spans), true});
    return made("conic",
                {std::make_shared<const curves::Outline>(std::move(outline)), height, top, false});
}

TEST_CASE("leaning walls: a circle about the axis is a cone") {
    Surface pointed;
    pointed.kind = SurfaceKind::cone;
    pointed.point = {1, 2, 9};
    pointed.axis = {0, 0, -1};
    pointed.sine = 0.6;
    pointed.cosine = 0.8;
    Surface wall;
    wall.kind = SurfaceKind::leaning;
    wall.height = 8.0;
    wall.axis = pointed.axis;
    wall.point = pointed.point + pointed.axis * wall.height;
    wall.across = {1, 0, 0};
    wall.up = {0, 1, 0};
    wall.run = std::make_shared<const Run>(circle(6.0, 0.0), true);
    for (int i = 0; i < 2000; ++i) {
        // Spread by multiples of irrational numbers.
        const auto part = [&](double step) { return std::fmod(i * step, 1.0); };
        const Vec3 p{20 * part(0.61803) - 9, 20 * part(0.75487) - 8, 8.5 - 14 * part(0.56984)};
        CAPTURE(i);
        CHECK(std::fabs(wall.distance(p) - pointed.distance(p)) < 1e-12);
        CHECK(norm(wall.normal(p) - pointed.normal(p)) < 1e-11);
    }
}

/// A boss with leaning walls on a plate whose top is z = 0, with a fillet of radius r. The balls' centres are all at z = r: from the
/// plate on up to there, the fillet is what lies below a ball about the nearest of them.
class Boss {
public:
    Boss(std::vector<curves::Span2> spans, double height, double top, double radius)
        : spans_(std::move(spans)), apex_(height / (1.0 - top)), height_(height), radius_(radius) {}

    /// How high the solid is above a place: to 1e-10 where `is_wall` comes out false, else by the contour as a polygon.
    [[nodiscard]] double high(Vec2 p, bool& is_wall) const {
        is_wall = false;
        double near = std::numeric_limits<double>::infinity();
        Foot foot;
        for (const curves::Span2& span : spans_) {
            for (int i = 0; i < 400; ++i) {
                const Foot f = foot_at(span, (i + 0.5) / 400);
                if (norm(f.centre - p) < near) {
                    near = norm(f.centre - p);
                    foot = f;
                }
            }
        }
        for (double h = 1.0 / 400; h > 1e-10; h *= 0.5) {
            for (const double u : {foot.u - h, foot.u + h}) {
                const Foot f = foot_at(*foot.span, std::clamp(u, 0.0, 1.0));
                if (norm(f.centre - p) < near) {
                    near = norm(f.centre - p);
                    foot = f;
                }
            }
        }
        // Towards the wall from the centre, and as far as the contact.
        const double towards = -dot(p - foot.centre, foot.outward);
        if (towards < 0.0) return 0.0;
        if (towards <= foot.reach) return radius_ - std::sqrt(radius_ * radius_ - near * near);
        is_wall = true;
        return wall(p);
    }

private:
    struct Foot {
        const curves::Span2* span = nullptr;
        double u = 0.0;
        Vec2 centre, outward;
        double reach = 0.0;  ///< from the centre to the contact, seen from above
    };
    [[nodiscard]] Foot foot_at(const curves::Span2& span, double u) const {
        const Vec2 b = point_of(span, u);
        const double h = 1e-5;
        const Vec2 w = point_of(span, u + h) - point_of(span, u - h);
        const Vec2 right = Vec2{w.y, -w.x} * (1.0 / norm(w));
        // Across the ruling from (b, 0) to (0, apex).
        const Vec3 n = unit(Vec3{right.x, right.y, dot(right, b) / apex_});
        // (b, 0) (1 - t) + (0, apex) t + r n at the height r.
        const double t = radius_ * (1.0 - n.z) / apex_;
        Foot f;
        f.span = &span;
        f.u = u;
        f.centre = b * (1.0 - t) + Vec2{n.x, n.y} * radius_;
        f.outward = right;
        f.reach = radius_ * dot(Vec2{n.x, n.y}, right);
        return f;
    }
    /// Where the wall is above a place: the contour, scaled about the axis, runs through it.
    [[nodiscard]] double wall(Vec2 p) const {
        double lo = 0.0;
        double hi = height_;
        const auto inside = [&](double z) { return winds(p * (1.0 / (1.0 - z / apex_))); };
        if (!inside(lo)) return 0.0;
        if (inside(hi)) return height_;
        for (int i = 0; i < 30; ++i) {
            const double z = 0.5 * (lo + hi);
            (inside(z) ? lo : hi) = z;
        }
        return lo;
    }
    [[nodiscard]] bool winds(Vec2 p) const {
        double sum = 0.0;
        for (const curves::Span2& span : spans_) {
            for (int i = 0; i < 250; ++i) {
                const Vec2 a = point_of(span, i / 250.0) - p;
                const Vec2 b = point_of(span, (i + 1) / 250.0) - p;
                sum += std::atan2(cross(a, b), dot(a, b));
            }
        }
        return sum > kPi;
    }

    std::vector<curves::Span2> spans_;
    double apex_, height_, radius_;
};

TEST_CASE("leaning walls: the fillet of a boss is what its balls leave") {
    struct Case {
        std::vector<curves::Span2> spans;
        double height, top, radius;
    };
    const Case cases[] = {{blob(), 9.0, 0.7, 1.0},
                          {blob(), 7.0, 0.0, 0.5},
                          {circle(3.0, 2.0), 8.0, 0.5, 1.5},
                          {rounded_rectangle(0, 0), 5.0, 0.7, 0.3},
                          {rounded_rectangle(-4, -3), 5.0, 0.7, 0.6}};
    const Affine frames[] = {{},
                             rotation(unit(Vec3{1, 2, 3}), 50) * scaling({3, 3, 3}),
                             reflection(unit(Vec3{1, 1, 0})) * translation({9, 0, 4})};
    for (const Case& c : cases) {
        const Boss boss(c.spans, c.height, c.top, c.radius);
        for (const Affine& frame : frames) {
            const double size = norm(frame.linear.column(0));
            CAPTURE(c.height);
            CAPTURE(size);
            const csg::Solid plate = move(centred_block(40, 40, 2), {0, 0, -1});
            Traced solid(
                blended(csg::Op::unite,
                        {mapped(plate, frame), mapped(conic(c.spans, c.height, c.top), frame)},
                        ball(c.radius * size), 1));
            std::size_t judged = 0;
            for (int i = 0; i < 400; ++i) {
                const Vec2 p{16 * std::fmod(i * 0.61803, 1.0) - 8,
                             12 * std::fmod(i * 0.75487, 1.0) - 6};
                bool is_wall = false;
                const double truth = boss.high(p, is_wall);
                judged += truth > 0.0 && !is_wall ? 1 : 0;
                CAPTURE(p.x);
                CAPTURE(p.y);
                const double chord =
                    solid.chord(frame(Vec3{p.x, p.y, 0}), unit(frame.linear * Vec3{0, 0, 1}));
                CHECK(chord / size == doctest::Approx(2.0 + truth).epsilon(is_wall ? 1e-4 : 1e-9));
            }
            CHECK(judged > 8);
        }
    }
}

/// Stretched by so little that only its kind is another.
TEST_CASE("leaning walls: a rounded cone that is told as free") {
    const Affine stretch = scaling({1.0 + 0x1p-30, 1.0, 1.0});
    const csg::Solid free = mapped(conic(circle(5.0, 0.0), 8.0, 0.5), stretch);
    Traced one(blended(free, Edges::convex, ball(0.75), 2));
    Traced other(blended(cone(5.0, 2.5, 8.0), Edges::convex, ball(0.75), 2));
    for (int i = 0; i < 300; ++i) {
        const Vec3 from{10 * std::fmod(i * 0.61803, 1.0) - 5, 10 * std::fmod(i * 0.75487, 1.0) - 5,
                        -1};
        const Vec3 way = unit(Vec3{0.3 * std::fmod(i * 0.34729, 1.0) - 0.1, 0.2, 1.0});
        CAPTURE(i);
        // Lines that graze it differ by the root of the stretch.
        const double truth = other.chord(from, way);
        if (truth < 0.5) continue;
        CHECK(one.chord(from, way) == doctest::Approx(truth).epsilon(2e-8));
    }
}

/// All edges and corners of a sweep with one bowed wall; it leans by so little that it is a prism but for 1e-6.
TEST_CASE("leaning walls: edges along rulings, and corners") {
    for (const double lean : {1e-6, 1e-7, 1e-8}) {
        // However far away the apex is.
        const csg::Solid aside = conic(circle(4.0, 1.0), 5.0, 1.0 - lean);
        CHECK(blended_edges(aside, Edges::convex, ball(0.4)).has_value());
    }
    const std::vector<curves::Span2> bowed{
        curves::cubic({0, 0}, {3, 3}, {7, 3}, {10, 0}), curves::segment({10, 0}, {10, 10}),
        curves::segment({10, 10}, {0, 10}), curves::segment({0, 10}, {0, 0})};
    curves::Outline outline;
    outline.curves.push_back({bowed, true});
    const csg::Solid upright =
        made("prism", {std::make_shared<const curves::Outline>(outline), 5.0, false});
    Traced one(blended(conic(bowed, 5.0, 1.0 - 1e-6), Edges::convex, ball(0.8), 12));
    Traced other(blended(upright, Edges::convex, ball(0.8), 12));
    for (int i = 0; i < 500; ++i) {
        const Vec3 from{10 * std::fmod(i * 0.61803, 1.0), 10 * std::fmod(i * 0.75487, 1.0), -1};
        CAPTURE(from.x);
        CAPTURE(from.y);
        const double truth = other.chord(from, {0, 0, 1});
        if (truth < 3.0) continue;
        CHECK(one.chord(from, {0, 0, 1}) == doctest::Approx(truth).epsilon(1e-4));
    }
}

}  // namespace
}  // namespace raymo::blends
