// Splines through or along given points, in any number of dimensions, as chains of cubics in Bernstein form.
//
// All kinds are cubics of one parameter per span, evenly spaced:
//
//     linear       segments from point to point
//     bspline      uniform B-splines of degree 1 to 3 [Wijk86 3.2]; span i of degree 3 has the control points
//                  (p0 + 4 p1 + p2) / 6,  (2 p1 + p2) / 3,  (p1 + 2 p2) / 3,  (p1 + 4 p2 + p3) / 6
//     bezier       spans of degree 1 to 3 that share their end points
//     catmull      through the points; the derivative at each is half the difference of its neighbours
//     interpolate  through the points with a continuous second derivative: the cubic spline
//
// Lower degrees are raised to cubics. Neighbouring spans share their end points bit for bit.
// Ref: [Farin02 8] (B-splines, blossoms), [Farin02 9] (interpolation).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "raymo/core/result.hpp"

namespace raymo::curves {

/// A point of D coordinates: (x, y) of a contour, (x, y, z, radius) of a path.
template <std::size_t D>
using Point = std::array<double, D>;
/// The control points of one cubic.
template <std::size_t D>
using SplineSpan = std::array<Point<D>, 4>;

template <std::size_t D>
struct Spline {
    std::vector<SplineSpan<D>> spans;  ///< never empty
    bool closed = false;               ///< ends exactly where it begins
};

enum class SplineKind : std::uint8_t { linear, bspline, bezier, catmull, interpolate };

struct SplineForm {
    SplineKind kind = SplineKind::bspline;
    int degree = 3;        ///< 1 to 3, of bspline and bezier
    bool closed = false;   ///< goes back to its first point
    bool clamped = false;  ///< an open bspline that begins and ends at its end points
};

/// Coordinates beyond this are an error: squares and cubes of what is made of them must stay finite.
inline constexpr double kLargestCoordinate = 1e90;

/// The spline of these points. A curve that ends exactly where it begins counts as closed, too; a closed one of a kind that
/// runs through its points may give the first point once more at its end. Repeated points are allowed elsewhere.
/// Errors, with `argument` 0 for the points and 1 for the degree: a degree that is not 1, 2 or 3; fewer points than the
/// degree needs; a number of points that does not fit the spans of `bezier`; points that all lie at one place (the first
/// three coordinates count); numbers that are not finite or beyond 1e90.
/// Cost: O(n) time and memory. Defined for D = 2 and 4.
template <std::size_t D>
[[nodiscard]] Result<Spline<D>> spline(std::span<const Point<D>> points, const SplineForm& form);

}  // namespace raymo::curves
