// Spans of f(x) <= 0, f a polynomial of degree 2, along a line.
//
// With x = o + s d:  f = A s^2 + 2 B s + C,  A = d.Ad,  B = d.(Ao + b),  C = f(o). The solid may be
// unbounded, so s may have any size, and A, B and C may be zero, alone or together.
//
// Error. The line is off by at most e for |s| |d| <= 1 and by e (1 + |s| |d|) beyond, so f(x) by
//     E(s) = 2 |Ax + b|.e (1 + |s| |d|) + (e.|A|e) (1 + |s| |d|)^2 + 8 u (|f|)(|o| + |s| |d|)
//         <= E0 + E1 |s| + E2 s^2
// where |f| is f with the absolute values of its coefficients, and |o| and |d| are taken one by one: eight roundings of the
// coefficients, of A, B and C, and of the root formula. A root r is certain to within
//     E / sqrt(max(D, |A| E)),  D = B^2 - A C,
// where E is E(r) and what E may change by up to the true root.
//
// |A| <= E2 means that the sign of A is not known: the line is parallel to a generator, and one
// root or both lie farther away than the line is known to be straight. A is then taken as 0; so is
// B when 2 |B| <= E1, and the line is inside or outside altogether.
//
// A root whose error is as large as its distance says that it may be anywhere, where in truth it is far away or missing:
// A is not known to within its half. Where f has one sign all over the model the line is inside or outside altogether; one
// such root of two lies at infinity. How far the model reaches is told by e, which is some roundings of that at least.
#include <cmath>
#include <limits>

#include "raymo/math/tolerance.hpp"
#include "raymo/solids/quadric/quadric.hpp"

namespace raymo::solids {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

/// A line that is parallel to a generator to within rounding is watched for crossings up to this
/// many lengths of the canonical frame.
constexpr double kReach = 64.0;

struct Line {
    double length;      ///< |d|
    double e0, e1, e2;  ///< of E(s)
    double e_size;      ///< largest component of e
    double reach;       ///< the model ends within so many lengths of the frame

    [[nodiscard]] double error(double s) const {
        const double t = std::fabs(s);
        return e0 + t * (e1 + t * e2);
    }
    /// The crossing may lie where the tracer looks, and is uncertain because of the angle at which
    /// it is met.
    [[nodiscard]] bool degenerate(const SpanEnd& end) const {
        const double place = std::fabs(end.s) * length;
        const double blur = end.error * length;
        return !(blur <= (kDegenerate + 1024.0 * e_size) * (1.0 + place)) &&
               !(place - blur > kReach);
    }
};

/// p q - r s with one rounding of each product's error [Kahan].
double difference_of_products(double p, double q, double r, double s) {
    const double rs = r * s;
    return std::fma(p, q, -rs) + std::fma(-r, s, rs);
}

/// Neither the place of the crossing is known, nor whether there is one: A may as well be 0, or have the other sign.
bool is_unknown(const SpanEnd& end) { return !(end.error < 0.25 * std::fabs(end.s)); }

/// Both ends as they are, or at infinity where they are unknown and far beyond the model. Their error bounds reach back into
/// it, but the crossings do not, since A is known to within its half.
struct Ends {
    SpanEnd low, high;
};
Ends within_reach(const Line& line, SpanEnd low, SpanEnd high) {
    const auto beyond = [&](const SpanEnd& end) {
        return std::fabs(end.s) * line.length > 4.0 * line.reach && is_unknown(end);
    };
    if (beyond(low)) low = {std::copysign(kInf, low.s), 0.0, 0};
    if (beyond(high)) high = {std::copysign(kInf, high.s), 0.0, 0};
    if (low.s == kInf) high = low;
    if (high.s == -kInf) low = high;
    return {low, high};
}

void push(const Line& line, SpanEnd enter, SpanEnd exit, SpanList& out) {
    if (line.degenerate(enter) || line.degenerate(exit)) out.set_degenerate();
    if (exit.s - enter.s > enter.error + exit.error) out.push({enter, exit});
}

constexpr SpanEnd kBegin{-kInf, 0.0, 0};
constexpr SpanEnd kEnd{kInf, 0.0, 0};

/// Whether the line does not cross within the model for certain.
bool is_settled(const Line& line, double c, double slope, double bend) {
    const double r = line.reach / line.length;
    return std::fabs(c) > line.error(r) + r * (std::fabs(slope) + r * std::fabs(bend));
}

void constant_spans(const Line& line, double c, double slope, double bend, SpanList& out) {
    if (!is_settled(line, c, slope, bend)) out.set_degenerate();
    if (c < 0.0) out.push({kBegin, kEnd});
}

void linear_spans(const Line& line, double c, double slope, double bend, SpanList& out) {
    const double s = -c / slope;
    const SpanEnd end{s, 2.0 * line.error(s) / std::fabs(slope), 0};
    if (is_unknown(end) && is_settled(line, c, slope, bend)) {
        constant_spans(line, c, slope, bend, out);
    } else if (slope > 0.0) {
        push(line, kBegin, end, out);
    } else {
        push(line, end, kEnd, out);
    }
}

}  // namespace

