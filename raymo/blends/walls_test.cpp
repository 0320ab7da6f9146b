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

}  // namespace
}  // namespace raymo::blends
