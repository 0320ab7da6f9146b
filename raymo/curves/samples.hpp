// Outlines that the solids made of them are tried on: smooth, cornered, holed, self-crossing and degenerate ones.
#pragma once

#include <span>

#include "raymo/curves/outline.hpp"

namespace raymo::curves {

/// The closed curve of segments through some points.
[[nodiscard]] Curve closed_polygon(std::span<const Vec2> points);
/// A whole circle, in four arcs.
[[nodiscard]] Curve full_circle(Vec2 centre, double radius);
/// The closed uniform cubic B-spline with these control points.
[[nodiscard]] Curve closed_bspline(std::span<const Vec2> points);

[[nodiscard]] OutlinePtr sample_rectangle();
[[nodiscard]] OutlinePtr sample_disc();
/// A disc with a square and a round hole, and an island in one of them.
[[nodiscard]] OutlinePtr sample_washer();
/// A five-pointed star drawn in one go: its middle is outside by the even-odd rule, inside by the non-zero rule.
[[nodiscard]] OutlinePtr sample_pentagram(Fill fill);
/// A rosette of B-splines with corners that are nearly cusps, away from the origin.
[[nodiscard]] OutlinePtr sample_rosette();
/// A cubic that crosses itself, with a cusp, points that coincide, and parts that are nearly straight.
[[nodiscard]] OutlinePtr sample_loop();
/// A half-disc with its straight side on the axis x = 0.
[[nodiscard]] OutlinePtr sample_half_disc();
/// An open profile from the axis to the axis, with corners, level and upright parts, and one that nearly is level.
[[nodiscard]] OutlinePtr sample_goblet();

}  // namespace raymo::curves
