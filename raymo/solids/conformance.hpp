// What the tests ask of every solid, written once: used by the unit tests (a seeded sample) and by the laws program (full
// counts). Not part of any library.
//
// The judge is a point's membership, computed with 113 bits on the true line. The kernel is told a line and how far it may
// be off; the true line is that line moved and turned by any amount within what it was told. Then
//   - an end of a span is outside the solid at `error` on its outer side and inside at `error` on its inner side,
//   - no point that is clearly outside lies in a span, no point that is clearly inside lies outside all of them,
//   - the normals of the ends face outwards, and the box holds the spans.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "raymo/math/tolerance.hpp"
#include "raymo/solids/freeform/test_field.hpp"
#include "raymo/solids/inventory.hpp"
#include "raymo/solids/sweep/test_field.hpp"
#include "raymo/solids/test_contour_field.hpp"
#include "raymo/solids/test_quad.hpp"

namespace raymo::solids::conformance {

/// A function that is negative inside and positive outside; zero on the boundary.
inline Quad field(const Block::Kernel&, const QuadPoint& p) {
    Quad f = quad_abs(p.x);
    if (quad_abs(p.y) > f) f = quad_abs(p.y);
    if (quad_abs(p.z) > f) f = quad_abs(p.z);
    return f - 1;
}
inline Quad field(const Sphere::Kernel&, const QuadPoint& p) {
    return p.x * p.x + p.y * p.y + p.z * p.z - 1;
}
inline Quad field(const Cylinder::Kernel&, const QuadPoint& p) {
    const Quad side = p.x * p.x + p.y * p.y - 1;
    const Quad cap = quad_abs(p.z) - 1;
    return side > cap ? side : cap;
}
inline Quad field(const Cone::Kernel& k, const QuadPoint& p) {
    const Quad ratio = k.ratio();
    const Quad q = ((1 + ratio) - (1 - ratio) * p.z) / 2;
    const Quad side = quad_sqrt(p.x * p.x + p.y * p.y) - q;
    const Quad cap = quad_abs(p.z) - 1;
    return side > cap ? side : cap;
}
inline Quad field(const Torus::Kernel& k, const QuadPoint& p) {
    const Quad q = quad_sqrt(p.x * p.x + p.y * p.y) - Quad(k.major_radius());
    return q * q + p.z * p.z - Quad(k.minor_radius()) * Quad(k.minor_radius());
}
inline Quad field(const Halfspace::Kernel&, const QuadPoint& p) { return p.z; }
inline Quad field(const Quadric::Kernel& k, const QuadPoint& p) {
    const QuadraticForm& f = k.form();
    const Quad x[3] = {p.x, p.y, p.z};
    Quad sum = f.c;
    for (int i = 0; i < 3; ++i) {
        sum += 2 * Quad(f.b[i]) * x[i];
        for (int j = 0; j < 3; ++j) {
            sum += Quad(f.a.row[static_cast<std::size_t>(i)][j]) * x[i] * x[j];
        }
    }
    return sum;
}

inline Quad field(const ContourSweep& k, const QuadPoint& p) {
    const Quad cap = quad_abs(p.z) - 1;
    if (cap > 0) return cap;
    const Quad ratio = k.ratio();
    const Quad q = ((1 + ratio) - (1 - ratio) * p.z) / 2;
    if (!(q > 0)) return 0;
    return quad_inside(k.region(), p.x / q, p.y / q) ? (cap < 0 ? -1 : 0) : 1;
}

inline Quad field(const Revolve::Kernel& k, const QuadPoint& p) {
    if (k.angle() < 360.0) {
        const SinCos end = sin_cos_degrees(k.angle());
        const Quad a = -p.y;
        const Quad b = Quad(end.cos) * p.y - Quad(end.sin) * p.x;
        const Quad depth = k.angle() <= 180.0 ? (a > b ? a : b) : (a < b ? a : b);
        if (depth > 0) return depth;
    }
    return quad_inside(k.region(), quad_sqrt(p.x * p.x + p.y * p.y), p.z) ? -1 : 1;
}

/// What a kernel may be off by beside what it was told, with room.
template <class K>
double own_error(const K&) {
    return std::derived_from<K, Freeform> ? 16.0 * kFreeformOwnError : 64.0 * kUnitRoundoff;
}

class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}
    double uniform(double lo, double hi) {
        return lo + (hi - lo) * static_cast<double>(engine_() >> 11) * 0x1p-53;
    }
    int below(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }
    bool chance(double p) { return uniform(0, 1) < p; }
    Vec3 in_cube(double r) { return {uniform(-r, r), uniform(-r, r), uniform(-r, r)}; }
    Vec3 direction() {
        for (;;) {
            const Vec3 v = in_cube(1);
            if (norm(v) > 0.1 && norm(v) < 1) return unit(v);
        }
    }
    /// 2^-k, k evenly spread over 0..most; or 0.
    double small(int most = 60) {
        return chance(0.2) ? 0.0 : std::ldexp(uniform(0.5, 1), -below(most + 1));
    }

private:
    std::mt19937_64 engine_;
};

