// What every name stands for, before the program runs.
//
// A name belongs to the block in which it is declared. Code of the same function sees it from its declaration on;
// functions inside the block see it anywhere, since they run later. A variable that an inner function uses lives in a
// cell of its own, made when its block is entered; all others live in slots of the function's frame.

#include <fmt/core.h>

#include "raymo/sml/builtins/builtin.hpp"
#include "raymo/sml/names.hpp"
#include "raymo/sml/program.hpp"
#include "raymo/sml/suggest.hpp"

namespace raymo::sml {
namespace {

class Resolver : private Names {
public:
    Resolver(Program& program, const SourceMap& sources, Reporter& reporter)
        : Names(program, sources, reporter) {}

    void module(std::uint32_t index) {
        module_ = index;
        Module& m = program_.modules[index];
        if (m.root == kNoNode) return;
        levels_.assign(1, {});
        scopes_.clear();
        open_scope();
        scopes_.back().is_module = true;
        const Node root = ast_[m.root];
        declare_all(root);
        for (const NodeId id : children(root)) statement(id);
        export_names(m);
        m.frame_size = levels_[0].frame_size;
        m.entry = close_scope();
    }

    void given_parameter(NodeId expression_node) {
        module_ = 0;
        levels_.assign(1, {});
        scopes_.clear();
        open_scope();
        scopes_.back().is_module = true;
        expression(expression_node);
        program_.modules[0].frame_size =
            std::max(program_.modules[0].frame_size, levels_[0].frame_size);
        static_cast<void>(close_scope());
    }

private:
    // ---- Expressions

    void expressions(const Node& n, std::uint32_t from = 0) {
        for (std::uint32_t i = from; i < n.count; ++i) expression(ast_.child(n, i));
    }

    void expression(NodeId id) {
        const Node n = ast_[id];
        switch (n.kind) {
            case NodeKind::name:
                name(id);
                return;
            case NodeKind::call:
                call(id, n);
                return;
            case NodeKind::method:
                method(id, n);
                return;
            case NodeKind::member:
                member(id, n);
                return;
            case NodeKind::lambda:
                lambda(id);
                return;
            case NodeKind::comprehension:
                comprehension(n);
                return;
            default:
                expressions(n);
        }
    }

    void comprehension(const Node& n) {
        std::size_t opened = 0;
        std::vector<NodeId> loops;
        for (std::uint32_t i = 0; i + 1 < n.count; ++i) {
            const NodeId id = ast_.child(n, i);
            const Node clause = ast_[id];
            if (clause.kind == NodeKind::if_clause) {
                expression(ast_.child(clause, 0));
                continue;
            }
            expression(ast_.child(clause, 1));
            open_scope();
            declare_pattern(ast_.child(clause, 0), Declared::let);
            mark_declared(ast_.child(clause, 0));
            loops.push_back(id);
            ++opened;
        }
        expression(ast_.child(n, n.count - 1));
        while (opened > 0) {
            ast_[loops[--opened]].slot = close_scope();
        }
    }

    void member(NodeId id, const Node& n) {
        const NodeId receiver = ast_.child(n, 0);
        Found found;
        if (name_in_file(receiver, n.symbol, n.span(), found)) {
            // The node becomes the name itself.
            Node& self = ast_[id];
            self.kind = NodeKind::name;
            self.place = found.place == Place::unresolved ? Place::global : found.place;
            self.slot = found.slot;
            self.count = 0;
            return;
        }
        expression(receiver);
        check_field(n, n.end - static_cast<std::uint32_t>(text(n.symbol).size()), false);
    }

    void check_field(const Node& n, std::uint32_t begin, bool is_call) {
        if (fields_.contains(n.symbol)) return;
        const SourceSpan where{n.file, begin,
                               begin + static_cast<std::uint32_t>(text(n.symbol).size())};
        if (is_call) {
            Node shown = n;
            shown.begin = where.begin;
            shown.end = where.end;
            report_unknown(shown, find(n.symbol), "function");
            return;
        }
        const Found function = find(n.symbol);
        if (function.place != Place::unresolved) {
            reporter_.error(ErrorCode::name, where,
                            fmt::format("no value has a field `{}`", text(n.symbol)),
                            fmt::format("to call the function, write .{}()", text(n.symbol)));
            return;
        }
        Suggestion out(text(n.symbol));
        for (const Symbol known : fields_) out.consider(text(known));
        reporter_.error(ErrorCode::name, where,
                        fmt::format("no value has a field `{}`", shortened(text(n.symbol))),
                        out.found() ? out.hint() : fields_written());
    }

