// Bicubic patches that close up, given by their control points. How rays meet them: solids/freeform/. Ref: [Wijk86 6.2].
#pragma once

#include "raymo/solids/freeform/freeform.hpp"

namespace raymo::solids {

struct Patches {
    using Kernel = FreeformKernel<Patches>;

    [[nodiscard]] static const Schema& schema();
    [[nodiscard]] static Result<Placed<Kernel>> prepare(std::span<const Argument> arguments);
    [[nodiscard]] static std::span<const std::vector<Argument>> examples();
};

}  // namespace raymo::solids
