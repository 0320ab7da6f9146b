// Primitives from the inventory, and Booleans of any number of solids.

#include <fmt/core.h>

#include "raymo/sml/builtins/call.hpp"
#include "raymo/sml/text.hpp"

namespace raymo::sml {
namespace {

// One argument of a primitive as its schema asks for it. `slot` is where it stands among the call's parameters.
bool take(Call& call, const solids::Param& param, std::size_t slot, std::size_t diameter,
          solids::Argument& out) {
    // The other name of the argument: a diameter for a radius, `dx` for a size.
    const bool is_diameter = diameter > 0 && call.has(diameter);
    if (!call.has(slot) && !is_diameter && param.fallback) {
        out = *param.fallback;
        return true;
    }
    switch (param.kind) {
        case solids::ParamKind::length:
        case solids::ParamKind::number:
        case solids::ParamKind::angle: {
            double value = 0.0;
            if (!call.number(is_diameter ? diameter : slot, value)) return false;
            out = is_diameter ? value * 0.5 : value;
            return true;
        }
        case solids::ParamKind::flag: {
            bool value = false;
            if (!call.flag(slot, value)) return false;
            out = value;
            return true;
        }
        case solids::ParamKind::vector: {
            Vec3 value;
            if (!call.vector(slot, value)) return false;
            out = value;
            return true;
        }
        case solids::ParamKind::size: {
            Vec3 value;
            if (call.has(slot) && call[slot].is(Tag::list)) {
                if (!call.vector(slot, value)) return false;
                if (call.has(slot + 1) || call.has(slot + 2)) {
                    return call.fail(call.has(slot + 1) ? slot + 1 : slot + 2,
                                     ErrorCode::bad_argument, "the size is given already",
                                     "give one vector, three numbers, or one number for a cube");
                }
            } else {
                if (!call.number(is_diameter ? diameter : slot, value.x)) return false;
                value = {value.x, value.x, value.x};
                if (is_diameter || call.has(slot + 1) || call.has(slot + 2)) {
                    if (!call.has(slot + 1) || !call.has(slot + 2)) {
                        return call.fail(ErrorCode::bad_argument,
                                         call.has(slot + 1)
                                             ? "the third number of the size is missing"
                                             : "the second number of the size is missing",
                                         "give three numbers, or one for a cube");
                    }
                    for (std::size_t axis = 1; axis < 3; ++axis) {
                        if (!call[slot + axis].is(Tag::number)) {
                            return call.fail(
                                slot + axis, ErrorCode::bad_argument,
                                "each number of the size must be a number", {},
                                fmt::format("this is {}", kind_text(call[slot + axis])));
                        }
                        value[static_cast<int>(axis)] = call[slot + axis].number();
                    }
                }
            }
            out = value;
            return true;
        }
        case solids::ParamKind::matrix: {
            std::array<double, 16> value{};
            if (!call.matrix(slot, true, value)) return false;
            out = value;
            return true;
        }
        case solids::ParamKind::contour:
        case solids::ParamKind::profile:
        case solids::ParamKind::path:
            break;  // no primitive takes one yet
    }
    return false;
}

// The argument that an error about a schema's parameter points at: of a size, the number that is wrong.
std::size_t blamed(Call& call, const solids::Param& param, std::size_t slot, std::size_t diameter) {
    const bool is_other = diameter > 0 && call.has(diameter);
    if (param.kind == solids::ParamKind::size) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t at = axis == 0 && is_other ? diameter : slot + axis;
            if (call.has(at) && call[at].is(Tag::number) && !(call[at].number() > param.min)) {
                return at;
            }
        }
    }
    if (is_other) return diameter;
    return slot;
}

