#include "raymo/sml/formula.hpp"

#include <algorithm>
#include <optional>

#include "raymo/sml/arithmetic.hpp"
#include "raymo/sml/builtins/builtin.hpp"
#include "raymo/sml/program.hpp"
#include "raymo/sml/value.hpp"

namespace raymo::sml {
namespace {

using Kind = FormulaStep::Kind;

/// A formula that costs more steps is left to the walk, which looks at the clock on the way.
constexpr std::uint32_t kMostCost = 2000;
constexpr int kMostNesting = 8;

/// The step for an operator whose right side is in hand. The steps with a number and with a place of the frame follow it.
std::optional<Kind> arithmetic_step(Operator op) {
    switch (op) {
        case Operator::add:
            return Kind::add;
        case Operator::subtract:
            return Kind::subtract;
        case Operator::multiply:
            return Kind::multiply;
        case Operator::divide:
            return Kind::divide;
        case Operator::modulo:
            return Kind::modulo;
        default:
            return {};
    }
}
Kind with_number(Kind step) { return static_cast<Kind>(static_cast<int>(step) + 1); }
Kind with_local(Kind step) { return static_cast<Kind>(static_cast<int>(step) + 2); }

class Maker {
public:
    explicit Maker(Program& program)
        : program_(program), ast_(program.ast), functions_(ast_.functions.size()) {}

    void run() {
        // Largest first: what is below a formula need not be one by itself.
        std::vector<NodeId> waiting;
        waiting.reserve(program_.modules.size() + program_.given.size());
        for (const Module& module : program_.modules) waiting.push_back(module.root);
        for (const auto& [name, expression] : program_.given) waiting.push_back(expression);
        while (!waiting.empty()) {
            const NodeId id = waiting.back();
            waiting.pop_back();
            if (id == kNoNode) continue;
            if (!is_computed(ast_[id]) || !make(id)) {
                const auto children = ast_.children_of(ast_[id]);
                waiting.insert(waiting.end(), children.begin(), children.end());
            }
        }
    }

private:
    enum class State : std::uint8_t { unknown, in_work, none, made };
    struct Function {
        State state = State::unknown;
        std::uint32_t formula = 0;
    };
    /// A formula while it is written.
    struct Draft {
        Formula formula;
        bool is_function = false;
        std::vector<bool> known{};  ///< of a function: which places of its frame hold something
        std::uint32_t stack = 0;
        std::uint32_t most_stack = 0;
        std::uint32_t most_room = 0;  ///< of what is called, from the end of the frame on
        int depth = 0;                ///< functions that are being made around it
    };

    [[nodiscard]] static bool is_computed(const Node& n) {
        return n.kind == NodeKind::binary || n.kind == NodeKind::chain ||
               n.kind == NodeKind::minus || n.kind == NodeKind::call;
    }

    bool make(NodeId id) {
        Draft draft;
        if (!write(draft, id)) return false;
        draft.formula.locals = static_cast<std::uint32_t>(draft.formula.inputs.size());
        const auto operations =
            std::count_if(draft.formula.steps.begin(), draft.formula.steps.end(),
                          [](const FormulaStep& s) { return s.kind > Kind::keep; });
        if (operations < 2 && draft.formula.nesting == 0) return false;
        const std::optional<std::uint32_t> index = finish(draft);
        if (!index) return false;
        ast_[id].flag = true;
        ast_[id].number = *index;
        return true;
    }

    std::optional<std::uint32_t> finish(Draft& draft) {
        Formula& f = draft.formula;
        f.room = f.locals + std::max(draft.most_stack, draft.most_room);
        if (f.room > kFormulaRoom || f.cost > kMostCost || f.nesting > kMostNesting) return {};
        program_.formulas.push_back(std::move(f));
        return static_cast<std::uint32_t>(program_.formulas.size() - 1);
    }

    /// The formula of a function's body, if it has one.
    std::optional<std::uint32_t> formula_of(std::uint32_t function, int depth) {
        Function& known = functions_[function];
        if (known.state == State::made) return known.formula;
        if (known.state != State::unknown || depth > kMostNesting) return {};
        known.state = State::in_work;
        const std::optional<std::uint32_t> index = make_function(ast_.functions[function], depth);
        known.state = index ? State::made : State::none;
        known.formula = index.value_or(0);
        return index;
    }

