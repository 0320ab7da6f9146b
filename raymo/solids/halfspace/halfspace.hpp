// All points on one side of a plane: n.x <= offset.
//
// Canonical frame: z <= 0. The map that places it is a rotation that takes z to n / |n|, so that it
// has no scale of its own; it is exact for normals along an axis. Along a ray: one span that
// reaches to infinity; derivation in kernel.inl. Its box is infinite, except under maps that keep
// the plane perpendicular to an axis. Ref: [Wijk86 2.3].
#pragma once

#include "raymo/solids/primitive.hpp"

namespace raymo::solids {

struct Halfspace {
    class Kernel {
    public:
        [[nodiscard]] Aabb bounds(const Affine& map) const;
        void spans(const LocalRay<double>& ray, SpanList& out) const;
        [[nodiscard]] Vec3 normal(Vec3 p, std::uint16_t face) const;
        [[nodiscard]] Where where(Vec3 p, Vec3 e) const;
        [[nodiscard]] std::span<const std::string_view> faces() const;
        friend bool operator==(const Kernel&, const Kernel&) = default;
    };

    [[nodiscard]] static const Schema& schema();
    [[nodiscard]] static Result<Placed<Kernel>> prepare(std::span<const Argument> arguments);
    [[nodiscard]] static std::span<const std::vector<Argument>> examples();
};

}  // namespace raymo::solids
