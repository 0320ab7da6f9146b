// Which rays of a packet: one bit each.
#pragma once

#include <cstddef>
#include <cstdint>

namespace raymo::trace {

/// Rays of a packet.
inline constexpr int kRays = 16;

/// Lanes of a packet, one bit each.
using LaneBits = std::uint32_t;
inline constexpr LaneBits kAllLanes = (LaneBits{1} << kRays) - 1;

[[nodiscard]] constexpr LaneBits first_lanes(std::size_t count) { return (1U << count) - 1U; }
[[nodiscard]] inline int lowest_lane(LaneBits lanes) { return __builtin_ctz(lanes); }
[[nodiscard]] constexpr int lane_count(LaneBits lanes) {
    // Not every machine that this is compiled for counts bits in one instruction.
    lanes = (lanes & 0x5555U) + (lanes >> 1U & 0x5555U);
    lanes = (lanes & 0x3333U) + (lanes >> 2U & 0x3333U);
    lanes = (lanes & 0x0f0fU) + (lanes >> 4U & 0x0f0fU);
    return static_cast<int>((lanes & 0xffU) + (lanes >> 8U));
}

}  // namespace raymo::trace
