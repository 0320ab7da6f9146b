// A line against the boxes of a sweep's tree.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>

#include "raymo/solids/sweep/swept_spheres.hpp"

namespace raymo::solids {

/// Slabs in floats, for boxes that are larger than need be by kBoxMargin [KayKajiya86].
class Slabs {
public:
    Slabs() = default;
    /// `error`: of a place on the line.
    Slabs(Vec3 origin, Vec3 along, double error) {
        const auto margin = static_cast<float>(error * (1.0 + 0x1p-20));
        for (int a = 0; a < 3; ++a) {
            const auto i = static_cast<std::size_t>(a);
            const auto d = static_cast<float>(along[a]);
            const auto o = static_cast<float>(origin[a]);
            // 1e-15 moves no place by more than the margin.
            inverse_[i] = 1.0F / std::copysign(std::max(std::fabs(d), 1e-15F), d);
            from_first_[i] = o + std::copysign(margin, d);
            from_last_[i] = o - std::copysign(margin, d);
        }
    }
    /// Bit c: child c may be met.
    [[nodiscard]] unsigned met(const SweptNode& node) const {
        constexpr std::size_t kWidth = SweptNode::kWidth;
        // Boxes without content have their ends the wrong way round, and so have their slabs.
        float near[3][kWidth];
        float far[3][kWidth];
        for (std::size_t a = 0; a < 3; ++a) {
            const float* first = inverse_[a] > 0.0F ? node.lo[a] : node.hi[a];
            const float* last = inverse_[a] > 0.0F ? node.hi[a] : node.lo[a];
            for (std::size_t c = 0; c < kWidth; ++c) {
                near[a][c] = (first[c] - from_first_[a]) * inverse_[a];
                far[a][c] = (last[c] - from_last_[a]) * inverse_[a];
            }
        }
        std::uint32_t missed[kWidth];
        for (std::size_t c = 0; c < kWidth; ++c) {
            const float begin = near[0][c] > near[1][c] ? near[0][c] : near[1][c];
            const float end = far[0][c] < far[1][c] ? far[0][c] : far[1][c];
            const float enter = begin > near[2][c] ? begin : near[2][c];
            const float exit = end < far[2][c] ? end : far[2][c];
            missed[c] = std::bit_cast<std::uint32_t>(exit - enter) >> 31;
        }
        unsigned bits = 0;
        for (std::size_t c = 0; c < kWidth; ++c) bits |= (1U - missed[c]) << c;
        return bits;
    }

private:
    /// The line's place, moved by the margin against the line for the planes that are met first, and on for the last.
    std::array<float, 3> inverse_, from_first_, from_last_;
};

/// Nodes of a tree that wait for a line, at most: of each level but the first seven, of 2^32 pieces.
inline constexpr std::size_t kMostWaiting = 8 * 11;

}  // namespace raymo::solids
