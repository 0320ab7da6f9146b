#include "raymo/sml/builtins/call.hpp"

#include <fmt/core.h>

#include <cmath>

#include "raymo/sml/suggest.hpp"
#include "raymo/sml/text.hpp"

namespace raymo::sml {

std::string operand_label(const Value& value, bool is_in_list) {
    return is_in_list ? fmt::format("this list has {} in it", kind_text(value))
                      : fmt::format("this is {}", kind_text(value));
}

bool is_vector2(const Value& value, Vec2& out) {
    if (!value.is(Tag::list) || value.items().size() != 2) return false;
    const auto& items = value.items();
    if (!items[0].is(Tag::number) || !items[1].is(Tag::number)) return false;
    out = {items[0].number(), items[1].number()};
    return true;
}

std::string kind_and_size(const Value& value) {
    return value.is(Tag::list) ? fmt::format("a list of {}", value.items().size())
                               : std::string(kind_text(value));
}

std::string numbers_text(const Value& value) {
    if (value.is(Tag::list)) {
        for (const Value& item : value.items()) {
            if (!item.is(Tag::number)) return fmt::format("a list with {} in it", kind_text(item));
        }
    }
    return kind_and_size(value);
}

bool is_vector(const Value& value, Vec3& out) {
    if (!value.is(Tag::list) || value.items().size() != 3) return false;
    for (std::size_t i = 0; i < 3; ++i) {
        if (!value.items()[i].is(Tag::number)) return false;
        out[static_cast<int>(i)] = value.items()[i].number();
    }
    return true;
}

SourceSpan Call::where(std::size_t i) const {
    const Ast& ast = evaluator_.program().ast;
    const Node& n = ast[node_];
    if (plan_ != nullptr) {
        for (std::size_t k = 0; k < plan_->parameter_of.size(); ++k) {
            if (plan_->parameter_of[k] != i) continue;
            NodeId argument = ast.child(n, first_ + static_cast<std::uint32_t>(k));
            if (ast[argument].kind == NodeKind::argument) argument = ast.child(ast[argument], 0);
            return ast[argument].span();
        }
    }
    return n.span();
}

std::string Call::argument_name(std::size_t i) const {
    const auto& parameters = builtin_.takes.parameters;
    if (i >= parameters.size()) return fmt::format("argument {}", i - parameters.size() + 1);
    return fmt::format("`{}`", parameters[i].name);
}

bool Call::fail(std::size_t i, ErrorCode code, std::string_view message, std::string hint,
                std::string label) {
    return evaluator_.fail(code, where(i), fmt::format("{}: {}", name(), message), std::move(hint),
                           std::move(label));
}

bool Call::fail(ErrorCode code, std::string_view message, std::string hint) {
    return evaluator_.fail(code, span(), fmt::format("{}: {}", name(), message), std::move(hint));
}

bool Call::fail(Error error) {
    if (!error.where.known()) error.where = span();
    return evaluator_.fail(std::move(error));
}

bool Call::wrong_kind(std::size_t i, std::string_view expected, std::string hint) {
    if (!has(i)) {
        return fail(ErrorCode::bad_argument,
                    fmt::format("the argument {} is missing", argument_name(i)),
                    fmt::format("it is {}", builtin_.takes.signature));
    }
    return fail(i, ErrorCode::bad_argument,
                fmt::format("{} must be {}", argument_name(i), expected), std::move(hint),
                fmt::format("this is {}", kind_text(slots_[i])));
}

bool Call::fail(Error error, std::span<const std::size_t> slots) {
    error.message = fmt::format("{}: {}", name(), error.message);
    if (error.argument >= 0 && static_cast<std::size_t>(error.argument) < slots.size()) {
        const std::size_t i = slots[static_cast<std::size_t>(error.argument)];
        error.where = where(i);
        // What was written is shown: a diameter, not the radius made of it.
        if (i < builtin_.takes.parameters.size() && builtin_.takes.parameters[i].stands_for >= 0 &&
            has(i) && slots_[i].is(Tag::number)) {
            error.label = "this is " + number_text(slots_[i].number());
        }
    }
    return fail(std::move(error));
}

void Call::warn(std::string_view message, std::string hint) {
    if (!evaluator_.warned_.insert(node_).second) return;
    evaluator_.reporter_.warn(span(), fmt::format("{}: {}", name(), message), std::move(hint));
}

bool Call::number(std::size_t i, double& out) {
    if (!has(i) || !slots_[i].is(Tag::number)) {
        return wrong_kind(i, "a number", fmt::format("it is {}", builtin_.takes.signature));
    }
    out = slots_[i].number();
    return true;
}

bool Call::positive(std::size_t i, double& out) {
    if (!number(i, out)) return false;
    if (out > 0.0) return true;
    return fail(i, ErrorCode::out_of_range,
                fmt::format("{} must be greater than 0", argument_name(i)), {},
                fmt::format("this is {}", number_text(out)));
}

bool Call::whole(std::size_t i, double low, double high, double& out) {
    if (!number(i, out)) return false;
    if (out == std::floor(out) && out >= low && out <= high) return true;
    return fail(i, ErrorCode::out_of_range,
                fmt::format("{} must be a whole number from {} to {}", argument_name(i),
                            number_text(low), number_text(high)),
                {}, fmt::format("this is {}", number_text(out)));
}

bool Call::flag(std::size_t i, bool& out) {
    if (!has(i) || !slots_[i].is(Tag::boolean)) return wrong_kind(i, "true or false");
    out = slots_[i].boolean();
    return true;
}

bool Call::vector(std::size_t i, Vec3& out) {
    if (has(i) && is_vector(slots_[i], out)) return true;
    if (has(i) && slots_[i].is(Tag::list)) {
        return fail(i, ErrorCode::bad_argument,
                    fmt::format("{} must be three numbers", argument_name(i)),
                    "write it as (x, y, z)", "this is " + numbers_text(slots_[i]));
    }
    return wrong_kind(i, "three numbers", "write it as (x, y, z)");
}

bool Call::direction(std::size_t i, Vec3& out) {
    if (!vector(i, out)) return false;
    if (max_norm(out) > 0.0) return true;
    return fail(i, ErrorCode::out_of_range,
                fmt::format("{} must not be (0, 0, 0)", argument_name(i)), "upwards is (0, 0, 1)",
                "this has no direction");
}

bool Call::axis(std::size_t i, Vec3& out) {
    if (!has(i) || !slots_[i].is(Tag::string)) return direction(i, out);
    static constexpr auto kAxes = std::to_array<std::string_view>({"x", "y", "z"});
    std::size_t chosen = 0;
    if (!choice(i, kAxes, chosen)) return false;
    out = {};
    out[static_cast<int>(chosen)] = 1.0;
    return true;
}

bool Call::text(std::size_t i, std::string& out) {
    if (!has(i) || !slots_[i].is(Tag::string)) return wrong_kind(i, "a string");
    out = slots_[i].string();
    return true;
}

bool Call::solid(std::size_t i, csg::Solid& out) {
    if (has(i) && slots_[i].is(Tag::solid)) {
        out = slots_[i].solid();
        return true;
    }
    const bool is_list = has(i) && slots_[i].is(Tag::list);
    return wrong_kind(i, "a solid", is_list ? "union(list) makes one solid of a list" : "");
}

bool Call::contour(std::size_t i, curves::Contour& out) {
    if (has(i) && slots_[i].is(Tag::contour)) {
        out = slots_[i].as<ContourObject>().value;
        return true;
    }
    const bool is_list = has(i) && slots_[i].is(Tag::list);
    return wrong_kind(i, "a contour",
                      is_list ? "polygon(points) makes one of a list of points" : "");
}

bool Call::path(std::size_t i, curves::PathPtr& out) {
    if (has(i) && slots_[i].is(Tag::path)) {
        out = slots_[i].as<PathObject>().value;
        return true;
    }
    const bool is_list = has(i) && slots_[i].is(Tag::list);
    return wrong_kind(i, "a path",
                      is_list ? "path(points, radius: r) makes one of a list of points" : "");
}

bool Call::mesh(std::size_t i, meshes::MeshPtr& out) {
    if (has(i) && slots_[i].is(Tag::mesh)) {
        out = slots_[i].as<MeshObject>().value;
        return true;
    }
    const bool is_list = has(i) && slots_[i].is(Tag::list);
    return wrong_kind(i, "a mesh", is_list ? "mesh(points, faces) makes one of two lists" : "");
}

bool Call::vector2(std::size_t i, Vec2& out) {
    if (has(i) && is_vector2(slots_[i], out)) return true;
    if (has(i) && slots_[i].is(Tag::list)) {
        return fail(i, ErrorCode::bad_argument,
                    fmt::format("{} must be two numbers", argument_name(i)), "write it as (x, y)",
                    "this is " + numbers_text(slots_[i]));
    }
    return wrong_kind(i, "two numbers", "write it as (x, y)");
}

bool Call::points(std::size_t i, std::vector<Vec2>& out) {
    if (!has(i) || !slots_[i].is(Tag::list)) {
        return wrong_kind(i, "a list of points", "write it as [(0, 0), (10, 0), (10, 5)]");
    }
    const auto& items = slots_[i].items();
    if (!evaluator_.room(500.0 * static_cast<double>(items.size()), node_)) return false;
    out.clear();
    out.reserve(items.size());
    for (std::size_t k = 0; k < items.size(); ++k) {
        Vec2 p;
        if (!is_vector2(items[k], p)) {
            return fail(i, ErrorCode::bad_argument,
                        fmt::format("{} must be a list of points of two numbers", argument_name(i)),
                        "a point is written (x, y)",
                        fmt::format("[{}] is {}", k, numbers_text(items[k])));
        }
        out.push_back(p);
    }
    return evaluator_.worked(static_cast<double>(items.size()), node_);
}

bool Call::half(std::size_t i, double& out, std::size_t& given) {
    const auto& parameters = builtin_.takes.parameters;
    given = i;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
        if (parameters[k].stands_for == static_cast<int>(i) && has(k)) given = k;
    }
    if (!number(given, out)) return false;
    if (given != i) out *= 0.5;
    return true;
}

