// All builtins in one table, and how calls fit their parameters.

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <unordered_map>

#include "raymo/sml/builtins/builtin.hpp"
#include "raymo/sml/suggest.hpp"

namespace raymo::sml {
namespace {

// "s x? y*" as data.
ParameterList parse_parameters(std::string_view name, std::string_view text) {
    ParameterList out;
    out.callee = name;
    bool by_name_only = false;
    std::string shown;
    std::vector<ParameterList::Parameter> others;
    while (!text.empty()) {
        const std::size_t space = std::min(text.find(' '), text.size());
        std::string_view word = text.substr(0, space);
        text.remove_prefix(std::min(space + 1, text.size()));
        if (word == "|") {
            by_name_only = true;
            continue;
        }
        const char mark = word.back();
        if (mark == '?' || mark == '*') word.remove_suffix(1);
        if (const std::size_t slash = word.find('/'); slash != std::string_view::npos) {
            others.push_back({std::string(word.substr(slash + 1)), false,
                              static_cast<int>(out.parameters.size())});
            word = word.substr(0, slash);
        }
        if (!shown.empty()) shown += ", ";
        if (mark == '*') {
            out.has_rest = true;
            shown += fmt::format("{}...", word);
            continue;
        }
        shown += by_name_only ? fmt::format("{}: ...", word) : std::string(word);
        out.parameters.push_back({std::string(word), mark != '?', -1});
        if (!by_name_only) out.positional = out.parameters.size();
    }
    out.parameters.insert(out.parameters.end(), others.begin(), others.end());
    out.signature = fmt::format("{}({})", name, shown);
    return out;
}

ParameterList parameters_of(const solids::Schema& schema) {
    ParameterList out;
    out.callee = schema.name;
    std::string shown;
    for (const solids::Param& p : schema.params) {
        if (!shown.empty()) shown += ", ";
        out.parameters.push_back({std::string(p.name), !p.fallback.has_value(), -1});
        if (p.kind == solids::ParamKind::size) {
            shown += "dx, dy, dz";
            out.parameters.push_back({"dy", false, -1});
            out.parameters.push_back({"dz", false, -1});
        } else {
            shown += p.name;
        }
    }
    out.positional = out.parameters.size();
    int index = 0;
    for (const solids::Param& p : schema.params) {
        if (!p.diameter.empty()) {
            out.parameters.push_back({std::string(p.diameter), false, index});
        }
        if (p.kind == solids::ParamKind::size) out.parameters.push_back({"dx", false, index});
        index += p.kind == solids::ParamKind::size ? 3 : 1;
    }
    out.signature = fmt::format("{}({})", schema.name, shown);
    return out;
}

struct Table {
    std::vector<Builtin> rows;
    std::unordered_map<std::string_view, int> index;

