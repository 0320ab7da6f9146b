#include "raymo/blends/section.hpp"

#include <algorithm>
#include <cmath>

#include "raymo/math/tolerance.hpp"

namespace raymo::blends {
namespace {

Vec2 turned(Vec2 v) { return {-v.y, v.x}; }

/// Of the size: what counts as met. A hundred times what distances are off by, and far less than anything drawn.
constexpr double kMet = 0x1p-40;
/// The way from an edge to a centre is divided into so many steps.
constexpr int kSteps = 16;
constexpr int kMostIterations = 40;
/// Curves whose normals' sine is smaller run along with each other.
constexpr double kTouching = 0x1p-20;

double signed_by(Branch branch, double value) { return branch == Branch::left ? value : -value; }

}  // namespace

double SectionCurve::distance(Vec2 p) const {
    if (run) return side * run->nearest(p).distance;
    return side * (is_line ? dot(normal, p) - offset : norm(p - centre) - radius);
}

Vec2 SectionCurve::outward(Vec2 p) const {
    if (run) return run->nearest(p).normal * side;
    if (is_line) return normal * side;
    const Vec2 d = p - centre;
    const double r = norm(d);
    return r > 0.0 ? d * (side / r) : Vec2{side, 0.0};
}

std::optional<Vec2> meet(const SectionCurve& a, double from_a, const SectionCurve& b, double from_b,
                         Branch branch) {
    if (a.is_line && b.is_line) {
        // The branches of one point: the left one.
        if (branch == Branch::right) return std::nullopt;
        const double det = cross(a.normal, b.normal);
        if (det == 0.0) return std::nullopt;
        const double ka = a.offset + a.side * from_a;
        const double kb = b.offset + b.side * from_b;
        const auto solved = [&](double to_a, double to_b) {
            return Vec2{(to_a * b.normal.y - to_b * a.normal.y) / det,
                        (a.normal.x * to_b - b.normal.x * to_a) / det};
        };
        Vec2 p = solved(ka, kb);
        // Where they meet at a small angle roundings have led off both lines, not only along them.
        p = p + solved(ka - dot(a.normal, p), kb - dot(b.normal, p));
        return is_finite(p) ? std::optional(p) : std::nullopt;
    }
    if (!a.is_line && b.is_line) {
        return meet(b, from_b, a, from_a, branch);
    }
    const double rb = b.radius + b.side * from_b;
    if (!(rb > 0.0)) return std::nullopt;
    if (a.is_line) {
        const double h = a.offset + a.side * from_a - dot(a.normal, b.centre);
        const double square = (rb - h) * (rb + h);
        if (!(square >= 0.0)) return std::nullopt;
        return b.centre + a.normal * h + turned(a.normal) * signed_by(branch, std::sqrt(square));
    }
    const double ra = a.radius + a.side * from_a;
    if (!(ra > 0.0)) return std::nullopt;
    const Vec2 between = b.centre - a.centre;
    const double d = norm(between);
    if (!(d > 0.0)) return std::nullopt;
    const Vec2 along = between * (1.0 / d);
    const double x = 0.5 * (d + (ra - rb) * (ra + rb) / d);
    const double square = (ra - x) * (ra + x);
    if (!(square >= 0.0)) return std::nullopt;
    return a.centre + along * x + turned(along) * signed_by(branch, std::sqrt(square));
}

std::vector<Vec2> run_meetings(const SectionCurve& a, const SectionCurve& b) {
    if (!a.run) return run_meetings(b, a);
    std::vector<Vec2> out;
    for (const Vec2 found : a.run->crossings([&](Vec2 p) { return b.distance(p); })) {
        // Where a distance jumps nothing is met.
        const Vec2 p = found;
        const double size = max_norm(p) + a.run->size();
        if (!(std::fabs(b.distance(p)) <= kMet * size)) continue;
        const bool is_old =
            std::any_of(out.begin(), out.end(), [&](Vec2 q) { return norm(p - q) <= kMet * size; });
        if (!is_old) out.push_back(p);
    }
    return out;
}

std::optional<Vec2> follow(const SectionCurve& a, double from_a, const SectionCurve& b,
                           double from_b, Vec2 at) {
    const double size =
        max_norm(at) + (a.run ? a.run->size() : a.radius) + (b.run ? b.run->size() : b.radius);
    Vec2 p = at;
    for (int step = 1; step <= kSteps; ++step) {
        const double part = static_cast<double>(step) / kSteps;
        const Vec2 before = p;
        double way = 0.0;
        bool is_found = false;
        for (int i = 0; i < kMostIterations && !is_found; ++i) {
            const Vec2 na = a.outward(p);
            const Vec2 nb = b.outward(p);
            const double det = cross(na, nb);
            if (!(std::fabs(det) > kTouching)) return std::nullopt;
            const double off_a = part * from_a - a.distance(p);
            const double off_b = part * from_b - b.distance(p);
            const Vec2 d{(off_a * nb.y - off_b * na.y) / det, (off_b * na.x - off_a * nb.x) / det};
            p = p + d;
            if (!is_finite(p)) return std::nullopt;
            if (i == 0) way = norm(d);
            is_found = norm(d) * std::fabs(det) <= 64.0 * kUnitRoundoff * size;
        }
        // Newton's method may have gone to another place at the same distances.
        if (!is_found || norm(p - before) > 2.0 * way + 0x1p-30 * size) return std::nullopt;
    }
    return p;
}

curves::Span2 conic_arc(Vec2 a, Vec2 b, Vec2 c, double weight) {
    // The rational parabola (a, w b, c) raised to degree 3.
    const double w = (1.0 + 2.0 * weight) / 3.0;
    const double k = 2.0 * weight / 3.0;
    return {{a.x, a.x / 3.0 + k * b.x, c.x / 3.0 + k * b.x, c.x},
            {a.y, a.y / 3.0 + k * b.y, c.y / 3.0 + k * b.y, c.y},
            {1.0, w, w, 1.0}};
}

void append_arc(curves::Curve& curve, Vec2 centre, Vec2 a, Vec2 c) {
    const Vec2 p = a - centre;
    const Vec2 q = c - centre;
    const double square = 0.5 * (dot(p, p) + dot(q, q));
    const double cosine = dot(p, q) / square;
    if (cosine < 0.0) {
        // More than a quarter of a turn: in two halves, with the middle on the bisector, which for opposite ends is across.
        const Vec2 sum = p + q;
        const Vec2 across = turned(p - q);
        const Vec2 bisector = norm(sum) * norm(sum) > 0x1p-20 * square
                                  ? sum
                                  : (dot(across, sum) < 0.0 ? -across : across);
        const Vec2 middle = centre + bisector * (std::sqrt(square) / norm(bisector));
        append_arc(curve, centre, a, middle);
        append_arc(curve, centre, middle, c);
        return;
    }
    // The tangents at the ends meet on the bisector, at (p + q) / (1 + cos): both have the same product with p and q.
    const Vec2 corner = centre + (p + q) * (1.0 / (1.0 + cosine));
    curve.spans.push_back(conic_arc(a, corner, c, std::sqrt(0.5 * (1.0 + cosine))));
}

}  // namespace raymo::blends