bool Call::list(std::size_t i, std::vector<Value>& out) {
    if (has(i) && slots_[i].is(Tag::list)) {
        const auto& items = slots_[i].items();
        if (!evaluator_.room(16.0 * static_cast<double>(items.size()), node_)) return false;
        out = items;
        return true;
    }
    if (has(i) && slots_[i].is(Tag::range)) {
        const auto& range = slots_[i].as<RangeObject>();
        if (!evaluator_.room(16.0 * range.count, node_)) return false;
        out.clear();
        out.reserve(static_cast<std::size_t>(range.count));
        for (double k = 0; k < range.count; ++k) {
            if (!evaluator_.step(node_)) return false;
            out.push_back(Value::number(range.at(k)));
        }
        return true;
    }
    return wrong_kind(i, "a list");
}

bool Call::function(std::size_t i) {
    if (has(i) &&
        (slots_[i].is(Tag::function) || slots_[i].is(Tag::builtin) || slots_[i].is(Tag::random))) {
        return true;
    }
    return wrong_kind(i, "a function", "write it as fn(x) x * x");
}

bool Call::numbers(std::size_t i, std::vector<double>& out) {
    if (!has(i) || !slots_[i].is(Tag::list)) return wrong_kind(i, "a list of numbers");
    out.clear();
    for (const Value& item : slots_[i].items()) {
        if (!item.is(Tag::number)) {
            return fail(i, ErrorCode::bad_argument,
                        fmt::format("{} must be a list of numbers", argument_name(i)), {},
                        fmt::format("this has {} in it", kind_text(item)));
        }
        out.push_back(item.number());
    }
    return true;
}