void Quadric::Kernel::spans(const LocalRay<double>& ray, SpanList& out) const {
    const Vec3 o{ray.ox, ray.oy, ray.oz};
    const Vec3 d{ray.dx, ray.dy, ray.dz};
    const Vec3 e{ray.ex, ray.ey, ray.ez};
    const Mat3 size = abs(form().a);
    const Vec3 ad = form().a * d;
    const Vec3 g = form().half_gradient(o);

    Line line{};
    line.length = std::sqrt(ray.dd);
    line.e_size = max_norm(e);
    line.reach = std::max(kReach, line.e_size / (4.0 * kUnitRoundoff));
    const double g0 = dot(abs(g), e);
    const double g1 = dot(abs(ad), e);
    const double q = dot(e, size * e);
    const double u = 8.0 * kUnitRoundoff;
    const Vec3 size_d = size * abs(d);
    line.e0 = 2.0 * g0 + q + u * form().magnitude(o);
    line.e1 = 2.0 * (g1 + (g0 + q) * line.length) + 2.0 * u * dot(size_d, abs(o)) +
              2.0 * u * dot(abs(form().b), abs(d));
    line.e2 = (2.0 * g1 + q * line.length) * line.length + u * dot(size_d, abs(d));

    const double a = dot(d, ad);
    const double b = dot(d, g);
    const double c = form()(o);
    if (!(std::fabs(a) > line.e2)) {
        if (!(2.0 * std::fabs(b) > line.e1)) {
            constant_spans(line, c, 2.0 * b, a, out);
        } else {
            linear_spans(line, c, 2.0 * b, a, out);
        }
        return;
    }
    const double disc = difference_of_products(b, b, a, c);
    const double root = std::sqrt(std::max(disc, 0.0));
    const double far = -(b + std::copysign(root, b));
    const double r1 = far / a;
    const double r2 = disc > 0.0 ? c / far : r1;
    const auto end = [&](double s) {
        // E at this very place; once more for how it may differ at the true root.
        const double place = std::max(1.0, std::fabs(s) * line.length / 1.75);
        const Vec3 x = o + d * s;
        double slack = 2.0 * dot(abs(form().half_gradient(x)), e) * place + q * place * place +
                       u * form().magnitude(abs(o) + abs(d) * std::fabs(s));
        double error = slack / std::sqrt(std::max(disc, std::fabs(a) * slack));
        slack += 4.0 * g1 * error * place;
        error = slack / std::sqrt(std::max(disc, std::fabs(a) * slack));
        return SpanEnd{s, error, 0};
    };
    const double s_low = std::min(r1, r2), s_high = std::max(r1, r2);
    const bool missed =
        disc + std::fabs(a) * std::max(line.error(s_low), line.error(s_high)) <= 0.0;
    const auto [low, high] = within_reach(line, end(s_low), end(s_high));
    if (a > 0.0) {
        if (!missed) push(line, low, high, out);
        return;
    }
    // Outside only between the roots; a gap thinner than its errors is nothing.
    if (!missed && (line.degenerate(low) || line.degenerate(high))) out.set_degenerate();
    if (missed || !(high.s - low.s > low.error + high.error)) {
        out.push({kBegin, kEnd});
        return;
    }
    if (low.s > -kInf) out.push({kBegin, low});
    if (high.s < kInf) out.push({high, kEnd});
}

}  // namespace raymo::solids
