// Blends in the plane: a ball rolled against two curves, each a line, a circle or a run.
//
// Two surfaces that share a direction (planes, cylinders along it) or an axis (of revolution) meet in lines along that
// direction or in circles about that axis, and everything about their blend happens in one section: the plane across the
// direction, or the half-plane that the axis bounds. There each surface is a line or a circle, with the same distances as in
// space. The ball of radius r that touches both has its centre where both distances are s r, s = -1 for a ball within the
// solid (a round) and +1 for one outside (a fillet): where a line or circle meets another.
//
// The walls of a contour are there the contour itself, a run (profile.hpp), which has no formula for where it meets another
// curve. The edge is then found between samples of the run, and any point at other distances is followed from the edge:
// both distances grow from 0 step by step, and each step is Newton's method on the two distances, whose gradients are the normals.
#pragma once

#include <optional>

#include "raymo/blends/profile.hpp"
#include "raymo/curves/outline.hpp"
#include "raymo/math/vec2.hpp"

namespace raymo::blends {

/// A line n.p = k, a circle |p - c| = R or a free-form run. The distance is negative where the solid is.
struct SectionCurve {
    bool is_line = true;  ///< or a circle, unless `run` is set
    Vec2 normal;          ///< n, of unit length
    double offset = 0.0;
    Vec2 centre;
    double radius = 0.0;
    double side = 1.0;  ///< -1: the solid is where n.p > k, or beyond the circle
    /// Of a surface that is round across the section (the wall of a cylinder beside its axis): its radius.
    double round = 0.0;
    RunPtr run;  ///< the solid is to its left

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

/// Where two curves meet, at least one of them a run: within its samples and a little beyond its ends.
[[nodiscard]] std::vector<Vec2> run_meetings(const SectionCurve& a, const SectionCurve& b);
/// The point at the distances `from_a` and `from_b` from two curves of which one is a run, followed from `at`, where both are
/// 0. Empty where there is none on the way, as beyond the centre of a bend.
[[nodiscard]] std::optional<Vec2> follow(const SectionCurve& a, double from_a,
                                         const SectionCurve& b, double from_b, Vec2 at);

/// The arc of a conic from a to c, tangent at its ends to the lines to b; `weight` < 1 gives an ellipse, 1 a parabola, > 1 a
/// hyperbola.
[[nodiscard]] curves::Span2 conic_arc(Vec2 a, Vec2 b, Vec2 c, double weight);
/// Appends the shorter arc about `centre` from a to c, both equally far from it, up to half a turn.
void append_arc(curves::Curve& curve, Vec2 centre, Vec2 a, Vec2 c);

}  // namespace raymo::blends
