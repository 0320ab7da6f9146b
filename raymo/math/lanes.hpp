// Arithmetic that kernels are written in: the same text serves one ray (double, bool) and several rays at once (a vector
// type and its mask, given by trace/). Every operation is one correctly rounded IEEE operation, so all give equal bits.
#pragma once

#include <cmath>

/// For what is computed in registers: a call would take its numbers through memory. Builds for sanitizers leave it to the
/// compiler, which needs minutes for checks of the long functions that come of it.
#ifndef RAYMO_INLINE
#define RAYMO_INLINE_BODY __attribute__((always_inline))  ///< of a lambda
#define RAYMO_INLINE inline RAYMO_INLINE_BODY
#endif

namespace raymo {

[[nodiscard]] inline double lane_sqrt(double a) { return std::sqrt(a); }
/// a b + c, rounded once.
[[nodiscard]] inline double lane_fma(double a, double b, double c) { return std::fma(a, b, c); }
[[nodiscard]] inline double lane_abs(double a) { return std::fabs(a); }
/// a < b ? a : b, so the second operand where one is NaN.
[[nodiscard]] constexpr double lane_min(double a, double b) { return a < b ? a : b; }
[[nodiscard]] constexpr double lane_max(double a, double b) { return a > b ? a : b; }
[[nodiscard]] inline double lane_copysign(double size, double sign) {
    return std::copysign(size, sign);
}
[[nodiscard]] constexpr double lane_select(bool mask, double yes, double no) {
    return mask ? yes : no;
}
[[nodiscard]] constexpr bool lane_and(bool a, bool b) { return a && b; }
[[nodiscard]] constexpr bool lane_or(bool a, bool b) { return a || b; }
[[nodiscard]] constexpr bool lane_not(bool a) { return !a; }
[[nodiscard]] constexpr bool lane_any(bool a) { return a; }

}  // namespace raymo
