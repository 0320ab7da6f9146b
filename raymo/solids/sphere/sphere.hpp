// The ball of radius r about the origin.
//
// Canonical frame: the unit sphere  |x|^2 <= 1. Polynomial along a ray: degree 2; derivation in
// kernel.inl. Under a map L its box reaches |row i of L| from the centre, since the support of the
// unit ball in direction n is |n|. Ref: [Wijk86 2.3].
#pragma once

#include "raymo/solids/primitive.hpp"

namespace raymo::solids {

struct Sphere {
    class Kernel {
    public:
        [[nodiscard]] Aabb bounds(const Affine& map) const;
        void spans(const LocalRay<double>& ray, SpanList& out) const;
        [[nodiscard]] Vec3 normal(Vec3 p, std::uint16_t) const { return p; }
        [[nodiscard]] Where where(Vec3 p, Vec3 e) const;
        [[nodiscard]] std::span<const std::string_view> faces() const;
        [[nodiscard]] double volume() const;  ///< 4 pi / 3, in the canonical frame.
        friend bool operator==(const Kernel&, const Kernel&) = default;
    };

    [[nodiscard]] static const Schema& schema();
    [[nodiscard]] static Result<Placed<Kernel>> prepare(std::span<const Argument> arguments);
    [[nodiscard]] static std::span<const std::vector<Argument>> examples();
};

}  // namespace raymo::solids
