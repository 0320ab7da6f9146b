// A line with a start and a direction.
#pragma once

#include "raymo/math/vec.hpp"

namespace raymo {

/// x(t) = origin + t direction. The direction need not be of unit length, but is neither zero nor infinite.
struct Ray {
    Vec3 origin;
    Vec3 direction;

    [[nodiscard]] constexpr Vec3 at(double t) const { return origin + direction * t; }
};

}  // namespace raymo
