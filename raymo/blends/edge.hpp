// Where two surfaces meet in a line or a circle, and where along it something else is met.
#pragma once

#include <optional>
#include <vector>

#include "raymo/blends/section.hpp"
#include "raymo/blends/surface.hpp"
#include "raymo/math/affine.hpp"

namespace raymo::blends {

/// A line or a whole circle in which two surfaces meet, with the section in which they are lines, circles and runs
/// (section.hpp).
/// Parameters along it are lengths on a line [mm] and angles on a circle [radians].
struct EdgeCurve {
    bool is_circle = false;
    Vec3 origin;  ///< of the section: any point of the direction, or the centre on the axis
    Vec3 across, up,
        along;  ///< right-handed; the section is (across, up) on a line, (radius, along) of a circle
    SectionCurve a, b;  ///< the two surfaces, by their own inner sides
    Branch branch = Branch::left;
    Vec2 at;  ///< the edge in the section

    /// The image of a point of the section at a parameter.
    [[nodiscard]] Vec3 place(Vec2 p, double t) const;
    /// The image of a direction of the section.
    [[nodiscard]] Vec3 turn(Vec2 v, double t) const;
    /// The point of the section at two distances from a and b, that belongs to this edge.
    [[nodiscard]] std::optional<Vec2> at_distances(double from_a, double from_b) const;
    [[nodiscard]] Vec3 point(double t) const { return place(at, t); }
    /// Unit; the way in which the parameter grows.
    [[nodiscard]] Vec3 tangent(double t) const;
    /// Length along the edge of a parameter's step of 1.
    [[nodiscard]] double speed() const { return is_circle ? at.x : 1.0; }
};

/// How two surfaces meet.
struct Meeting {
    std::vector<EdgeCurve> edges;
    /// They share neither a direction nor an axis, so that they may meet in other curves.
    bool is_general = false;
};
[[nodiscard]] Meeting meeting_of(const Surface& a, const Surface& b);

/// Whether a surface does not change when it is moved along the line, or turned about the circle's axis.
[[nodiscard]] bool runs_along(const EdgeCurve& edge, const Surface& surface);

/// Whether two surfaces are one, but for rounding. Of free-form ones it is not found out.
[[nodiscard]] bool is_one(const Surface& a, const Surface& b);

/// Parameters at which an edge, or any line or circle that runs along with it through `section`, meets a surface: within
/// [lo, hi] on a line, in [0, 2 pi) on a circle. Each of them is found, those where they only touch, too; some more may be.
/// Of free-form surfaces only those that are further apart than 1/256 of the range.
void append_crossings(const EdgeCurve& edge, Vec2 section, const Surface& surface, double lo,
                      double hi, std::vector<double>& out);

}  // namespace raymo::blends
