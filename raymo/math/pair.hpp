// Two numbers side by side in one register, where the machine has such: for computations on one ray that do the same thing
// twice. Every operation is that on both numbers, one correctly rounded IEEE operation each, so the bits are those of two
// numbers one after the other on any machine.
#pragma once

#include "raymo/math/lanes.hpp"

namespace raymo {

/// Of GCC and Clang; + - * / are those of the language.
using Pair = double __attribute__((vector_size(16)));

[[nodiscard]] RAYMO_INLINE Pair pair_of(double a) { return Pair{a, a}; }
[[nodiscard]] RAYMO_INLINE Pair swapped(Pair a) { return Pair{a[1], a[0]}; }
/// The second operand where they tie and where one is NaN, like lane_min and lane_max.
[[nodiscard]] RAYMO_INLINE Pair pair_min(Pair a, Pair b) { return a < b ? a : b; }
[[nodiscard]] RAYMO_INLINE Pair pair_max(Pair a, Pair b) { return a > b ? a : b; }

[[nodiscard]] RAYMO_INLINE Pair pair_abs(Pair a) {
    using Bits = long long __attribute__((vector_size(16)));
    constexpr long long kAllButSign = 0x7fffffffffffffff;
    return reinterpret_cast<Pair>(reinterpret_cast<Bits>(a) & Bits{kAllButSign, kAllButSign});
}

}  // namespace raymo
