// Vectors of two doubles, for what lies in a plane.
#pragma once

#include <algorithm>
#include <cmath>

#include "raymo/math/aabb.hpp"

namespace raymo {

struct Vec2 {
    double x = 0.0;
    double y = 0.0;

    constexpr Vec2& operator+=(Vec2 b) { return *this = {x + b.x, y + b.y}; }
    friend constexpr bool operator==(const Vec2&, const Vec2&) = default;
};

constexpr Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
constexpr Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
constexpr Vec2 operator-(Vec2 a) { return {-a.x, -a.y}; }
constexpr Vec2 operator*(Vec2 a, double s) { return {a.x * s, a.y * s}; }
constexpr Vec2 operator*(double s, Vec2 a) { return a * s; }
constexpr double dot(Vec2 a, Vec2 b) { return a.x * b.x + a.y * b.y; }
/// The third component of the cross product: positive where b lies to the left of a.
constexpr double cross(Vec2 a, Vec2 b) { return a.x * b.y - a.y * b.x; }
/// Largest absolute component.
inline double max_norm(Vec2 a) { return std::max(std::fabs(a.x), std::fabs(a.y)); }
inline double norm(Vec2 a) { return std::hypot(a.x, a.y); }
inline bool is_finite(Vec2 a) { return std::isfinite(a.x) && std::isfinite(a.y); }

/// All points p with lo <= p <= hi. Default: empty.
struct Box2 {
    Vec2 lo{Aabb::kInf, Aabb::kInf};
    Vec2 hi{-Aabb::kInf, -Aabb::kInf};

    [[nodiscard]] constexpr bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y); }
    [[nodiscard]] constexpr Vec2 size() const { return hi - lo; }
    [[nodiscard]] constexpr Vec2 centre() const { return lo + (hi - lo) * 0.5; }
    constexpr void include(Vec2 p) {
        lo = {std::min(lo.x, p.x), std::min(lo.y, p.y)};
        hi = {std::max(hi.x, p.x), std::max(hi.y, p.y)};
    }
    constexpr void include(const Box2& b) {
        include(b.lo);
        include(b.hi);
    }
    friend constexpr bool operator==(const Box2&, const Box2&) = default;
};

/// An affine map of the plane,  p -> (xx p.x + xy p.y + x, yx p.x + yy p.y + y).
struct Affine2 {
    double xx = 1.0, xy = 0.0, x = 0.0;
    double yx = 0.0, yy = 1.0, y = 0.0;

    [[nodiscard]] constexpr Vec2 operator()(Vec2 p) const {
        return {xx * p.x + xy * p.y + x, yx * p.x + yy * p.y + y};
    }
    [[nodiscard]] constexpr double determinant() const { return xx * yy - xy * yx; }
    friend constexpr bool operator==(const Affine2&, const Affine2&) = default;
};

}  // namespace raymo
