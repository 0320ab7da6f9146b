// A closed mesh of faces with any number of sides, smoothed to bicubic patches: meshes/smooth.cpp tells how the patches are
// found, solids/freeform/ how rays meet them. Ref: [Wijk86 6.3], [CatmullClark78].
#pragma once

#include "raymo/solids/freeform/freeform.hpp"

namespace raymo::solids {

struct Smooth {
    using Kernel = FreeformKernel<Smooth>;

    [[nodiscard]] static const Schema& schema();
    [[nodiscard]] static Result<Placed<Kernel>> prepare(std::span<const Argument> arguments);
    [[nodiscard]] static std::span<const std::vector<Argument>> examples();
};

}  // namespace raymo::solids
