// Primitives by their names in the language, for benchmarks that build their models in C++.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "raymo/scene/scene.hpp"

namespace raymo::bench {

/// A primitive; parameters that are not given take their fallback.
inline Result<csg::Solid> primitive(
    std::string_view name,
    std::initializer_list<std::pair<std::string_view, solids::Argument>> given) {
    const auto inventory = solids::inventory();
    for (std::uint32_t index = 0; index < inventory.size(); ++index) {
        const solids::Schema& schema = *inventory[index].schema;
        if (schema.name != name) continue;
        std::vector<solids::Argument> arguments;
        for (const solids::Param& param : schema.params) {
            const solids::Argument* value = param.fallback ? &*param.fallback : nullptr;
            for (const auto& [key, argument] : given) {
                if (key == param.name) value = &argument;
            }
            if (value == nullptr) {
                return fail(ErrorCode::bad_argument,
                            std::string(name) + ": no " + std::string(param.name));
            }
            arguments.push_back(*value);
        }
        return csg::primitive(index, arguments);
    }
    return fail(ErrorCode::name, "no primitive " + std::string(name));
}

}  // namespace raymo::bench
