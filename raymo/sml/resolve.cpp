// What every name stands for, before the program runs.
//
// A name belongs to the block in which it is declared. Code of the same function sees it from its declaration on;
// functions inside the block see it anywhere, since they run later. A variable that an inner function uses lives in a
// cell of its own, made when its block is entered; all others live in slots of the function's frame.

#include <fmt/core.h>

#include <unordered_set>

#include "raymo/sml/builtins/builtin.hpp"
#include "raymo/sml/program.hpp"
#include "raymo/sml/suggest.hpp"

namespace raymo::sml {
namespace {

constexpr std::uint32_t kMainLevel = 0xffffffffU;

std::string_view file_name(std::string_view path) {
    const std::size_t slash = path.rfind('/');
    return slash == std::string_view::npos ? path : path.substr(slash + 1);
}

struct Variable {
    Symbol symbol = kNoSymbol;
    NodeId node = kNoNode;  ///< binding or parameter
    Declared as = Declared::let;
    bool is_declared = false;
    bool is_captured = false;
    std::uint32_t slot = 0;
    std::uint32_t function = 0;  ///< of a `fn`: index into Ast::functions
    std::uint32_t module = 0;    ///< of an imported file
};

// A block, the names of a loop, or the parameters of a function.
struct Scope {
    std::unordered_map<Symbol, std::uint32_t> names;  ///< to variables_
    std::vector<std::uint32_t> order;
    std::uint32_t level = 0;  ///< index into levels_ of the function it belongs to
    bool is_module = false;
    std::vector<NodeId> functions;  ///< to make on entry
};

// A function whose body is being read; levels_[0] is the main code of a file.
struct Level {
    std::uint32_t function = kMainLevel;
    std::uint32_t frame_size = 0;
    std::unordered_map<std::uint32_t, std::uint32_t> captures;  ///< variable -> slot of the closure
    int loops = 0;
};

class Resolver {
public:
    Resolver(Program& program, const SourceMap& sources, Reporter& reporter)
        : program_(program), ast_(program.ast), sources_(sources), reporter_(reporter) {
        for (const std::string_view field : builtin_fields()) {
            fields_.insert(program_.symbols.intern(field));
        }
        for (const Node& n : ast_.nodes) {
            if (n.kind == NodeKind::field) fields_.insert(n.symbol);
        }
        if (reporter.errors() == 0) return;
        // Statements that did not parse are gone; what they may have declared is not called unknown.
        for (const Node& n : ast_.nodes) {
            if (n.kind == NodeKind::binding || n.kind == NodeKind::parameter)
                lost_.insert(n.symbol);
        }
    }

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
    // A copy: resolving adds nodes nowhere, but children must not be read through a dangling span.
    [[nodiscard]] std::span<const NodeId> children(const Node& n) const {
        return ast_.children_of(n);
    }
    [[nodiscard]] const std::string& text(Symbol s) const { return program_.symbols.text(s); }

    // ---- Scopes

    void open_scope() {
        scopes_.emplace_back();
        scopes_.back().level = static_cast<std::uint32_t>(levels_.size() - 1);
    }

    // Index of the entry that the scope needs, or kNoPlan.
    std::uint32_t close_scope() {
        Scope& scope = scopes_.back();
        Ast::Entry entry;
        if (!scope.is_module) {
            for (const std::uint32_t v : scope.order) {
                if (variables_[v].is_captured) entry.cells.push_back(variables_[v].slot);
            }
        }
        entry.functions = std::move(scope.functions);
        scopes_.pop_back();
        if (entry.cells.empty() && entry.functions.empty()) return kNoPlan;
        ast_.entries.push_back(std::move(entry));
        return static_cast<std::uint32_t>(ast_.entries.size() - 1);
    }

    std::uint32_t add(NodeId node, Declared as, bool is_declared) {
        Scope& scope = scopes_.back();
        const Symbol symbol = ast_[node].symbol;
        if (const auto found = scope.names.find(symbol); found != scope.names.end()) {
            const Variable& before = variables_[found->second];
            reporter_.error(
                ErrorCode::name, ast_[node].span(),
                fmt::format("`{}` is declared already, on line {}", text(symbol),
                            line(before.node)),
                before.as == Declared::var
                    ? fmt::format("to give it a new value, write `{} = ...`", text(symbol))
                    : std::string("choose another name"));
            return found->second;
        }
        Variable v;
        v.symbol = symbol;
        v.node = node;
        v.as = as;
        v.is_declared = is_declared;
        if (scope.is_module) {
            v.slot = static_cast<std::uint32_t>(program_.globals.size());
            program_.globals.push_back(node);
            ast_[node].place = Place::global;
        } else {
            v.slot = levels_.back().frame_size++;
            ast_[node].place = Place::local;
        }
        ast_[node].slot = v.slot;
        const auto index = static_cast<std::uint32_t>(variables_.size());
        variables_.push_back(v);
        scope.names.emplace(symbol, index);
        scope.order.push_back(index);
        return index;
    }

