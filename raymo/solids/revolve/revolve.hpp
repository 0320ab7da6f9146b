// A contour turned about the z axis: all points whose radius and height, (sqrt(x^2 + y^2), z), lie in the contour; by less
// than a whole turn, also only those whose angle about the axis lies between 0 (the x axis) and the angle given.
//
// Canonical frame: the middle height at z = 0, scaled by a power of two so that radii and heights are at most 1. How a ray
// meets the wall is told in profile_line.hpp. The cuts of a partial turn are two half-planes that end in the axis: up to half
// a turn the solid is on the inner side of both, beyond it is not on the outer side of both.
// Faces: 0 the cut at angle 0, 1 the cut at the end, then the walls (solids/crossings.hpp). Ref: [Wijk86 3.5].
#pragma once

#include "raymo/curves/region.hpp"
#include "raymo/math/vec2.hpp"
#include "raymo/solids/primitive.hpp"

namespace raymo::solids {

struct RayBlock;
struct SpanBlock;
struct PlaceBlock;

struct Revolve {
    class Kernel {
    public:
        Kernel() = default;
        /// `angle`: 0 < angle <= 360 [degrees].
        Kernel(curves::RegionPtr region, double angle);
        [[nodiscard]] Aabb bounds(const Affine& map) const;
        void spans(const LocalRay<double>& ray, SpanList& out) const;
        void spans(const RayBlock& rays, std::uint32_t asked, SpanBlock& out) const;
        /// The same for rays that are not plain (kernel.inl); right for all, but slower.
        void spans_in_full(const LocalRay<double>& ray, SpanList& out) const;
        [[nodiscard]] Vec3 normal(Vec3 p, std::uint16_t face) const;
        void normals(PlaceBlock& places, std::uint32_t asked) const;
        /// The same for points that are not on the wall that `face` tells, or where it has no tangent.
        [[nodiscard]] Vec3 normal_in_full(Vec3 p, std::uint16_t face) const;
        [[nodiscard]] Where where(Vec3 p, Vec3 e) const;
        [[nodiscard]] std::span<const std::string_view> faces() const;
        [[nodiscard]] const curves::Region& region() const { return *region_; }
        [[nodiscard]] double bytes() const { return region_->bytes(); }
        [[nodiscard]] double angle() const { return angle_; }
        /// Of the cut where the turn ends, outwards.
        [[nodiscard]] Vec3 end_normal() const { return {end_.x, end_.y, 0.0}; }

        friend bool operator==(const Kernel& a, const Kernel& b) {
            return a.angle_ == b.angle_ && (a.region_ == b.region_ || *a.region_ == *b.region_);
        }

    private:
        [[nodiscard]] bool is_whole() const { return angle_ >= 360.0; }

        curves::RegionPtr region_;
        double angle_ = 360.0;
        Vec2 end_;  ///< normal of the cut where the turn ends, outwards
    };

    [[nodiscard]] static const Schema& schema();
    [[nodiscard]] static Result<Placed<Kernel>> prepare(std::span<const Argument> arguments);
    [[nodiscard]] static std::span<const std::vector<Argument>> examples();
};

}  // namespace raymo::solids
