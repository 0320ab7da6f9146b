#include <fmt/core.h>

#include <cmath>

#include "raymo/core/assert.hpp"
#include "raymo/sml/arithmetic.hpp"
#include "raymo/sml/evaluate.hpp"
#include "raymo/sml/lexer.hpp"
#include "raymo/sml/suggest.hpp"
#include "raymo/sml/text.hpp"

namespace raymo::sml {

bool Evaluator::eval(NodeId id, Value& out) {
    const Node& n = ast_[id];
    switch (n.kind) {
        case NodeKind::number:
            out.set_number(n.number);
            return true;
        case NodeKind::name:
            return eval_name(n, id, out);
        case NodeKind::binary:
            return eval_binary(n, id, out);
        case NodeKind::call:
            return eval_call(n, id, out);
        case NodeKind::method:
            return eval_method(n, id, out);
        case NodeKind::chain:
            return eval_chain(n, id, out);
        case NodeKind::member:
            return eval_member(n, out);
        case NodeKind::index:
            return eval_index(n, id, out);
        case NodeKind::string:
            out = Value::string(program_.symbols.text(n.symbol));
            return true;
        case NodeKind::interpolation:
            return eval_interpolation(n, id, out);
        case NodeKind::boolean:
            out = Value::boolean(n.flag);
            return true;
        case NodeKind::nothing:
            out = Value::nothing();
            return true;
        case NodeKind::list:
        case NodeKind::vector:
            return eval_list(n, id, out);
        case NodeKind::record:
            return eval_record(n, out);
        case NodeKind::range: {
            double low = 0.0;
            double high = 0.0;
            double step_size = 0.0;
            double count = 0.0;
            if (!eval_range(n, id, low, high, step_size, count)) return false;
            out = Value::object(new RangeObject(low, high, step_size, count));
            return true;
        }
        case NodeKind::all_of:
        case NodeKind::any_of: {
            const bool decides = n.kind == NodeKind::any_of;
            bool value = !decides;
            for (std::uint32_t i = 0; i < n.count && value != decides; ++i) {
                if (!condition(ast_.child(n, i), decides ? "`or`" : "`and`", value)) return false;
            }
            out = Value::boolean(value);
            return true;
        }
        case NodeKind::negation: {
            bool value = false;
            if (!condition(ast_.child(n, 0), "`not`", value)) return false;
            out = Value::boolean(!value);
            return true;
        }
        case NodeKind::minus:
            return eval_minus(n, id, out);
        case NodeKind::choice: {
            bool value = false;
            if (!condition(ast_.child(n, 0), "`if`", value)) return false;
            return eval(ast_.child(n, value ? 1 : 2), out);
        }
        case NodeKind::comprehension:
            return eval_comprehension(n, id, out);
        case NodeKind::lambda:
            make_closure(id, out);
            return true;
        default:
            RAYMO_ASSERT(false);
            return false;
    }
}

bool Evaluator::eval_name(const Node& n, NodeId id, Value& out) {
    switch (n.place) {
        case Place::local: {
            const Value& v = frame_->slots[n.slot];
            out = v.is(Tag::cell) ? v.as<CellObject>().value : v;
            break;
        }
        case Place::captured:
            out = frame_->closure->captures[n.slot].as<CellObject>().value;
            break;
        case Place::global:
            out = globals_[n.slot];
            break;
        default: {
            const Builtin& b = builtins()[n.slot];
            if (b.is_constant) {
                out = b.is_axis ? Value::vector(b.axis) : Value::number(b.constant);
            } else if (!b.is_available) {
                return fail(ErrorCode::not_available, n.span(),
                            fmt::format("`{}` is not available yet", b.takes.callee));
            } else {
                out = Value::builtin(n.slot);
            }
            return true;
        }
    }
    if (!out.is(Tag::missing)) return true;
    return fail(ErrorCode::name, span(id),
                fmt::format("`{}` has no value yet", program_.symbols.text(n.symbol)),
                "it gets one further down: move that up");
}

bool Evaluator::condition(NodeId id, std::string_view what, bool& out) {
    Value value;
    if (!operand(id, value)) return false;
    if (!value.is(Tag::boolean)) {
        return fail(ErrorCode::bad_argument, span(id), fmt::format("{} needs true or false", what),
                    value.is(Tag::number) ? "compare it: x != 0" : "",
                    fmt::format("this is {}", kind_text(value)));
    }
    out = value.boolean();
    return true;
}

bool Evaluator::number_of(NodeId id, std::string_view what, double& out) {
    Value value;
    if (!operand(id, value)) return false;
    if (!value.is(Tag::number)) {
        return fail(ErrorCode::bad_argument, span(id), fmt::format("{} must be a number", what), {},
                    fmt::format("this is {}", kind_text(value)));
    }
    out = value.number();
    return true;
}

bool Evaluator::eval_list(const Node& n, NodeId id, Value& out) {
    if (!room(16.0 * n.count, id)) return false;
    std::vector<Value> items(n.count);
    for (std::uint32_t i = 0; i < n.count; ++i) {
        if (!operand(ast_.child(n, i), items[i])) return false;
    }
    out = Value::list(std::move(items));
    return true;
}

bool Evaluator::eval_record(const Node& n, Value& out) {
    std::vector<std::pair<Symbol, Value>> fields(n.count);
    for (std::uint32_t i = 0; i < n.count; ++i) {
        const Node& field = ast_[ast_.child(n, i)];
        fields[i].first = field.symbol;
        if (!eval(ast_.child(field, 0), fields[i].second)) return false;
    }
    out = Value::record(std::move(fields));
    return true;
}

// The end of a range is reached when it lies within the rounding of (high - low) / step: 0..0.3 step 0.1 has four
// numbers, though 0.3 / 0.1 is a little less than 3 in binary.
double range_count(double low, double high, double step, bool is_open) {
    const double steps = (high - low) / step;
    if (!(steps >= 0.0)) return 0.0;
    const double nearest = std::round(steps);
    const bool reaches = std::fabs(steps - nearest) <= 8.0 * 0x1p-53 * nearest;
    if (reaches) return is_open ? nearest : nearest + 1.0;
    return std::floor(steps) + 1.0;
}

bool Evaluator::eval_range(const Node& n, NodeId id, double& low, double& high, double& step_size,
                           double& count) {
    step_size = 1.0;
    if (!number_of(ast_.child(n, 0), "the beginning of a range", low) ||
        !number_of(ast_.child(n, 1), "the end of a range", high)) {
        return false;
    }
    if (n.count > 2) {
        if (!number_of(ast_.child(n, 2), "the step of a range", step_size)) return false;
        if (step_size == 0.0) {
            return fail(ErrorCode::out_of_range, span(ast_.child(n, 2)),
                        "the step of a range must not be 0", "leave it out for steps of 1",
                        "this is 0");
        }
    }
    count = range_count(low, high, step_size, n.op == Operator::range_open);
    if (!(count < 0x1p53)) {
        return fail(ErrorCode::out_of_range, span(id), "the range has too many numbers",
                    "choose a larger step");
    }
    return true;
}

bool Evaluator::eval_binary(const Node& n, NodeId id, Value& out) {
    if (solve(n, out)) return step(id);
    const NodeId left = ast_.child(n, 0);
    const NodeId right = ast_.child(n, 1);
    Value a;
    Value b;
    if (!operand(left, a) || !operand(right, b)) return false;
    if (a.is(Tag::number) && b.is(Tag::number)) {
        const double x = a.number();
        const double y = b.number();
        switch (n.op) {
            case Operator::equal:
                out = Value::boolean(x == y);
                return true;
            case Operator::less:
                out = Value::boolean(x < y);
                return true;
            case Operator::less_equal:
                out = Value::boolean(x <= y);
                return true;
            case Operator::greater:
                out = Value::boolean(x > y);
                return true;
            case Operator::greater_equal:
                out = Value::boolean(x >= y);
                return true;
            default:
                break;
        }
        double r = 0.0;
        if (quick_arithmetic(n.op, x, y, r)) {
            out.set_number(r);
            return true;
        }
    }
    return binary(n.op, a, b, id, n.span(), left, right, out);
}

// Runs of the same operator on solids become one Boolean of many operands.
bool Evaluator::eval_chain(const Node& n, NodeId id, Value& out) {
    if (solve(n, out)) return step(id);
    Value left;
    if (!operand(ast_.child(n, 0), left)) return false;
    std::vector<csg::Solid> run;  // operands of `run_op` that are not combined yet
    Operator run_op = Operator::none;
    std::uint32_t run_end = n.begin;
    const auto flush = [&] {
        if (run.empty()) return true;
        const csg::Op op = run_op == Operator::add        ? csg::Op::unite
                           : run_op == Operator::subtract ? csg::Op::difference
                                                          : csg::Op::intersection;
        const bool done = combine(op, std::move(run), id, {n.file, n.begin, run_end}, left);
        run.clear();
        return done;
    };
    for (std::uint32_t i = 1; i < n.count; ++i) {
        const Node& next = ast_[ast_.child(n, i)];
        const NodeId right_id = ast_.child(next, 0);
        Value right;
        if (!operand(right_id, right)) return false;
        double r = 0.0;
        if (left.is(Tag::number) && right.is(Tag::number) &&
            quick_arithmetic(next.op, left.number(), right.number(), r)) {
            left.set_number(r);
            if (!step(id)) return false;
            continue;
        }
        const bool is_boolean = next.op == Operator::add || next.op == Operator::subtract ||
                                next.op == Operator::intersect;
        const bool left_is_solid = !run.empty() || left.is(Tag::solid);
        if (is_boolean && left_is_solid && right.is(Tag::solid)) {
            if (!run.empty() && run_op != next.op && !flush()) return false;
            if (run.empty()) run.push_back(left.solid());
            run_op = next.op;
            run.push_back(right.solid());
        } else {
            if (!flush()) return false;
            Value result;
            const NodeId left_id = i == 1 ? ast_.child(n, 0) : kNoNode;
            if (!binary(next.op, left, right, id, {n.file, n.begin, next.end}, left_id, right_id,
                        result)) {
                return false;
            }
            left = std::move(result);
        }
        run_end = next.end;
        if (!step(id)) return false;
    }
    if (!flush()) return false;
    out = std::move(left);
    return true;
}

bool Evaluator::eval_minus(const Node& n, NodeId id, Value& out) {
    if (solve(n, out)) return step(id);
    const NodeId operand = ast_.child(n, 0);
    Value value;
    if (!eval(operand, value)) return false;
    if (value.is(Tag::number)) {
        out = Value::number(-value.number());
        return true;
    }
    if (value.is(Tag::list)) {
        return binary(Operator::multiply, value, Value::number(-1.0), id, n.span(), operand,
                      operand, out);
    }
    return fail(ErrorCode::bad_argument, span(operand), "`-` needs a number or a vector",
                value.is(Tag::solid)     ? "to take one solid from another, write a - b"
                : value.is(Tag::contour) ? "to take one contour from another, write a - b"
                                         : "",
                fmt::format("this is {}", kind_text(value)));
}

std::string Evaluator::fields_hint(const RecordObject& record, std::string_view written) const {
    Suggestion suggestion(written);
    std::string fields;
    for (const auto& [symbol, ignored] : record.fields) {
        const std::string& field = program_.symbols.text(symbol);
        suggestion.consider(field);
        if (fields.size() <= 60) fields += (fields.empty() ? "" : ", ") + shortened(field);
    }
    if (fields.empty()) return "it has no fields";
    if (!suggestion.found()) return fmt::format("its fields are {}", fields);
    return fmt::format("{} its fields are {}", suggestion.hint(), fields);
}

bool Evaluator::eval_member(const Node& n, Value& out) {
    const NodeId receiver = ast_.child(n, 0);
    Value value;
    if (!eval(receiver, value)) return false;
    const std::string& name = program_.symbols.text(n.symbol);
    if (value.is(Tag::record)) {
        if (const Value* field = value.as<RecordObject>().find(n.symbol)) {
            out = *field;
            return true;
        }
        return fail(ErrorCode::name, n.span(), fmt::format("the record has no field `{}`", name),
                    fields_hint(value.as<RecordObject>(), name));
    }
    if (value.is(Tag::list) && name.size() == 1 && name[0] >= 'x' && name[0] <= 'z') {
        const auto axis = static_cast<std::size_t>(name[0] - 'x');
        const auto& items = value.items();
        if (axis < items.size() && items.size() <= 4) {
            out = items[axis];
            return true;
        }
        return fail(ErrorCode::name, n.span(), fmt::format("the list has no `.{}`", name),
                    "only vectors of 2 to 4 numbers have .x .y .z",
                    fmt::format("it has {} elements", items.size()));
    }
    return fail(ErrorCode::name, n.span(),
                fmt::format("{} has no field `{}`", kind_text(value), name));
}

bool Evaluator::element(const Value& list, double index, NodeId id, NodeId index_node, Value& out) {
    const double size = list.is(Tag::list) ? static_cast<double>(list.items().size())
                                           : list.as<RangeObject>().count;
    const double i = index < 0 ? index + size : index;
    if (index != std::floor(index)) {
        return fail(ErrorCode::out_of_range, span(index_node), "an index must be a whole number",
                    "round it with floor() or round()",
                    fmt::format("this is {}", number_text(index)));
    }
    if (!(i >= 0.0 && i < size)) {
        return fail(ErrorCode::out_of_range, span(index_node), "the index is outside of the list",
                    size == 0.0 ? "the list is empty"
                                : fmt::format("indices go from 0 to {}, or from -{} to -1",
                                              number_text(size - 1), number_text(size)),
                    fmt::format("this is {}", number_text(index)));
    }
    static_cast<void>(id);
    out = list.is(Tag::list) ? list.items()[static_cast<std::size_t>(i)]
                             : Value::number(list.as<RangeObject>().at(i));
    return true;
}

bool Evaluator::eval_index(const Node& n, NodeId id, Value& out) {
    const NodeId index_node = ast_.child(n, 1);
    Value list;
    Value index;
    const Node& range = ast_[index_node];
    const bool is_slice = range.kind == NodeKind::range && range.count == 2;
    if (!eval(ast_.child(n, 0), list) || (!is_slice && !eval(index_node, index))) return false;
    const bool is_text = list.is(Tag::string);
    if (list.is(Tag::record) && index.is(Tag::string)) {
        const Symbol symbol = program_.symbols.find(index.string());
        const Value* const field =
            symbol == kNoSymbol ? nullptr : list.as<RecordObject>().find(symbol);
        if (field == nullptr) {
            return fail(ErrorCode::name, span(index_node), "the record has no such field",
                        fields_hint(list.as<RecordObject>(), index.string()),
                        fmt::format("this is {}", quoted(index.string().substr(0, 40))));
        }
        out = *field;
        return true;
    }
    if (!list.is(Tag::list) && !list.is(Tag::range) && !list.is(Tag::string)) {
        return fail(ErrorCode::bad_argument, span(ast_.child(n, 0)),
                    "only lists, ranges and strings have elements", {},
                    fmt::format("this is {}", kind_text(list)));
    }
    if (list.is(Tag::string)) {
        std::vector<Value> characters;
        const std::string& text = list.string();
        if (!room(64.0 * static_cast<double>(text.size()), id)) return false;
        for (std::size_t at = 0; at < text.size();) {
            std::uint32_t length = 1;
            static_cast<void>(code_point(text, at, length));
            characters.push_back(Value::string(text.substr(at, length)));
            at += length;
        }
        list = Value::list(std::move(characters));
    }
    if (index.is(Tag::number)) return element(list, index.number(), id, index_node, out);
    if (!is_slice && !index.is(Tag::range)) {
        return fail(ErrorCode::bad_argument, span(index_node),
                    "an index must be a number or a range", {},
                    fmt::format("this is {}", kind_text(index)));
    }
    // A slice. Ends count from behind when negative, as written: the range itself can not know the length.
    const double size = list.is(Tag::list) ? static_cast<double>(list.items().size())
                                           : list.as<RangeObject>().count;
    if (is_slice) {
        double low = 0.0;
        double high = 0.0;
        if (!number_of(ast_.child(range, 0), "the beginning of a slice", low) ||
            !number_of(ast_.child(range, 1), "the end of a slice", high)) {
            return false;
        }
        if (low < 0) low += size;
        if (high < 0) high += size;
        index = Value::object(new RangeObject(
            low, high, 1.0, range_count(low, high, 1.0, range.op == Operator::range_open)));
    }
    const RangeObject& slice = index.as<RangeObject>();
    if (!room(16.0 * slice.count, id)) return false;
    std::vector<Value> items;
    std::string text;
    for (double i = 0; i < slice.count; ++i) {
        Value item;
        if (!element(list, slice.at(i), id, index_node, item) || !step(id)) return false;
        if (is_text) {
            text += item.string();
        } else {
            items.push_back(std::move(item));
        }
    }
    out = is_text ? Value::string(std::move(text)) : Value::list(std::move(items));
    return true;
}

bool Evaluator::eval_interpolation(const Node& n, NodeId id, Value& out) {
    std::string text;
    for (std::uint32_t i = 0; i < n.count; ++i) {
        const Node& part = ast_[ast_.child(n, i)];
        if (part.kind == NodeKind::string) {
            text += program_.symbols.text(part.symbol);
            continue;
        }
        Value value;
        if (!eval(ast_.child(n, i), value) || !show(value, id, text)) return false;
    }
    out = Value::string(std::move(text));
    return true;
}

bool Evaluator::eval_comprehension(const Node& n, NodeId id, Value& out) {
    std::vector<Value> items;
    if (!comprehend(n, id, 0, items)) return false;
    items.shrink_to_fit();
    out = Value::list(std::move(items));
    return true;
}

}  // namespace raymo::sml
