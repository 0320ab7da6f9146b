// Where a ray meets the wall that a contour of the half-plane (r, z) sweeps about the z axis.
//
// Seen in that half-plane a ray is one branch of a hyperbola. With the ray o + s d, D = d.x^2 + d.y^2, and s_c, z_c, rho the
// place, the height and the distance of its point nearest to the axis,
//     r^2 = rho^2 + D (s - s_c)^2,   z = z_c + d.z (s - s_c).
// A point (x, z) / w of the contour is on it where the sextic
//     F = A^2 + B^2 - C^2 = 0,   C = d.z x,
// with, for a flat ray (d.z^2 <= D),  A = sqrt(D) (z - z_c w),  B = d.z rho w, and for a steep one, where z_c may be far away,
//     (A, B) = d.z (o.x, o.y) w + (z - o.z w) (d.x, d.y).
// F is positive on the axis' side [Wijk86 3.5], and so it is, whatever the rounding of A, where the contour is nearer to the axis
// than the ray. A, B and C are cubics in Bernstein form; they are halved, and F is formed
// of the halves: so F keeps its digits where it is small because A, B and C are.
//
// Where the ray is off by e, (A, B) is off by a = |d.z| (e.x + e.y) + sqrt(D) e.z at most, and F by 2 a |(A, B)| + a^2: next to the
// axis, where |(A, B)| is small, that is little.
//
// Nearly perpendicular to the axis both halves of the hyperbola nearly coincide, and F nearly has double roots: one for each
// half. These are told apart by  g = A -+ sqrt(C^2 - B^2), which is zero on one half each. Where F has one zero in a part, A
// has its half's sign there; and if |A| is lost in rounding, as where a joint is at the height of a ray that is nearly level, at
// that end of the part where F > 0: between the zero and there A^2 > C^2 - B^2, so A can not change its sign where the right
// side is positive. At d.z = 0 the roots of A count
// twice; parallel to the axis (D = 0) the wall is met where x = rho w.
//
// Errors. As for every surface, a ray that is off by e crosses it ds = |n|.e / |n.d| earlier or later, n the wall's normal, as
// long as n hardly turns on the way: it turns with the contour and with the angle about the axis. Otherwise the ray runs in
// the wall as far as is known, and is told to be degenerate. At a corner of the contour, and at a joint, the neighbour's ds
// counts, too; where the neighbour turns back, the ray may meet both or none: a touch.
#pragma once

#include "raymo/curves/region.hpp"
#include "raymo/solids/crossings.hpp"

namespace raymo::solids {

/// A direction that is off an axis or its perpendicular by less than this, seen from the ray's length, is taken to be
/// exactly so: over the solid that is less than a rounding.
inline constexpr double kProfileExact = 0x1p-58;

/// How much the slope may change, as a part of itself, over the range in which a crossing may lie.
inline constexpr double kProfileSteady = 0.25;

class ProfileLine {
public:
    ProfileLine(const curves::Region& region, const LocalRay<double>& ray, Crossings& out);
    /// Adds all crossings of the ray's line.
    void meet_all();

private:
    using Cubic = curves::Bernstein<3>;
    /// A piece of the contour, or a part of one, in the terms of F.
    struct Part {
        Cubic a, b, c;
        double lo, hi;  ///< where in the piece
    };
    enum class Slant : unsigned char { level, flat, steep, upright };

    [[nodiscard]] bool meets(const Box2& box) const;
    void meet(std::uint32_t i);
    void meet_level(std::uint32_t i);
    void meet_upright(std::uint32_t i);
    void meet_slanted(std::uint32_t i);
    /// The two roots, one of each half, of a part in which A changes its sign once; false: it is not certain that there are.
    bool split_halves(std::uint32_t i, const Part& part);
    /// Whether a part, for a flat ray, is nearer to the axis than `share` times rho.
    [[nodiscard]] bool is_within(const Part& part, double share) const;
    /// Which half of the hyperbola the only zero of F in a part is on, +1 or -1; 0: it is not known. F `rises` there or falls.
    [[nodiscard]] int half_of(const Part& part, double u, bool rises) const;
    /// How far in the half-plane of the contour the ray moves, at most, within `way` of s: far less than that where it runs along a
    /// circle.
    [[nodiscard]] double across_section(double s, double way) const;
    /// A crossing at u; `half`: +1 after, -1 before the place nearest to the axis, of flat and level rays.
    void cross_at(std::uint32_t i, double u, int turn, int half);
    void meet_corner(std::uint32_t i);
    /// s of the point of the ray that a point of the contour is on, or next to.
    [[nodiscard]] double place(Vec2 p, int half) const;
    /// The wall's normal at parameter u of a piece, where the ray is at s; `slope` gets n.d and `ds` the error.
    void slope_at(const curves::Piece& piece, double u, double s, double& slope, double& ds) const;

    const curves::Region& region_;
    Vec3 o_, d_, e_;
    double length_;  ///< |d|
    double across_;  ///< sqrt(D)
    double s_c_ = 0.0, z_c_ = 0.0, rho_ = 0.0;
    Slant slant_ = Slant::steep;
    double off_ = 0.0;  ///< how far (A, B) may be off, for w = 1
    Crossings& out_;
};

}  // namespace raymo::solids