    std::optional<std::uint32_t> make_function(const FunctionInfo& info, int depth) {
        if (!info.captures.empty() || info.entry != kNoPlan) return {};
        Draft draft;
        draft.is_function = true;
        draft.depth = depth;
        draft.known.resize(std::max(info.frame_size, info.parameter_count));
        std::fill_n(draft.known.begin(), info.parameter_count, true);
        draft.formula.parameters = info.parameter_count;
        draft.formula.locals = static_cast<std::uint32_t>(draft.known.size());
        const Node& lambda = ast_[info.lambda];
        if (!write_body(draft, ast_.child(lambda, lambda.count - 1))) return {};
        return finish(draft);
    }

    bool write_body(Draft& draft, NodeId id) {
        const Node& body = ast_[id];
        if (body.kind != NodeKind::block) return write(draft, id);
        if (body.slot != kNoPlan) return false;
        for (std::uint32_t i = 0; i < body.count; ++i) {
            const Node& statement = ast_[ast_.child(body, i)];
            if (statement.kind == NodeKind::give_back)
                return statement.count == 1 && write(draft, ast_.child(statement, 0));
            if (statement.kind != NodeKind::let) return false;
            const Node& name = ast_[ast_.child(statement, 0)];
            if (name.kind != NodeKind::binding || name.place != Place::local || name.flag)
                return false;
            if (!write(draft, ast_.child(statement, 1))) return false;
            put(draft, {Kind::keep, name.slot}, -1);
            draft.known[name.slot] = true;
        }
        return false;
    }

    static void put(Draft& draft, FormulaStep step, int pushes) {
        draft.formula.steps.push_back(step);
        ++draft.formula.cost;
        draft.stack += static_cast<std::uint32_t>(pushes);
        draft.most_stack = std::max(draft.most_stack, draft.stack);
    }

    /// Recurses no deeper than expressions are high (kMaxHeight), times kMostNesting.
    bool write(Draft& draft, NodeId id) {
        if (draft.formula.cost > kMostCost) return false;
        const Node& n = ast_[id];
        switch (n.kind) {
            case NodeKind::number:
                put(draft, {Kind::number, 0, n.number}, 1);
                return true;
            case NodeKind::name:
                return write_name(draft, n);
            case NodeKind::minus:
                if (!write(draft, ast_.child(n, 0))) return false;
                put(draft, {Kind::negate}, 0);
                return true;
            case NodeKind::binary:
                return write(draft, ast_.child(n, 0)) && apply(draft, n.op, ast_.child(n, 1));
            case NodeKind::chain:
                if (!write(draft, ast_.child(n, 0))) return false;
                for (std::uint32_t i = 1; i < n.count; ++i) {
                    const Node& next = ast_[ast_.child(n, i)];
                    if (!apply(draft, next.op, ast_.child(next, 0))) return false;
                }
                return true;
            case NodeKind::call:
                return write_call(draft, n);
            default:
                return false;
        }
    }

    /// What is on top, `op` the expression.
    bool apply(Draft& draft, Operator op, NodeId right) {
        const std::optional<Kind> step = arithmetic_step(op);
        if (!step || !write(draft, right)) return false;
        FormulaStep& last = draft.formula.steps.back();
        if (last.kind != Kind::number && last.kind != Kind::local) {
            put(draft, {*step}, -1);
            return true;
        }
        // In one step with the operand.
        last.kind = last.kind == Kind::number ? with_number(*step) : with_local(*step);
        --draft.stack;
        return true;
    }

    bool write_name(Draft& draft, const Node& n) {
        if (n.place == Place::local && draft.is_function) {
            if (n.slot >= draft.known.size() || !draft.known[n.slot]) return false;
            put(draft, {Kind::local, n.slot}, 1);
            return true;
        }
        if (n.place == Place::local) {
            std::vector<std::uint32_t>& inputs = draft.formula.inputs;
            const auto known = std::find(inputs.begin(), inputs.end(), n.slot);
            const auto index = static_cast<std::uint32_t>(known - inputs.begin());
            if (known == inputs.end()) {
                if (inputs.size() == kFormulaRoom / 4) return false;
                inputs.push_back(n.slot);
            }
            put(draft, {Kind::local, index}, 1);
            return true;
        }
        if (n.place == Place::global) {
            put(draft, {Kind::global, n.slot}, 1);
            return true;
        }
        if (n.place != Place::builtin) return false;
        const Builtin& b = builtins()[n.slot];
        if (!b.is_constant || b.is_axis) return false;
        put(draft, {Kind::number, 0, b.constant}, 1);
        return true;
    }

