// A ray in the frame of the base solid.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "raymo/trace/data.hpp"
#include "raymo/trace/tracer.hpp"

namespace raymo::trace {

/// Origins further from the centre than this (the solid's own radius is 0.5 to 1) are moved nearer, so that neither the
/// kernels' doubles nor the boxes' floats lose accuracy.
inline constexpr double kFarOrigin = 8.0;

/// x = o + s d, and how s gives the user's t.
struct BaseRay {
    Vec3 o, d;
    double shift = 0.0;    ///< s = 0 stands at this parameter (in lengths of d) of the user's ray
    double t_per_s = 1.0;  ///< user's t = (s + shift) * t_per_s; a power of two
    double error = 0.0;    ///< of o
    double start_error = 0.0;  ///< distance of the start from its surface, at most
    double step = 0.0;         ///< how far the ray was moved aside
    Vec3 moved;                ///< by this

    [[nodiscard]] double to_s(double t) const { return t / t_per_s - shift; }
};

/// The power of two that brings `size` (> 0, finite) to [1, 2).
[[nodiscard]] inline double binary_inverse(double size) {
    const std::uint64_t exponent = std::bit_cast<std::uint64_t>(size) >> 52;
    // 2046 - exponent is the exponent of the inverse; it would not be normal for 0 and for the largest numbers.
    if (exponent == 0 || exponent >= 2046) return std::ldexp(1.0, -std::ilogb(size));
    return std::bit_cast<double>((2046 - exponent) << 52);
}

[[nodiscard]] BaseRay base_ray(const CompiledSolid& solid, const RayQuery& query);

/// The ray moved sideways by `step` (times 4 to the number of the attempt), in a generic direction that differs by the
/// attempt. `on_surface`: it starts on a surface, which it then misses by as much.
[[nodiscard]] BaseRay moved_aside(BaseRay ray, double step, int attempt, bool on_surface);

}  // namespace raymo::trace
