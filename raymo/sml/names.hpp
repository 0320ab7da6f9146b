// Scopes and names while a program is resolved; see resolve.cpp.
#pragma once

#include <fmt/core.h>

#include <unordered_set>

#include "raymo/sml/builtins/builtin.hpp"
#include "raymo/sml/program.hpp"
#include "raymo/sml/suggest.hpp"

namespace raymo::sml {

inline constexpr std::uint32_t kMainLevel = 0xffffffffU;

inline std::string_view file_name(std::string_view path) {
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

/// What is declared where, and what a name stands for.
class Names {
protected:
    Names(Program& program, const SourceMap& sources, Reporter& reporter)
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
        // A variable called x is not the axis before it is declared.
        const int row = find_builtin(text(symbol));
        const bool is_axis = row >= 0 && builtins()[static_cast<std::size_t>(row)].is_axis;
        if (row >= 0 && !(is_axis && out.pending != kNoPlan)) {
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
            if (b.is_available && !b.is_axis) out.consider(b.takes.callee);
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

}  // namespace raymo::sml
