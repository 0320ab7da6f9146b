// Cubics and bicubics that follow a surface.
//
// What counts is that they lie on the surface; where on it their points are does not. A plane cubic whose ends are given has four
// numbers left. Let it meet the curve that it follows in four more places: then it is off by the sixth power of its length,
// u (u - u1) ... (u - u4) (u - 1) times what hardly changes. The places are chosen so that this polynomial is the Chebyshev polynomial
// of degree 6, stretched until its outermost zeros are the ends; then the largest of its five extrema is least. For a circle's arc of
// the angle a that makes 5 10^-6 a^6 of its radius. Cubics that meet given points at given parameters are off by the fourth
// power. A cubic in a curved surface has six numbers, and needs no more conditions; a patch with given borders has twelve,
// for four times four.
//
// The conditions are met in the sense of least squares, and that points stay where they are along the surface, too, but with the
// weight 2^-14: they give way where that helps. That they slide by d counts as the bend of the surface times d^2 / 2, which the
// following steps take into account (Gauss' and Newton's). First and second derivatives of the surface are those of the polynomial through
// its points.
#pragma once

#include "raymo/blends/spine.hpp"
#include "raymo/meshes/sew.hpp"

namespace raymo::blends {

/// Zeros and extrema of the stretched polynomial: (1 +- cos(k pi / 12) / cos(pi / 12)) / 2 for k = 1, 3, 5 and for k = 2, 4, 6.
inline constexpr std::array<double, 6> kPlaces{
    0.0, 0.13397459621556135, 0.36602540378443865, 0.6339745962155614, 0.8660254037844386, 1.0};
inline constexpr std::array<double, 5> kBetween{0.05171226391597322, 0.2411809548974792, 0.5,
                                                0.7588190451025207, 0.9482877360840267};

/// A surface next to one of its points, by two parameters there.
struct LocalSurface {
    Vec3 point;
    Vec3 along, across;             ///< derivatives by the parameters
    Vec3 normal;                    ///< unit
    double uu = 0, uv = 0, vv = 0;  ///< second derivatives, along the normal

    struct Offset {
        double u, v;   ///< parameters from the point
        double level;  ///< the surface's height there, along the normal
        double off;    ///< of the point asked for, above that
    };
    /// Where a point is that is next to it.
    [[nodiscard]] Offset offset(Vec3 p) const;
};

/// How far points may slide along the surface, as part of its length there: what that counts for is known to the third power.
inline constexpr double kSlide = 0x1p-9;

/// Points at all places.
using Places = std::array<Vec3, 6>;
/// Points of a surface: [k][l] is at place k along the first parameter of a net and at place l along the second.
using Grid = std::array<Places, 6>;
using LocalLine = std::array<LocalSurface, 6>;
using LocalGrid = std::array<LocalLine, 6>;

/// A plane curve as a surface upright on its plane, by its points and the plane's normal.
[[nodiscard]] LocalLine local_line(const Places& points, Vec3 upright);
[[nodiscard]] LocalGrid local_grid(const Grid& points);
/// A plane cubic as such a surface.
[[nodiscard]] LocalSurface local_cubic(const Cubic& cubic, Vec3 upright, double u);
[[nodiscard]] LocalSurface local_patch(const meshes::GivenNet& net, double u, double v);

/// The cubic from the first to the last place along a surface.
[[nodiscard]] Cubic cubic_through(const LocalLine& line);

struct Borders {
    Cubic from, to;  ///< at the ends of the first parameter
    Cubic lo, hi;    ///< at the ends of the second
};
/// The patch with these borders along a surface.
[[nodiscard]] meshes::GivenNet patch_through(const Borders& borders, const LocalGrid& grid);

}  // namespace raymo::blends