bool Call::matrix(std::size_t i, bool is_square, std::array<double, 16>& out) {
    const std::string_view wanted =
        is_square ? "4 rows of 4 numbers" : "4 rows of 4 numbers, or 3 rows of 4";
    if (!has(i) || !slots_[i].is(Tag::list)) return wrong_kind(i, wanted);
    std::vector<double> flat;
    for (const Value& row : slots_[i].items()) {
        if (row.is(Tag::number)) {
            flat.push_back(row.number());
        } else if (row.is(Tag::list) && row.items().size() == 4) {
            for (const Value& x : row.items()) {
                if (!x.is(Tag::number)) return wrong_kind(i, wanted);
                flat.push_back(x.number());
            }
        } else {
            return wrong_kind(i, wanted);
        }
        if (flat.size() > 16) break;
    }
    if ((is_square || flat.size() != 12) && flat.size() != 16) {
        return fail(i, ErrorCode::bad_argument,
                    fmt::format("{} must be {}", argument_name(i), wanted), {},
                    fmt::format("this has {} numbers", flat.size()));
    }
    out = {};
    out[15] = 1.0;
    std::copy(flat.begin(), flat.end(), out.begin());
    return true;
}

bool Call::colour(std::size_t i, scene::Colour& out, std::string& written) {
    if (has(i) && slots_[i].is(Tag::string)) {
        written = slots_[i].string();
        Vec3 srgb;
        if (find_colour(written, srgb)) {
            out = scene::from_srgb(srgb);
            return true;
        }
        return fail(i, ErrorCode::bad_argument, "unknown colour", suggest_colour(written),
                    fmt::format("this is {}", quoted(shortened(written))));
    }
    Vec3 srgb;
    if (has(i) && is_vector(slots_[i], srgb)) {
        for (int c = 0; c < 3; ++c) {
            if (srgb[c] >= 0.0 && srgb[c] <= 1.0) continue;
            return fail(i, ErrorCode::out_of_range, "the parts of a colour must be from 0 to 1",
                        srgb[c] > 1.0 ? "divide by 255, or write \"#rrggbb\"" : "",
                        fmt::format("this has {}", number_text(srgb[c])));
        }
        out = scene::from_srgb(srgb);
        written.clear();
        return true;
    }
    return wrong_kind(i, "a colour", R"(write "tomato", "#ff6347" or (1, 0.4, 0.3))");
}

bool Call::choice(std::size_t i, std::span<const std::string_view> choices, std::size_t& out) {
    std::string written;
    if (!text(i, written)) return false;
    std::string all;
    for (out = 0; out < choices.size(); ++out) {
        if (choices[out] == written) return true;
        all += fmt::format("{}\"{}\"", out == 0 ? "" : (out + 1 == choices.size() ? " or " : ", "),
                           choices[out]);
    }
    return fail(i, ErrorCode::bad_argument, fmt::format("{} must be {}", argument_name(i), all), {},
                fmt::format("this is {}", quoted(shortened(written))));
}

bool Call::result(double value, Value& out) {
    if (!std::isfinite(value)) {
        return fail(ErrorCode::evaluation, "the result is not a finite number");
    }
    out = Value::number(value);
    return true;
}

bool Call::result(Result<csg::Solid> solid, Value& out) {
    if (!solid) {
        Error error = std::move(solid).error();
        error.message =
            error.message.starts_with(name() + ":") ? error.message : name() + ": " + error.message;
        return fail(std::move(error));
    }
    out = Value::solid(std::move(*solid));
    return evaluator_.made(out.solid(), false, node_);
}

}  // namespace raymo::sml
