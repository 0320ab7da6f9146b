#include "raymo/curves/region.hpp"

#include <doctest/doctest.h>

#include <numbers>
#include <random>

#include "raymo/curves/samples.hpp"

namespace raymo::curves {
namespace {

RegionPtr region_of(const OutlinePtr& outline) {
    auto made = Region::make(*outline, {0, 0}, 1.0);
    REQUIRE(made.has_value());
    return *made;
}

TEST_CASE("arcs lie on their circle to the last bits") {
    const Curve circle = full_circle({3, -1}, 5.0);
    for (const Span2& span : circle.spans) {
        for (int i = 0; i <= 100; ++i)
            CHECK(norm(point_at(span, 0.01 * i) - Vec2{3, -1}) ==
                  doctest::Approx(5.0).epsilon(1e-15));
    }
    CHECK(circle.spans[0].point(3) == circle.spans[1].point(0));
}

TEST_CASE("areas: disc, polygon, spline") {
    CHECK(region_of(sample_disc())->signed_area() ==
          doctest::Approx(25.0 * std::numbers::pi).epsilon(1e-14));
    CHECK(region_of(sample_rectangle())->signed_area() == doctest::Approx(9.0).epsilon(1e-14));
    // Around the control square of a B-spline: 4 spans, by hand 1 - 2 * 11/60 ... of its area; here from a fine polygon.
    const std::array<Vec2, 4> square{Vec2{0, 0}, {6, 0}, {6, 6}, {0, 6}};
    const Curve curve = closed_bspline(square);
    double area = 0.0;
    constexpr int kSteps = 4000;
    for (const Span2& span : curve.spans) {
        for (int i = 0; i < kSteps; ++i) {
            area += 0.5 * cross(point_at(span, static_cast<double>(i) / kSteps),
                                point_at(span, static_cast<double>(i + 1) / kSteps));
        }
    }
    auto region = Region::make({{curve}, Fill::even_odd}, {0, 0}, 1.0);
    REQUIRE(region.has_value());
    CHECK((*region)->signed_area() == doctest::Approx(area).epsilon(1e-6));
}

TEST_CASE("pieces are monotone and hang together") {
    for (const OutlinePtr& outline :
         {sample_loop(), sample_rosette(), sample_washer(), sample_disc()}) {
        const RegionPtr region = region_of(outline);
        for (const Piece& piece : region->pieces()) {
            const Piece& next = region->pieces()[piece.next];
            CHECK(piece.x[3] == next.x[0]);
            CHECK(piece.y[3] == next.y[0]);
            CHECK(&region->pieces()[next.previous] == &piece);
            Vec2 last = piece.point(0);
            const Vec2 way = piece.point(3) - last;
            for (int i = 1; i <= 64; ++i) {
                const Vec2 at = point_at(piece, i / 64.0);
                CHECK((at.x - last.x) * way.x >= -1e-12);
                CHECK((at.y - last.y) * way.y >= -1e-12);
                last = at;
            }
        }
    }
}

TEST_CASE("points: circles with holes, stars by both rules") {
    const RegionPtr washer = region_of(sample_washer());
    const Vec2 e{1e-12, 1e-12};
    CHECK(washer->where({0, 5}, e) == Side::in);
    CHECK(washer->where({-4, 0}, e) == Side::out);
    CHECK(washer->where({4, 0}, e) == Side::in);
    CHECK(washer->where({4, 2}, e) == Side::out);
    CHECK(washer->where({10, 0}, e) == Side::on);
    CHECK(washer->where({-2, 1}, e) == Side::on);
    CHECK(washer->where({20, 0}, e) == Side::out);
    CHECK(region_of(sample_pentagram(Fill::even_odd))->where({0, 0}, e) == Side::out);
    CHECK(region_of(sample_pentagram(Fill::non_zero))->where({0, 0}, e) == Side::in);
    // Against a fine polygon.
    const OutlinePtr outline = sample_rosette();
    const RegionPtr rosette = region_of(outline);
    std::vector<Vec2> polygon;
    for (const Span2& span : outline->curves[0].spans) {
        for (int i = 0; i < 500; ++i) polygon.push_back(point_at(span, i / 500.0));
    }
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> any(-12.0, 12.0);
    int judged = 0;
    for (int n = 0; n < 3000; ++n) {
        const Vec2 p = Vec2{20, 7} + Vec2{any(random), any(random)};
        bool inside = false;
        double nearest = Aabb::kInf;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Vec2 a = polygon[i];
            const Vec2 b = polygon[(i + 1) % polygon.size()];
            nearest = std::min(nearest, norm(a - p));
            if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y)) {
                inside = !inside;
            }
        }
        if (nearest < 0.02) continue;
        ++judged;
        CHECK(rosette->where(p, e) == (inside ? Side::in : Side::out));
    }
    CHECK(judged > 2500);
}