    // The fields of all records that the program writes.
    [[nodiscard]] std::string fields_written() const {
        std::string out;
        std::unordered_set<Symbol> seen;
        for (const Node& n : ast_.nodes) {
            if (n.kind != NodeKind::field || !seen.insert(n.symbol).second) continue;
            out += (out.empty() ? "" : ", ") + shortened(text(n.symbol));
            if (out.size() > 60) return out + ", ...";
        }
        return out.empty() ? "the program makes no records" : "records here have the fields " + out;
    }

    // The arguments of a call or method node from child `first` on; the receiver counts where it is one.
    [[nodiscard]] std::vector<GivenArgument> given(const Node& n, std::uint32_t first) const {
        std::vector<GivenArgument> out;
        for (std::uint32_t i = first; i < n.count; ++i) {
            const Node& argument = ast_[ast_.child(n, i)];
            out.push_back({argument.kind == NodeKind::argument ? argument.symbol : kNoSymbol,
                           argument.span()});
        }
        return out;
    }

    void plan(NodeId id, std::uint32_t first, const Found& callee, bool is_known) {
        CallPlan out;
        out.is_known = is_known;
        ParameterList takes_own;
        const ParameterList* takes = &takes_own;
        if (callee.place == Place::builtin) {
            const Builtin& b = builtins()[callee.slot];
            if (b.is_constant || !b.is_available) {
                if (b.is_constant && is_known) {
                    const Node& n = ast_[id];
                    reporter_.error(ErrorCode::bad_argument, n.span(),
                                    fmt::format("`{}` is {}, not a function", b.takes.callee,
                                                b.is_axis ? "a vector" : "a number"));
                }
                return;
            }
            out.is_builtin = true;
            out.callee = callee.slot;
            takes = &b.takes;
        } else if (file_member_ != nullptr && file_member_->as == Declared::function) {
            out.callee = file_member_->function;
            takes_own = parameters_of(ast_, ast_.functions[out.callee], program_.symbols);
        } else if (callee.variable != kNoPlan &&
                   variables_[callee.variable].as == Declared::function) {
            out.callee = variables_[callee.variable].function;
            takes_own = parameters_of(ast_, ast_.functions[out.callee], program_.symbols);
        } else {
            return;
        }
        const Node n = ast_[id];
        const auto arguments = given(n, first);
        if (auto error = match(*takes, arguments, program_.symbols, n.span(), out)) {
            if (is_known) {
                reporter_.error(std::move(*error));
            }
            return;
        }
        ast_[id].slot = static_cast<std::uint32_t>(ast_.plans.size());
        ast_.plans.push_back(std::move(out));
    }

    void call(NodeId id, const Node& n) {
        ast_[id].slot = kNoPlan;
        const NodeId callee = ast_.child(n, 0);
        Found found;
        file_member_ = nullptr;
        if (ast_[callee].kind == NodeKind::name) {
            found = name(callee);
        } else {
            expression(callee);
        }
        if (found.place != Place::unresolved) plan(id, 1, found, true);
        expressions(n, 1);
    }

    void method(NodeId id, const Node& n) {
        ast_[id].slot = kNoPlan;
        const NodeId receiver = ast_.child(n, 0);
        Found found;
        file_member_ = nullptr;
        const std::uint32_t name_begin = find_member(n, receiver);
        const SourceSpan whole{n.file, n.begin,
                               name_begin + static_cast<std::uint32_t>(text(n.symbol).size())};
        if (name_in_file(receiver, n.symbol, whole, found)) {
            ast_[id].kind = NodeKind::call;
            ast_[receiver].end = whole.end;
            if (found.place != Place::unresolved) plan(id, 1, found, true);
            file_member_ = nullptr;
            expressions(n, 1);
            return;
        }
        expression(receiver);
        found = find(n.symbol);
        file_member_ = nullptr;
        if (found.place == Place::unresolved) {
            check_field(n, name_begin, true);
        } else {
            ast_[id].place = found.place;
            ast_[id].number = found.slot;
            // A record may have a field of that name; then its function is called.
            plan(id, 0, found, !fields_.contains(n.symbol));
        }
        expressions(n, 1);
    }

    // Where the name behind the dot stands: behind the receiver, past blanks and the dot.
    [[nodiscard]] std::uint32_t find_member(const Node& n, NodeId receiver) const {
        const std::string& source = sources_[n.file].text;
        const std::size_t found = source.find(text(n.symbol), ast_[receiver].end);
        return found == std::string::npos ? n.begin : static_cast<std::uint32_t>(found);
    }