    bool write_call(Draft& draft, const Node& n) {
        const Node& name = ast_[ast_.child(n, 0)];
        if (n.slot == kNoPlan || name.kind != NodeKind::name || name.place != Place::global)
            return false;
        const CallPlan& plan = ast_.plans[n.slot];
        if (plan.is_builtin || !plan.is_known) return false;
        // All parameters, in their order.
        const std::uint32_t count = n.count - 1;
        if (count != ast_.functions[plan.callee].parameter_count) return false;
        for (std::uint32_t i = 0; i < count; ++i) {
            if (plan.parameter_of[i] != i) return false;
        }
        const std::optional<std::uint32_t> callee = formula_of(plan.callee, draft.depth + 1);
        if (!callee) return false;
        for (std::uint32_t i = 0; i < count; ++i) {
            NodeId argument = ast_.child(n, 1 + i);
            if (ast_[argument].kind == NodeKind::argument) argument = ast_.child(ast_[argument], 0);
            if (!write(draft, argument)) return false;
        }
        const Formula& called = program_.formulas[*callee];
        draft.formula.cost += called.cost;
        draft.formula.nesting = std::max(draft.formula.nesting, called.nesting + 1);
        draft.most_room = std::max(draft.most_room, draft.stack - count + called.room + 1);
        put(draft, {Kind::call, *callee, static_cast<double>(name.slot)},
            1 - static_cast<int>(count));
        return true;
    }

    Program& program_;
    Ast& ast_;
    std::vector<Function> functions_;
};

}  // namespace

void make_formulas(Program& program) { Maker(program).run(); }

// A number that is not finite stays so through + - *, so it is looked for only where it could get lost: where it divides, is
// kept or goes into a function, which need not use it, and at the end.
bool compute(std::span<const Formula> formulas, const Formula& formula,
             std::span<const Value> globals, double* frame) {
    double* top = frame + formula.locals;
    double x =
        0.0;  // in hand, so that a step need not wait for the memory that the one before wrote
    const auto can_divide = [](double y) { return y != 0.0 && std::isfinite(y); };
    for (const FormulaStep& step : formula.steps) {
        switch (step.kind) {
            case Kind::number:
                *top++ = x;
                x = step.number;
                break;
            case Kind::local:
                *top++ = x;
                x = frame[step.index];
                break;
            case Kind::global: {
                const Value& value = globals[step.index];
                if (!value.is(Tag::number)) return false;
                *top++ = x;
                x = value.number();
                break;
            }
            case Kind::keep:
                if (!std::isfinite(x)) return false;
                frame[step.index] = x;
                x = *--top;
                break;
            case Kind::call: {
                if (!globals[static_cast<std::size_t>(step.number)].is(Tag::function)) return false;
                const Formula& called = formulas[step.index];
                *top++ = x;
                top -= called.parameters;
                const bool good = std::all_of(top, top + called.parameters,
                                              [](double y) { return std::isfinite(y); });
                if (!good || !compute(formulas, called, globals, top)) return false;
                x = *top;
                break;
            }
            case Kind::negate:
                x = -x;
                break;
            case Kind::add:
                x = *--top + x;
                break;
            case Kind::add_number:
                x += step.number;
                break;
            case Kind::add_local:
                x += frame[step.index];
                break;
            case Kind::subtract:
                x = *--top - x;
                break;
            case Kind::subtract_number:
                x -= step.number;
                break;
            case Kind::subtract_local:
                x -= frame[step.index];
                break;
            case Kind::multiply:
                x = *--top * x;
                break;
            case Kind::multiply_number:
                x *= step.number;
                break;
            case Kind::multiply_local:
                x *= frame[step.index];
                break;
            case Kind::divide:
                if (!can_divide(x)) return false;
                x = *--top / x;
                break;
            case Kind::divide_number:
                if (!can_divide(step.number)) return false;
                x /= step.number;
                break;
            case Kind::divide_local:
                if (!can_divide(frame[step.index])) return false;
                x /= frame[step.index];
                break;
            case Kind::modulo:
                if (!can_divide(x)) return false;
                x = remainder_of(*--top, x);
                break;
            case Kind::modulo_number:
                if (!can_divide(step.number)) return false;
                x = remainder_of(x, step.number);
                break;
            case Kind::modulo_local:
                if (!can_divide(frame[step.index])) return false;
                x = remainder_of(x, frame[step.index]);
                break;
        }
    }
    frame[0] = x;
    return std::isfinite(x);
}

}  // namespace raymo::sml
