// Blends in the plane: a ball rolled against two curves, each a line or a circle.
//
// Two surfaces that share a direction (planes, cylinders along it) or an axis (of revolution) meet in lines along that
// direction or in circles about that axis, and everything about their blend happens in one section: the plane across the
// direction, or the half-plane that the axis bounds. There each surface is a line or a circle, with the same distances as in
// space. The ball of radius r that touches both has its centre where both distances are s r, s = -1 for a ball within the
// solid (a round) and +1 for one outside (a fillet): where a line or circle meets another.
#pragma once

#include <optional>

#include "raymo/curves/outline.hpp"
#include "raymo/math/vec2.hpp"

namespace raymo::blends {

/// A line n.p = k or a circle |p - c| = R. The distance is negative where the solid is.
struct SectionCurve {
    bool is_line = true;
    Vec2 normal;  ///< n, of unit length
    double offset = 0.0;
    Vec2 centre;
    double radius = 0.0;
    double side = 1.0;  ///< -1: the solid is where n.p > k, or beyond the circle
    /// Of a surface that is round across the section (the wall of a cylinder beside its axis): its radius.
    double round = 0.0;

    [[nodiscard]] double distance(Vec2 p) const;
    /// Unit; where the distance grows.
    [[nodiscard]] Vec2 outward(Vec2 p) const;
};

/// Which of the (up to) two common points of two curves: along a line to its one or other side of a circle's centre, and of
/// two circles to the one or other side of the line through their centres.
enum class Branch : std::uint8_t { left, right };

/// The point at the distances `from_a` and `from_b` from the curves. The branch varies continuously with both. Empty where there is
/// none, as when a circle has shrunk to nothing.
[[nodiscard]] std::optional<Vec2> meet(const SectionCurve& a, double from_a, const SectionCurve& b,
                                       double from_b, Branch branch);

/// The arc of a conic from a to c, tangent at its ends to the lines to b; `weight` < 1 gives an ellipse, 1 a parabola, > 1 a
/// hyperbola.
[[nodiscard]] curves::Span2 conic_arc(Vec2 a, Vec2 b, Vec2 c, double weight);
/// Appends the shorter arc about `centre` from a to c, both equally far from it, up to half a turn.
void append_arc(curves::Curve& curve, Vec2 centre, Vec2 a, Vec2 c);

}  // namespace raymo::blends
