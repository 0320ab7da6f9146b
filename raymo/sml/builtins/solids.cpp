// Primitives from the inventory, and Booleans of any number of solids.

#include <fmt/core.h>

#include <functional>
#include <map>
#include <unordered_map>

#include "raymo/sml/builtins/blends.hpp"
#include "raymo/sml/text.hpp"

namespace raymo::sml {
namespace {

// One argument of a primitive as its schema asks for it. `slot` is where it stands among the call's parameters.
// A contour goes to `contour`, since it may stand for several arguments.
bool take(Call& call, const solids::Param& param, std::size_t slot, std::size_t diameter,
          curves::Contour& contour, solids::Argument& out) {
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
            if (!call.contour(slot, contour)) return false;
            if (param.kind == solids::ParamKind::contour && curves::is_open(contour)) {
                return call.fail(
                    slot, ErrorCode::bad_argument,
                    fmt::format("the {} must be closed", param.words),
                    "close it with `closed: true`, or an arc with chain([...], closed: true)",
                    "this curve is open");
            }
            return true;
        case solids::ParamKind::path: {
            curves::PathPtr path;
            if (!call.path(slot, path)) return false;
            out = std::move(path);
            return true;
        }
        case solids::ParamKind::mesh: {
            meshes::MeshPtr mesh;
            if (!call.mesh(slot, mesh)) return false;
            // Two refinements, the patches that come of them, and their leaves.
            const auto corners = static_cast<double>(mesh->corners.size());
            if (!call.evaluator().room(40e3 * corners, call.node()) ||
                !call.evaluator().worked(1e4 * corners, call.node()))
                return false;
            out = std::move(mesh);
            return true;
        }
        case solids::ParamKind::nets: {
            meshes::NetsPtr nets;
            if (!take_nets(call, slot, nets)) return false;
            const auto count = static_cast<double>(nets->size());
            if (!call.evaluator().room(10e3 * count, call.node()) ||
                !call.evaluator().worked(2e3 * count, call.node()))
                return false;
            out = std::move(nets);
            return true;
        }
        case solids::ParamKind::choice: {
            std::size_t chosen = 0;
            if (!call.choice(slot, param.choices, chosen)) return false;
            out = chosen;
            return true;
        }
    }
    return false;
}

curves::ContourOp contour_op(csg::Op op) {
    return op == csg::Op::unite        ? curves::ContourOp::unite
           : op == csg::Op::difference ? curves::ContourOp::difference
                                       : curves::ContourOp::intersection;
}
csg::Op solid_op(curves::ContourOp op) {
    return op == curves::ContourOp::unite        ? csg::Op::unite
           : op == curves::ContourOp::difference ? csg::Op::difference
                                                 : csg::Op::intersection;
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

/// Of the Booleans' parameters.
constexpr BlendSlots kBlend{0, 1, "blends need faces of different operands that cross each other"};

// union(list), union(a, b, c), and the same for the other Booleans. Without operands: nothing.
bool boolean(Call& call, csg::Op op, Value& out) {
    blends::Form form;
    const bool is_blended = call.has(kBlend.radius);
    if (is_blended && !take_blend(call, kBlend, form)) return false;
    for (std::size_t i = kBlend.others; !is_blended && i < call.rest_begin(); ++i) {
        if (!call.has(i)) continue;
        return call.fail(i, ErrorCode::bad_argument,
                         call.argument_name(i) + " is for blended edges",
                         "give the radius, too: `blend: 2`");
    }
    std::vector<csg::Solid> solids;
    std::vector<curves::Contour> contours;
    Value last;
    const auto add = [&](const Value& value, std::size_t argument, bool is_in_list) {
        const auto refuse = [&](std::string_view message, std::string hint) {
            return call.fail(argument, ErrorCode::bad_argument, message, std::move(hint),
                             operand_label(value, is_in_list));
        };
        if (value.is(Tag::nothing) && op != csg::Op::intersection) return true;
        if (value.is(Tag::solid)) {
            solids.push_back(value.solid());
        } else if (value.is(Tag::contour)) {
            contours.push_back(value.as<ContourObject>().value);
        } else {
            return refuse(contours.empty() ? "every operand must be a solid"
                                           : "every operand must be a contour",
                          value.is(Tag::path) ? "make a solid of it first: sweep(path)" : "");
        }
        if (!solids.empty() && !contours.empty()) {
            return refuse("solids and contours do not go together",
                          "make solids of the contours first: prism(contour, height)");
        }
        last = value;
        return true;
    };
    for (std::size_t i = 0; i < call.rest().size(); ++i) {
        const Value& operand = call.rest()[i];
        const std::size_t argument = call.rest_begin() + i;
        if (!operand.is(Tag::list)) {
            if (!add(operand, argument, false)) return false;
            continue;
        }
        for (const Value& item : operand.items()) {
            if (!call.evaluator().step(call.node()) || !add(item, argument, true)) return false;
        }
    }
    if (!contours.empty() && is_blended) {
        return call.fail(kBlend.radius, ErrorCode::bad_argument, "contours can not be blended",
                         "blend the solids that are made of them");
    }
    if (contours.size() == 1) {
        out = last;
        return true;
    }
    if (!contours.empty()) {
        return call.evaluator().combine(contour_op(op), std::move(contours), call.node(), out);
    }
    if (solids.empty()) {
        if (op == csg::Op::unite) {
            out = Value::nothing();
            return true;
        }
        return call.fail(ErrorCode::bad_argument, "there are no solids to work on");
    }
    if (is_blended) {
        return give_blend(call, kBlend,
                          blends::blended(op, std::move(solids), form, call.span(), spend_on(call)),
                          out);
    }
    return call.evaluator().combine(op, std::move(solids), call.node(), call.span(), out);
}

bool unite(Call& call, Value& out) { return boolean(call, csg::Op::unite, out); }
bool difference(Call& call, Value& out) { return boolean(call, csg::Op::difference, out); }
bool intersection(Call& call, Value& out) { return boolean(call, csg::Op::intersection, out); }

}  // namespace

bool for_each_outline(Call& call, const curves::Contour& contour, bool moves_along,
                      const std::function<bool(const curves::OutlinePtr&, Value&)>& make,
                      Value& out) {
    // What one outline makes, at the origin and where it is asked for.
    struct Made {
        csg::Solid at_origin;
        std::map<std::pair<double, double>, csg::Solid> placed;
    };
    std::unordered_map<const curves::Outline*, Made> of_outline;
    const auto make_at = [&](const curves::ContourNode& node, csg::Solid& solid) {
        Made& known = of_outline[node.outline.get()];
        csg::Solid& placed = known.placed[{node.at.x, node.at.y}];
        if (!placed) {
            Value made;
            const bool is_moved = node.at != Vec2{};
            if (!moves_along || !is_moved) {
                if (!make(curves::placed_outline(node), made)) return false;
                placed = made.take_solid();
            } else {
                if (!known.at_origin) {
                    if (!make(node.outline, made)) return false;
                    known.at_origin = made.take_solid();
                }
                if (!call.result(
                        csg::transform(known.at_origin, translation({node.at.x, node.at.y, 0.0}),
                                       call.span()),
                        made)) {
                    return false;
                }
                placed = made.take_solid();
            }
        }
        solid = placed;
        return true;
    };
    std::unordered_map<const curves::ContourNode*, csg::Solid> of_node;
    bool good = true;
    curves::visit(contour, [&](const curves::ContourNode& node) {
        if (!good) return;
        if (node.op == curves::ContourOp::outline) {
            good = make_at(node, of_node[&node]);
            return;
        }
        std::vector<csg::Solid> operands;
        operands.reserve(node.operands.size());
        for (const curves::Contour& operand : node.operands)
            operands.push_back(of_node[operand.get()]);
        Value made;
        // Without a place in the text, which its leaves have: only of blends all parts have that of the whole.
        good =
            call.evaluator().combine(solid_op(node.op), std::move(operands), call.node(), {}, made);
        if (good) of_node[&node] = made.take_solid();
    });
    if (good) out = Value::solid(of_node[contour.get()]);
    return good;
}

bool make_primitive(Call& call, Value& out) {
    const auto row = static_cast<std::size_t>(call.builtin().primitive);
    const solids::Schema& schema = *solids::inventory()[row].schema;
    const auto& parameters = call.builtin().takes.parameters;
    constexpr std::size_t kMost = 8;
    std::array<solids::Argument, kMost> arguments;
    std::array<std::size_t, kMost> slots{};
    std::array<std::size_t, kMost> diameters{};
    curves::Contour contour;
    std::size_t swept = kMost;  // the parameter that takes the contour
    std::size_t slot = 0;
    for (std::size_t i = 0; i < schema.params.size(); ++i) {
        slots[i] = slot;
        for (std::size_t k = 0; k < parameters.size(); ++k) {
            if (parameters[k].stands_for == static_cast<int>(slot)) diameters[i] = k;
        }
        if (!take(call, schema.params[i], slot, diameters[i], contour, arguments[i])) return false;
        if (contour != nullptr && swept == kMost) swept = i;
        slot += schema.params[i].kind == solids::ParamKind::size ? 3 : 1;
    }
    const auto make = [&](Value& made_value) {
        auto made = csg::primitive(static_cast<std::uint32_t>(row),
                                   std::span(arguments.data(), schema.params.size()), call.span());
        if (made) {
            made_value = Value::solid(std::move(*made));
            return call.evaluator().made(made_value.solid(), true, call.node());
        }
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
    };
    if (contour == nullptr) return make(out);
    // Arguments are checked once more for each outline; a contour of many outlines makes as many solids.
    return for_each_outline(
        call, contour, schema.moves_with_contour,
        [&](const curves::OutlinePtr& outline, Value& made) {
            arguments[swept] = outline;
            return make(made);
        },
        out);
}

std::span<const BuiltinRow> solid_rows() {
    static constexpr auto kRows = std::to_array<BuiltinRow>({
        {"union", "solids* | blend? kind? shape? near? where?", &unite,
         "All solids or contours as one."},
        {"difference", "solids* | blend? kind? shape? near? where?", &difference,
         "The first without the others."},
        {"intersection", "solids* | blend? kind? shape? near? where?", &intersection,
         "What all share."},
    });
    return kRows;
}

}  // namespace raymo::sml