    void lambda(NodeId id) {
        const Node n = ast_[id];
        Level level;
        level.function = n.slot;
        levels_.push_back(std::move(level));
        open_scope();
        for (std::uint32_t i = 0; i + 1 < n.count; ++i) add(ast_.child(n, i), Declared::let, false);
        for (std::uint32_t i = 0; i + 1 < n.count; ++i) {
            const NodeId parameter = ast_.child(n, i);
            if (ast_[parameter].count > 0) expression(ast_.child(ast_[parameter], 0));
            const auto found = scopes_.back().names.find(ast_[parameter].symbol);
            if (found != scopes_.back().names.end()) variables_[found->second].is_declared = true;
        }
        const NodeId body = ast_.child(n, n.count - 1);
        if (ast_[body].kind == NodeKind::block) {
            statement(body);
        } else {
            expression(body);
        }
        const std::uint32_t entry = close_scope();
        ast_.functions[n.slot].frame_size = levels_.back().frame_size;
        ast_.functions[n.slot].entry = entry;
        levels_.pop_back();
    }

    // ---- Statements

    void block(NodeId id) {
        const Node n = ast_[id];
        if (n.kind != NodeKind::block) return;
        open_scope();
        declare_all(n);
        for (const NodeId child : children(n)) statement(child);
        ast_[id].slot = close_scope();
    }

    void statement(NodeId id) {
        const Node n = ast_[id];
        switch (n.kind) {
            case NodeKind::block:
                block(id);
                return;
            case NodeKind::let:
            case NodeKind::var:
            case NodeKind::part:
            case NodeKind::view:
                expression(ast_.child(n, 1));
                mark_declared(ast_.child(n, 0));
                return;
            case NodeKind::param:
                if (scopes_.size() > 1) {
                    reporter_.error(ErrorCode::syntax, n.span(),
                                    "a param stands at the top level of a file",
                                    "move it to the beginning of the file");
                }
                expressions(n, 1);
                mark_declared(ast_.child(n, 0));
                return;
            case NodeKind::function:
                lambda(ast_.child(n, 1));
                return;
            case NodeKind::assign:
                assignment(n);
                return;
            case NodeKind::if_else:
                expression(ast_.child(n, 0));
                for (std::uint32_t i = 1; i < n.count; ++i) statement(ast_.child(n, i));
                return;
            case NodeKind::for_each:
                expression(ast_.child(n, 1));
                open_scope();
                declare_pattern(ast_.child(n, 0), Declared::let);
                mark_declared(ast_.child(n, 0));
                ++levels_.back().loops;
                block(ast_.child(n, 2));
                --levels_.back().loops;
                ast_[id].slot = close_scope();
                return;
            case NodeKind::while_loop:
                expression(ast_.child(n, 0));
                ++levels_.back().loops;
                block(ast_.child(n, 1));
                --levels_.back().loops;
                return;
            case NodeKind::break_loop:
            case NodeKind::continue_loop:
                if (levels_.back().loops == 0) {
                    const bool is_break = n.kind == NodeKind::break_loop;
                    reporter_.error(ErrorCode::syntax, n.span(),
                                    fmt::format("`{}` stands outside of a loop",
                                                is_break ? "break" : "continue"),
                                    "it belongs inside a `for` or a `while`");
                }
                return;
            case NodeKind::give_back:
                if (levels_.size() == 1) {
                    reporter_.error(ErrorCode::syntax, n.span(),
                                    "`return` stands outside of a function",
                                    "to show a solid, write it alone or use `part`");
                }
                expressions(n);
                return;
            case NodeKind::import:
            case NodeKind::import_names:
                return;  // done when the block was entered
            default:
                expressions(n);
        }
    }

    void assignment(const Node& n) {
        const NodeId target = ast_.child(n, 0);
        expression(ast_.child(n, 1));
        const Found found = name(target);
        if (found.place == Place::unresolved) return;
        if (found.place == Place::builtin) {
            reporter_.error(
                ErrorCode::name, ast_[target].span(),
                fmt::format("`{}` is a {} of the language", text(ast_[target].symbol),
                            builtins()[found.slot].is_constant ? "constant" : "function"),
                fmt::format("declare a variable of that name: var {} = ...",
                            text(ast_[target].symbol)));
            return;
        }
        const Variable& v = variables_[found.variable];
        if (v.as == Declared::var || v.as == Declared::file) return;
        reporter_.error(ErrorCode::name, ast_[target].span(),
                        fmt::format("`{}` can not be given a new value", text(v.symbol)),
                        v.as == Declared::let && ast_[v.node].kind == NodeKind::binding
                            ? fmt::format("declare it with `var` on line {}", line(v.node))
                            : std::string("use a variable of another name"));
    }
};

}  // namespace

void resolve(Program& program, const SourceMap& sources, Reporter& reporter) {
    Resolver resolver(program, sources, reporter);
    for (const std::uint32_t module : program.order) resolver.module(module);
    for (const auto& [name, expression] : program.given) resolver.given_parameter(expression);
}

}  // namespace raymo::sml
