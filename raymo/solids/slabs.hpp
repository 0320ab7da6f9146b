// A line against eight boxes at once.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "raymo/math/aabb.hpp"

namespace raymo::solids {

/// By so much boxes in floats are larger than what they hold: the rounding of floats, in the products of the slab test
/// too, of numbers below 4.
inline constexpr double kBoxMargin = 0x1p-18;

/// Boxes in floats, side by side. One without content has its ends the wrong way round.
struct EightBoxes {
    static constexpr std::size_t kWidth = 8;
    float lo[3][kWidth];
    float hi[3][kWidth];

    EightBoxes() {
        for (std::size_t a = 0; a < 3; ++a) {
            std::fill(std::begin(lo[a]), std::end(lo[a]), std::numeric_limits<float>::infinity());
            std::fill(std::begin(hi[a]), std::end(hi[a]), -std::numeric_limits<float>::infinity());
        }
    }
    /// Box i holds `box`, with the margin.
    void set(std::size_t i, const Aabb& box) {
        constexpr float kMost = std::numeric_limits<float>::max();
        for (int a = 0; a < 3; ++a) {
            const auto k = static_cast<std::size_t>(a);
            lo[k][i] = std::nextafter(static_cast<float>(box.lo[a] - kBoxMargin), -kMost);
            hi[k][i] = std::nextafter(static_cast<float>(box.hi[a] + kBoxMargin), kMost);
        }
    }
};

/// The slabs of eight lines side by side; see Slabs, and slabs-inl.hpp.
struct alignas(32) SlabLanes {
    float inverse[3][8], from_first[3][8], from_last[3][8], past[8];
};

/// Slabs in floats, for boxes that are larger than need be by kBoxMargin [KayKajiya86].
class Slabs {
public:
    /// `error`: of a place on the line. What the line has met before `past` along it does not count.
    Slabs(Vec3 origin, Vec3 along, double error,
          double past = -std::numeric_limits<double>::infinity())
        : past_(static_cast<float>(past - 0x1p-20 * (1.0 + std::fabs(past)))) {
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
    [[nodiscard]] unsigned met(const EightBoxes& node) const {
        static_assert(EightBoxes::kWidth == 8);
        return met(node, 0) | met(node, 4) << 4;
    }

private:
    /// Four numbers side by side: what every processor computes at once, written so that the compiler sees it.
    using Four = float __attribute__((vector_size(16)));
    using FourBits = std::int32_t __attribute__((vector_size(16)));

    [[nodiscard]] static Four load(const float* from) {
        Four out;
        std::memcpy(&out, from, sizeof out);
        return out;
    }
    [[nodiscard]] unsigned met(const EightBoxes& node, std::size_t first) const {
        // Boxes without content have their ends the wrong way round, and so have their slabs.
        Four enter{}, exit{};
        for (std::size_t a = 0; a < 3; ++a) {
            const bool forwards = inverse_[a] > 0.0F;
            const Four lo = load(node.lo[a] + first);
            const Four hi = load(node.hi[a] + first);
            const Four near = ((forwards ? lo : hi) - from_first_[a]) * inverse_[a];
            const Four far = ((forwards ? hi : lo) - from_last_[a]) * inverse_[a];
            if (a == 0) {
                enter = near;
                exit = far;
            } else {
                enter = near > enter ? near : enter;
                exit = far < exit ? far : exit;
            }
        }
        const FourBits bits = (enter <= exit) & (exit >= past_) & FourBits{1, 2, 4, 8};
        return static_cast<unsigned>(bits[0] | bits[1] | bits[2] | bits[3]);
    }

    /// The line's place, moved by the margin against the line for the planes that are met first, and on for the last.
    std::array<float, 3> inverse_, from_first_, from_last_;
    float past_;
};

}  // namespace raymo::solids
