// Curves of the plane from the numbers a designer gives.
//
// Errors name what is wrong with the numbers, without the name of the function; `argument` counts the parameters of the
// function here, from 0. All lengths are in millimetres, all angles in degrees. Numbers beyond 1e90 are errors.
#pragma once

#include <span>

#include "raymo/core/result.hpp"
#include "raymo/curves/build_spline.hpp"
#include "raymo/curves/outline.hpp"

namespace raymo::curves {

/// The closed polygon with these corners, at least 3.
[[nodiscard]] Result<Curve> polygon(std::span<const Vec2> corners);
/// The spline of these points; see spline().
[[nodiscard]] Result<Curve> spline_curve(std::span<const Vec2> points, const SplineForm& form);
/// The circle of radius > 0 about the origin: four rational arcs, exact.
[[nodiscard]] Result<Curve> circle(double radius);
/// Width and height > 0, one corner at the origin unless `is_centred`. Corners are rounded by arcs of the given radius, from
/// 0 to half the shorter side.
[[nodiscard]] Result<Curve> rectangle(double width, double height, double corner_radius,
                                      bool is_centred);
/// The regular polygon of `n` corners, 3 to 10^6, on the circle of radius > 0 about the origin; the first lies on +x.
[[nodiscard]] Result<Curve> regular(double n, double radius);
/// The arc about `centre` from angle `from` to angle `to`, counter-clockwise where `to` is greater; at most a full turn,
/// which makes a closed circle.
[[nodiscard]] Result<Curve> arc_curve(double radius, double from, double to, Vec2 centre);
/// The arc from a by way of b to c; it ends at a and c exactly. Error: the three lie on a line.
[[nodiscard]] Result<Curve> arc_through(Vec2 a, Vec2 b, Vec2 c);

/// Open curves end to end. Each may be run through from either end: it is turned so that it begins where the one before it
/// ends. Ends meet when they differ by no more than the rounding of their making, and are made equal then. Where the last
/// ends at the beginning of the first, the chain is closed; `is_closed` closes it by a segment otherwise.
/// Errors: no curve; a closed curve; a gap. `argument` is the number of the curve that is to blame.
[[nodiscard]] Result<Curve> chain(std::span<const Curve> curves, bool is_closed);

}  // namespace raymo::curves
