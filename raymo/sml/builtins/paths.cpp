// Paths: curves in space with a radius at every place.

#include <fmt/core.h>

#include <array>

#include "raymo/curves/build_path.hpp"
#include "raymo/sml/builtins/call.hpp"
#include "raymo/sml/text.hpp"

namespace raymo::sml {
namespace {

using curves::SplineForm;
using curves::SplineKind;
using Point4 = curves::Point<4>;

bool finish(Call& call, Result<curves::BuiltPath> made, std::initializer_list<std::size_t> slots,
            Value& out) {
    if (!made) return call.fail(std::move(made).error(), std::span(slots.begin(), slots.size()));
    if (made->is_clamped) {
        call.warn("between its points the radius would fall below 0; it is 0 there",
                  "a path of `kind: \"bspline\"` stays between its radii");
    }
    return call.evaluator().made(std::make_shared<const curves::Path>(std::move(made->path)),
                                 call.node(), out);
}

/// (x, y, z, r), or (x, y, z) with the radius that holds everywhere.
bool is_point(const Value& value, bool has_radius, double radius, Point4& out) {
    if (!value.is(Tag::list) || value.items().size() != (has_radius ? 3U : 4U)) return false;
    for (std::size_t k = 0; k < value.items().size(); ++k) {
        if (!value.items()[k].is(Tag::number)) return false;
        out[k] = value.items()[k].number();
    }
    if (has_radius) out[3] = radius;
    return true;
}

/// What is wrong with a point, and how to mend it.
std::string point_hint(const Value& value, bool has_radius) {
    const std::size_t size = value.is(Tag::list) ? value.items().size() : 0;
    if (has_radius && size == 4) return "leave out `radius`, or the fourth number";
    if (!has_radius && size == 3) return "write radius: 2, or (x, y, z, r) for every point";
    return has_radius ? "a point is written (x, y, z)" : "a point is written (x, y, z, r)";
}

// path(points, radius: r), path([(x, y, z, r), ...])
bool path(Call& call, Value& out) {
    static constexpr auto kKinds =
        std::to_array<std::string_view>({"bspline", "bezier", "catmull", "interpolate", "linear"});
    static constexpr std::array kSplines{SplineKind::bspline, SplineKind::bezier,
                                         SplineKind::catmull, SplineKind::interpolate,
                                         SplineKind::linear};
    SplineForm form;
    std::size_t kind = 0;
    if (call.has(2) && !call.choice(2, kKinds, kind)) return false;
    form.kind = kSplines[kind];
    if (!spline_degree(call, 3, form)) return false;
    if (call.has(3) && kind > 1) {
        return call.fail(3, ErrorCode::bad_argument,
                         "`degree` goes with B-splines and Bezier curves", "leave it out");
    }
    if (call.has(4) && !call.flag(4, form.closed)) return false;
    if (!spline_ends(call, 5, form)) return false;
    double radius = 0.0;
    const bool has_radius = call.has(1);
    if (has_radius && !call.positive(1, radius)) return false;
    if (!call.has(0) || !call[0].is(Tag::list)) {
        return call.wrong_kind(0, "a list of points",
                               "write it as [(0, 0, 0), (10, 0, 5), (20, 5, 5)]");
    }
    const auto& items = call[0].items();
    if (!call.evaluator().room(1000.0 * static_cast<double>(items.size()), call.node()))
        return false;
    std::vector<Point4> points(items.size());
    for (std::size_t k = 0; k < items.size(); ++k) {
        if (is_point(items[k], has_radius, radius, points[k])) continue;
        return call.fail(0, ErrorCode::bad_argument,
                         has_radius ? "`points` must be a list of points of three numbers"
                                    : "`points` must be a list of points of three numbers and a "
                                      "radius",
                         point_hint(items[k], has_radius),
                         fmt::format("[{}] is {}", k, numbers_text(items[k])));
    }
    return call.evaluator().worked(static_cast<double>(items.size()), call.node()) &&
           finish(call, curves::spline_path(points, form), {0, 3}, out);
}

bool helix(Call& call, Value& out) {
    std::array<double, 4> n{};
    for (std::size_t i = 0; i < 4; ++i) {
        if (!call.number(i, n[i])) return false;
    }
    if (n[2] > 0.0 && n[2] < curves::kMostPathSpans &&
        !call.evaluator().room(36.0 * n[2] * sizeof(curves::PathSpan), call.node())) {
        return false;
    }
    auto made = curves::helix(n[0], n[1], n[2], n[3]);
    if (!made) {
        static constexpr std::array<std::size_t, 4> kSlots{0, 1, 2, 3};
        return call.fail(std::move(made).error(), kSlots);
    }
    return call.evaluator().made(std::make_shared<const curves::Path>(std::move(*made)),
                                 call.node(), out);
}

/// The two numbers of low..high or (low, high).
bool interval(Call& call, std::size_t i, Vec2& out) {
    if (call.has(i) && call[i].is(Tag::range)) {
        out = {call[i].as<RangeObject>().low, call[i].as<RangeObject>().high};
        return true;
    }
    if (call.has(i) && is_vector2(call[i], out)) return true;
    return call.wrong_kind(i, "a range", "write it as 0..1");
}

// path_from(fn(t) (x, y, z, r), 0..1), path_from(fn(t) (x, y, z), 0..1, radius: r)
bool path_from(Call& call, Value& out) {
    constexpr double kTolerance = 1e-4;
    Vec2 range;
    double radius = 0.0;
    double tolerance = kTolerance;
    const bool has_radius = call.has(2);
    if (!call.function(0) || !interval(call, 1, range) ||
        (has_radius && !call.positive(2, radius)) ||
        (call.has(3) && !call.positive(3, tolerance))) {
        return false;
    }
    bool is_reported = false;
    const curves::PathFunction f = [&](double t) -> Result<Point4> {
        const Value argument = Value::number(t);
        Value given;
        Point4 p{};
        if (!call.evaluator().call(call[0], std::span(&argument, 1), call.node(), given) ||
            !call.evaluator().step(call.node())) {
            is_reported = true;
            return fail(ErrorCode::evaluation, {});
        }
        if (is_point(given, has_radius, radius, p)) return p;
        return fail(Error{ErrorCode::bad_argument,
                          has_radius ? "the function must give three numbers"
                                     : "the function must give three numbers and a radius",
                          fmt::format("it gave {} for {}", numbers_text(given), number_text(t)),
                          point_hint(given, has_radius),
                          0,
                          {}});
    };
    auto made = curves::fit_path(f, range.x, range.y, tolerance);
    return !is_reported && finish(call, std::move(made), {0, 1, 3}, out);
}

}  // namespace

std::span<const BuiltinRow> path_rows() {
    static constexpr auto kRows = std::to_array<BuiltinRow>({
        {"path", "points radius? | kind? degree? closed? ends?", &path,
         "A curve of spheres: points (x, y, z) with one radius, or (x, y, z, r)."},
        {"helix", "radius pitch turns thickness", &helix,
         "A wire of that thickness, its diameter, that climbs by `pitch` each turn about z."},
        {"path_from", "f range | radius? tolerance?", &path_from,
         "The path that a function draws, to a tolerance of 1e-4 mm or what is given."},
    });
    return kRows;
}

}  // namespace raymo::sml