    [[nodiscard]] std::size_t line(NodeId node) const {
        return line_of(sources_[ast_[node].file].text, ast_[node].begin);
    }

    // Names of a block, before its statements are read.
    void declare_all(const Node& block) {
        for (const NodeId id : children(block)) {
            const Node n = ast_[id];
            switch (n.kind) {
                case NodeKind::let:
                    declare_pattern(ast_.child(n, 0), Declared::let);
                    break;
                case NodeKind::var:
                    declare_pattern(ast_.child(n, 0), Declared::var);
                    break;
                case NodeKind::param:
                    declare_pattern(ast_.child(n, 0), Declared::param);
                    break;
                case NodeKind::part:
                    declare_pattern(ast_.child(n, 0), Declared::part);
                    break;
                case NodeKind::view:
                    declare_pattern(ast_.child(n, 0), Declared::view);
                    break;
                case NodeKind::function: {
                    const std::uint32_t v = add(ast_.child(n, 0), Declared::function, true);
                    variables_[v].function = ast_[ast_.child(n, 1)].slot;
                    scopes_.back().functions.push_back(id);
                    break;
                }
                case NodeKind::import:
                    declare_file(id, n);
                    break;
                case NodeKind::import_names:
                    declare_imported(id, n);
                    break;
                default:
                    break;
            }
        }
    }

    void declare_pattern(NodeId pattern, Declared as) {
        const Node n = ast_[pattern];
        if (n.kind == NodeKind::binding) {
            add(pattern, as, false);
        } else {
            for (const NodeId name : children(n)) {
                if (ast_[name].kind == NodeKind::binding) add(name, as, false);
            }
        }
    }

    void mark_declared(NodeId pattern) {
        const Node n = ast_[pattern];
        if (n.kind == NodeKind::binding) {
            const auto found = scopes_.back().names.find(n.symbol);
            if (found != scopes_.back().names.end()) variables_[found->second].is_declared = true;
        } else {
            for (const NodeId name : children(n)) mark_declared(name);
        }
    }

    [[nodiscard]] const Module* imported(NodeId statement) const {
        const auto& imports = program_.modules[module_].imports;
        const auto found = imports.find(statement);
        return found == imports.end() ? nullptr : &program_.modules[found->second];
    }

    void declare_file(NodeId id, const Node& n) {
        if (!at_top_level(n) || n.count < 2) return;
        const std::uint32_t v = add(ast_.child(n, 1), Declared::file, true);
        const auto found = program_.modules[module_].imports.find(id);
        variables_[v].module =
            found == program_.modules[module_].imports.end() ? kMainLevel : found->second;
    }

    void declare_imported(NodeId id, const Node& n) {
        if (!at_top_level(n)) return;
        const Module* const module = imported(id);
        for (std::uint32_t i = 1; i < n.count; ++i) {
            const NodeId name = ast_.child(n, i);
            const std::uint32_t v = add(name, Declared::let, true);
            if (module == nullptr) continue;
            const auto found = module->names.find(ast_[name].symbol);
            if (found == module->names.end()) {
                unknown_in_file(*module, ast_[name]);
                continue;
            }
            variables_[v].slot = found->second.slot;
            variables_[v].function = found->second.function;
            variables_[v].as =
                found->second.as == Declared::function ? Declared::function : Declared::let;
        }
    }

    bool at_top_level(const Node& n) {
        if (scopes_.size() == 1) return true;
        reporter_.error(ErrorCode::syntax, n.span(), "an import stands at the top level of a file",
                        "move it to the beginning of the file");
        return false;
    }

    void unknown_in_file(const Module& module, const Node& name) {
        Suggestion suggestion(text(name.symbol));
        for (const auto& [known, exported] : module.names) suggestion.consider(text(known));
        reporter_.error(ErrorCode::name, name.span(),
                        fmt::format("`{}` is not declared in `{}`", text(name.symbol),
                                    file_name(sources_[module.file].path)),
                        suggestion.hint());
    }

    void export_names(Module& m) {
        for (const auto& [symbol, index] : scopes_.front().names) {
            const Variable& v = variables_[index];
            if (v.as == Declared::file) continue;
            m.names[symbol] = {v.slot, v.as, v.node, v.function};
        }
    }

    // ---- Names

    struct Found {
        Place place = Place::unresolved;
        std::uint32_t slot = 0;
        std::uint32_t variable = kNoPlan;
        std::uint32_t pending = kNoPlan;  ///< declared further down
    };