    Table() {
        int primitive = 0;
        for (const solids::Entry& entry : solids::inventory()) {
            Builtin b;
            b.takes = parameters_of(*entry.schema);
            b.run = &make_primitive;
            b.doc = entry.schema->doc;
            b.primitive = primitive++;
            rows.push_back(std::move(b));
        }
        for (const auto topic :
             {number_rows(), vector_rows(), list_rows(), text_rows(), solid_rows(), blend_rows(),
              contour_rows(), path_rows(), mesh_rows(), drawing_rows(), transform_rows(),
              arrangement_rows(), look_rows(), question_rows()}) {
            for (const BuiltinRow& row : topic) {
                Builtin b;
                b.takes = parse_parameters(row.name, row.parameters);
                b.run = row.run;
                b.doc = row.doc;
                rows.push_back(std::move(b));
            }
        }
        for (const std::string_view name : unavailable_names()) {
            Builtin b;
            b.takes.callee = name;
            b.run = &report_unavailable;
            b.is_available = false;
            rows.push_back(std::move(b));
        }
        add_constant("pi", std::numbers::pi);
        add_constant("tau", 2.0 * std::numbers::pi);
        add_axis("x", {1, 0, 0});
        add_axis("y", {0, 1, 0});
        add_axis("z", {0, 0, 1});
        for (std::size_t i = 0; i < rows.size(); ++i) {
            index.emplace(rows[i].takes.callee, static_cast<int>(i));
        }
    }
    void add_constant(std::string_view name, double value) {
        Builtin b;
        b.takes.callee = name;
        b.is_constant = true;
        b.constant = value;
        rows.push_back(std::move(b));
    }
    void add_axis(std::string_view name, Vec3 direction) {
        add_constant(name, 0.0);
        rows.back().is_axis = true;
        rows.back().axis = direction;
    }
};

const Table& table() {
    static const Table kTable;
    return kTable;
}

Error argument_error(SourceSpan where, std::string message, std::string hint) {
    return {ErrorCode::bad_argument, std::move(message), {}, std::move(hint), -1, where};
}

std::string plural(std::size_t n, std::string_view word) {
    return fmt::format("{} {}{}", n, word, n == 1 ? "" : "s");
}

}  // namespace

std::span<const Builtin> builtins() { return table().rows; }

int find_builtin(std::string_view name) {
    const auto found = table().index.find(name);
    return found == table().index.end() ? -1 : found->second;
}

std::span<const std::string_view> builtin_fields() {
    static constexpr auto kFields = std::to_array<std::string_view>(
        {"x", "y", "z", "min", "max", "size", "center", "enter", "exit", "enter_point",
         "exit_point", "enter_normal", "exit_normal"});
    return kFields;
}

ParameterList parameters_of(const Ast& ast, const FunctionInfo& info, const Symbols& symbols) {
    ParameterList out;
    out.callee = info.name == kNoSymbol ? "the function" : symbols.text(info.name);
    std::string shown;
    const Node& lambda = ast[info.lambda];
    for (std::uint32_t i = 0; i < info.parameter_count; ++i) {
        const std::string& name = symbols.text(ast[ast.child(lambda, i)].symbol);
        if (!shown.empty()) shown += ", ";
        shown += name;
        out.parameters.push_back({name, i < info.required_count, -1});
    }
    out.positional = info.parameter_count;
    out.signature =
        fmt::format("{}({})", info.name == kNoSymbol ? "fn" : symbols.text(info.name), shown);
    return out;
}

std::optional<Error> match(const ParameterList& takes, std::span<const GivenArgument> given,
                           const Symbols& symbols, SourceSpan call, CallPlan& plan) {
    const std::size_t count = takes.parameters.size();
    std::vector<bool> taken(count, false);
    std::size_t next = 0;
    std::size_t rest = 0;
    plan.parameter_of.clear();
    for (const GivenArgument& argument : given) {
        std::size_t parameter = count;
        if (argument.name == kNoSymbol) {
            if (next < takes.positional) {
                parameter = next++;
            } else if (takes.has_rest) {
                parameter = count + rest++;
            } else {
                const std::size_t positions = static_cast<std::size_t>(std::count_if(
                    given.begin(), given.end(), [](const auto& g) { return g.name == kNoSymbol; }));
                return argument_error(argument.where,
                                      fmt::format("{}: takes {}, given {}", takes.callee,
                                                  plural(takes.positional, "argument"), positions),
                                      fmt::format("it is {}", takes.signature));
            }
        } else {
            const std::string& name = symbols.text(argument.name);
            for (std::size_t i = 0; i < count; ++i) {
                if (takes.parameters[i].name == name) parameter = i;
            }
            if (parameter == count) {
                Suggestion suggestion(name);
                for (const auto& p : takes.parameters) suggestion.consider(p.name);
                return argument_error(
                    argument.where,
                    fmt::format("{}: there is no argument `{}`", takes.callee, shortened(name)),
                    suggestion.found() ? suggestion.hint()
                                       : fmt::format("it is {}", takes.signature));
            }
        }
        if (parameter < count) {
            const int other = takes.parameters[parameter].stands_for;
            if (other >= 0 && taken[static_cast<std::size_t>(other)]) {
                return argument_error(
                    argument.where,
                    fmt::format("{}: give `{}` or `{}`, not both", takes.callee,
                                takes.parameters[static_cast<std::size_t>(other)].name,
                                takes.parameters[parameter].name),
                    {});
            }
            if (taken[parameter]) {
                return argument_error(argument.where,
                                      fmt::format("{}: the argument `{}` is given twice",
                                                  takes.callee, takes.parameters[parameter].name),
                                      {});
            }
            taken[parameter] = true;
            for (std::size_t i = 0; i < count; ++i) {
                if (takes.parameters[i].stands_for != static_cast<int>(parameter) || !taken[i])
                    continue;
                return argument_error(
                    argument.where,
                    fmt::format("{}: give `{}` or `{}`, not both", takes.callee,
                                takes.parameters[parameter].name, takes.parameters[i].name),
                    {});
            }
        }
        plan.parameter_of.push_back(
            static_cast<std::uint16_t>(std::min<std::size_t>(parameter, 65535)));
    }
    if (count + rest > 60000) {
        return argument_error(call, fmt::format("{}: too many arguments", takes.callee),
                              "pass a list");
    }
    for (std::size_t i = 0; i < count; ++i) {
        bool found = taken[i] || !takes.parameters[i].required;
        for (std::size_t k = 0; k < count && !found; ++k) {
            found = takes.parameters[k].stands_for == static_cast<int>(i) && taken[k];
        }
        if (!found) {
            return argument_error(call,
                                  fmt::format("{}: the argument `{}` is missing", takes.callee,
                                              takes.parameters[i].name),
                                  fmt::format("it is {}", takes.signature));
        }
    }
    plan.slots = static_cast<std::uint32_t>(count + rest);
    return std::nullopt;
}

}  // namespace raymo::sml