// union(list), union(a, b, c), and the same for the other Booleans. Without solids: nothing.
bool boolean(Call& call, csg::Op op, Value& out) {
    if (call.has(0) || call.has(1) || call.has(2)) {
        return call.fail(call.has(0) ? 0 : (call.has(1) ? 1 : 2), ErrorCode::not_available,
                         "blends are not available yet", "leave out `blend` for sharp edges");
    }
    std::vector<csg::Solid> operands;
    const auto add = [&](const Value& value, std::size_t argument) {
        if (value.is(Tag::nothing) && op != csg::Op::intersection) return true;
        if (value.is(Tag::solid)) {
            operands.push_back(value.solid());
            return true;
        }
        return call.fail(argument, ErrorCode::bad_argument, "every operand must be a solid", {},
                         fmt::format("this is {}", kind_text(value)));
    };
    for (std::size_t i = 0; i < call.rest().size(); ++i) {
        const Value& operand = call.rest()[i];
        const std::size_t argument = call.rest_begin() + i;
        if (!operand.is(Tag::list)) {
            if (!add(operand, argument)) return false;
            continue;
        }
        for (const Value& item : operand.items()) {
            if (!call.evaluator().step(call.node())) return false;
            if (!item.is(Tag::solid) && !item.is(Tag::nothing)) {
                return call.fail(argument, ErrorCode::bad_argument, "every operand must be a solid",
                                 {}, fmt::format("this list has {} in it", kind_text(item)));
            }
            if (!add(item, argument)) return false;
        }
    }
    if (operands.empty()) {
        if (op == csg::Op::unite) {
            out = Value::nothing();
            return true;
        }
        return call.fail(ErrorCode::bad_argument, "there are no solids to work on");
    }
    return call.evaluator().combine(op, std::move(operands), call.node(), call.span(), out);
}

bool unite(Call& call, Value& out) { return boolean(call, csg::Op::unite, out); }
bool difference(Call& call, Value& out) { return boolean(call, csg::Op::difference, out); }
bool intersection(Call& call, Value& out) { return boolean(call, csg::Op::intersection, out); }

}  // namespace

bool make_primitive(Call& call, Value& out) {
    const auto row = static_cast<std::size_t>(call.builtin().primitive);
    const solids::Schema& schema = *solids::inventory()[row].schema;
    const auto& parameters = call.builtin().takes.parameters;
    constexpr std::size_t kMost = 8;
    std::array<solids::Argument, kMost> arguments;
    std::array<std::size_t, kMost> slots{};
    std::array<std::size_t, kMost> diameters{};
    std::size_t slot = 0;
    for (std::size_t i = 0; i < schema.params.size(); ++i) {
        slots[i] = slot;
        for (std::size_t k = 0; k < parameters.size(); ++k) {
            if (parameters[k].stands_for == static_cast<int>(slot)) diameters[i] = k;
        }
        if (!take(call, schema.params[i], slot, diameters[i], arguments[i])) return false;
        slot += schema.params[i].kind == solids::ParamKind::size ? 3 : 1;
    }
    auto made = csg::primitive(static_cast<std::uint32_t>(row),
                               std::span(arguments.data(), schema.params.size()), call.span());
    if (!made) {
        Error error = std::move(made).error();
        error.where = call.span();
        if (error.argument >= 0) {
            const auto i = static_cast<std::size_t>(error.argument);
            const std::size_t at = blamed(call, schema.params[i], slots[i], diameters[i]);
            error.where = call.where(at);
            // What was written is shown: a diameter, not the radius made of it.
            if (call.has(at) && call[at].is(Tag::number)) {
                error.label = "this is " + number_text(call[at].number());
            }
        }
        return call.fail(std::move(error));
    }
    out = Value::solid(std::move(*made));
    return call.evaluator().made(out.solid(), true, call.node());
}

std::span<const BuiltinRow> solid_rows() {
    static constexpr auto kRows = std::to_array<BuiltinRow>({
        {"union", "solids* | blend? kind? shape?", &unite, "All solids as one."},
        {"difference", "solids* | blend? kind? shape?", &difference,
         "The first without the others."},
        {"intersection", "solids* | blend? kind? shape?", &intersection, "What all share."},
    });
    return kRows;
}

}  // namespace raymo::sml
