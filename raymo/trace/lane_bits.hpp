// Which rays of a packet: one bit each.
#pragma once

#include <cstddef>
#include <cstdint>

namespace raymo::trace {

/// Rays of a packet.
inline constexpr int kRays = 32;

/// Lanes of a packet, one bit each.
using LaneBits = std::uint32_t;
inline constexpr LaneBits kAllLanes = ~LaneBits{0} >> (32 - kRays);

[[nodiscard]] constexpr LaneBits first_lanes(std::size_t count) {
    return static_cast<LaneBits>((std::uint64_t{1} << count) - 1);
}
[[nodiscard]] inline int lowest_lane(LaneBits lanes) { return __builtin_ctz(lanes); }
/// One more than the last of some lanes; 0 of none.
[[nodiscard]] constexpr int end_of(LaneBits lanes) {
    return lanes == 0 ? 0 : 32 - __builtin_clz(lanes);
}
/// Lanes are computed by groups of this many, or fewer.
inline constexpr int kGroup = 8;
/// Where the group of the first of some lanes begins.
[[nodiscard]] constexpr int begin_of(LaneBits lanes) {
    return lanes == 0 ? 0 : __builtin_ctz(lanes) / kGroup * kGroup;
}
[[nodiscard]] constexpr int lane_count(LaneBits lanes) {
    // Not every machine that this is compiled for counts bits in one instruction.
    lanes = (lanes & 0x55555555U) + (lanes >> 1U & 0x55555555U);
    lanes = (lanes & 0x33333333U) + (lanes >> 2U & 0x33333333U);
    lanes = (lanes & 0x0f0f0f0fU) + (lanes >> 4U & 0x0f0f0f0fU);
    return static_cast<int>((lanes * 0x01010101U) >> 24U);
}

}  // namespace raymo::trace