    Found find(Symbol symbol) {
        Found out;
        const auto here = static_cast<std::uint32_t>(levels_.size() - 1);
        for (auto scope = scopes_.rbegin(); scope != scopes_.rend(); ++scope) {
            const auto named = scope->names.find(symbol);
            if (named == scope->names.end()) continue;
            Variable& v = variables_[named->second];
            if (scope->level == here && !v.is_declared) {
                if (out.pending == kNoPlan) out.pending = named->second;
                continue;
            }
            out.variable = named->second;
            if (scope->is_module) {
                out.place = Place::global;
                out.slot = v.slot;
            } else if (scope->level == here) {
                out.place = Place::local;
                out.slot = v.slot;
            } else {
                v.is_captured = true;
                out.place = Place::captured;
                out.slot = capture(here, scope->level, named->second);
            }
            return out;
        }
        const int row = find_builtin(text(symbol));
        if (row >= 0) {
            out.place = Place::builtin;
            out.slot = static_cast<std::uint32_t>(row);
        }
        return out;
    }

    std::uint32_t capture(std::uint32_t level, std::uint32_t owner, std::uint32_t variable) {
        const auto known = levels_[level].captures.find(variable);
        if (known != levels_[level].captures.end()) return known->second;
        FunctionInfo::Capture from;
        from.from_local = level - 1 == owner;
        from.slot =
            from.from_local ? variables_[variable].slot : capture(level - 1, owner, variable);
        auto& captures = ast_.functions[levels_[level].function].captures;
        captures.push_back(from);
        const auto slot = static_cast<std::uint32_t>(captures.size() - 1);
        levels_[level].captures.emplace(variable, slot);
        return slot;
    }

    // Suggests among all names in sight.
    [[nodiscard]] std::string suggestion(Symbol symbol) const {
        Suggestion out(text(symbol));
        for (const Scope& scope : scopes_) {
            for (const auto& [known, index] : scope.names) {
                if (known != kNoSymbol) out.consider(text(known));
            }
        }
        for (const Builtin& b : builtins()) {
            if (b.is_available) out.consider(b.takes.callee);
        }
        return out.hint();
    }

    void report_unknown(const Node& n, const Found& found, std::string_view what) {
        if (found.pending != kNoPlan) {
            reporter_.error(ErrorCode::name, n.span(),
                            fmt::format("`{}` is used before it is declared", text(n.symbol)),
                            fmt::format("it is declared on line {}: move that up",
                                        line(variables_[found.pending].node)));
            return;
        }
        if (lost_.contains(n.symbol)) return;
        reporter_.error(ErrorCode::name, n.span(),
                        fmt::format("unknown {} `{}`", what, shortened(text(n.symbol))),
                        suggestion(n.symbol));
    }

    Found name(NodeId id) {
        Node& n = ast_[id];
        const Found found = find(n.symbol);
        if (found.place == Place::unresolved) {
            report_unknown(n, found, "name");
            return found;
        }
        if (found.variable != kNoPlan && variables_[found.variable].as == Declared::file) {
            reporter_.error(ErrorCode::name, n.span(),
                            fmt::format("`{}` is an imported file, not a value", text(n.symbol)),
                            fmt::format("take a name from it: {}.name", text(n.symbol)));
            return found;
        }
        n.place = found.place;
        n.slot = found.slot;
        return found;
    }

    // gear.spur: the name of an imported file's name. True when `receiver` names a file.
    bool name_in_file(NodeId receiver, Symbol member, SourceSpan whole, Found& out) {
        Node& n = ast_[receiver];
        if (n.kind != NodeKind::name) return false;
        const Found found = find(n.symbol);
        if (found.variable == kNoPlan || variables_[found.variable].as != Declared::file)
            return false;
        n.place = Place::global;
        const std::uint32_t m = variables_[found.variable].module;
        if (m == kMainLevel) return true;  // reported when it was loaded
        const auto exported = program_.modules[m].names.find(member);
        if (exported == program_.modules[m].names.end()) {
            Node shown = n;
            shown.symbol = member;
            shown.begin = whole.begin;
            shown.end = whole.end;
            unknown_in_file(program_.modules[m], shown);
            return true;
        }
        n.symbol = member;
        n.slot = exported->second.slot;
        out.place = Place::global;
        out.slot = exported->second.slot;
        file_member_ = &exported->second;
        return true;
    }

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
                        out.hint());
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
                if (b.is_constant) {
                    const Node& n = ast_[id];
                    reporter_.error(
                        ErrorCode::bad_argument, n.span(),
                        fmt::format("`{}` is a number, not a function", b.takes.callee));
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
                fmt::format("`{}` is a function of the language", text(ast_[target].symbol)),
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

    Program& program_;
    Ast& ast_;
    const SourceMap& sources_;
    Reporter& reporter_;
    std::uint32_t module_ = 0;
    std::vector<Variable> variables_;
    std::vector<Scope> scopes_;
    std::vector<Level> levels_;
    std::unordered_set<Symbol> fields_;
    std::unordered_set<Symbol> lost_;
    const Exported* file_member_ = nullptr;
};

}  // namespace

void resolve(Program& program, const SourceMap& sources, Reporter& reporter) {
    Resolver resolver(program, sources, reporter);
    for (const std::uint32_t module : program.order) resolver.module(module);
    for (const auto& [name, expression] : program.given) resolver.given_parameter(expression);
}

}  // namespace raymo::sml