/// A line as a kernel sees it, and as it is.
struct Probe {
    LocalRay<double> ray;
    QuadPoint origin, direction;

    [[nodiscard]] QuadPoint at(Quad s) const {
        return {origin.x + s * direction.x, origin.y + s * direction.y, origin.z + s * direction.z};
    }
};

/// A point of the surface and its normal, found by a line through the middle.
template <class K>
bool surface_point(const K& kernel, Random& random, Vec3& p, Vec3& n) {
    const Vec3 d = random.direction();
    Vec3 o = random.in_cube(0.7);
    o -= d * dot(o, d);
    const double e = 16.0 * kUnitRoundoff;
    SpanList spans;
    kernel.spans({o.x, o.y, o.z, d.x, d.y, d.z, e, e, e, dot(d, d), kFromTheBeginning}, spans);
    if (spans.size() == 0) return false;
    const Span& span =
        spans[static_cast<std::size_t>(random.below(static_cast<int>(spans.size())))];
    const SpanEnd& end = random.chance(0.5) ? span.enter : span.exit;
    if (std::isinf(end.s)) return false;
    p = o + d * end.s;
    n = kernel.normal(p, end.face);
    return true;
}

/// Lines that are hard for the solids: through corners, along edges, faces, generators and axes, tangent, and all of these
/// missed by little; a fifth of them are just any lines.
template <class K>
Probe make_probe(const K& kernel, Random& random) {
    static constexpr double kSpecial[] = {-1, 1, 0, 0.5, -0.5, 2, 0.7071067811865476, 0.8, 0.6};
    const auto special = [&] { return kSpecial[random.below(9)]; };
    Vec3 p, d;
    if (random.chance(0.2)) {
        p = random.in_cube(1);
        d = random.direction();
    } else {
        p = random.chance(0.7) ? Vec3{special(), special(), special()} : random.in_cube(1);
        if (random.chance(0.2)) {
            // On the unit cylinder, and on the unit sphere when z = 0.
            const double angle = random.uniform(0, 7);
            p = {std::cos(angle), std::sin(angle),
                 random.chance(0.5) ? 0.0 : random.uniform(-1, 1)};
        }
        switch (random.below(4)) {
            case 0:
                d = Vec3{};
                d[random.below(3)] = random.chance(0.5) ? 1 : -1;
                break;
            case 1:
                d = {special(), special(), special()};
                break;
            case 2: {  // tangent to spheres and cylinders through p
                d = cross(random.chance(0.5) ? p : Vec3{p.x, p.y, 0}, random.direction());
                break;
            }
            default:
                d = Vec3{special(), special(), special()} - p;
        }
        Vec3 at, normal;
        if (random.chance(0.4) && surface_point(kernel, random, at, normal)) {
            p = at;
            d = cross(unit(normal), random.chance(0.5) ? random.direction() : Vec3{0, 0, 1});
        }
        if constexpr (requires { aim(kernel, random, p, d); }) {
            if (random.chance(0.6)) aim(kernel, random, p, d);
        }
        p += random.in_cube(1) * random.small();
        d += random.in_cube(1) * random.small();
        if (!(max_norm(d) > 1e-3)) d = random.direction();
    }
    d *= std::ldexp(random.uniform(0.5, 1), random.below(40) - 20);
    // The point nearest to the origin.
    Vec3 o = p - d * (dot(p, d) / dot(d, d));
    o -= d * (dot(o, d) / dot(d, d));
    const double size = std::ldexp(kUnitRoundoff, random.below(20));
    const Vec3 e{size * random.uniform(1, 8), size * random.uniform(1, 8),
                 size * random.uniform(1, 8)};

    Probe probe;
    probe.ray = {o.x, o.y, o.z, d.x, d.y, d.z, e.x, e.y, e.z, dot(d, d), kFromTheBeginning};
    Quad shifted[3], turned[3];
    for (int i = 0; i < 3; ++i) {
        const double share = random.chance(0.3) ? 0.0 : random.uniform(0, 1);
        shifted[i] = Quad(o[i]) + Quad(e[i] * share * (random.chance(0.5) ? 1 : -1));
        turned[i] = Quad(d[i]) + Quad(e[i] * (1 - share) * norm(d) / 1.75 * random.uniform(-1, 1));
    }
    probe.origin = {shifted[0], shifted[1], shifted[2]};
    probe.direction = {turned[0], turned[1], turned[2]};
    return probe;
}

struct Tally {
    std::uint64_t rays = 0, spans = 0, degenerate = 0, faults = 0;
    std::string first_fault;

    void fault(const std::string& what, const Probe& probe, double s) {
        ++faults;
        if (!first_fault.empty()) return;
        char text[512];
        const LocalRay<double>& r = probe.ray;
        std::snprintf(text, sizeof text,
                      "%s at s = %a; o = {%a, %a, %a} d = {%a, %a, %a} e = {%a, %a, %a}",
                      what.c_str(), s, r.ox, r.oy, r.oz, r.dx, r.dy, r.dz, r.ex, r.ey, r.ez);
        first_fault = text;
    }
};

/// Largest error at which the span's end is still judged by its error alone, in canonical lengths.
inline constexpr double kJudged = 0.25;

