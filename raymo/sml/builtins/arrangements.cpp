// Many of one solid: the instances share it, and rows of rows share the rows, so that a grid of nx x ny x nz costs the
// memory of nx + ny + nz.

#include <fmt/core.h>

#include <cmath>

#include "raymo/curves/build_spline.hpp"
#include "raymo/sml/builtins/call.hpp"
#include "raymo/sml/text.hpp"

namespace raymo::sml {
namespace {

constexpr double kMostInstances = 1e9;
constexpr double kRow = 4096;  ///< longer rows are made of rows

bool instance(Call& call, const csg::Solid& s, const Affine& map, std::vector<csg::Solid>& out) {
    auto placed = csg::transform(s, map, call.span());
    Value counted;
    if (!call.result(std::move(placed), counted)) return false;
    out.push_back(counted.solid());
    return true;
}

// n instances of s at 0, step, 2 step, ...
bool row(Call& call, const csg::Solid& s, double n, Vec3 step, csg::Solid& out) {
    if (n == 1) {
        out = s;
        return true;
    }
    csg::Solid element = s;
    double inner = 1;
    if (n > kRow) {
        inner = std::floor(std::sqrt(n));
        if (!row(call, s, inner, step, element)) return false;
    }
    const double outer = std::floor(n / inner);
    std::vector<csg::Solid> operands{element};
    operands.reserve(static_cast<std::size_t>(outer) + 1);
    for (double i = 1; i < outer; ++i) {
        if (!instance(call, element, translation(step * (i * inner)), operands)) return false;
    }
    const double left = n - outer * inner;
    if (left > 0) {
        csg::Solid tail;
        if (!row(call, s, left, step, tail) ||
            !instance(call, tail, translation(step * (outer * inner)), operands)) {
            return false;
        }
    }
    Value value;
    if (!call.evaluator().combine(csg::Op::unite, std::move(operands), call.node(), call.span(),
                                  value)) {
        return false;
    }
    out = value.solid();
    return true;
}

// Contours that are turned are drawn anew for each copy, so there may be fewer of them.
constexpr double kMostContours = 1e6;

// The union of n copies of a contour, each under its own map of the plane.
template <class F>
bool copies(Call& call, double n, F&& map_of, Value& out) {
    const curves::Contour contour = call[0].as<ContourObject>().value;
    const double bytes = curves::bytes_of_image(contour, map_of(1.0));
    if (!call.evaluator().room(bytes * n, call.node())) return false;
    std::vector<curves::Contour> operands{contour};
    double charged = 0.0;
    for (double i = 1; i < n; ++i) {
        operands.push_back(curves::mapped(contour, map_of(i)));
        if (!(curves::extent_of(operands.back()) <= curves::kLargestCoordinate)) {
            return call.fail(ErrorCode::out_of_range,
                             "the contour becomes too large to be computed with",
                             "stay within 1e90 of the origin");
        }
        charged += bytes;
        if (!call.evaluator().worked(bytes / 64.0, call.node())) return false;
    }
    curves::Contour all = curves::combined(curves::ContourOp::unite, std::move(operands));
    if (n == 1) {
        out = Value(call[0]);
        return true;
    }
    charged += curves::bytes_of(*all);
    return call.evaluator().made(std::move(all), charged, call.node(), out);
}

bool repeat_contour(Call& call, Value& out) {
    double n = 0.0;
    Vec2 step;
    return call.whole(1, 1, kMostContours, n) && call.vector2(2, step) &&
           copies(
               call, n, [&](double i) { return Affine2{1, 0, step.x * i, 0, 1, step.y * i}; }, out);
}

bool repeat(Call& call, Value& out) {
    if (call.has(0) && call[0].is(Tag::contour)) return repeat_contour(call, out);
    csg::Solid s;
    double n = 0.0;
    Vec3 step;
    if (!call.solid(0, s) || !call.whole(1, 1, kMostInstances, n) || !call.vector(2, step))
        return false;
    csg::Solid all;
    if (!row(call, s, n, step, all)) return false;
    out = Value::solid(std::move(all));
    return true;
}

bool ring(Call& call, Value& out) {
    csg::Solid s;
    double n = 0.0;
    Vec3 axis{0, 0, 1};
    double angle = 360.0;
    const bool is_contour = call.has(0) && call[0].is(Tag::contour);
    if ((!is_contour && !call.solid(0, s)) || !call.whole(1, 1, 1e6, n)) return false;
    if (call.has(2) && !call.axis(2, axis)) return false;
    if (call.has(3) && !call.number(3, angle)) return false;
    // A full turn ends where it began; less than that has an instance at both ends.
    const bool is_full = std::fabs(angle) >= 360.0;
    const double step = n == 1 ? 0.0 : angle / (is_full ? n : n - 1);
    if (is_contour) {
        if (axis.x != 0.0 || axis.y != 0.0) {
            return call.fail(2, ErrorCode::bad_argument, "a contour stays in its plane, z = 0",
                             "make a solid of it first, and ring that");
        }
        const double sense = axis.z < 0.0 ? -1.0 : 1.0;
        return copies(
            call, n,
            [&](double i) {
                const SinCos at = sin_cos_degrees(sense * i * step);
                return Affine2{at.cos, -at.sin, 0, at.sin, at.cos, 0};
            },
            out);
    }
    std::vector<csg::Solid> operands{s};
    for (double i = 1; i < n; ++i) {
        if (!instance(call, s, rotation(unit(axis), i * step), operands)) return false;
    }
    return call.evaluator().combine(csg::Op::unite, std::move(operands), call.node(), call.span(),
                                    out);
}

bool grid(Call& call, Value& out) {
    csg::Solid s;
    std::array<double, 3> n{};
    if (!call.solid(0, s)) return false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!call.whole(1 + axis, 1, kMostInstances, n[axis])) return false;
    }
    if (n[0] * n[1] * n[2] > kMostInstances) {
        return call.fail(ErrorCode::out_of_range,
                         fmt::format("at most {} instances", number_text(kMostInstances)), {});
    }
    Vec3 pitch;
    if (call.has(4) && call[4].is(Tag::number)) {
        pitch = {call[4].number(), call[4].number(), call[4].number()};
    } else if (!call.vector(4, pitch)) {
        return false;
    }
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 step;
        step[axis] = pitch[axis];
        csg::Solid line;
        if (!row(call, s, n[static_cast<std::size_t>(axis)], step, line)) return false;
        s = line;
    }
    out = Value::solid(std::move(s));
    return true;
}

}  // namespace

std::span<const BuiltinRow> arrangement_rows() {
    static constexpr auto kRows = std::to_array<BuiltinRow>({
        {"repeat", "s n step", &repeat, "n instances, each moved by `step` from the one before."},
        {"ring", "s n axis? angle?", &ring, "n instances around an axis through the origin."},
        {"grid", "s nx ny nz pitch", &grid, "nx x ny x nz instances, `pitch` apart."},
    });
    return kRows;
}

}  // namespace raymo::sml
