// Runs a resolved program.
//
// A walk over the table of nodes with one frame of values a call. Errors are a return value: `false`, with the error
// kept in the evaluator. Depth is limited three ways: calls by Limits::call_depth, the height of an expression by the
// parser, and both together by the bytes of stack they use.
#pragma once

#include <memory>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "raymo/core/row_index.hpp"
#include "raymo/sml/builtins/builtin.hpp"
#include "raymo/sml/drawings.hpp"
#include "raymo/sml/program.hpp"
#include "raymo/sml/value.hpp"

namespace raymo::sml {

/// Values of frames and arguments: grows in chunks that never move.
class ValueStack {
public:
    struct Mark {
        std::size_t chunk = 0;
        std::size_t used = 0;
    };
    [[nodiscard]] Mark mark() const { return {chunk_, used_}; }
    /// `count` missing values.
    [[nodiscard]] Value* push(std::size_t count) {
        if (chunk_ >= chunks_.size() || used_ + count > chunks_[chunk_].size) open_chunk(count);
        Value* const first = chunks_[chunk_].values.get() + used_;
        used_ += count;
        return first;
    }
    /// Gives back the last `count` values pushed, from `first` on.
    void pop(Value* first, std::size_t count, Mark before) {
        for (std::size_t i = 0; i < count; ++i) first[i].reset();
        chunk_ = before.chunk;
        used_ = before.used;
    }

private:
    static constexpr std::size_t kChunk = 1024;
    /// Goes on to a chunk with room for `count` values.
    void open_chunk(std::size_t count);

    struct Chunk {
        std::unique_ptr<Value[]> values;
        std::size_t size = 0;
    };
    std::vector<Chunk> chunks_;
    std::size_t chunk_ = 0;
    std::size_t used_ = 0;
};

class Evaluator {
public:
    Evaluator(Program& program, const Host& host, Outcome& outcome, Reporter& reporter);

    /// The whole program. False: an error was reported.
    bool run();

    // ---- For builtins

    /// Reports an error at a place; always false.
    bool fail(ErrorCode code, SourceSpan where, std::string message, std::string hint = {},
              std::string label = {});
    bool fail(Error error);
    /// Calls a function value with arguments by position.
    bool call(const Value& function, std::span<const Value> arguments, NodeId site, Value& out);
    /// To be called once for every piece of work that a program repeats. False: a limit was passed or the user
    /// stopped.
    bool step(NodeId site) {
        if (++steps_ % kStepsBetweenChecks != 0 && heap_.bytes() <= host_.limits.bytes) return true;
        return check_limits(site);
    }
    /// False, with an error, when `bytes` more would pass the limit.
    bool room(double bytes, NodeId site);
    /// Counts a new node of a solid. `is_primitive`: against the limit of solids too.
    bool made(const csg::Solid& solid, bool is_primitive, NodeId site);
    /// Counts work that a program can repeat: `units` of some 100 ns. False: a limit was passed or the user stopped.
    bool worked(double units, NodeId site) {
        return units < kStepsBetweenChecks ? step(site) : check_limits(site);
    }
    /// A new contour as a value. `bytes`: what was made for it.
    bool made(curves::Contour contour, double bytes, NodeId site, Value& out);
    bool made(curves::PathPtr path, NodeId site, Value& out);
    bool made(meshes::Mesh mesh, NodeId site, Value& out);
    /// A Boolean of contours.
    bool combine(curves::ContourOp op, std::vector<curves::Contour> operands, NodeId site,
                 Value& out);
    /// A Boolean of two solids or `nothing`.
    bool combine(csg::Op op, std::vector<csg::Solid> operands, NodeId site, SourceSpan span,
                 Value& out);
    bool binary(Operator op, const Value& a, const Value& b, NodeId site, SourceSpan span,
                NodeId left, NodeId right, Value& out);
    /// Deep equality.
    bool equal(const Value& a, const Value& b, NodeId site, bool& out);
    /// As print and ${...} show it.
    bool show(const Value& value, NodeId site, std::string& out);
    [[nodiscard]] csg::MaterialId material(const scene::Material& material);

    [[nodiscard]] SourceSpan span(NodeId node) const { return program_.ast[node].span(); }
    [[nodiscard]] Program& program() { return program_; }
    [[nodiscard]] const Host& host() const { return host_; }
    [[nodiscard]] Drawings& drawings() { return drawings_; }
    /// The file that a place is in.
    [[nodiscard]] const std::string& path(SourceSpan where) const {
        return outcome_.sources[where.file].path;
    }
    [[nodiscard]] scene::Scene& scene() { return outcome_.scene; }
    /// False while an imported file runs: it contributes names only.
    [[nodiscard]] bool in_main_file() const { return in_main_file_; }

private:
    friend class Call;
    static constexpr std::uint32_t kStepsBetweenChecks = 1024;
    static constexpr std::size_t kMaxStackBytes = 5U << 20;

    enum class Flow : std::uint8_t { normal, broke, continued, returned, failed };

    struct Frame {
        Value* slots = nullptr;
        const FunctionObject* closure = nullptr;
        const Frame* caller = nullptr;
        NodeId site = kNoNode;
        std::uint32_t function = 0xffffffffU;
    };

