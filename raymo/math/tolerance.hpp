// The only home of tolerances. Each is a bound that follows from the arithmetic, with its derivation.
#pragma once

namespace raymo {

/// Half the distance from 1 to the next double: the relative error of one correctly rounded operation.
inline constexpr double kUnitRoundoff = 0x1p-53;

/// Input rounding of every number of a transformation: the entries were typed in decimal or computed by the program, so
/// each carries an error of up to 2 roundings (relative; zeros are exact).
inline constexpr double kInputError = 2.0 * kUnitRoundoff;

/// Error of a point on a ray in a leaf's own frame, relative to the row length of the map times the distance from the
/// ray's origin to the leaf's centre: subtraction (1), product of matrix row and vector (3), the same for the direction
/// (3) times the shift along the ray, the shift's own product and sum (2), counted for both factors and doubled for the
/// difference between the max-norm and the Euclidean norm used in the bound.
inline constexpr double kPointError = 24.0 * kUnitRoundoff;

/// A surface crossing is called degenerate when its position along the ray is uncertain by more than this part of the
/// leaf's size: the ray runs in the surface to within rounding. Such a ray is moved aside by kSidestep times its
/// position error e and traced again. A crossing is uncertain by e / sin(angle between ray and surface), so more than
/// 2^-12 of the size means a sine below 2^12 e / size: over the whole leaf, twice its size, the ray departs from the
/// surface by less than 2^13 e, and a step of 2^14 e takes it clear.
inline constexpr double kDegenerate = 0x1p-12;
inline constexpr double kSidestep = 0x1p14;

/// A crossing is blurred when it is known to no better than this, in parts of the scene's size, because the ray glances off its
/// surface: well above what it is known to at a sine of 2^-16, and below what anyone sees. Others within that are told apart a little
/// aside: a step of kBlurredStep position errors e moves the blurred crossing by as many of its own errors, e over the sine, and
/// those of surfaces that are climbed kBlurredClimb times as steeply by less than a quarter of one. The bounds of two kernels for
/// one surface differ by less than kBlurredClimb, so surfaces that coincide are not told apart.
inline constexpr double kBlurred = 0x1p-32;
inline constexpr double kBlurredClimb = 256.0;
inline constexpr double kBlurredStep = 64.0;

}  // namespace raymo
