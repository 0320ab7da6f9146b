// From the crossings of a line to spans; derivation in spans.cpp.
#pragma once

#include "raymo/solids/freeform/search.hpp"
#include "raymo/solids/span.hpp"

namespace raymo::solids {

/// A ray as a line, with the error of the ray and of the arithmetic.
[[nodiscard]] FreeformLine line_of(const LocalRay<double>& ray);

/// Appends the spans between crossings that leave no doubt. False: they do not close, and nothing is appended.
[[nodiscard]] bool tell_certain(const FreeformFound& found, const LocalRay<double>& ray,
                                SpanList& out);

}  // namespace raymo::solids
