// The right circular cone or cone frustum about the z axis.
//
// Canonical frame: -1 <= z <= 1, with radius 1 at z = -1 and k at z = 1, 0 <= k <= 1: the wider end
// is always below, and a cone that widens upwards is turned over by the map that places it. Along a
// ray: a quadratic for the side, of which one nappe counts, and a slab for the caps; derivation in
// kernel.inl. It is the convex hull of its two end discs, so its support in direction n is
//     max(-n_z + |(n_x, n_y)|, n_z + k |(n_x, n_y)|).
// Faces: 0 side, 1 the wider end (z = -1), 2 the narrower (z = 1). Ref: [Wijk86 2.3].
#pragma once

#include "raymo/solids/primitive.hpp"

namespace raymo::solids {

struct Cone {
    class Kernel {
    public:
        Kernel() = default;
        Kernel(double ratio, bool turned) : ratio_(ratio), turned_(turned) {}
        [[nodiscard]] Aabb bounds(const Affine& map) const;
        void spans(const LocalRay<double>& ray, SpanList& out) const;
        [[nodiscard]] Vec3 normal(Vec3 p, std::uint16_t face) const;
        [[nodiscard]] Where where(Vec3 p, Vec3 e) const;
        [[nodiscard]] std::span<const std::string_view> faces() const;
        [[nodiscard]] double volume() const;  ///< 2 pi (1 + k + k^2) / 3, in the canonical frame.
        [[nodiscard]] double area()
            const;  ///< pi (1 + k) sqrt((1 - k)^2 + 4) + pi (1 + k^2), in the canonical frame.
        /// k, the smaller radius divided by the larger.
        [[nodiscard]] double ratio() const { return ratio_; }
        friend bool operator==(const Kernel&, const Kernel&) = default;

    private:
        double ratio_ = 0.0;
        bool turned_ = false;  ///< the user's bottom is our top
    };

    [[nodiscard]] static const Schema& schema();
    [[nodiscard]] static Result<Placed<Kernel>> prepare(std::span<const Argument> arguments);
    [[nodiscard]] static std::span<const std::vector<Argument>> examples();
};

}  // namespace raymo::solids
