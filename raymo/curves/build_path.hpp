// Paths of spheres from the numbers a designer gives.
//
// Place and radius are one spline in four dimensions [Wijk86 4.4]. Splines that stay within the hull of their control points
// keep a radius that is nowhere negative; one that runs through its points may fall below 0 between them, and is 0 there:
// the span is cut where its radius is 0.
// Errors as in build_contour.hpp; numbers beyond 1e90 are errors.
#pragma once

#include <functional>
#include <span>

#include "raymo/core/result.hpp"
#include "raymo/curves/build_spline.hpp"
#include "raymo/curves/path.hpp"
#include "raymo/math/affine.hpp"

namespace raymo::curves {

/// More spans than this are an error.
inline constexpr double kMostPathSpans = 1e6;

struct BuiltPath {
    Path path;
    bool is_clamped = false;  ///< the spline's radius fell below 0 somewhere
};

/// The spline of these points (x, y, z, radius); see spline(). Every radius must be at least 0, and one greater.
[[nodiscard]] Result<BuiltPath> spline_path(std::span<const Point<4>> points,
                                            const SplineForm& form);

/// The path of these cubics, each of which begins where the one before it ends; radii below 0 are raised to 0. Not empty.
[[nodiscard]] BuiltPath path_of(std::span<const SplineSpan<4>> spans);

/// The right-handed helix about the z axis that begins at (radius, 0, 0) and climbs by `pitch` each turn, of a wire of the
/// given diameter. radius, turns, thickness > 0; a negative pitch goes down, left-handed; 0 is an error.
/// 36 cubics a turn: they are tangent to the helix at their joints, and nowhere further from it than 1.1e-9 of the radius
/// in the plane and 3e-9 of the pitch along the axis.
[[nodiscard]] Result<Path> helix(double radius, double pitch, double turns, double thickness);

/// A function from a parameter to (x, y, z, radius).
using PathFunction = std::function<Result<Point<4>>(double)>;

/// Cubics, with derivatives that agree at the joints, that stay within `tolerance` [mm] > 0 of f on [low, high] in place and
/// in radius, as seen at nine parameters of each; the interval is halved until they do. low < high.
/// Errors: those of f; a negative radius; a place where f jumps, or where the tolerance is below the rounding of f; more than
/// 10^5 spans. `argument` 0: the function, 1: the interval, 2: the tolerance.
/// Cost: about 15 values of f for each span and its halvings.
[[nodiscard]] Result<BuiltPath> fit_path(const PathFunction& f, double low, double high,
                                         double tolerance);

/// The image under a map that keeps angles and multiplies lengths by `factor` > 0.
[[nodiscard]] Path mapped(const Path& path, const Affine& map, double factor);

/// Largest coordinate or radius of its control points; infinite when one is not a number.
[[nodiscard]] double extent_of(const Path& path);

/// Bytes of a path.
[[nodiscard]] double bytes_of(const Path& path);

}  // namespace raymo::curves
