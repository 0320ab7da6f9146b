// Polynomials of degree 3 and 4, eight side by side.
#pragma once

#include <cstddef>

namespace raymo::bench {

struct LaneCounts {
    std::size_t none = 0;  ///< without a root
    std::size_t one = 0;   ///< with one crossing, found
    double sum = 0.0;      ///< of what was found, so that it is
};

/// `c` holds blocks of eight polynomials, all first coefficients first.
LaneCounts count_in_lanes(int degree, const double* c, std::size_t polynomials);

}  // namespace raymo::bench
