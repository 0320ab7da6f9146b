// A region swept along a line, keeping its size (a prism) or shrinking towards a point (a conic sweep).
//
// Canonical frame: |z| <= 1; the section at height z is the region times q(z) = m - g z, with m = (1 + k) / 2 and
// g = (1 - k) / 2: as it is at z = -1, and k times as large at z = 1, 0 <= k <= 1. k = 1 is the prism, k = 0 runs to a
// point.
//
// Spans. In the space of (x, y, q) the walls are a cone over the contour with its tip at the origin, for any k. There the
// ray is A + s B, with A = (o.x, o.y, m - g o.z) and B = (d.x, d.y, -g d.z), and the plane through it and the tip has the
// normal N = A x B. A point P = (x, y, w) of the contour is in that plane where
//     f(u) = N.P(u) = 0,
// a cubic of its parameter in Bernstein form [Wijk86 3.2]; its wall is met where A + s B is a multiple of P:
//     s = -((A x P).(B x P)) / |B x P|^2,
// and counts where the multiple is positive. Seen along the ray, the contour crosses from one side of it to the other; the
// winding number so far says whether the ray is inside. The part of the ray with q > 0 begins, or ends, at q = 0, where it
// is infinitely far from every contour; for a prism it is the whole line.
//
// Errors. A ray that is off by a = (e.x, e.y, g e.z) at the wall makes an error of |f| <= a.|B x P|: it is moved there from
// the wall's own tangent plane, with the normal T = P' x P, so that it crosses the wall
//     ds = a.|T| / |B.T|
// earlier or later. That holds as long as the contour is straight over the range of u in question, f'^2 >= 8 |f''| a.|B x P|,
// and does not reach beyond a corner; beyond corners the neighbour's ds counts, too. Otherwise the range is found by
// following the contour to where |f| exceeds its error. Rounding counts as part of e; but next to the tip and along a prism,
// where A and B are nearly parallel, N would lose digits that no e accounts for, so its components are computed exactly.
// A ray that runs (nearly) through the tip, or along a prism, stays at one point of the section: the contour is asked about
// that point instead. Ref: [Wijk86 3.2 to 3.4].
#pragma once

#include "raymo/curves/region.hpp"
#include "raymo/solids/primitive.hpp"

namespace raymo::solids {

struct RayBlock;
struct SpanBlock;
struct PlaceBlock;

class ContourSweep {
public:
    ContourSweep() = default;
    /// `ratio`: k. `flipped`: the user's bottom is our top.
    ContourSweep(curves::RegionPtr region, double ratio, bool flipped)
        : region_(std::move(region)), ratio_(ratio), flipped_(flipped) {}

    [[nodiscard]] Aabb bounds(const Affine& map) const;
    void spans(const LocalRay<double>& ray, SpanList& out) const;
    void spans(const RayBlock& rays, std::uint32_t asked, SpanBlock& out) const;
    /// The same for rays that are not plain (contour_sweep.inl); right for all, but slower.
    void spans_in_full(const LocalRay<double>& ray, SpanList& out) const;
    [[nodiscard]] Vec3 normal(Vec3 p, std::uint16_t face) const;
    void normals(PlaceBlock& places, std::uint32_t asked) const;
    /// The same for points that are not on the wall that `face` tells, or where it has no tangent.
    [[nodiscard]] Vec3 normal_in_full(Vec3 p, std::uint16_t face) const;
    [[nodiscard]] Where where(Vec3 p, Vec3 e) const;
    [[nodiscard]] std::span<const std::string_view> faces() const;
    [[nodiscard]] const curves::Region& region() const { return *region_; }
    [[nodiscard]] double bytes() const { return region_->bytes(); }
    [[nodiscard]] double ratio() const { return ratio_; }
    friend bool operator==(const ContourSweep& a, const ContourSweep& b) {
        return a.ratio_ == b.ratio_ && a.flipped_ == b.flipped_ &&
               (a.region_ == b.region_ || *a.region_ == *b.region_);
    }

private:
    [[nodiscard]] double shrink() const { return 0.5 * (1.0 - ratio_); }
    [[nodiscard]] double middle() const { return 0.5 * (1.0 + ratio_); }

    curves::RegionPtr region_;
    double ratio_ = 1.0;
    bool flipped_ = false;
};

/// The region of an outline in the frame of a sweep, and the map from there to where the outline was drawn.
struct FramedRegion {
    curves::RegionPtr region;
    Vec2 centre;
    double size = 1.0;  ///< a power of two
};
/// `centred`: the middle of its box comes to the origin; otherwise the origin stays, for conic sweeps, which shrink towards it.
[[nodiscard]] Result<FramedRegion> frame_region(const curves::Outline& outline, bool centred);

}  // namespace raymo::solids
