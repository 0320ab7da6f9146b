// Contours: regions of the plane, and the curves that bound them.

#include <fmt/core.h>

#include <array>

#include "raymo/curves/build_contour.hpp"
#include "raymo/sml/builtins/call.hpp"

namespace raymo::sml {
namespace {

using curves::Curve;
using curves::SplineForm;
using curves::SplineKind;

/// A curve as a contour of its own, or the error of its making.
bool finish(Call& call, Result<Curve> made, std::initializer_list<std::size_t> slots, Value& out) {
    if (!made) return call.fail(std::move(made).error(), std::span(slots.begin(), slots.size()));
    const curves::Contour contour = curves::contour_of(std::move(*made));
    return call.evaluator().made(contour, curves::bytes_of(contour), call.node(), out);
}

bool polygon(Call& call, Value& out) {
    std::vector<Vec2> points;
    return call.points(0, points) && finish(call, curves::polygon(points), {0}, out);
}

bool circle(Call& call, Value& out) {
    double radius = 0.0;
    std::size_t given = 0;
    return call.half(0, radius, given) && finish(call, curves::circle(radius), {given}, out);
}

// rectangle(w, h), rectangle((w, h)), rectangle(side)
bool rectangle(Call& call, Value& out) {
    Vec2 size;
    double radius = 0.0;
    bool is_centred = false;
    const bool is_vector = call.has(0) && call[0].is(Tag::list);
    if (is_vector) {
        if (call.has(1)) {
            return call.fail(1, ErrorCode::bad_argument, "the size is given already",
                             "give one vector, two numbers, or one number for a square");
        }
        if (!call.vector2(0, size)) return false;
    } else {
        if (!call.number(0, size.x)) return false;
        size.y = size.x;
        if (call.has(1) && !call.number(1, size.y)) return false;
    }
    if (call.has(2) && !call.number(2, radius)) return false;
    if (call.has(3) && !call.flag(3, is_centred)) return false;
    return finish(call, curves::rectangle(size.x, size.y, radius, is_centred),
                  {0, call.has(1) ? std::size_t{1} : 0, 2}, out);
}

bool regular(Call& call, Value& out) {
    double n = 0.0;
    double radius = 0.0;
    std::size_t given = 0;
    if (!call.number(0, n) || !call.half(1, radius, given)) return false;
    if (n > 0 && n <= 1e6 && !call.evaluator().room(300.0 * n, call.node())) return false;
    return finish(call, curves::regular(n, radius), {0, given}, out);
}

bool closed_flag(Call& call, std::size_t i, SplineForm& form) {
    return !call.has(i) || call.flag(i, form.closed);
}

bool spline(Call& call, const SplineForm& form, Value& out) {
    std::vector<Vec2> points;
    return call.points(0, points) && finish(call, curves::spline_curve(points, form), {0, 1}, out);
}

bool bspline(Call& call, Value& out) {
    SplineForm form{SplineKind::bspline, 3, false, false};
    return spline_degree(call, 1, form) && closed_flag(call, 2, form) &&
           spline_ends(call, 3, form) && spline(call, form, out);
}

bool bezier(Call& call, Value& out) {
    SplineForm form{SplineKind::bezier, 3, false, false};
    return spline_degree(call, 1, form) && closed_flag(call, 2, form) && spline(call, form, out);
}

bool catmull(Call& call, Value& out) {
    SplineForm form{SplineKind::catmull, 3, false, false};
    return closed_flag(call, 1, form) && spline(call, form, out);
}

bool interpolate(Call& call, Value& out) {
    SplineForm form{SplineKind::interpolate, 3, false, false};
    return closed_flag(call, 1, form) && spline(call, form, out);
}

// arc(r, start, end, center: p) or arc(through: [a, b, c])
bool arc(Call& call, Value& out) {
    constexpr std::size_t kCentre = 3;
    constexpr std::size_t kThrough = 4;
    constexpr std::size_t kDiameter = 5;
    if (call.has(kThrough)) {
        for (const std::size_t i :
             {std::size_t{0}, std::size_t{1}, std::size_t{2}, kCentre, kDiameter}) {
            if (!call.has(i)) continue;
            return call.fail(i, ErrorCode::bad_argument,
                             fmt::format("give {} or {}, not both", call.argument_name(i),
                                         call.argument_name(kThrough)));
        }
        std::vector<Vec2> p;
        if (!call.points(kThrough, p)) return false;
        if (p.size() != 3) {
            return call.fail(kThrough, ErrorCode::bad_argument, "`through` must be three points",
                             "its beginning, a point on the way, and its end",
                             fmt::format("this is a list of {}", p.size()));
        }
        return finish(call, curves::arc_through(p[0], p[1], p[2]), {kThrough}, out);
    }
    double radius = 0.0;
    double from = 0.0;
    double to = 0.0;
    Vec2 centre;
    std::size_t given = 0;
    return call.half(0, radius, given) && call.number(1, from) && call.number(2, to) &&
           (!call.has(kCentre) || call.vector2(kCentre, centre)) &&
           finish(call, curves::arc_curve(radius, from, to, centre), {given, 1, 2, kCentre}, out);
}

/// Calls f(value, argument) for each operand, those of lists too.
template <class F>
bool for_each_operand(Call& call, F&& f) {
    for (std::size_t i = 0; i < call.rest().size(); ++i) {
        const Value& operand = call.rest()[i];
        const std::size_t argument = call.rest_begin() + i;
        if (!operand.is(Tag::list)) {
            if (!f(operand, argument, false)) return false;
            continue;
        }
        for (const Value& item : operand.items()) {
            if (!call.evaluator().step(call.node()) || !f(item, argument, true)) return false;
        }
    }
    return true;
}

// chain(a, b, c) or chain([a, b, c])
bool chain(Call& call, Value& out) {
    bool is_closed = false;
    if (call.has(0) && !call.flag(0, is_closed)) return false;
    std::vector<Curve> joined;
    std::vector<std::size_t> slots;
    double spans = 0.0;
    const bool good =
        for_each_operand(call, [&](const Value& value, std::size_t argument, bool is_in_list) {
            if (!value.is(Tag::contour)) {
                return call.fail(argument, ErrorCode::bad_argument, "every element must be a curve",
                                 "a straight piece is bspline([a, b], degree: 1)",
                                 operand_label(value, is_in_list));
            }
            const curves::Contour& contour = value.as<ContourObject>().value;
            if (contour->op != curves::ContourOp::outline || contour->outline->curves.size() != 1) {
                return call.fail(argument, ErrorCode::bad_argument,
                                 "every element must be one curve", "join regions with `+`",
                                 is_in_list ? "this list has several curves in one element"
                                            : "this has several curves");
            }
            joined.push_back(curves::placed_outline(*contour)->curves[0]);
            slots.push_back(argument);
            spans += static_cast<double>(joined.back().spans.size());
            return call.evaluator().room(2.0 * sizeof(curves::Span2) * spans, call.node());
        });
    if (!good) return false;
    auto made = curves::chain(joined, is_closed);
    if (!made) return call.fail(std::move(made).error(), slots);
    return finish(call, std::move(made), {}, out);
}

}  // namespace

bool spline_degree(Call& call, std::size_t i, SplineForm& form) {
    if (!call.has(i)) return true;
    double degree = 0.0;
    if (!call.whole(i, 1, 3, degree)) return false;
    form.degree = static_cast<int>(degree);
    return true;
}

bool spline_ends(Call& call, std::size_t i, SplineForm& form) {
    if (!call.has(i)) return true;
    static constexpr auto kEnds = std::to_array<std::string_view>({"free", "clamped"});
    std::size_t chosen = 0;
    if (!call.choice(i, kEnds, chosen)) return false;
    if (form.kind != SplineKind::bspline) {
        return call.fail(i, ErrorCode::bad_argument,
                         "`ends` goes with B-splines: the other kinds end at their end points");
    }
    if (form.closed) {
        return call.fail(i, ErrorCode::bad_argument, "a closed curve has no ends",
                         "leave out `closed` or `ends`");
    }
    form.clamped = chosen == 1;
    return true;
}

std::span<const BuiltinRow> contour_rows() {
    static constexpr auto kRows = std::to_array<BuiltinRow>({
        {"polygon", "points", &polygon, "The region with these corners."},
        {"circle", "r/d", &circle, "The disc about the origin, exact."},
        {"rectangle", "w h? | radius? center?", &rectangle,
         "A corner at the origin; `radius` rounds the corners, `center: true` centres it."},
        {"regular", "n r/d", &regular,
         "The regular polygon of n corners, the first on the x axis."},
        {"bspline", "points degree? | closed? ends?", &bspline,
         "The uniform B-spline of degree 1 to 3; `ends: \"clamped\"` makes it begin and end at its "
         "end points."},
        {"bezier", "points degree? | closed?", &bezier,
         "Bezier curves of degree 1 to 3 that share their end points."},
        {"catmull", "points | closed?", &catmull, "The Catmull-Rom spline through the points."},
        {"interpolate", "points | closed?", &interpolate,
         "The curve through the points with continuous curvature."},
        {"arc", "r/d? start? end? | center? through?", &arc,
         "The arc from one angle to another, or through three points."},
        {"chain", "curves* | closed?", &chain, "Curves end to end; closed where they come back."},
    });
    return kRows;
}

}  // namespace raymo::sml
