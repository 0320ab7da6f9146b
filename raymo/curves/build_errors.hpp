// What the builders of curves and paths say of numbers that can not be.
#pragma once

#include "raymo/core/result.hpp"
#include "raymo/core/shown.hpp"

namespace raymo::curves {

/// An error of range; `argument` counts the parameters of the builder.
[[nodiscard]] inline Failure wrong(int argument, std::string message, std::string hint = {},
                                   std::string label = {}) {
    return Failure(Error{ErrorCode::out_of_range,
                         std::move(message),
                         std::move(label),
                         std::move(hint),
                         argument,
                         {}});
}

}  // namespace raymo::curves
