#include "raymo/blends/wedge.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "raymo/blends/conic.hpp"
#include "raymo/blends/make.hpp"
#include "raymo/blends/others.hpp"
#include "raymo/core/assert.hpp"
#include "raymo/math/tolerance.hpp"

namespace raymo::blends {
namespace {

using solids::Where;

/// Faces whose normals' sine is smaller somewhere along a curve touch there, and what a ball does is no matter of rolling.
constexpr double kTouching = 0x1p-6;
constexpr double kDegrees = 180.0 / std::numbers::pi;

void append_line(curves::Curve& curve, Vec2 a, Vec2 b) {
    if (a != b) curve.spans.push_back(curves::segment(a, b));
}

/// Along a face's line, circle or run, moved beyond it.
void append_side(curves::Curve& curve, const SectionCurve& side, Vec2 a, Vec2 b) {
    if (side.run) {
        const auto from = side.run->nearest(a);
        const auto to = side.run->nearest(b);
        curves::Curve way;
        side.run->append_moved(from.at, to.at, from.distance, way);
        // Its ends are a and b but for rounding, or straight beyond the run's ends.
        if (way.spans.empty()) return append_line(curve, a, b);
        append_line(curve, a, way.spans.front().point(0));
        const Vec2 end = way.spans.back().point(3);
        curve.spans.insert(curve.spans.end(), way.spans.begin(), way.spans.end());
        append_line(curve, end, b);
    } else if (side.is_line) {
        append_line(curve, a, b);
    } else if (a != b) {
        append_arc(curve, side.centre, a, b);
    }
}

curves::Outline outline_of(const Segment& segment, const Wedge& w, const Form& form) {
    curves::Curve curve;
    append_side(curve, segment.edge.a, w.behind[0], w.corner);
    append_side(curve, segment.edge.b, w.corner, w.behind[1]);
    append_line(curve, w.behind[1], w.contact[1]);
    switch (form.profile) {
        case Profile::ball:
            append_arc(curve, w.centre, w.contact[1], w.contact[0]);
            break;
        case Profile::chamfer:
            append_line(curve, w.contact[1], w.contact[0]);
            break;
        case Profile::conic:
            append_conic(curve, segment, w, form.shape);
            break;
    }
    append_line(curve, w.contact[0], w.behind[0]);
    curve.closed = true;
    curves::Outline outline;
    outline.curves.push_back(std::move(curve));
    return outline;
}

/// Where a ball's centre is; also where leaves meet flush there, which is no boundary: both sides tell the same then.
Where at_centre(const Body& body, const Touch& touch, double radius) {
    const Where where = body.where(touch.centre);
    if (where != Where::on) return where;
    const Vec3 step = (touch.outward[0] - touch.outward[1]) * (0x1p-14 * radius);
    const Where beside = body.where(touch.centre + step);
    return body.where(touch.centre - step) == beside ? beside : Where::on;
}

}  // namespace

std::optional<Wedge> wedge_of(const Segment& segment, double radius) {
    const double s = segment.sign();
    const EdgeCurve& e = segment.edge;
    const auto centre = e.at_distances(s * radius, s * radius);
    const double beyond = -s * kBeyond * radius;
    const auto corner = e.at_distances(beyond, beyond);
    if (!centre || !corner) return std::nullopt;
    Wedge w;
    w.radius = radius;
    w.centre = *centre;
    w.corner = *corner;
    for (std::size_t i = 0; i < 2; ++i) {
        const SectionCurve& side = i == 0 ? e.a : e.b;
        w.contact[i] = w.centre - side.outward(w.centre) * (s * radius);
        w.behind[i] = w.contact[i] + side.outward(w.contact[i]) * beyond;
        if (e.is_circle && !(w.contact[i].x >= 0.0 && w.behind[i].x >= 0.0)) return std::nullopt;
        // Past the centre of a bend the normal turns over.
        if (side.run && !(dot(side.outward(w.centre), side.outward(w.contact[i])) > 0.5))
            return std::nullopt;
    }
    // A ball beyond the axis would touch its own other side.
    if (e.is_circle && !(w.centre.x >= 0.0 && w.corner.x >= 0.0)) return std::nullopt;
    return w;
}

Touch touch_at(const Segment& segment, const Wedge& w, double t) {
    Touch touch;
    touch.centre = segment.edge.place(w.centre, t);
    for (std::size_t i = 0; i < 2; ++i) {
        const SectionCurve& side = i == 0 ? segment.edge.a : segment.edge.b;
        touch.contact[i] = segment.edge.place(w.contact[i], t);
        touch.outward[i] = segment.edge.turn(side.outward(w.contact[i]), t);
    }
    return touch;
}

std::optional<Touch> touch_at(const Body& body, const Segment& segment, double radius, double t) {
    if (!segment.space) {
        const auto wedge = wedge_of(segment, radius);
        return wedge ? std::optional(touch_at(segment, *wedge, t)) : std::nullopt;
    }
    const double s = segment.sign();
    Touch touch;
    const Surface& a = body.faces()[segment.face_a].surface;
    const Surface& b = body.faces()[segment.face_b].surface;
    const double side_a = segment.edge.a.side;
    const double side_b = segment.edge.b.side;
    const Vec3 at = segment.point(t);
    const Vec3 na = a.normal(at) * side_a;
    const Vec3 nb = b.normal(at) * side_b;
    // Between planes it would be here.
    touch.centre = at + (na + nb) * (s * radius / (1.0 + dot(na, nb)));
    const double reach = norm(touch.centre - at);
    if (!to_distances(a, side_a * s * radius, b, side_b * s * radius, segment.tangent(t),
                      touch.centre)) {
        return std::nullopt;
    }
    // Newton's method may find another corner of the same two surfaces.
    if (!(norm(touch.centre - at) < 4.0 * reach)) return std::nullopt;
    for (std::size_t i = 0; i < 2; ++i) {
        const Vec3 n = (i == 0 ? a : b).normal(touch.centre) * (i == 0 ? side_a : side_b);
        touch.contact[i] = touch.centre - n * (s * radius);
        touch.outward[i] = (i == 0 ? a : b).normal(touch.contact[i]) * (i == 0 ? side_a : side_b);
        // Past a surface's centre or axis its normal turns over.
        if (!(dot(n, touch.outward[i]) > 0.0)) return std::nullopt;
    }
    return touch;
}

double touch_work(const Body& body, const Segment& segment) {
    // Newton's method takes some four steps, and asks for both surfaces' normals beside.
    constexpr double kTimes = 8.0;
    if (!segment.space) return 1.0;
    return kTimes * (body.faces()[segment.face_a].surface.work() +
                     body.faces()[segment.face_b].surface.work());
}

double extent_of(const Body& body, const Segment& segment, double radius) {
    double extent = 0.0;
    constexpr int kPlaces = 64;
    for (int i = 0; i <= kPlaces; ++i) {
        const double t = segment.lo + (segment.hi - segment.lo) * i / kPlaces;
        const auto touch = touch_at(body, segment, radius, t);
        if (!touch) continue;
        const Vec3 at = segment.point(t);
        for (const Vec3 p : {touch->contact[0], touch->contact[1], touch->centre}) {
            extent = std::max(extent, norm(p - at));
        }
        if (!segment.space) break;
    }
    return extent;
}

Fitting fitting_of(const Body& body, const Segment& segment, double radius, const Spend& spend,
                   std::size_t first_face) {
    if (segment.space) {
        if (!segment.space->is_smooth()) return {Fit::endless_bend, 0};
        const Surface& a = body.faces()[segment.face_a].surface;
        const Surface& b = body.faces()[segment.face_b].surface;
        const std::size_t nodes = segment.space->steps() * (segment.space->is_closed() ? 2 : 1);
        for (std::size_t i = 0; i <= nodes; ++i) {
            const double t = segment.space->node(i);
            if (t < segment.lo || t > segment.hi) continue;
            const Vec3 p = segment.point(t);
            if (norm(cross(a.normal(p), b.normal(p))) < kTouching) return {Fit::touching, 0};
        }
    }
    double lo = segment.lo;
    double hi = segment.hi;
    const double margin = extent_of(body, segment, radius) / segment.speed();
    if (!segment.is_closed) {
        // In a corner the ball comes to rest, and at other ends it is another's concern.
        const End& end = segment.ends[segment.ends[0].rest_face ? 0 : 1];
        if (end.rest_face && segment.rolled() < -kPress * radius)
            return {Fit::blocked, *end.rest_face};
        const double first = lo + segment.ends[0].rest;
        const double last = std::max(first, hi - segment.ends[1].rest);
        lo = std::clamp(std::min(lo + margin, segment.middle()), first, last);
        hi = std::clamp(std::max(hi - margin, segment.middle()), first, last);
    }
    // Along a line or a circle only other faces make a difference, along a curve in space all does.
    const int places = segment.space ? 192 : 16;
    const double work = places * (touch_work(body, segment) + 6.0 * body.where_work());
    if (spend && !spend(work)) return {Fit::stopped, 0};
    Vec3 last;
    for (int i = 0; i < places; ++i) {
        const double t = lo + (hi - lo) * (i + 0.5) / places;
        const auto touch = touch_at(body, segment, radius, t);
        if (!touch) return {Fit::none, 0};
        // A ball larger than its path's curvature allows runs back.
        if (i > 0 && dot(touch->centre - last, segment.tangent(t)) < 0.0 && segment.space) {
            const auto before = touch_at(body, segment, radius, t - 0x1p-6 * (hi - lo));
            if (!before || dot(touch->centre - before->centre, segment.tangent(t)) < 0.0)
                return {Fit::none, 0};
        }
        last = touch->centre;
        if (const Fitting f = at_contacts(body, segment, *touch, radius); f.fit != Fit::good)
            return f;
        // A ball as large as the whole solid may have its foot on another face where that ends.
        if (at_centre(body, *touch, radius) != (segment.is_convex ? Where::in : Where::out))
            return {Fit::none, 0};
        if (lo == hi) break;
    }
    return among_others(body, segment, radius, lo, hi, margin, spend, first_face);
}

Result<csg::Solid> solid_of(const Segment& segment, const Form& form, double lo, double hi,
                            SourceSpan span) {
    const EdgeCurve& e = segment.edge;
    const auto wedge = wedge_of(segment, form.radius);
    RAYMO_ASSERT(wedge.has_value());
    auto outline = std::make_shared<const curves::Outline>(outline_of(segment, *wedge, form));
    Vec3 u = e.across;
    Vec3 v = e.up;
    if (e.is_circle) {
        u = e.across * std::cos(lo) + e.up * std::sin(lo);
        v = cross(e.along, u);
    }
    const Affine map = frame(u, v, e.along, e.is_circle ? e.origin : e.origin + e.along * lo);
    auto solid = e.is_circle
                     ? make<solids::Revolve>(
                           {std::move(outline),
                            segment.is_closed ? 360.0 : std::min((hi - lo) * kDegrees, 360.0)},
                           span)
                     : make<solids::Prism>({std::move(outline), hi - lo, false}, span);
    if (!solid) return solid;
    return csg::transform(std::move(*solid), map, span);
}

double reach_past(const Body& body, const Segment& segment, double radius, std::size_t end,
                  const Surface& surface, double limit) {
    const double at = segment.ends[end].at;
    // Along a curve in space nothing tells but trying.
    if (segment.space)
        return std::min(limit, 2.0 * extent_of(body, segment, radius) / segment.speed());
    const auto wedge = wedge_of(segment, radius);
    RAYMO_ASSERT(wedge.has_value());
    const double sign = end == 0 ? -1.0 : 1.0;
    double reach = 0.0;
    std::vector<double> crossings;
    for (const Vec2 p : {wedge->contact[0], wedge->contact[1], wedge->corner, wedge->centre}) {
        crossings.clear();
        const double lo = sign > 0.0 ? at : at - limit;
        append_crossings(segment.edge, p, surface, lo, lo + limit, crossings);
        double nearest = limit;
        for (const double t : crossings) {
            double beyond = sign * (t - at);
            if (segment.edge.is_circle) {
                beyond = std::remainder(beyond, 2.0 * std::numbers::pi);
            }
            if (beyond >= 0.0) nearest = std::min(nearest, beyond);
        }
        // What is past it already counts as nothing.
        if (nearest < limit) reach = std::max(reach, nearest);
    }
    return reach;
}

}  // namespace raymo::blends
