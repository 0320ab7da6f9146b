// Volumes of swept solids to 1e-9, from the spans that their kernels find, by quadrature, against closed forms: areas of
// contours, Pappus' rule, and the volumes of tubes.
//
// Along a line that is moved across a solid the spans' ends are smooth but where the line passes a corner or an extremum of
// the contour; there they may have roots in them. Between such places tanh-sinh quadrature [Takahasi74] gets all digits.
// Tubes are cut by the planes across the path in which balls touch the envelope. With arc length s, tangent T, curvature k
// and radius a, the plane at s holds the disc of radius R = a sqrt(1 - a_s^2) about r - a a_s T, and
//     dV = (1 - (a a_s)_s - k R cos(angle)) dA ds;
// what is beyond the first and the last plane is part of a ball.
#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <numbers>

#include "raymo/curves/samples.hpp"
#include "raymo/solids/inventory.hpp"
#include "raymo/solids/sweep/test_paths.hpp"

namespace raymo::solids {
namespace {

using namespace test;
using Function = std::function<double(double)>;

constexpr double kPi = std::numbers::pi;

doctest::Approx near(double x) { return doctest::Approx(x).scale(0.0).epsilon(1e-9); }

/// The integral of f over [a, b], which may have roots and powers at its ends.
double tanh_sinh(double a, double b, const Function& f) {
    constexpr double kStep = 1.0 / 16.0;
    double sum = 0.0;
    for (int i = -56; i <= 56; ++i) {
        const double t = kStep * i;
        const double q = std::exp(-kPi * std::sinh(std::fabs(t)));
        const double from_end = q / (1.0 + q) * (b - a);  // to the nearer end
        const double x = t < 0 ? a + from_end : b - from_end;
        if (x > a && x < b) sum += f(x) * std::cosh(t) * q / ((1.0 + q) * (1.0 + q));
    }
    return sum * kPi * kStep * (b - a);
}

/// The same of a smooth f, by ten times as many of Gauss' nodes as make a polynomial of degree 9 exact.
double gauss(double a, double b, const Function& f) {
    constexpr double kNodes[5] = {-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                                  0.9061798459386640};
    constexpr double kWeights[5] = {0.2369268850561891, 0.4786286704993665, 128.0 / 225.0,
                                    0.4786286704993665, 0.2369268850561891};
    constexpr int kParts = 10;
    const double half = 0.5 * (b - a) / kParts;
    double sum = 0.0;
    for (int i = 0; i < kParts; ++i) {
        for (int k = 0; k < 5; ++k) sum += kWeights[k] * f(a + half * (2 * i + 1 + kNodes[k]));
    }
    return sum * half;
}

/// Spans of o + s d in a kernel's own frame, where o is the point nearest to its origin.
template <class K>
SpanList spans_of(const K& kernel, Vec3 o, Vec3 d) {
    const double e = 0x1p-50;
    SpanList spans;
    kernel.spans({o.x, o.y, o.z, d.x, d.y, d.z, e, e, e, dot(d, d), kFromTheBeginning}, spans);
    return spans;
}

/// Heights at which pieces of the contour begin and end, ascending.
std::vector<double> corner_heights(const curves::Region& region) {
    std::vector<double> heights;
    for (const curves::Piece& piece : region.pieces()) {
        heights.push_back(piece.y[0] / piece.w[0]);
        heights.push_back(piece.y[3] / piece.w[3]);
    }
    std::sort(heights.begin(), heights.end());
    heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
    return heights;
}

/// The integral of f over the heights of a contour, strip by strip.
double over_strips(const curves::Region& region, const Function& f) {
    const std::vector<double> heights = corner_heights(region);
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < heights.size(); ++i)
        sum += tanh_sinh(heights[i], heights[i + 1], f);
    return sum;
}

/// By lines through the axis, which cross the section of height z from -s to s: its area is pi times the integral of |s|.
double turned_volume(const std::vector<Argument>& arguments) {
    const auto placed = Revolve::prepare(arguments);
    REQUIRE(placed.has_value());
    const auto section = [&](double z) {
        const SpanList spans = spans_of(placed->kernel, {0, 0, z}, {1, 0, 0});
        double area = 0.0;
        for (std::size_t i = 0; i < spans.size(); ++i) {
            const double a = spans[i].enter.s;
            const double b = spans[i].exit.s;
            area += 0.5 * kPi * (b * std::fabs(b) - a * std::fabs(a));
        }
        return area;
    };
    return over_strips(placed->kernel.region(), section) * determinant(placed->to_object.linear);
}

/// By chords along x in three sections, whose areas are the square of a linear function of the height.
template <class P>
double swept_volume(const std::vector<Argument>& arguments, double top) {
    const auto placed = P::prepare(arguments);
    REQUIRE(placed.has_value());
    const auto& kernel = placed->kernel;
    const double ratio = std::min(top, 1.0 / top);
    const auto section = [&](double z) {
        const double scale = 0.5 * (1.0 + ratio) - 0.5 * (1.0 - ratio) * z;
        const auto chord = [&](double y) {
            const SpanList spans = spans_of(kernel, {0, y * scale, z}, {1, 0, 0});
            double length = 0.0;
            for (std::size_t i = 0; i < spans.size(); ++i)
                length += spans[i].exit.s - spans[i].enter.s;
            return length;
        };
        return over_strips(kernel.region(), chord) * scale;
    };
    // Gauss' rule of two nodes on [-1, 1] is exact up to degree 3.
    const double node = 1.0 / std::sqrt(3.0);
    return (section(-node) + section(node)) * std::fabs(determinant(placed->to_object.linear));
}

/// Integrals along the outline, which runs counter-clockwise or clockwise: of x dy, and of x^2 dy.
struct Green {
    double area = 0.0, moment = 0.0;
};
Green green(const curves::Outline& outline) {
    Green sum;
    for (const curves::Curve& curve : outline.curves) {
        for (const curves::Span2& span : curve.spans) {
            const auto at = [&](const std::array<double, 4>& c, double u) {
                const double v = 1.0 - u;
                return v * v * (v * c[0] + 3.0 * u * c[1]) + u * u * (3.0 * v * c[2] + u * c[3]);
            };
            const auto slope = [&](const std::array<double, 4>& c, double u) {
                const double v = 1.0 - u;
                return 3.0 * (v * v * (c[1] - c[0]) + 2.0 * u * v * (c[2] - c[1]) +
                              u * u * (c[3] - c[2]));
            };
            const auto dy = [&](double u) {
                const double w = at(span.w, u);
                return (slope(span.y, u) * w - at(span.y, u) * slope(span.w, u)) / (w * w);
            };
            const auto x = [&](double u) { return at(span.x, u) / at(span.w, u); };
            sum.area += gauss(0, 1, [&](double u) { return x(u) * dy(u); });
            sum.moment += gauss(0, 1, [&](double u) { return x(u) * x(u) * dy(u); });
        }
    }
    return sum;
}

TEST_CASE("volumes: prisms are area times height, conic sweeps a third of it and more") {
    const double rosette = std::fabs(green(*curves::sample_rosette()).area);
    const double washer = 92.0 * kPi - 16.0;
    CHECK(swept_volume<Prism>({curves::sample_disc(), 12.0, false}, 1) == near(300.0 * kPi));
    CHECK(swept_volume<Prism>({curves::sample_washer(), 12.0, false}, 1) == near(12.0 * washer));
    CHECK(swept_volume<Prism>({curves::sample_rosette(), 12.0, false}, 1) == near(12.0 * rosette));
    for (const double top : {0.25, 0.5, 3.0}) {
        const double factor = 12.0 * (1.0 + top + top * top) / 3.0;
        CHECK(swept_volume<Conic>({curves::sample_washer(), 12.0, top, false}, top) ==
              near(factor * washer));
        CHECK(swept_volume<Conic>({curves::sample_rosette(), 12.0, top, false}, top) ==
              near(factor * rosette));
    }
}

TEST_CASE("volumes: turned contours follow Pappus' rule") {
    const auto ring = std::make_shared<const curves::Outline>(
        curves::Outline{{curves::full_circle({5, 1}, 2)}, curves::Fill::even_odd});
    CHECK(turned_volume({ring, 360.0}) == near(40.0 * kPi * kPi));
    CHECK(turned_volume({curves::sample_rosette(), 360.0}) ==
          near(40.0 * kPi * std::fabs(green(*curves::sample_rosette()).area)));
    for (const curves::OutlinePtr& outline : {curves::sample_half_disc(), curves::sample_goblet()})
        CHECK(turned_volume({outline, 360.0}) == near(kPi * std::fabs(green(*outline).moment)));
}

/// A path of one cubic with its derivatives, and the plane across it that belongs to a ball.
class Tube {
public:
    explicit Tube(const Ball (&powers)[4])
        : powers_{powers[0], powers[1], powers[2], powers[3]},
          sweep_(curves::Path{{of_powers(powers)}, false}) {}

