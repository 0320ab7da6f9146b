// Parts of the language that have a name already, so that a program that uses one is told the truth.

#include <fmt/core.h>

#include "raymo/sml/builtins/call.hpp"

namespace raymo::sml {

std::span<const std::string_view> unavailable_names() {
    static constexpr auto kNames = std::to_array<std::string_view>(
        {"volume", "area", "centroid", "inertia", "clearance", "overlaps"});
    return kNames;
}

bool report_unavailable(Call& call, Value& out) {
    static_cast<void>(out);
    return call.evaluator().fail(ErrorCode::not_available, call.span(),
                                 fmt::format("`{}` is not available yet", call.name()));
}

}  // namespace raymo::sml
