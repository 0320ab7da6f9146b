// Boxes with faces along the axes.
#pragma once

#include <limits>

#include "raymo/math/vec.hpp"

namespace raymo {

/// All points p with lo <= p <= hi. Default: empty (lo > hi). Sides may be infinite.
struct Aabb {
    static constexpr double kInf = std::numeric_limits<double>::infinity();

    Vec3 lo{kInf, kInf, kInf};
    Vec3 hi{-kInf, -kInf, -kInf};

    [[nodiscard]] static constexpr Aabb everything() {
        return {{-kInf, -kInf, -kInf}, {kInf, kInf, kInf}};
    }
    [[nodiscard]] constexpr bool empty() const {
        return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z);
    }
    [[nodiscard]] bool bounded() const { return empty() || (is_finite(lo) && is_finite(hi)); }
    [[nodiscard]] constexpr Vec3 size() const { return hi - lo; }
    [[nodiscard]] constexpr Vec3 centre() const { return lo + (hi - lo) * 0.5; }
    [[nodiscard]] constexpr bool contains(Vec3 p) const {
        return lo.x <= p.x && p.x <= hi.x && lo.y <= p.y && p.y <= hi.y && lo.z <= p.z &&
               p.z <= hi.z;
    }
    constexpr void include(Vec3 p) {
        lo = min(lo, p);
        hi = max(hi, p);
    }
    friend constexpr bool operator==(const Aabb&, const Aabb&) = default;
};

/// Smallest box around both.
constexpr Aabb hull(const Aabb& a, const Aabb& b) { return {min(a.lo, b.lo), max(a.hi, b.hi)}; }
/// What both share; may be empty.
constexpr Aabb overlap(const Aabb& a, const Aabb& b) { return {max(a.lo, b.lo), min(a.hi, b.hi)}; }
/// The box grown by `margin` on each side.
constexpr Aabb grown(const Aabb& a, double margin) {
    const Vec3 m{margin, margin, margin};
    return {a.lo - m, a.hi + m};
}

}  // namespace raymo
