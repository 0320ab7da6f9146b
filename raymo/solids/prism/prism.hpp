// A contour swept along its normal: all points (x, y, z) with (x, y) in the contour and 0 <= z <= h. Derivation:
// solids/contour_sweep.hpp. Ref: [Wijk86 3.3].
#pragma once

#include "raymo/solids/contour_sweep.hpp"

namespace raymo::solids {

struct Prism {
    class Kernel : public ContourSweep {
    public:
        using ContourSweep::ContourSweep;
    };

    [[nodiscard]] static const Schema& schema();
    [[nodiscard]] static Result<Placed<Kernel>> prepare(std::span<const Argument> arguments);
    [[nodiscard]] static std::span<const std::vector<Argument>> examples();
};

}  // namespace raymo::solids
