// Sums of products without the loss of digits that cancellation brings.
#pragma once

#include <cmath>

#include "raymo/math/vec.hpp"

namespace raymo {

/// a b - c d, wrong by at most 1.5 units in its last place, whatever cancels [Jeannerod13].
[[nodiscard]] inline double difference_of_products(double a, double b, double c, double d) {
    const double cd = c * d;
    return std::fma(a, b, -cd) + std::fma(-c, d, cd);
}

/// a x b, each component to its last places.
[[nodiscard]] inline Vec3 accurate_cross(Vec3 a, Vec3 b) {
    return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
            difference_of_products(a.x, b.y, a.y, b.x)};
}

}  // namespace raymo
