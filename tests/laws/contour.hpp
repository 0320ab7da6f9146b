// Random contours, and a judge of their points that knows control points only: it halves curves until they are clear of the
// question, in extended precision.
#pragma once

#include "raymo/curves/outline.hpp"
#include "tests/laws/model.hpp"
#include "tests/laws/rays.hpp"

namespace raymo::laws {

/// Circles, polygons and splines within about 5 of the origin, some with holes, some that cross themselves; `beside_axis`:
/// with x >= 0, some touching the line x = 0.
[[nodiscard]] curves::OutlinePtr random_outline(Random& random, bool beside_axis);

/// Where (x, y) is, when it is further than `margin` from the curves. These must be closed; or, `beside_axis`, where x >= 0 and
/// what they have on the line x = 0 bounds nothing, begin and end there: then that line closes them.
[[nodiscard]] Side classify(const curves::Outline& outline, Real x, Real y, Real margin,
                            bool beside_axis);

}  // namespace raymo::laws
