// Calls: of functions of the program and of the language, by plan where the callee is known and by matching otherwise.

#include <fmt/core.h>

#include "raymo/core/assert.hpp"
#include "raymo/sml/builtins/call.hpp"
#include "raymo/sml/evaluate.hpp"

namespace raymo::sml {

void ValueStack::open_chunk(std::size_t count) {
    const std::size_t next = chunks_.empty() ? 0 : chunk_ + 1;
    if (next >= chunks_.size() || chunks_[next].size < count) {
        chunks_.resize(next);  // any further ones are empty, and too small
        const std::size_t size = std::max(kChunk, count);
        chunks_.push_back({std::make_unique<Value[]>(size), size});
    }
    chunk_ = next;
    used_ = 0;
}

bool Evaluator::too_deep(NodeId site) {
    return fail(
        ErrorCode::limit, span(site),
        depth_ > host_.limits.call_depth
            ? fmt::format("the call depth passed its limit of {}", host_.limits.call_depth)
            : fmt::format("the call depth passed its limit: {} calls of long expressions", depth_),
        "is there a recursion that does not end?");
}

void Evaluator::make_closure(NodeId lambda, Value& out) {
    const Node& n = ast_[lambda];
    const FunctionInfo& info = ast_.functions[n.slot];
    std::vector<Value> captures;
    captures.reserve(info.captures.size());
    for (const FunctionInfo::Capture& c : info.captures) {
        captures.push_back(c.from_local ? frame_->slots[c.slot]
                                        : frame_->closure->captures[c.slot]);
        RAYMO_ASSERT(captures.back().is(Tag::cell));
    }
    out = Value::object(new FunctionObject(n.slot, std::move(captures)));
}

void Evaluator::enter(std::uint32_t entry) {
    if (entry == kNoPlan) return;
    for (const std::uint32_t slot : ast_.entries[entry].cells) {
        frame_->slots[slot] = Value::object(new CellObject(Value()));
    }
    for (const NodeId id : ast_.entries[entry].functions) {
        const Node& statement = ast_[id];
        Value closure;
        make_closure(ast_.child(statement, 1), closure);
        store(ast_[ast_.child(statement, 0)], std::move(closure));
    }
}

bool Evaluator::enter_function(const FunctionObject& closure, Value* slots, NodeId id, Value& out) {
    const FunctionInfo& info = ast_.functions[closure.info];
    const Node& lambda = ast_[info.lambda];
    Frame frame;
    frame.slots = slots;
    frame.closure = &closure;
    frame.caller = frame_;
    frame.site = id;
    frame.function = closure.info;
    ++depth_;
    Frame* const before = frame_;
    // The limit is reported at the call, in the caller's chain.
    if (!stack_left(id) || !step(id)) {
        --depth_;
        return false;
    }
    frame_ = &frame;
    bool good = true;
    if (info.entry != kNoPlan) {
        for (const std::uint32_t slot : ast_.entries[info.entry].cells) {
            slots[slot] = Value::object(new CellObject(std::move(slots[slot])));
        }
    }
    for (std::uint32_t i = info.required_count; i < info.parameter_count && good; ++i) {
        Value& slot = slots[i];
        const bool is_missing = slot.is(Tag::cell) ? slot.as<CellObject>().value.is(Tag::missing)
                                                   : slot.is(Tag::missing);
        if (!is_missing) continue;
        const Node& parameter = ast_[ast_.child(lambda, i)];
        Value value;
        good = eval(ast_.child(parameter, 0), value);
        if (good) store(parameter, std::move(value));
    }
    if (good) {
        const NodeId body = ast_.child(lambda, lambda.count - 1);
        if (ast_[body].kind != NodeKind::block) {
            good = eval(body, out);
        } else {
            const Flow flow = exec_block(ast_[body]);
            good = flow != Flow::failed;
            out = flow == Flow::returned ? std::move(returned_) : Value::nothing();
        }
    }
    frame_ = before;
    --depth_;
    return good;
}

bool Evaluator::run_builtin(std::uint32_t row, Value* slots, std::size_t count, NodeId id,
                            const CallPlan* plan, std::uint32_t first, Value& out) {
    const Builtin& b = builtins()[row];
    Call call(*this, id, b, slots, count, plan, first);
    return b.run(call, out);
}

// `first` is the child that is the first argument: 0 for the receiver of a method, 1 behind the callee of a call.
bool Evaluator::call_planned(const CallPlan& plan, const Node& n, NodeId id, std::uint32_t first,
                             Value* receiver, const Value& callee, Value& out) {
    const ValueStack::Mark mark = stack_.mark();
    const std::size_t count =
        plan.is_builtin ? plan.slots : std::max(plan.slots, ast_.functions[plan.callee].frame_size);
    Value* const slots = stack_.push(count);
    bool good = true;
    for (std::uint32_t i = 0; i < plan.parameter_of.size() && good; ++i) {
        Value& slot = slots[plan.parameter_of[i]];
        if (i == 0 && receiver != nullptr) {
            slot = std::move(*receiver);
            continue;
        }
        NodeId argument = ast_.child(n, first + i);
        if (ast_[argument].kind == NodeKind::argument) argument = ast_.child(ast_[argument], 0);
        good = operand(argument, slot);
    }
    if (good) {
        good = plan.is_builtin ? run_builtin(plan.callee, slots, plan.slots, id, &plan, first, out)
                               : enter_function(callee.as<FunctionObject>(), slots, id, out);
    }
    stack_.pop(slots, count, mark);
    return good;
}

bool Evaluator::call_dynamic(const Value& callee, const Node& n, NodeId id, std::uint32_t first,
                             Value* receiver, Value& out) {
    if (callee.is(Tag::random) && n.count == first) return call(callee, {}, id, out);
    if (!callee.is(Tag::function) && !callee.is(Tag::builtin)) {
        return fail(ErrorCode::bad_argument, span(n.kind == NodeKind::call ? ast_.child(n, 0) : id),
                    "only functions can be called", {},
                    fmt::format("this is {}", kind_text(callee)));
    }
    CallPlan plan;
    ParameterList own;
    const ParameterList* takes = &own;
    if (callee.is(Tag::builtin)) {
        plan.is_builtin = true;
        plan.callee = callee.builtin();
        takes = &builtins()[plan.callee].takes;
    } else {
        plan.callee = callee.as<FunctionObject>().info;
        own = parameters_of(ast_, ast_.functions[plan.callee], program_.symbols);
    }
    std::vector<GivenArgument> given;
    for (std::uint32_t i = first; i < n.count; ++i) {
        const Node& argument = ast_[ast_.child(n, i)];
        given.push_back(
            {argument.kind == NodeKind::argument ? argument.symbol : kNoSymbol, argument.span()});
    }
    if (auto error = match(*takes, given, program_.symbols, n.span(), plan)) {
        return fail(std::move(*error));
    }
    return call_planned(plan, n, id, first, receiver, callee, out);
}

bool Evaluator::eval_call(const Node& n, NodeId id, Value& out) {
    if (solve(n, out)) return step(id);
    const Node& name = ast_[ast_.child(n, 0)];
    if (n.slot != kNoPlan) {
        const CallPlan& plan = ast_.plans[n.slot];
        if (plan.is_builtin) return call_planned(plan, n, id, 1, nullptr, {}, out);
        // A function that can be no other stays where it is while it runs.
        if (plan.is_known && name.place == Place::global && globals_[name.slot].is(Tag::function)) {
            return call_planned(plan, n, id, 1, nullptr, globals_[name.slot], out);
        }
        Value callee;
        if (!eval_name(name, ast_.child(n, 0), callee)) return false;
        return call_planned(plan, n, id, 1, nullptr, callee, out);
    }
    Value callee;
    if (!eval(ast_.child(n, 0), callee)) return false;
    return call_dynamic(callee, n, id, 1, nullptr, out);
}

bool Evaluator::eval_method(const Node& n, NodeId id, Value& out) {
    Value receiver;
    if (!eval(ast_.child(n, 0), receiver)) return false;
    if (receiver.is(Tag::record)) {
        if (const Value* field = receiver.as<RecordObject>().find(n.symbol)) {
            const Value callee = *field;
            return call_dynamic(callee, n, id, 1, nullptr, out);
        }
    }
    if (n.place == Place::unresolved) {
        return fail(ErrorCode::name, n.span(),
                    fmt::format("{} has no field `{}`", kind_text(receiver),
                                program_.symbols.text(n.symbol)),
                    "and there is no function of that name");
    }
    const CallPlan* const plan = n.slot == kNoPlan ? nullptr : &ast_.plans[n.slot];
    if (plan != nullptr && plan->is_builtin) {
        return call_planned(*plan, n, id, 0, &receiver, {}, out);
    }
    Node name = n;
    name.slot = static_cast<std::uint32_t>(n.number);
    Value callee;
    if (!eval_name(name, id, callee)) return false;
    if (plan != nullptr) return call_planned(*plan, n, id, 0, &receiver, callee, out);
    return call_dynamic(callee, n, id, 0, &receiver, out);
}

bool Evaluator::call(const Value& function, std::span<const Value> arguments, NodeId site,
                     Value& out) {
    if (function.is(Tag::random)) {
        // SplitMix64 (Steele, Lea, Flood 2014): the top 53 bits as a fraction.
        auto& random = *static_cast<RandomObject*>(function.object());
        random.state += 0x9E3779B97F4A7C15ULL;
        std::uint64_t z = random.state;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
        z ^= z >> 31;
        out = Value::number(static_cast<double>(z >> 11) * 0x1p-53);
        return true;
    }
    if (!function.is(Tag::function) && !function.is(Tag::builtin)) {
        return fail(ErrorCode::bad_argument, span(site), "only functions can be called", {},
                    fmt::format("this is {}", kind_text(function)));
    }
    CallPlan plan;
    ParameterList own;
    const ParameterList* takes = &own;
    std::size_t count = 0;
    const bool is_builtin = function.is(Tag::builtin);
    if (is_builtin) {
        takes = &builtins()[function.builtin()].takes;
    } else {
        const FunctionInfo& info = ast_.functions[function.as<FunctionObject>().info];
        count = info.frame_size;
        // The common case needs no matching.
        if (arguments.size() < info.required_count || arguments.size() > info.parameter_count) {
            own = parameters_of(ast_, info, program_.symbols);
        } else {
            takes = nullptr;
        }
    }
    if (takes != nullptr) {
        const std::vector<GivenArgument> given(arguments.size(), {kNoSymbol, span(site)});
        if (auto error = match(*takes, given, program_.symbols, span(site), plan)) {
            return fail(std::move(*error));
        }
        count = std::max<std::size_t>(count, plan.slots);
    }
    const ValueStack::Mark mark = stack_.mark();
    Value* const slots = stack_.push(count);
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        slots[takes == nullptr ? i : plan.parameter_of[i]] = arguments[i];
    }
    bool good = false;
    if (is_builtin) {
        // Builtins that call builtins: depth counts, since map(xs, map) may nest.
        ++depth_;
        good = stack_left(site) && step(site) &&
               run_builtin(function.builtin(), slots, count, site, nullptr, 0, out);
        --depth_;
    } else {
        const Value keep = function;  // the function may be the last reference to itself
        good = enter_function(keep.as<FunctionObject>(), slots, site, out);
    }
    stack_.pop(slots, count, mark);
    return good;
}

}  // namespace raymo::sml