    /// From spans alone: lines through the middles of the discs.
    [[nodiscard]] double measured() const {
        return gauss(0, 1,
                     [&](double u) {
                         const Plane p = plane(u);
                         double sum = 0.0;
                         for (int i = 0; i < kAngles; ++i) {
                             const double angle = 2.0 * kPi * (i + 0.5) / kAngles;
                             const double r =
                                 reach(p.middle, p.side * std::cos(angle) + p.up * std::sin(angle));
                             sum += 0.5 * r * r * p.step -
                                    p.curvature * std::cos(angle) * r * r * r / 3.0;
                         }
                         return sum * 2.0 * kPi / kAngles * p.speed;
                     }) +
               measured_cap(0.0, -1.0) + measured_cap(1.0, 1.0);
    }
    /// From the formula: pi R^2 (1 - (a a_s)_s) ds, and what balls keep beyond a plane.
    [[nodiscard]] double expected() const {
        const auto cap = [](double a, double q) {
            return kPi * a * a * a * (2.0 / 3.0 + q - q * q * q / 3.0);
        };
        const Plane first = plane(0), last = plane(1);
        return gauss(0, 1,
                     [&](double u) {
                         const Plane p = plane(u);
                         return kPi * p.radius * p.radius * (1.0 - p.growth * p.growth) * p.step *
                                p.speed;
                     }) +
               cap(first.radius, -first.growth) + cap(last.radius, last.growth);
    }

private:
    static constexpr int kAngles = 12;
    struct Plane {
        Vec3 ball, middle, tangent, side, up;  ///< side: where the path bends to
        double radius, growth;                 ///< a, a_s
        double step;                           ///< 1 - (a a_s)_s
        double curvature, speed;
    };
    [[nodiscard]] Plane plane(double u) const {
        const auto& k = powers_;
        const Vec3 r = k[0].p + (k[1].p + (k[2].p + k[3].p * u) * u) * u;
        const Vec3 d = k[1].p + (k[2].p * 2.0 + k[3].p * (3.0 * u)) * u;
        const Vec3 dd = k[2].p * 2.0 + k[3].p * (6.0 * u);
        const double a = k[0].r + k[1].r * u;  // radii here are linear in u
        const double speed = norm(d);
        const Vec3 t = d / speed;
        const Vec3 bend = (dd - t * dot(dd, t)) / (speed * speed);
        Vec3 side, up;
        make_frame(t, side, up);
        if (norm(bend) > 0.0) {
            side = bend / norm(bend);
            up = cross(t, side);
        }
        const double growth = k[1].r / speed;
        const double second = -k[1].r * dot(dd, t) / (speed * speed * speed);
        return {r,          r - t * (a * growth),
                t,          side,
                up,         a,
                growth,     1.0 - growth * growth - a * second,
                norm(bend), speed};
    }
    /// How far the solid reaches from a point of it in direction d.
    [[nodiscard]] double reach(Vec3 from, Vec3 d) const {
        for (const Span& span : sweep_.spans(from, d)) {
            if (span.enter.s <= 0.0 && span.exit.s >= 0.0) return span.exit.s;
        }
        FAIL("a point of the solid is not in it");
        return 0.0;
    }
    /// By discs across the path; `way` is -1 at its beginning and 1 at its end.
    [[nodiscard]] double measured_cap(double u, double way) const {
        const Plane p = plane(u);
        return gauss(-way * p.growth * p.radius, p.radius, [&](double h) {
            double sum = 0.0;
            for (int i = 0; i < kAngles; ++i) {
                const double angle = 2.0 * kPi * (i + 0.5) / kAngles;
                const double r = reach(p.ball + p.tangent * (way * h),
                                       p.side * std::cos(angle) + p.up * std::sin(angle));
                sum += 0.5 * r * r;
            }
            return sum * 2.0 * kPi / kAngles;
        });
    }

