// The right circular cylinder about the z axis.
//
// Canonical frame: x^2 + y^2 <= 1, -1 <= z <= 1. Along a ray: a quadratic for the side, a slab for
// the caps; derivation in kernel.inl. Its support in direction n is |(n_x, n_y)| + |n_z|, which
// gives its box under any map. Faces: 0 side, 1 bottom (z = -1), 2 top (z = 1). Ref: [Wijk86 2.3].
#pragma once

#include "raymo/solids/primitive.hpp"

namespace raymo::solids {

struct Cylinder {
    class Kernel {
    public:
        [[nodiscard]] Aabb bounds(const Affine& map) const;
        void spans(const LocalRay<double>& ray, SpanList& out) const;
        [[nodiscard]] Vec3 normal(Vec3 p, std::uint16_t face) const;
        [[nodiscard]] Where where(Vec3 p, Vec3 e) const;
        [[nodiscard]] std::span<const std::string_view> faces() const;
        [[nodiscard]] double volume() const;  ///< 2 pi, in the canonical frame.
        [[nodiscard]] double area() const;    ///< 6 pi, in the canonical frame.
        friend bool operator==(const Kernel&, const Kernel&) = default;
    };

    [[nodiscard]] static const Schema& schema();
    [[nodiscard]] static Result<Placed<Kernel>> prepare(std::span<const Argument> arguments);
    [[nodiscard]] static std::span<const std::vector<Argument>> examples();
};

}  // namespace raymo::solids