template <class K>
void judge(const K& kernel, const Probe& probe, Tally& tally) {
    const auto inside = [&](double s) { return field(kernel, probe.at(s)) <= 0; };
    const double length = std::sqrt(probe.ray.dd);
    SpanList spans;
    kernel.spans(probe.ray, spans);
    ++tally.rays;
    tally.spans += spans.size();
    if (spans.degenerate()) {
        ++tally.degenerate;
        return;
    }
    double last = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < spans.size(); ++i) {
        const Span& span = spans[i];
        if (!(span.enter.s < span.exit.s) || (i > 0 && !(span.enter.s >= last))) {
            tally.fault("spans out of order", probe, span.enter.s);
        }
        if (!(span.exit.s - span.enter.s > span.enter.error + span.exit.error)) {
            tally.fault("span thinner than its errors", probe, span.enter.s);
        }
        const double gap_before = span.enter.s - last;
        const double gap_after = i + 1 < spans.size() ? spans[i + 1].enter.s - span.exit.s
                                                      : std::numeric_limits<double>::infinity();
        const auto judge_end = [&](const SpanEnd& end, double outward, double gap) {
            if (std::isinf(end.s)) return;
            if (!(end.error >= 0.0) || std::isinf(end.error)) {
                tally.fault("error is not a number", probe, end.s);
                return;
            }
            // The line is known near the solid only, so distant ends of endless solids are left to `where` below.
            if (std::fabs(end.s) * length > 8.0) return;
            if (!inside(end.s - outward * end.error))
                tally.fault("end is too far out", probe, end.s);
            if (gap > 2.0 * end.error && inside(end.s + outward * end.error) &&
                field(kernel, probe.at(end.s + outward * end.error)) < 0) {
                tally.fault("end is too far in", probe, end.s);
            }
            const QuadPoint q = probe.at(end.s);
            const Vec3 n = kernel.normal(
                {static_cast<double>(q.x), static_cast<double>(q.y), static_cast<double>(q.z)},
                end.face);
            const double facing = dot(n, {probe.ray.dx, probe.ray.dy, probe.ray.dz}) * outward;
            if (!(max_norm(n) > 0.0) || kernel.faces().empty()) {
                tally.fault("no normal", probe, end.s);
            }
            // At a grazing end the normal's own rounding decides.
            const double blur = (1e-6 + end.error * length) * norm(n) * length;
            if (facing < -blur) tally.fault("normal faces inwards", probe, end.s);
        };
        judge_end(span.enter, -1.0, gap_before);
        judge_end(span.exit, 1.0, gap_after);
        last = span.exit.s;
    }
    // Points along the line that are clearly inside or outside.
    const Vec3 margin =
        Vec3{probe.ray.ex, probe.ray.ey, probe.ray.ez} * 16.0 + Vec3{1, 1, 1} * own_error(kernel);
    const auto covered = [&](double s) {
        for (std::size_t i = 0; i < spans.size(); ++i) {
            if (spans[i].enter.s <= s && s <= spans[i].exit.s) return true;
        }
        return false;
    };
    const auto judge_point = [&](double s) {
        // Ends are judged by their errors, above.
        for (std::size_t i = 0; i < spans.size(); ++i) {
            for (const SpanEnd& end : {spans[i].enter, spans[i].exit}) {
                if (std::fabs(s - end.s) <= end.error) return;
            }
        }
        const QuadPoint q = probe.at(s);
        const double far = std::max(1.0, std::fabs(s) * length);
        const Where where = kernel.where(
            {static_cast<double>(q.x), static_cast<double>(q.y), static_cast<double>(q.z)},
            margin * far);
        if (where == Where::in && !covered(s)) tally.fault("inside, but in no span", probe, s);
        if (where == Where::out && covered(s)) tally.fault("outside, but in a span", probe, s);
    };
    for (int i = -24; i <= 24; ++i) judge_point((static_cast<double>(i) / 16.0 + 0.01) / length);
    for (std::size_t i = 0; i < spans.size(); ++i) {
        const double a = std::max(spans[i].enter.s, -4.0 / length);
        const double b = std::min(spans[i].exit.s, 4.0 / length);
        for (const double w : {0.01, 0.5, 0.99}) {
            if (a < b) judge_point(a + w * (b - a));
        }
        if (i + 1 < spans.size()) judge_point(0.5 * (spans[i].exit.s + spans[i + 1].enter.s));
    }
}

/// Judges `count` lines through every example of the primitive P.
template <class P>
Tally judge_primitive(std::uint64_t count, std::uint64_t seed) {
    Tally tally;
    Random random(seed);
    const auto examples = P::examples();
    for (const auto& example : examples) {
        const auto placed = P::prepare(example);
        if (!placed) {
            tally.fault("example is refused: " + placed.error().message, {}, 0.0);
            continue;
        }
        for (std::uint64_t i = 0; i < count / examples.size() + 1; ++i) {
            judge(placed->kernel, make_probe(placed->kernel, random), tally);
        }
    }
    return tally;
}

}  // namespace raymo::solids::conformance
