// Primitives by name, for the tests of this layer.
#pragma once

#include <string_view>
#include <vector>

#include "raymo/csg/model.hpp"

namespace raymo::trace::test {

/// Arguments that are left out at the end have their defaults.
inline csg::Solid primitive(std::string_view name, std::vector<solids::Argument> arguments) {
    const auto rows = solids::inventory();
    for (std::uint32_t i = 0; i < rows.size(); ++i) {
        if (rows[i].schema->name != name) continue;
        const auto params = rows[i].schema->params;
        while (arguments.size() < params.size())
            arguments.push_back(*params[arguments.size()].fallback);
        return csg::primitive(i, arguments).value();
    }
    return {};
}

}  // namespace raymo::trace::test
