// Sweeps of circles and rectangles are solids that have kernels of their own: two ways to the same spans.
#include <doctest/doctest.h>

#include <numbers>

#include "raymo/curves/samples.hpp"
#include "raymo/solids/conformance.hpp"

namespace raymo::solids {
namespace {

using conformance::Random;

curves::OutlinePtr outline(std::vector<curves::Curve> curves) {
    return std::make_shared<const curves::Outline>(
        curves::Outline{std::move(curves), curves::Fill::even_odd});
}
curves::Curve rectangle(Vec2 lo, Vec2 hi) {
    const std::array<Vec2, 4> points{lo, {hi.x, lo.y}, hi, {lo.x, hi.y}};
    return curves::closed_polygon(points);
}

/// The spans of a line o + s d that is given in the frame in which the user writes.
template <class K>
SpanList spans_of(const Placed<K>& placed, Vec3 o, Vec3 d, double& shift) {
    const Affine back = inverse(placed.to_object);
    const Vec3 along = back.linear * d;
    Vec3 at = back(o);
    const double dd = dot(along, along);
    shift = -dot(at, along) / dd;
    at += along * shift;
    const double e = 0x1p-48 * (1.0 + max_norm(back(o)));
    SpanList spans;
    placed.kernel.spans(
        {at.x, at.y, at.z, along.x, along.y, along.z, e, e, e, dd, kFromTheBeginning}, spans);
    return spans;
}

template <class P, class Q>
void compare(const std::vector<Argument>& p, const std::vector<Argument>& q, double size,
             int least) {
    const auto a = P::prepare(p);
    const auto b = Q::prepare(q);
    REQUIRE(a.has_value());
    REQUIRE(b.has_value());
    Random random(11);
    int met = 0;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 o = random.in_cube(size);
        Vec3 d = random.direction();
        if (random.chance(0.2)) d.z = 0.0;
        if (random.chance(0.1)) d = {0, 0, 1};
        double shift_a, shift_b;
        const SpanList x = spans_of(*a, o, d, shift_a);
        const SpanList y = spans_of(*b, o, d, shift_b);
        if (x.degenerate() || y.degenerate() || x.touched() || y.touched()) continue;
        REQUIRE(x.size() == y.size());
        met += x.size() > 0 ? 1 : 0;
        for (std::size_t k = 0; k < x.size(); ++k) {
            const auto close = [&](const SpanEnd& e, const SpanEnd& f) {
                CHECK(std::fabs((e.s + shift_a) - (f.s + shift_b)) <=
                      e.error + f.error + 1e-13 * size);
                const auto normal = [&](const auto& placed, const SpanEnd& end, double shift) {
                    const Affine back = inverse(placed.to_object);
                    return unit(transposed_times(
                        back.linear,
                        placed.kernel.normal(back(o + d * (end.s + shift)), end.face)));
                };
                CHECK(norm(normal(*a, e, shift_a) - normal(*b, f, shift_b)) <= 1e-7);
            };
            close(x[k].enter, y[k].enter);
            close(x[k].exit, y[k].exit);
        }
    }
    CHECK(met > least);
}

TEST_CASE("a prism of a circle is a cylinder, of a rectangle a block") {
    compare<Prism, Cylinder>({curves::sample_disc(), 4.0, true}, {5.0, 4.0, true}, 8.0, 3000);
    compare<Prism, Block>({outline({rectangle({-1, -2}, {1, 2})}), 6.0, true},
                          {Vec3{2, 4, 6}, true}, 4.0, 3000);
}

TEST_CASE("a conic sweep of a circle is a cone, whichever end is larger") {
    compare<Conic, Cone>({curves::sample_disc(), 7.0, 0.4, true}, {5.0, 2.0, 7.0, true}, 8.0, 3000);
    compare<Conic, Cone>({curves::sample_disc(), 7.0, 2.0, false}, {5.0, 10.0, 7.0, false}, 12.0,
                         3000);
    compare<Conic, Cone>({curves::sample_disc(), 7.0, 0.0, false}, {5.0, 0.0, 7.0, false}, 8.0,
                         600);
    compare<Conic, Prism>({curves::sample_rosette(), 7.0, 1.0, true},
                          {curves::sample_rosette(), 7.0, true}, 25.0, 600);
}

TEST_CASE("a turned circle is a torus, a half-disc a sphere, a rectangle a cylinder") {
    compare<Revolve, Torus>({outline({curves::full_circle({5, 0}, 2)}), 360.0}, {5.0, 2.0}, 8.0,
                            2000);
    compare<Revolve, Cylinder>({outline({rectangle({0, -2}, {5, 2})}), 360.0}, {5.0, 4.0, true},
                               8.0, 3000);
    curves::Curve half;
    half.spans = {curves::arc({0, 0}, 3, -90, 0), curves::arc({0, 0}, 3, 0, 90)};
    compare<Revolve, Sphere>({outline({half}), 360.0}, {3.0}, 5.0, 2000);
    curves::Curve cone;
    cone.spans = {curves::segment({4, -3}, {1, 3})};
    compare<Revolve, Cone>({outline({cone}), 360.0}, {4.0, 1.0, 6.0, true}, 6.0, 3000);
}

/// Volume by the mean length of the spans of parallel lines in a direction of its own, jittered.
template <class P>
double volume(const std::vector<Argument>& arguments) {
    const auto placed = P::prepare(arguments);
    REQUIRE(placed.has_value());
    Random random(5);
    constexpr int kCells = 500;
    double sum = 0.0;
    for (int i = 0; i < kCells; ++i) {
        for (int j = 0; j < kCells; ++j) {
            const double x = -1.5 + 3.0 * (i + random.uniform(0, 1)) / kCells;
            const double y = -1.5 + 3.0 * (j + random.uniform(0, 1)) / kCells;
            const double e = 0x1p-48;
            // Along z tilted a little, so that no wall is met edge on.
            const Vec3 d{0.1, 0.2, 1.0};
            Vec3 o{x, y, 0.0};
            o -= d * (dot(o, d) / dot(d, d));
            SpanList spans;
            placed->kernel.spans(
                {o.x, o.y, o.z, d.x, d.y, d.z, e, e, e, dot(d, d), kFromTheBeginning}, spans);
            for (std::size_t k = 0; k < spans.size(); ++k)
                sum += spans[k].exit.s - spans[k].enter.s;
        }
    }
    return sum * 9.0 / (kCells * kCells) * determinant(placed->to_object.linear);
}

TEST_CASE("volumes: area times height, and Pappus' rule") {
    const auto area = [](const curves::OutlinePtr& outline) {
        return (*curves::Region::make(*outline, {0, 0}, 1.0))->signed_area();
    };
    const double rosette = area(curves::sample_rosette());
    CHECK(volume<Prism>({curves::sample_rosette(), 12.0, false}) ==
          doctest::Approx(12.0 * rosette).epsilon(1e-3));
    CHECK(volume<Prism>({curves::sample_washer(), 12.0, false}) ==
          doctest::Approx(12.0 * ((100 - 9 + 1) * std::numbers::pi - 16)).epsilon(1e-3));
    CHECK(volume<Conic>({curves::sample_rosette(), 12.0, 0.5, false}) ==
          doctest::Approx(12.0 * rosette * (1 + 0.5 + 0.25) / 3).epsilon(2e-3));
    // The rosette's middle is 20 from the axis, by its symmetry.
    CHECK(volume<Revolve>({curves::sample_rosette(), 360.0}) ==
          doctest::Approx(2 * std::numbers::pi * 20 * rosette).epsilon(1e-3));
    CHECK(volume<Revolve>({curves::sample_rosette(), 100.0}) ==
          doctest::Approx(2 * std::numbers::pi * 20 * rosette * 100 / 360).epsilon(3e-3));
    CHECK(volume<Revolve>({curves::sample_rosette(), 300.0}) ==
          doctest::Approx(2 * std::numbers::pi * 20 * rosette * 300 / 360).epsilon(3e-3));
}

/// The outline that is `margin` wide about a rectangle whose corners are (r, +-c) for two r: arcs at the corners.
curves::OutlinePtr rounded(double near, double far, double c, double margin) {
    curves::Curve curve;
    const auto line = [&](Vec2 a, Vec2 b) { curve.spans.push_back(curves::segment(a, b)); };
    curve.spans.push_back(curves::arc({far, -c}, margin, -90, 0));
    line({far + margin, -c}, {far + margin, c});
    curve.spans.push_back(curves::arc({far, c}, margin, 0, 90));
    line({far, c + margin}, {near, c + margin});
    curve.spans.push_back(curves::arc({near, c}, margin, 90, 180));
    line({near - margin, c}, {near - margin, -c});
    curve.spans.push_back(curves::arc({near, -c}, margin, 180, 270));
    line({near, -c - margin}, {far, -c - margin});
    curve.closed = true;
    return outline({curve});
}

TEST_CASE("a nearly level ray at the height of a joint of a turned contour meets both sides") {
    const double c = 0.6666666666666666;
    const auto ring = Revolve::prepare(std::vector<Argument>{rounded(1.5, 3.0, c, 1.0), 360.0});
    REQUIRE(ring.has_value());
    int judged = 0;
    for (const double joint : {-c, c}) {
        for (int steps = -8; steps <= 8; ++steps) {
            for (const double rise : {0.0, 1e-18, 1e-17, 3e-17, 1e-16, 1e-14, 1e-10}) {
                for (const double sign : {1.0, -1.0}) {
                    const Vec3 o{-10.0, 0.05, joint + steps * 0x1p-53};
                    double shift;
                    const SpanList spans = spans_of(*ring, o, {1.0, 1e-3, sign * rise}, shift);
                    CAPTURE(joint);
                    CAPTURE(steps);
                    CAPTURE(sign * rise);
                    CHECK_FALSE(spans.degenerate());
                    REQUIRE(spans.size() == 2);
                    for (std::size_t k = 0; k < 2; ++k)
                        CHECK(spans[k].exit.s - spans[k].enter.s ==
                              doctest::Approx(3.5).epsilon(0.01));
                    ++judged;
                }
            }
        }
    }
    CHECK(judged == 2 * 17 * 7 * 2);
}

TEST_CASE("a nearly level ray is certain beside a wall that is nearer to the axis") {
    // A hair-thin slope between two heights, which tells by how much a ray was moved.
    const std::array<Vec2, 3> slope{Vec2{0.27, -0.03}, {0.17, -0.03 - 3e-8}, {0.17, -0.1}};
    const auto solid = Revolve::prepare(std::vector<Argument>{
        outline({curves::closed_polygon(slope), rectangle({0.01, -0.5}, {0.6, 0.5})}), 360.0});
    REQUIRE(solid.has_value());
    for (const double rise : {0.0, 1e-18, 1e-17, -1e-17, 1e-16, 1e-12, 1e-9}) {
        for (const double off : {-1e-9, 1e-9, 1e-8}) {
            double shift;
            const SpanList spans =
                spans_of(*solid, {-2.0, 0.15, -0.03 - 3e-8 + off}, {1.0, 0.0, rise}, shift);
            CAPTURE(rise);
            CAPTURE(off);
            CHECK_FALSE(spans.degenerate());
            CHECK_FALSE(spans.touched());
            CHECK(spans.size() == 3);
        }
    }
}

TEST_CASE("a ray along the circle on which a ring is highest is certain next to where it touches") {
    // There it touches to the fourth order: it runs along the circle, and so turns off the contour slowly.
    const auto ring =
        Revolve::prepare(std::vector<Argument>{outline({curves::full_circle({5, 0}, 2)}), 360.0});
    REQUIRE(ring.has_value());
    for (double deep = 1e-1; deep > 1e-9; deep *= 0.3) {
        for (const double rise : {0.0, 1e-3 * deep, -0.1 * deep}) {
            CAPTURE(deep);
            CAPTURE(rise);
            double shift;
            const SpanList spans = spans_of(*ring, {5.0, 0.0, 2.0 - deep}, {0.0, 1.0, rise}, shift);
            REQUIRE(spans.size() == 1);
            CHECK(!spans.degenerate());
            CHECK(!spans.touched());
            // The radius there is 5 + t, with t^2 + z^2 = 4.
            for (const SpanEnd& end : {spans[0].enter, spans[0].exit}) {
                const double y = end.s + shift;
                const double low = deep - rise * y;
                const double expected = std::sqrt(low * (4.0 - low));
                const double actual = y * y / (std::hypot(5.0, y) + 5.0);
                CHECK(std::fabs(actual - expected) <=
                      1e-12 / expected + 4.0 * end.error * std::fabs(y) / 5.0);
            }
        }
    }
}

TEST_CASE("next to the axis a ray that was moved off the wall is certain") {
    // A cone nearly from the axis on, and rays along it, moved by little.
    const double least = 0x1p-26;
    const std::array<Vec2, 3> cone{Vec2{0.0555556, 0.0837}, {least, -0.083}, {least, 0.0837}};
    const auto solid = Revolve::prepare(std::vector<Argument>{
        outline({curves::closed_polygon(cone), rectangle({least, -0.5}, {0.6, 0.5})}), 360.0});
    REQUIRE(solid.has_value());
    const Vec3 d = unit(Vec3{0.0, 0.0555556 - least, 0.0837 + 0.083});
    const Vec3 across = cross(d, {1.0, 0.0, 0.0});
    for (const double off : {1e-10, 1e-9, 4e-9, -1e-10, -1e-9, -4e-9}) {
        for (const double aside : {0.3, -0.7}) {
            const Vec3 o = Vec3{0.0, least, -0.083} + across * off + Vec3{aside * off, 0.0, 0.0};
            double shift;
            const SpanList spans = spans_of(*solid, o, d, shift);
            CAPTURE(off);
            CAPTURE(aside);
            CHECK_FALSE(spans.degenerate());
        }
    }
}

/// Smooth curves that come back to the origin, twice.
curves::OutlinePtr loops(Vec2 middle) {
    curves::Curve curve;
    const auto add = [&](Vec2 a, Vec2 b, Vec2 c, Vec2 d) {
        curve.spans.push_back(curves::cubic(middle + a, middle + b, middle + c, middle + d));
    };
    add({0, 0}, {12, 9}, {-12, 9}, {0, 0});
    add({0, 0}, {12, -9}, {-9, -12}, {-2, -3});
    add({-2, -3}, {5, 6}, {5, 5}, {0, 0});
    curve.closed = true;
    return outline({curve});
}

template <class P>
void check_facing(const std::vector<Argument>& arguments, Vec3 through, int least) {
    const auto placed = P::prepare(arguments);
    REQUIRE(placed.has_value());
    Random random(3);
    int judged = 0;
    for (int i = 0; i < 3000; ++i) {
        Vec3 d = random.direction();
        if (random.chance(0.3)) d.z = 0.0;
        double shift;
        const Vec3 o = through - d * random.uniform(0, 3);
        const SpanList spans = spans_of(*placed, o, d, shift);
        if (spans.degenerate()) continue;
        const Affine back = inverse(placed->to_object);
        for (std::size_t k = 0; k < spans.size(); ++k) {
            for (const bool enters : {true, false}) {
                const SpanEnd& end = enters ? spans[k].enter : spans[k].exit;
                const Vec3 n = unit(transposed_times(
                    back.linear, placed->kernel.normal(back(o + d * (end.s + shift)), end.face)));
                CAPTURE(i);
                CHECK((enters ? -dot(n, d) : dot(n, d)) > -1e-3);
                ++judged;
            }
        }
    }
    CHECK(judged > least);
}

TEST_CASE("where a smooth curve meets itself the normals are those of the walls that are met") {
    check_facing<Prism>({loops({0, 0}), 4.0, false}, {0, 0, 2}, 3000);
    check_facing<Conic>({loops({0, 0}), 4.0, 0.5, false}, {0, 0, 2}, 3000);
    check_facing<Revolve>({loops({15, 0}), 360.0}, {15, 0, 0}, 3000);
    check_facing<Revolve>({loops({15, 0}), 200.0}, {0, 15, 0}, 3000);
}

TEST_CASE("revolve refuses what lies beyond its axis, and angles beyond a turn") {
    const auto beyond =
        Revolve::prepare(std::vector<Argument>{outline({rectangle({-1, 0}, {2, 1})}), 360.0});
    REQUIRE_FALSE(beyond.has_value());
    CHECK(beyond.error().argument == 0);
    CHECK(beyond.error().message.find("other side of its axis") != std::string::npos);
    const auto angle = Revolve::prepare(std::vector<Argument>{curves::sample_disc(), 361.0});
    REQUIRE_FALSE(angle.has_value());
    CHECK(angle.error().argument == 1);
}

}  // namespace
}  // namespace raymo::solids
