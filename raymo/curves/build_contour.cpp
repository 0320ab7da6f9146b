#include "raymo/curves/build_contour.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "raymo/core/assert.hpp"
#include "raymo/curves/build_errors.hpp"
#include "raymo/math/affine.hpp"
#include "raymo/math/tolerance.hpp"

namespace raymo::curves {
namespace {

Result<void> check_length(double value, int argument, const char* name) {
    // Written so that NaN fails too.
    if (!(value > 0.0))
        return wrong(argument, std::string(name) + " must be greater than 0", {},
                     "this is " + shown(value));
    if (!(value <= kLargestCoordinate))
        return wrong(argument, std::string(name) + " is too large to be computed with",
                     "give at most 1e90", "this is " + shown(value));
    return {};
}

Vec2 on_circle(Vec2 centre, double radius, double degrees) {
    const SinCos at = sin_cos_degrees(degrees);
    return centre + radius * Vec2{at.cos, at.sin};
}

void set_start(Span2& span, Vec2 p) {
    span.x[0] = p.x * span.w[0];
    span.y[0] = p.y * span.w[0];
}
void set_end(Span2& span, Vec2 p) {
    span.x[3] = p.x * span.w[3];
    span.y[3] = p.y * span.w[3];
}

/// Largest coordinate of the control points.
double extent(const Curve& curve) {
    double size = 0.0;
    for (const Span2& span : curve.spans) {
        for (std::size_t i = 0; i < 4; ++i) size = std::max(size, max_norm(span.point(i)));
    }
    return size;
}

Curve reversed(const Curve& curve) {
    Curve out;
    out.closed = curve.closed;
    out.spans.reserve(curve.spans.size());
    for (auto span = curve.spans.rbegin(); span != curve.spans.rend(); ++span)
        out.spans.push_back(reversed(*span));
    return out;
}

Vec2 start_of(const Curve& curve) { return curve.spans.front().point(0); }
Vec2 end_of(const Curve& curve) { return curve.spans.back().point(3); }

/// Two ends meet when they are as near as their rounding. An end is a sum of products of numbers no larger than the
/// curve's extent: an arc's takes 4 roundings, each transformation 6 more, the user's own arithmetic some. 16 for each of
/// both ends, each at most kUnitRoundoff of the extent, in each of two coordinates.
constexpr double kMeet = 2.0 * 16.0 * 2.0 * kUnitRoundoff;

std::string text_of(Vec2 p) { return "(" + shown(p.x) + ", " + shown(p.y) + ")"; }

}  // namespace

Result<Curve> spline_curve(std::span<const Vec2> points, const SplineForm& form) {
    std::vector<Point<2>> p(points.size());
    std::transform(points.begin(), points.end(), p.begin(), [](Vec2 v) {
        return Point<2>{v.x, v.y};
    });
    auto made = spline<2>(p, form);
    if (!made) return Failure(std::move(made).error());
    Curve out;
    out.closed = made->closed;
    out.spans.reserve(made->spans.size());
    for (const SplineSpan<2>& s : made->spans) {
        out.spans.push_back(
            cubic({s[0][0], s[0][1]}, {s[1][0], s[1][1]}, {s[2][0], s[2][1]}, {s[3][0], s[3][1]}));
    }
    return out;
}

Result<Curve> polygon(std::span<const Vec2> corners) {
    return spline_curve(corners, {SplineKind::linear, 1, true, false});
}

Result<Curve> circle(double radius) {
    if (auto checked = check_length(radius, 0, "the radius"); !checked)
        return Failure(checked.error());
    Curve out;
    out.closed = true;
    for (int i = 0; i < 4; ++i) out.spans.push_back(arc(Vec2{}, radius, 90.0 * i, 90.0 * (i + 1)));
    return out;
}

Result<Curve> rectangle(double width, double height, double corner_radius, bool is_centred) {
    if (auto checked = check_length(width, 0, "the width"); !checked)
        return Failure(checked.error());
    if (auto checked = check_length(height, 1, "the height"); !checked)
        return Failure(checked.error());
    const double r = corner_radius;
    const double most = 0.5 * std::min(width, height);
    if (!(r >= 0.0))
        return wrong(2, "the radius of the corners must be at least 0", {}, "this is " + shown(r));
    if (!(r <= most))
        return wrong(2, "the radius of the corners must be at most half the shorter side",
                     "the largest is " + shown(most), "this is " + shown(r));
    const Vec2 lo = is_centred ? Vec2{-0.5 * width, -0.5 * height} : Vec2{};
    const Vec2 hi = lo + Vec2{width, height};
    if (r == 0.0) {
        const std::array<Vec2, 4> corners{lo, Vec2{hi.x, lo.y}, hi, Vec2{lo.x, hi.y}};
        return polygon(corners);
    }
    // The sides' end points are the corners' end points, so that all meet exactly; at half a side only one is left.
    const std::array<Vec2, 4> centres{Vec2{hi.x - r, lo.y + r}, Vec2{hi.x - r, hi.y - r},
                                      Vec2{lo.x + r, hi.y - r}, Vec2{lo.x + r, lo.y + r}};
    const std::array<Vec2, 4> starts{Vec2{hi.x - r, lo.y}, Vec2{hi.x, hi.y - r},
                                     Vec2{lo.x + r, hi.y}, Vec2{lo.x, lo.y + r}};
    const std::array<Vec2, 4> ends{Vec2{hi.x, lo.y + r}, Vec2{hi.x - r, hi.y}, Vec2{lo.x, hi.y - r},
                                   Vec2{lo.x + r, lo.y}};
    Curve out;
    out.closed = true;
    for (std::size_t i = 0; i < 4; ++i) {
        Span2 corner =
            arc(centres[i], r, 90.0 * static_cast<double>(i) - 90.0, 90.0 * static_cast<double>(i));
        set_start(corner, starts[i]);
        set_end(corner, ends[i]);
        out.spans.push_back(corner);
        const Vec2 next = starts[(i + 1) % 4];
        const bool is_gone = i % 2 == 0 ? 2.0 * r >= height : 2.0 * r >= width;
        if (!is_gone) out.spans.push_back(segment(ends[i], next));
    }
    for (std::size_t i = 0; i < out.spans.size(); ++i)
        set_start(out.spans[(i + 1) % out.spans.size()], out.spans[i].point(3));
    return out;
}

Result<Curve> regular(double n, double radius) {
    constexpr double kMost = 1e6;
    if (!(n >= 3.0 && n <= kMost && n == std::floor(n)))
        return wrong(0, "the number of corners must be a whole number from 3 to 1000000", {},
                     "this is " + shown(n));
    if (auto checked = check_length(radius, 1, "the radius"); !checked)
        return Failure(checked.error());
    std::vector<Vec2> corners;
    corners.reserve(static_cast<std::size_t>(n));
    for (double i = 0; i < n; ++i) corners.push_back(on_circle({}, radius, 360.0 * i / n));
    return polygon(corners);
}

Result<Curve> arc_curve(double radius, double from, double to, Vec2 centre) {
    if (auto checked = check_length(radius, 0, "the radius"); !checked)
        return Failure(checked.error());
    // Within this the whole turns that are taken off below are exact, and an angle is told from its neighbours.
    constexpr double kLargestAngle = 1e9;
    for (const int i : {1, 2}) {
        const double angle = i == 1 ? from : to;
        if (!(std::fabs(angle) <= kLargestAngle))
            return wrong(i, "the angle must be within 1e9 degrees", {}, "this is " + shown(angle));
    }
    const double turn = to - from;
    if (turn == 0.0)
        return wrong(2, "the arc must end at another angle than it begins",
                     "0 and 360 make the whole circle", "this is " + shown(to));
    if (!(std::fabs(turn) <= 360.0))
        return wrong(2, "the arc must be at most a full turn", {},
                     "this is " + shown(turn) + " degrees behind the start");
    if (!(max_norm(centre) <= kLargestCoordinate))
        return wrong(3, "the coordinates are too large to be computed with",
                     "stay within 1e90 of the origin");
    const auto count = static_cast<int>(std::ceil(std::fabs(turn) / 90.0));
    Curve out;
    out.closed = std::fabs(turn) == 360.0;
    const double first = std::fmod(from, 360.0);
    const double last = to - (from - first);
    double begin = first;
    for (int i = 1; i <= count; ++i) {
        const double end = i == count ? last : first + turn * i / count;
        Span2 piece = arc(centre, radius, begin, end);
        if (i > 1) set_start(piece, end_of(out));
        out.spans.push_back(piece);
        begin = end;
    }
    if (out.closed) set_end(out.spans.back(), start_of(out));
    return out;
}

Result<Curve> arc_through(Vec2 a, Vec2 b, Vec2 c) {
    const double size = std::max(max_norm(a), std::max(max_norm(b), max_norm(c)));
    if (!(size <= kLargestCoordinate))
        return wrong(0, "the coordinates are too large to be computed with",
                     "stay within 1e90 of the origin");
    // The centre lies on the perpendicular bisectors of a b and a c. With p = b - a and q = c - a, it is at
    // a + (q (p.p) - p (q.q)) turned by 90 degrees / (2 p x q).
    const Vec2 p = b - a;
    const Vec2 q = c - a;
    const double reach = std::max(max_norm(p), max_norm(q));
    const double area = cross(p, q);
    // Each of the two products of the area carries 3 roundings, one of them of the difference of coordinates up to `size`.
    if (!(std::fabs(area) > 8.0 * kUnitRoundoff * reach * size))
        return wrong(0, "the three points lie on a line, which no arc does",
                     "for a straight piece, write bspline([a, b], degree: 1)");
    const Vec2 m = (dot(p, p) / (2.0 * area)) * q - (dot(q, q) / (2.0 * area)) * p;
    const Vec2 from_centre{-m.y, m.x};  // from the centre to a
    const Vec2 centre = a - from_centre;
    const double radius = norm(from_centre);
    const double to_degrees = 180.0 / std::numbers::pi;
    const double from = std::atan2(from_centre.y, from_centre.x) * to_degrees;
    // The angle at b over the chord a c is half the turn of the other arc.
    const double angle_at_b = std::atan2(std::fabs(cross(a - b, c - b)), dot(a - b, c - b));
    const double turn = std::copysign(2.0 * (std::numbers::pi - angle_at_b) * to_degrees, area);
    const auto count = static_cast<int>(std::ceil(std::fabs(turn) / 90.0));
    RAYMO_ASSERT(count >= 1);
    Curve out;
    for (int i = 0; i < count; ++i) {
        out.spans.push_back(
            arc(centre, radius, from + turn * i / count, from + turn * (i + 1) / count));
        if (i > 0) set_start(out.spans.back(), out.spans[out.spans.size() - 2].point(3));
    }
    set_start(out.spans.front(), a);
    set_end(out.spans.back(), c);
    return out;
}

Result<Curve> chain(std::span<const Curve> curves, bool is_closed) {
    if (curves.empty()) return wrong(0, "there are no curves to join");
    double size = 0.0;
    for (std::size_t i = 0; i < curves.size(); ++i) {
        if (curves[i].closed && curves.size() > 1)
            return wrong(static_cast<int>(i), "a closed curve has no ends to join",
                         "join regions with `+`");
        size = std::max(size, extent(curves[i]));
    }
    const auto meet = [&](Vec2 a, Vec2 b) { return max_norm(a - b) <= kMeet * size; };
    Curve out = curves[0];
    const bool is_first_turned =
        curves.size() > 1 && !meet(end_of(out), start_of(curves[1])) &&
        !meet(end_of(out), end_of(curves[1])) &&
        (meet(start_of(out), start_of(curves[1])) || meet(start_of(out), end_of(curves[1])));
    if (is_first_turned) out = reversed(out);
    for (std::size_t i = 1; i < curves.size(); ++i) {
        const Vec2 end = end_of(out);
        const bool begins = meet(end, start_of(curves[i]));
        if (!begins && !meet(end, end_of(curves[i]))) {
            return wrong(static_cast<int>(i),
                         "the curves do not meet: one ends at " + text_of(end) +
                             " and the next begins at " + text_of(start_of(curves[i])),
                         "fill the gap with a straight piece: bspline([a, b], degree: 1)");
        }
        Curve next = begins ? curves[i] : reversed(curves[i]);
        set_start(next.spans.front(), end);
        out.spans.insert(out.spans.end(), next.spans.begin(), next.spans.end());
    }
    const Vec2 first = start_of(out);
    // A single segment meets itself nowhere, however short.
    if (out.spans.size() > 1 && meet(end_of(out), first)) {
        set_end(out.spans.back(), first);
        out.closed = true;
    } else if (is_closed && !out.closed) {
        out.spans.push_back(segment(end_of(out), first));
        out.closed = true;
    }
    return out;
}

}  // namespace raymo::curves
