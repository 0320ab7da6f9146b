// What the kernels of swept and turned contours stand on, for one ray or several (see math/lanes.hpp). Included once per
// instruction set, after math/triple.inl; needs <limits>, math/tolerance.hpp, solids/crossings.hpp and solids/span.hpp.
#include "raymo/curves/crossings.inl"
#include "raymo/curves/lane_normals.inl"
#include "raymo/curves/walk_lanes.inl"
#include "raymo/solids/interval.inl"
//
#include "raymo/solids/line_crossings.inl"

/// Number of the stretch of the contour that a wall's face (solids/crossings.hpp) belongs to, and which side of it.
template <class R>
struct WallOfFace {
    R run;
    R sign;  ///< 1: the right side, -1: the left
};
template <class R>
RAYMO_INLINE WallOfFace<R> wall_of_face(R face) {
    // Whole numbers: wall / 2 is off by 1/2 where the wall is odd.
    const R half = (face - R(static_cast<double>(solids::kFirstWall))) * R(0.5);
    const R run = (half + R(0x1p52)) - R(0x1p52);
    const auto odd = lane_abs(half - run) > R(0.25);
    const R down = lane_select(run > half, run - R(1.0), run);
    return {lane_select(odd, down, run), lane_select(odd, R(-1.0), R(1.0))};
}