    // Expressions (eval_expr.cpp)
    bool eval(NodeId id, Value& out);
    /// eval() for what is mostly a number, written out or in a variable; `out` is missing.
    bool operand(NodeId id, Value& out) {
        const Node& n = ast_[id];
        if (n.kind == NodeKind::number) {
            out.set_number(n.number);
            return true;
        }
        if (n.kind == NodeKind::name && n.place == Place::local) {
            const Value& v = frame_->slots[n.slot];
            if (v.is(Tag::number)) {
                out.set_number(v.number());
                return true;
            }
        }
        if (n.kind == NodeKind::binary) return eval_binary(n, id, out);
        if (n.kind == NodeKind::chain) return eval_chain(n, id, out);
        return eval(id, out);
    }
    /// What the node's formula gives. False: it has none, or that gives nothing, and the node has to be walked.
    bool solve(const Node& n, Value& out) const {
        if (!n.flag) return false;
        const Formula& formula = program_.formulas[static_cast<std::size_t>(n.number)];
        if (depth_ + formula.nesting > host_.limits.call_depth) return false;
        double frame[kFormulaRoom];
        for (std::size_t i = 0; i < formula.inputs.size(); ++i) {
            const Value& input = frame_->slots[formula.inputs[i]];
            if (!input.is(Tag::number)) return false;
            frame[i] = input.number();
        }
        if (!compute(program_.formulas, formula, globals_, frame)) return false;
        out.set_number(frame[0]);
        return true;
    }
    bool eval_name(const Node& n, NodeId id, Value& out);
    bool eval_list(const Node& n, NodeId id, Value& out);
    bool eval_record(const Node& n, Value& out);
    bool eval_range(const Node& n, NodeId id, double& low, double& high, double& step,
                    double& count);
    bool eval_binary(const Node& n, NodeId id, Value& out);
    bool eval_chain(const Node& n, NodeId id, Value& out);
    /// For a record without the field `written`: a name like it, and the fields it has.
    [[nodiscard]] std::string fields_hint(const RecordObject& record,
                                          std::string_view written) const;
    bool eval_member(const Node& n, Value& out);
    bool eval_index(const Node& n, NodeId id, Value& out);
    bool eval_interpolation(const Node& n, NodeId id, Value& out);
    bool eval_comprehension(const Node& n, NodeId id, Value& out);
    bool comprehend(const Node& n, NodeId id, std::uint32_t clause, std::vector<Value>& items);
    bool eval_minus(const Node& n, NodeId id, Value& out);
    bool condition(NodeId id, std::string_view what, bool& out);
    bool number_of(NodeId id, std::string_view what, double& out);
    bool element(const Value& list, double index, NodeId id, NodeId index_node, Value& out);

    // Calls (eval_call.cpp)
    bool eval_call(const Node& n, NodeId id, Value& out);
    bool eval_method(const Node& n, NodeId id, Value& out);
    /// `receiver` is moved into its place among the arguments.
    bool call_planned(const CallPlan& plan, const Node& n, NodeId id, std::uint32_t first,
                      Value* receiver, const Value& callee, Value& out);
    bool call_dynamic(const Value& callee, const Node& n, NodeId id, std::uint32_t first,
                      Value* receiver, Value& out);
    bool run_builtin(std::uint32_t row, Value* slots, std::size_t count, NodeId id,
                     const CallPlan* plan, std::uint32_t first, Value& out);
    bool enter_function(const FunctionObject& closure, Value* slots, NodeId id, Value& out);
    void make_closure(NodeId lambda, Value& out);
    void enter(std::uint32_t entry);

    // Statements (eval_stmt.cpp)
    Flow exec(NodeId id);
    Flow exec_block(const Node& n);
    Flow exec_for(const Node& n);
    Flow exec_while(const Node& n, NodeId id);
    bool exec_expression(const Node& n, NodeId id);
    bool exec_assertion(const Node& n);
    bool exec_param(const Node& n);
    bool exec_part(const Node& n);
    bool exec_view(const Node& n);
    bool exec_assign(const Node& n);
    bool check_domain(NodeId domain, const std::string& name, const Value& value, SourceSpan where);
    bool bind(NodeId pattern, Value&& value, NodeId source);
    void store(const Node& name, Value&& value);
    /// Calls f(element) for each element of a list, range or text; f returns false to stop.
    template <class F>
    bool for_each(NodeId source, F&& f);

    // Scene
    enum class Shown : std::uint8_t { yes, no, failed };
    Shown show_in_scene(const Value& value, NodeId node, bool is_emitted);
    void add_part(std::string name, csg::Solid solid, SourceSpan where);
    [[nodiscard]] std::string part_name(NodeId node) const;

    bool check_limits(NodeId site);
    /// False, with an error, when calls are nested too deep.
    [[nodiscard]] bool stack_left(NodeId site) {
        const char* const here = static_cast<const char*>(__builtin_frame_address(0));
        const auto used =
            static_cast<std::size_t>(stack_base_ > here ? stack_base_ - here : here - stack_base_);
        if (depth_ <= host_.limits.call_depth && used <= kMaxStackBytes) [[likely]]
            return true;
        return too_deep(site);
    }
    bool too_deep(NodeId site);
    void collect_docs();

    Program& program_;
    const Ast& ast_;
    const Host& host_;
    Outcome& outcome_;
    Reporter& reporter_;
    Heap heap_;
    Drawings drawings_;
    ValueStack stack_;
    std::vector<Value> globals_;
    Frame* frame_ = nullptr;
    Value returned_;
    double started_ = 0.0;
    double solids_ = 0.0;
    std::uint32_t steps_ = 0;
    int depth_ = 0;
    const char* stack_base_ = nullptr;
    bool in_main_file_ = false;
    RowIndex materials_;  ///< of the scene's materials
    std::unordered_map<std::string, std::uint32_t> part_names_;
    std::unordered_set<NodeId> warned_;
    std::unordered_map<NodeId, TextRange> docs_;
    std::uint32_t unnamed_parts_ = 0;
};

/// The numbers of a range; see RangeObject.
[[nodiscard]] double range_count(double low, double high, double step, bool is_open);

}  // namespace raymo::sml