    Ball powers_[4];
    Asked sweep_;
};

TEST_CASE("volumes: straight and curved tubes, of one radius and of many") {
    const auto check = [](const Tube& tube, double volume) {
        CHECK(tube.expected() == near(volume));
        CHECK(tube.measured() == near(volume));
    };
    // A capsule; a cone between two balls.
    check(Tube({{{}, 1}, {{0, 0, 4}, 0}, {{}, 0}, {{}, 0}}), 16.0 * kPi / 3.0);
    const double s = 1.0 / 3.0;
    const double caps = 8.0 * (2.0 / 3.0 + s - s * s * s / 3.0) + (2.0 / 3.0 - s + s * s * s / 3.0);
    check(Tube({{{}, 2}, {{0, 0, 3}, -1}, {{}, 0}, {{}, 0}}),
          kPi * (7.0 * (1.0 - s * s) * (1.0 - s * s) + caps));
    // A parabola; a cubic in the plane and one in space whose lengths are rational.
    const double length = std::sqrt(2.0) + std::asinh(1.0);
    check(Tube({{{-1, 0.5, 0}, 0.5}, {{2, -2, 0}, 0}, {{0, 2, 0}, 0}, {{}, 0}}),
          kPi * 0.25 * length + kPi / 6.0);
    check(Tube({{{}, 0.25}, {{1, 0, 0}, 0}, {{0, 1, 0}, 0}, {{-1.0 / 3.0, 0, 0}, 0}}),
          5.0 * kPi / 48.0);
    check(Tube({{{}, 1}, {{6, 0, 0}, 0}, {{0, 6, 0}, 0}, {{0, 0, 4}, 0}}), 34.0 * kPi / 3.0);
    // The same of growing radius has no closed form beyond the integral.
    const Tube growing({{{}, 1}, {{6, 0, 0}, 0.5}, {{0, 6, 0}, 0}, {{0, 0, 4}, 0}});
    CHECK(growing.expected() == doctest::Approx(63.013899).epsilon(1e-8));
    CHECK(growing.measured() == near(growing.expected()));
}

TEST_CASE(
    "areas: of tubes, by what a little more and a little less of radius makes of their volumes") {
    // Steiner: by d more of radius the volume grows by A d + M d^2 + 4/3 pi d^3, so this is A.
    const auto check = [](std::array<Ball, 4> powers, double area) {
        const double d = 0.1 * powers[0].r;
        const auto volume = [&](double more) {
            std::array<Ball, 4> grown = powers;
            grown[0].r += more;
            return Tube({grown[0], grown[1], grown[2], grown[3]}).measured();
        };
        CHECK((volume(d) - volume(-d)) / (2.0 * d) - 4.0 / 3.0 * kPi * d * d == near(area));
    };
    check({{{{}, 1}, {{0, 0, 4}, 0}, {{}, 0}, {{}, 0}}}, 12.0 * kPi);
    check({{{{}, 2}, {{0, 0, 3}, -1}, {{}, 0}, {{}, 0}}}, 20.0 * kPi);
    const double length = std::sqrt(2.0) + std::asinh(1.0);
    check({{{{-1, 0.5, 0}, 0.5}, {{2, -2, 0}, 0}, {{0, 2, 0}, 0}, {{}, 0}}}, kPi * length + kPi);
    check({{{{}, 0.25}, {{1, 0, 0}, 0}, {{0, 1, 0}, 0}, {{-1.0 / 3.0, 0, 0}, 0}}},
          11.0 * kPi / 12.0);
    check({{{{}, 1}, {{6, 0, 0}, 0}, {{0, 6, 0}, 0}, {{0, 0, 4}, 0}}}, 24.0 * kPi);
}

TEST_CASE("volumes: a ball that holds all others, and a path that stands still at its ends") {
    const auto about_axis = [](const Asked& sweep, std::initializer_list<double> heights) {
        double sum = 0.0;
        for (const double* z = heights.begin(); z + 1 < heights.end(); ++z) {
            sum += tanh_sinh(*z, z[1], [&](double height) {
                double area = 0.0;
                for (const Span& span : sweep.spans({0, 0, height}, {1, 0, 0}))
                    area +=
                        0.25 * kPi * (span.exit.s - span.enter.s) * (span.exit.s - span.enter.s);
                return area;
            });
        }
        return sum;
    };
    const Asked held(curves::Path{{straight({{0, 0, 0}, 1}, {{0, 0, 1}, 3})}, false});
    CHECK(about_axis(held, {-2, 4}) == near(36.0 * kPi));
    const Asked still(
        curves::Path{{of_powers({{{}, 1}, {{}, 0}, {{0, 0, 12}, 0}, {{0, 0, -8}, 0}})}, false});
    CHECK(about_axis(still, {-1, 0, 4, 5}) == near(16.0 * kPi / 3.0));
}

}  // namespace
}  // namespace raymo::solids
