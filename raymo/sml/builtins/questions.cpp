// Questions about solids. Those that need rays are answered by the host.

#include <fmt/core.h>

#include <cmath>

#include "raymo/sml/builtins/box.hpp"

namespace raymo::sml {
namespace {

Value record(Call& call, std::initializer_list<std::pair<std::string_view, Value>> fields) {
    std::vector<std::pair<Symbol, Value>> out;
    for (const auto& [name, value] : fields) {
        out.emplace_back(call.evaluator().program().symbols.intern(name), value);
    }
    return Value::record(std::move(out));
}

bool unanswered(Call& call) {
    return call.fail(ErrorCode::not_available, "questions that need rays can not be answered here");
}

bool bounds(Call& call, Value& out) {
    const bool is_plane = call.has(0) && call[0].is(Tag::contour);
    Aabb box;
    if (!box_of(call, 0, box)) return false;
    const auto point = [&](Vec3 p) {
        return is_plane ? Value::list({Value::number(p.x), Value::number(p.y)}) : Value::vector(p);
    };
    out = record(call, {{"min", point(box.lo)},
                        {"max", point(box.hi)},
                        {"size", point(box.size())},
                        {"center", point(box.centre())}});
    return true;
}

bool contains(Call& call, Value& out) {
    csg::Solid solid;
    Vec3 point;
    if (!call.solid(0, solid) || !call.vector(1, point)) return false;
    const auto& ask = call.evaluator().host().answers.contains;
    if (!ask) return unanswered(call);
    auto answer = ask(solid, point);
    if (!answer) return call.fail(std::move(answer).error());
    out = Value::boolean(*answer);
    return true;
}

bool is_empty(Call& call, Value& out) {
    if (call[0].is(Tag::nothing)) {
        out = Value::boolean(true);
        return true;
    }
    csg::Solid solid;
    if (!call.solid(0, solid)) return false;
    const auto& ask = call.evaluator().host().answers.is_empty;
    if (!ask) return unanswered(call);
    auto answer = ask(solid);
    if (!answer) return call.fail(std::move(answer).error());
    out = Value::boolean(*answer);
    return true;
}

// An end at infinity is `nothing`.
Value where(double t, Vec3 v) { return std::isfinite(t) ? Value::vector(v) : Value::nothing(); }
Value parameter(double t) { return std::isfinite(t) ? Value::number(t) : Value::nothing(); }

bool hits(Call& call, Value& out) {
    csg::Solid solid;
    Ray ray;
    if (!call.solid(0, solid) || !call.vector(1, ray.origin) || !call.direction(2, ray.direction)) {
        return false;
    }
    const auto& ask = call.evaluator().host().answers.hits;
    if (!ask) return unanswered(call);
    auto answer = ask(solid, ray);
    if (!answer) return call.fail(std::move(answer).error());
    std::vector<Value> spans;
    if (!call.evaluator().room(1024.0 * static_cast<double>(answer->size()), call.node()))
        return false;
    for (const HitInterval& hit : *answer) {
        spans.push_back(record(call, {{"enter", parameter(hit.enter)},
                                      {"exit", parameter(hit.exit)},
                                      {"enter_point", where(hit.enter, hit.enter_point)},
                                      {"exit_point", where(hit.exit, hit.exit_point)},
                                      {"enter_normal", where(hit.enter, hit.enter_normal)},
                                      {"exit_normal", where(hit.exit, hit.exit_normal)}}));
    }
    out = Value::list(std::move(spans));
    return true;
}

}  // namespace

std::span<const BuiltinRow> question_rows() {
    static constexpr auto kRows = std::to_array<BuiltinRow>({
        {"bounds", "s", &bounds,
         "The box around a solid, a contour, a path or a mesh: {min, max, size, center}."},
        {"contains", "s p", &contains, "True when the point is in the solid or on its boundary."},
        {"hits", "s origin direction", &hits,
         "Where a line is inside: {enter, exit, enter_point, ...} in order."},
        {"is_empty", "s", &is_empty, "True when the solid has no points."},
    });
    return kRows;
}

}  // namespace raymo::sml
