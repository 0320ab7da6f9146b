// Functions of the language that are written in C++. A topic is one file with its table at the end; the tables are
// listed in table.cpp. Primitives are not in any table: they come from solids::inventory().
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "raymo/sml/ast.hpp"
#include "raymo/sml/value.hpp"

namespace raymo::sml {

class Call;
/// Runs a builtin: false when it failed and said so.
using BuiltinFunction = bool (*)(Call& call, Value& out);

/// One row of a topic's table.
struct BuiltinRow {
    std::string_view name;
    /// Parameters, parted by spaces: `x` required, `x?` optional, `x*` any number, behind `|` by name only. `r/d`: `d`, by
    /// name, gives twice `r`.
    std::string_view parameters;
    BuiltinFunction run;
    std::string_view doc;
};

/// What a call may give: of a builtin, or of a function of the program.
struct ParameterList {
    struct Parameter {
        std::string name;
        bool required = false;
        int stands_for = -1;  ///< gives the same as that parameter (a diameter for a radius)
    };
    std::string callee;
    std::vector<Parameter> parameters;
    std::size_t positional = 0;  ///< the first so many may be given by position
    bool has_rest = false;
    std::string signature;  ///< for hints: "ring(s, n, axis, angle)"
};

struct Builtin {
    ParameterList takes;
    BuiltinFunction run = nullptr;
    std::string_view doc;
    int primitive = -1;        ///< row of solids::inventory()
    bool is_constant = false;  ///< pi, tau, x, y, z: no function
    bool is_available = true;
    double constant = 0.0;
    bool is_axis = false;  ///< x, y, z: the constant is the vector `axis`
    Vec3 axis;
};

[[nodiscard]] std::span<const Builtin> builtins();
/// Row of the table, or -1.
[[nodiscard]] int find_builtin(std::string_view name);
/// Names of the fields of records that builtins make.
[[nodiscard]] std::span<const std::string_view> builtin_fields();

struct GivenArgument {
    Symbol name = kNoSymbol;  ///< kNoSymbol: by position
    SourceSpan where;
};
/// Finds the parameter of each argument. Error: too many, missing, unknown or doubled arguments.
[[nodiscard]] std::optional<Error> match(const ParameterList& takes,
                                         std::span<const GivenArgument> given,
                                         const Symbols& symbols, SourceSpan call, CallPlan& plan);
[[nodiscard]] ParameterList parameters_of(const Ast& ast, const FunctionInfo& info,
                                          const Symbols& symbols);

// The topics.
[[nodiscard]] std::span<const BuiltinRow> number_rows();
[[nodiscard]] std::span<const BuiltinRow> vector_rows();
[[nodiscard]] std::span<const BuiltinRow> list_rows();
[[nodiscard]] std::span<const BuiltinRow> text_rows();
[[nodiscard]] std::span<const BuiltinRow> solid_rows();
[[nodiscard]] std::span<const BuiltinRow> blend_rows();
[[nodiscard]] std::span<const BuiltinRow> contour_rows();
[[nodiscard]] std::span<const BuiltinRow> path_rows();
[[nodiscard]] std::span<const BuiltinRow> mesh_rows();
[[nodiscard]] std::span<const BuiltinRow> drawing_rows();
[[nodiscard]] std::span<const BuiltinRow> transform_rows();
[[nodiscard]] std::span<const BuiltinRow> arrangement_rows();
[[nodiscard]] std::span<const BuiltinRow> look_rows();
[[nodiscard]] std::span<const BuiltinRow> question_rows();
/// Parts of the language that are named but not built yet.
[[nodiscard]] std::span<const std::string_view> unavailable_names();
/// Runs the primitive of the call's row.
bool make_primitive(Call& call, Value& out);
/// The Boolean of what make(outline) makes for each outline of a contour, as the contour is the Boolean of its outlines.
/// make() is called once for each outline, however often the contour uses it: where it is moved to, too, if `moves_along`
/// says that what is made moves along. Cost: one visit of each node of the contour.
bool for_each_outline(Call& call, const curves::Contour& contour, bool moves_along,
                      const std::function<bool(const curves::OutlinePtr&, Value&)>& make,
                      Value& out);
bool report_unavailable(Call& call, Value& out);

}  // namespace raymo::sml
