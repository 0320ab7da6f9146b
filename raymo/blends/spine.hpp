// The path of a ball's centre along an edge in space, followed exactly.
//
// Let n_a and n_b be the outward normals at the centre c. The path runs along T ~ n_a x n_b, and the contacts c - s r n lie in the plane
// across it. When c moves on by ds, a point c + v that is kept in that plane moves by (1 - K.v) ds along the path, where K = dT/ds
// is the path's curvature vector: where this is positive for all v of a section, neighbouring sections do not cross.
//
// Between two places the path is a cubic that has its tangents and curvatures there: a planar curve is met to the sixth
// order [deBoor87], where cubics through places alone meet it to the fourth.
#pragma once

#include <array>
#include <optional>

#include "raymo/blends/wedge.hpp"

namespace raymo::blends {

/// Control points of a cubic in Bernstein form.
using Cubic = std::array<Vec3, 4>;
[[nodiscard]] Vec3 value_at(const Cubic& cubic, double u);
/// A third of its derivative.
[[nodiscard]] Vec3 slope_at(const Cubic& cubic, double u);
/// How far from the ends p and q of an arc with these unit tangents the inner control points are, so that of a circle the cubic
/// is off by less than 2^-15 of the radius for every right angle.
[[nodiscard]] double round_handle(Vec3 p, Vec3 from, Vec3 q, Vec3 to);

/// The ball at one place of its path.
struct Station {
    double t = 0.0;  ///< parameter of the edge
    Vec3 centre;
    Vec3 tangent;     ///< T: unit, the way in which t grows
    Vec3 bend;        ///< K [1 / mm]
    Vec3 contact[2];  ///< where it touches face a and face b
    Vec3 way[2];      ///< the contacts' derivatives by the length of the path

    /// How fast a point in the plane across the path moves along it, in parts of the centre's speed.
    [[nodiscard]] double speed_of(Vec3 p) const { return 1.0 - dot(bend, p - centre); }
};

class Spine {
public:
    Spine(const Body& body, const Segment& segment, double radius);

    [[nodiscard]] double radius() const { return radius_; }
    [[nodiscard]] const Segment& segment() const { return segment_; }
    [[nodiscard]] const Surface& surface(std::size_t which) const { return which == 0 ? a_ : b_; }
    [[nodiscard]] double side(std::size_t which) const {
        return which == 0 ? segment_.edge.a.side : segment_.edge.b.side;
    }
    /// Whether from parameter lo to hi it runs back into itself.
    [[nodiscard]] bool is_ring(double lo, double hi) const {
        return segment_.is_closed && lo == segment_.lo && hi == segment_.hi;
    }
    /// The ball that belongs to a parameter. Empty where there is none, or its path does not run along the edge.
    [[nodiscard]] std::optional<Station> at(double t) const;
    /// The ball of the path next to `centre`, between two others.
    [[nodiscard]] std::optional<Station> between(const Station& from, const Station& to,
                                                 Vec3 centre) const;
    /// The point of the path next to another, in the plane across a direction.
    [[nodiscard]] std::optional<Vec3> beside(Vec3 p, Vec3 across) const;
    /// How far a point is from the path, when it is near it.
    [[nodiscard]] double off(Vec3 centre) const;
    /// The least that such distances can tell.
    [[nodiscard]] double rounding() const { return rounding_; }

private:
    /// Sets all but t and the centre; `sense`: the way in which t grows, roughly.
    [[nodiscard]] bool complete(Station& station, Vec3 sense) const;
    [[nodiscard]] Vec3 outward(std::size_t which, Vec3 p) const {
        return surface(which).normal(p) * side(which);
    }

    const Body& body_;
    const Segment& segment_;
    const Surface& a_;
    const Surface& b_;
    double radius_;
    double rounding_;
};

/// The path between two places, by its tangents and curvatures there.
[[nodiscard]] Cubic path_between(const Station& from, const Station& to);

/// Places of the path from parameter lo to hi, or all round (where the last is the first), as coarse as is asked for at first; in order.
/// Empty when one of them is lost.
[[nodiscard]] std::vector<Station> coarse_stations(const Spine& spine, double lo, double hi);

}  // namespace raymo::blends
