// The torus about the z axis: all points within r of the circle of radius R in the plane z = 0.
//
// Canonical frame: (q - a)^2 + z^2 <= b^2, q^2 = x^2 + y^2, with a = R / (R + r), b = r / (R + r):
// it just fits the unit ball. With r > R this is the spindle, filled. Along a ray: at most two
// spans; derivation in kernel.inl. Its convex hull is the circle's disc grown by b, so its support
// in direction n is a |(n_x, n_y)| + b |n|. Volume and area by Pappus' rule over the part of the
// circle with q = a + b cos v > 0, |v| <= w: w = pi for a >= b, else cos w = -a / b:
//     V = 2 pi b (a^2 sin w + a b (w + sin w cos w) + b^2 (sin w - sin^3 w / 3)),
//     A = 4 pi b (a w + b sin w).
// Ref: [Wijk86 2.3].
#pragma once

#include "raymo/solids/primitive.hpp"

namespace raymo::solids {

struct Torus {
    class Kernel {
    public:
        Kernel() = default;
        Kernel(double a, double b) : a_(a), b_(b) {}
        [[nodiscard]] Aabb bounds(const Affine& map) const;
        void spans(const LocalRay<double>& ray, SpanList& out) const;
        [[nodiscard]] Vec3 normal(Vec3 p, std::uint16_t face) const;
        [[nodiscard]] Where where(Vec3 p, Vec3 e) const;
        [[nodiscard]] std::span<const std::string_view> faces() const;
        [[nodiscard]] double volume() const;                      ///< V, in the canonical frame.
        [[nodiscard]] double area() const;                        ///< A, in the canonical frame.
        [[nodiscard]] double major_radius() const { return a_; }  ///< a
        [[nodiscard]] double minor_radius() const { return b_; }  ///< b
        friend bool operator==(const Kernel&, const Kernel&) = default;

    private:
        double a_ = 0.5;
        double b_ = 0.5;
    };

    [[nodiscard]] static const Schema& schema();
    [[nodiscard]] static Result<Placed<Kernel>> prepare(std::span<const Argument> arguments);
    [[nodiscard]] static std::span<const std::vector<Argument>> examples();
};

}  // namespace raymo::solids
