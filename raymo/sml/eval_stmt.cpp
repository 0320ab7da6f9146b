#include <fmt/core.h>

#include <cmath>

#include "raymo/core/assert.hpp"
#include "raymo/sml/evaluate.hpp"
#include "raymo/sml/lexer.hpp"
#include "raymo/sml/text.hpp"

namespace raymo::sml {

template <class F>
bool Evaluator::for_each(NodeId source, F&& f) {
    const Node& n = ast_[source];
    if (n.kind == NodeKind::range) {
        double low = 0.0;
        double high = 0.0;
        double step_size = 0.0;
        double count = 0.0;
        if (!eval_range(n, source, low, high, step_size, count)) return false;
        for (double i = 0; i < count; ++i) {
            if (!step(source)) return false;
            if (!f(Value::number(low + i * step_size))) return false;
        }
        return true;
    }
    Value value;
    if (!eval(source, value)) return false;
    if (value.is(Tag::list)) {
        for (std::size_t i = 0; i < value.items().size(); ++i) {
            if (!step(source)) return false;
            if (!f(Value(value.items()[i]))) return false;
        }
        return true;
    }
    if (value.is(Tag::range)) {
        const auto& range = value.as<RangeObject>();
        for (double i = 0; i < range.count; ++i) {
            if (!step(source)) return false;
            if (!f(Value::number(range.at(i)))) return false;
        }
        return true;
    }
    if (value.is(Tag::string)) {
        const std::string& text = value.string();
        for (std::size_t at = 0; at < text.size();) {
            std::uint32_t length = 1;
            static_cast<void>(code_point(text, at, length));
            if (!step(source)) return false;
            if (!f(Value::string(text.substr(at, length)))) return false;
            at += length;
        }
        return true;
    }
    return fail(ErrorCode::bad_argument, span(source),
                "`for` goes through a list, a range or a string",
                value.is(Tag::number) ? "write 0..<n to count" : "",
                fmt::format("this is {}", kind_text(value)));
}

bool Evaluator::comprehend(const Node& n, NodeId id, std::uint32_t clause,
                           std::vector<Value>& items) {
    const NodeId clause_id = ast_.child(n, clause);
    const Node& c = ast_[clause_id];
    if (clause + 1 == n.count) {
        Value value;
        if (!eval(clause_id, value)) return false;
        if (items.size() == items.capacity() &&
            !room(static_cast<double>(16 * (items.size() + 16)) * 2.0, id)) {
            return false;
        }
        items.push_back(std::move(value));
        return true;
    }
    if (c.kind == NodeKind::if_clause) {
        bool holds = false;
        if (!condition(ast_.child(c, 0), "`if`", holds)) return false;
        return !holds || comprehend(n, id, clause + 1, items);
    }
    const NodeId pattern = ast_.child(c, 0);
    const NodeId source = ast_.child(c, 1);
    return for_each(source, [&](Value value) {
        enter(c.slot);
        return bind(pattern, std::move(value), source) && comprehend(n, id, clause + 1, items);
    });
}

void Evaluator::store(const Node& name, Value&& value) {
    if (name.place == Place::global) {
        globals_[name.slot] = std::move(value);
        return;
    }
    Value& target = name.place == Place::captured
                        ? const_cast<Value&>(frame_->closure->captures[name.slot])
                        : frame_->slots[name.slot];
    if (target.is(Tag::cell)) {
        // Moved in at the end: the old value may hold this very cell.
        Value old = std::move(value);
        std::swap(static_cast<CellObject*>(target.object())->value, old);
        return;
    }
    target = std::move(value);
}

bool Evaluator::bind(NodeId pattern, Value&& value, NodeId source) {
    const Node& n = ast_[pattern];
    if (n.kind == NodeKind::binding) {
        store(n, std::move(value));
        return true;
    }
    if (n.kind == NodeKind::list_pattern) {
        if (!value.is(Tag::list)) {
            return fail(ErrorCode::bad_argument, span(source),
                        fmt::format("{} names need a list of {} values", n.count, n.count), {},
                        fmt::format("this is {}", kind_text(value)));
        }
        if (value.items().size() != n.count) {
            return fail(ErrorCode::bad_argument, span(source),
                        fmt::format("{} names need a list of {} values", n.count, n.count), {},
                        fmt::format("this has {}", value.items().size()));
        }
        for (std::uint32_t i = 0; i < n.count; ++i) {
            store(ast_[ast_.child(n, i)], Value(value.items()[i]));
        }
        return true;
    }
    if (!value.is(Tag::record)) {
        return fail(ErrorCode::bad_argument, span(source), "names in { } need a record", {},
                    fmt::format("this is {}", kind_text(value)));
    }
    for (std::uint32_t i = 0; i < n.count; ++i) {
        const Node& name = ast_[ast_.child(n, i)];
        const Value* const field = value.as<RecordObject>().find(name.symbol);
        if (field == nullptr) {
            return fail(
                ErrorCode::name, name.span(),
                fmt::format("the record has no field `{}`", program_.symbols.text(name.symbol)));
        }
        store(name, Value(*field));
    }
    return true;
}

Evaluator::Flow Evaluator::exec_block(const Node& n) {
    enter(n.slot);
    for (std::uint32_t i = 0; i < n.count; ++i) {
        const Flow flow = exec(ast_.child(n, i));
        if (flow != Flow::normal) return flow;
    }
    return Flow::normal;
}

Evaluator::Flow Evaluator::exec(NodeId id) {
    const Node& n = ast_[id];
    const auto flow_of = [](bool good) { return good ? Flow::normal : Flow::failed; };
    switch (n.kind) {
        case NodeKind::let:
        case NodeKind::var: {
            const NodeId source = ast_.child(n, 1);
            Value value;
            if (!operand(source, value)) return Flow::failed;
            const NodeId pattern = ast_.child(n, 0);
            if (ast_[pattern].kind == NodeKind::binding) {
                store(ast_[pattern], std::move(value));
                return Flow::normal;
            }
            return flow_of(bind(pattern, std::move(value), source));
        }
        case NodeKind::assign:
            return flow_of(exec_assign(n));
        case NodeKind::expression:
            return flow_of(exec_expression(n, id));
        case NodeKind::block:
            return exec_block(n);
        case NodeKind::if_else: {
            bool holds = false;
            if (!condition(ast_.child(n, 0), "`if`", holds)) return Flow::failed;
            if (holds) return exec(ast_.child(n, 1));
            return n.count > 2 ? exec(ast_.child(n, 2)) : Flow::normal;
        }
        case NodeKind::for_each:
            return exec_for(n);
        case NodeKind::while_loop:
            return exec_while(n, id);
        case NodeKind::break_loop:
            return Flow::broke;
        case NodeKind::continue_loop:
            return Flow::continued;
        case NodeKind::give_back:
            if (n.count == 0) {
                returned_ = Value::nothing();
                return Flow::returned;
            } else {
                Value value;
                if (!operand(ast_.child(n, 0), value)) return Flow::failed;
                returned_ = std::move(value);
                return Flow::returned;
            }
        case NodeKind::emit: {
            Value value;
            if (!eval(ast_.child(n, 0), value)) return Flow::failed;
            const Shown shown = show_in_scene(value, ast_.child(n, 0), true);
            if (shown == Shown::no) {
                return flow_of(fail(ErrorCode::bad_argument, span(ast_.child(n, 0)),
                                    "emit needs a solid, a light or a camera", {},
                                    fmt::format("this is {}", kind_text(value))));
            }
            return flow_of(shown == Shown::yes);
        }
        case NodeKind::assertion:
            return flow_of(exec_assertion(n));
        case NodeKind::param:
            return flow_of(exec_param(n));
        case NodeKind::part:
            return flow_of(exec_part(n));
        case NodeKind::view:
            return flow_of(exec_view(n));
        default:  // functions are made when their block is entered; imports before the program runs
            return Flow::normal;
    }
}

Evaluator::Flow Evaluator::exec_for(const Node& n) {
    const NodeId pattern = ast_.child(n, 0);
    const NodeId source = ast_.child(n, 1);
    const Node& body = ast_[ast_.child(n, 2)];
    Flow flow = Flow::normal;
    const bool done = for_each(source, [&](Value value) {
        enter(n.slot);
        if (!bind(pattern, std::move(value), source)) {
            flow = Flow::failed;
            return false;
        }
        flow = exec_block(body);
        return flow == Flow::normal || flow == Flow::continued;
    });
    if (done || flow == Flow::broke) return Flow::normal;
    return flow == Flow::returned ? Flow::returned : Flow::failed;
}

Evaluator::Flow Evaluator::exec_while(const Node& n, NodeId id) {
    const Node& body = ast_[ast_.child(n, 1)];
    while (true) {
        bool holds = false;
        if (!step(id) || !condition(ast_.child(n, 0), "`while`", holds)) return Flow::failed;
        if (!holds) return Flow::normal;
        const Flow flow = exec_block(body);
        if (flow == Flow::broke) return Flow::normal;
        if (flow == Flow::returned || flow == Flow::failed) return flow;
    }
}

bool Evaluator::exec_assign(const Node& n) {
    const NodeId target = ast_.child(n, 0);
    const NodeId source = ast_.child(n, 1);
    Value value;
    if (!operand(source, value)) return false;
    if (n.op != Operator::none) {
        Value before;
        Value after;
        if (!eval(target, before) ||
            !binary(n.op, before, value, source, n.span(), target, source, after)) {
            return false;
        }
        value = std::move(after);
    }
    store(ast_[target], std::move(value));
    return true;
}

bool Evaluator::exec_assertion(const Node& n) {
    const NodeId claim = ast_.child(n, 0);
    const Node& compared = ast_[claim];
    bool holds = false;
    std::string label;
    if (compared.kind == NodeKind::binary) {
        // Taken apart so that the message can show both sides.
        const NodeId left = ast_.child(compared, 0);
        const NodeId right = ast_.child(compared, 1);
        Value a;
        Value b;
        Value result;
        if (!eval(left, a) || !eval(right, b) ||
            !binary(compared.op, a, b, claim, compared.span(), left, right, result)) {
            return false;
        }
        if (!result.is(Tag::boolean)) {
            return fail(ErrorCode::bad_argument, span(claim), "`assert` needs true or false", {},
                        fmt::format("this is {}", kind_text(result)));
        }
        holds = result.boolean();
        if (a.is(Tag::number) && b.is(Tag::number)) {
            label = fmt::format("this is {} {} {}", number_text(a.number()), spelling(compared.op),
                                number_text(b.number()));
        }
    } else if (!condition(claim, "`assert`", holds)) {
        return false;
    }
    if (holds) return true;
    std::string message = "assertion failed";
    if (n.count > 1) {
        Value value;
        std::string text;
        if (!eval(ast_.child(n, 1), value) || !show(value, ast_.child(n, 1), text)) return false;
        message += ": " + text;
    }
    return fail(ErrorCode::assertion, span(claim), std::move(message), {}, std::move(label));
}

}  // namespace raymo::sml
