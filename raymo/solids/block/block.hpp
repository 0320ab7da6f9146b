// The block with edges along the axes.
//
// Canonical frame: the cube [-1, 1]^3. Along a ray: three pairs of parallel planes; derivation in
// solids/interval.inl. Under a map L its box reaches |L_i1| + |L_i2| + |L_i3| from the centre, the
// support of the cube in direction L_i. Ref: [Wijk86 2.3], [KayKajiya86].
#pragma once

#include "raymo/solids/primitive.hpp"

namespace raymo::solids {

struct Block {
    class Kernel {
    public:
        [[nodiscard]] Aabb bounds(const Affine& map) const;
        void spans(const LocalRay<double>& ray, SpanList& out) const;
        [[nodiscard]] Vec3 normal(Vec3 p, std::uint16_t face) const;
        [[nodiscard]] Where where(Vec3 p, Vec3 e) const;
        [[nodiscard]] std::span<const std::string_view> faces() const;
        [[nodiscard]] double volume() const;  ///< 8, in the canonical frame.
        [[nodiscard]] double area() const;    ///< 24, in the canonical frame.
        friend bool operator==(const Kernel&, const Kernel&) = default;
    };

    [[nodiscard]] static const Schema& schema();
    [[nodiscard]] static Result<Placed<Kernel>> prepare(std::span<const Argument> arguments);
    [[nodiscard]] static std::span<const std::vector<Argument>> examples();
};

}  // namespace raymo::solids
