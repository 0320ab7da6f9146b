// Numbers of 113 bits, for tests that judge what doubles found.
#pragma once

#include <cmath>

namespace raymo::solids::conformance {

/// 113 bits.
using Quad = __float128;

inline Quad quad_sqrt(Quad a) {
    if (!(a > 0)) return 0;
    Quad r = std::sqrt(static_cast<long double>(a));
    r = (r + a / r) / 2;
    return (r + a / r) / 2;
}
inline Quad quad_abs(Quad a) { return a < 0 ? -a : a; }

struct QuadPoint {
    Quad x, y, z;
};

}  // namespace raymo::solids::conformance
