// The solid swept by a ball whose centre r(u) and radius a(u) run along a path: cubics in Bernstein form, span by span.
//
// A point x belongs to it when for some u
//     F(x, u) = |x - r(u)|^2 - a(u)^2 <= 0.
// Canonical frame: the centre of the box in the origin, lengths divided by the power of two that brings half its longest
// side to [1/2, 1). Spans are halved where that makes boxes tighter, and the pieces found by a tree of their boxes; neighbours
// share the ball at their joint bit for bit, so a union of closed pieces has no seams. How a line is met: chords.cpp. A point
// is in, or not, by the signs of F, a sextic of u: membership.cpp. In direction n the solid reaches to the largest
// n.r(u) + |n| a(u), which is where the derivative, a parabola, is zero, or at the end of a span.
//
// Ends. The balls at the ends belong to the sweep: a round cap needs nothing. A flat cap stands where the envelope touches the
// end's ball, in the plane  t.(x - r) = -a q  across the tangent t, q = da/ds by arc length, which exists when |q| < 1. The
// balls that the path passes from its end on until one is beside the plane lose what lies beyond it; other parts of the
// path may cross that plane.
// Faces: 0 side, 1 start, 2 end; closed paths have only a side. Ref: [Wijk84b], [Wijk86 4].
#pragma once

#include <memory>
#include <utility>

#include "raymo/solids/primitive.hpp"
#include "raymo/solids/sweep/swept_spheres.hpp"

namespace raymo::solids {

struct RayBlock;
struct SpanBlock;
struct PlaceBlock;

struct Sweep {
    class Kernel {
    public:
        explicit Kernel(std::shared_ptr<const SweptSpheres> spheres)
            : spheres_(std::move(spheres)) {}
        [[nodiscard]] Aabb bounds(const Affine& map) const;
        void spans(const LocalRay<double>& ray, SpanList& out) const;
        void spans(const RayBlock& rays, std::uint32_t asked, SpanBlock& out) const;
        /// The same for rays that are not plain (kernel.inl); right for all, but slower.
        void spans_in_full(const LocalRay<double>& ray, SpanList& out) const;
        [[nodiscard]] Vec3 normal(Vec3 p, std::uint16_t face) const;
        void normals(PlaceBlock& places, std::uint32_t asked) const;
        [[nodiscard]] Where where(Vec3 p, Vec3 e) const;
        [[nodiscard]] std::span<const std::string_view> faces() const;
        [[nodiscard]] const SweptSpheres& spheres() const { return *spheres_; }
        /// Memory that all copies share.
        [[nodiscard]] double bytes() const { return spheres_->bytes(); }
        friend bool operator==(const Kernel& a, const Kernel& b) {
            return a.spheres_ == b.spheres_ || a.spheres_->equals(*b.spheres_);
        }

    private:
        std::shared_ptr<const SweptSpheres> spheres_;
    };

    [[nodiscard]] static const Schema& schema();
    [[nodiscard]] static Result<Placed<Kernel>> prepare(std::span<const Argument> arguments);
    [[nodiscard]] static std::span<const std::vector<Argument>> examples();
};

}  // namespace raymo::solids
