// A contour that shrinks, or grows, along its normal: its section at height z is the contour times 1 + (s - 1) z / h, about
// the origin. Derivation: solids/contour_sweep.hpp. Ref: [Wijk86 3.4].
#pragma once

#include "raymo/solids/contour_sweep.hpp"

namespace raymo::solids {

struct Conic {
    class Kernel : public ContourSweep {
    public:
        using ContourSweep::ContourSweep;
    };

    [[nodiscard]] static const Schema& schema();
    [[nodiscard]] static Result<Placed<Kernel>> prepare(std::span<const Argument> arguments);
    [[nodiscard]] static std::span<const std::vector<Argument>> examples();
};

}  // namespace raymo::solids