TEST_CASE("support is the furthest point, normals are at right angles to the curve") {
    const RegionPtr disc = region_of(sample_disc());
    for (int i = 0; i < 360; i += 7) {
        const double angle = i * std::numbers::pi / 180.0;
        const Vec2 n{std::cos(angle), std::sin(angle)};
        CHECK(disc->support(n) == doctest::Approx(5.0).epsilon(1e-14));
        const Vec2 normal = disc->normal(n * 5.0, 0, 1000);
        CHECK(cross(normal, n) == doctest::Approx(0.0).epsilon(1e-9 * norm(normal)));
        CHECK(dot(normal, n) > 0.0);  // the circle turns left, so its right is outside
    }
    CHECK(disc->runs() == 1);
    CHECK(region_of(sample_rectangle())->runs() == 4);
}

TEST_CASE(
    "pieces of a smooth curve that meet, but at a joint between them, are told apart by their "
    "stretches") {
    // A figure of eight that passes the origin twice at joints, and one that crosses itself between joints.
    for (const bool at_joints : {true, false}) {
        Curve eight;
        if (at_joints) {
            eight.spans = {cubic({0, 0}, {9, 9}, {9, -9}, {0, 0}),
                           cubic({0, 0}, {-9, 9}, {-9, -9}, {0, 0})};
        } else {
            eight.spans = {cubic({-1, -1}, {7, 7}, {9, -8}, {1, 0}),
                           cubic({1, 0}, {-7, 8}, {-9, -9}, {-1, -1})};
        }
        eight.closed = true;
        const auto region = *Region::make({{eight}, Fill::even_odd}, {0, 0}, 1.0);
        const auto& pieces = region->pieces();
        int met = 0;
        for (std::uint32_t i = 0; i < pieces.size(); ++i) {
            for (std::uint32_t k = 0; k < i; ++k) {
                if (pieces[i].next == k || pieces[k].next == i) continue;
                bool meets = false;
                for (double u = 0.0; u <= 1.0; u += 0x1p-7) {
                    for (double v = 0.0; v <= 1.0; v += 0x1p-7) {
                        const Vec2 apart = point_at(pieces[i], u) - point_at(pieces[k], v);
                        meets = meets || max_norm(apart) < 0.1;
                    }
                }
                if (!meets) continue;
                ++met;
                CHECK(pieces[i].run != pieces[k].run);
            }
        }
        CHECK(met > 0);
    }
}

TEST_CASE("what encloses nothing is refused") {
    Curve point;
    point.spans = {segment({1, 1}, {1, 1})};
    point.closed = true;
    CHECK_FALSE(Region::make({{point}, Fill::even_odd}, {0, 0}, 1.0).has_value());
    Curve open;
    open.spans = {segment({1, 1}, {2, 1})};
    const auto refused = Region::make({{open}, Fill::even_odd}, {0, 0}, 1.0);
    REQUIRE_FALSE(refused.has_value());
    CHECK(refused.error().hint.find("closed: true") != std::string::npos);
    Curve infinite;
    infinite.spans = {segment({1, 1}, {2, 1}), segment({2, 1}, {Aabb::kInf, 5}),
                      segment({Aabb::kInf, 5}, {1, 1})};
    infinite.closed = true;
    CHECK_FALSE(Region::make({{infinite}, Fill::even_odd}, {0, 0}, 1.0).has_value());
}

TEST_CASE("what has no width encloses nothing") {
    const auto made = [](std::initializer_list<Vec2> points, Fill fill) {
        return Region::make({{closed_polygon(std::vector<Vec2>(points))}, fill}, {0, 0}, 1.0);
    };
    for (const Fill fill : {Fill::even_odd, Fill::non_zero}) {
        // Points in a line, level and leaning; there and back along two sides of a square.
        CHECK_FALSE(made({{0, 0}, {1, 0}, {2, 0}}, fill).has_value());
        CHECK_FALSE(made({{0, 0}, {3, 1}, {1, 1.0 / 3}}, fill).has_value());
        CHECK_FALSE(made({{0, 0}, {1, 0}, {1, 1}, {1, 0}}, fill).has_value());
        // A figure of eight has no area by its senses; a sliver little; a triangle with a tail some.
        CHECK(made({{0, 0}, {2, 2}, {2, 0}, {0, 2}}, fill).has_value());
        CHECK(made({{0, 0}, {1, 0}, {1, 1e-9}}, fill).has_value());
        CHECK(made({{0, 0}, {1, 0}, {1, 1}, {1, 9}, {1, 1}}, fill).has_value());
    }
}

}  // namespace
}  // namespace raymo::curves
