// What the language may ask about solids, answered by the tracer: the two are siblings that meet only here.
#pragma once

#include "raymo/core/progress.hpp"
#include "raymo/sml/sml.hpp"

namespace raymo::app {

/// Answers for `hits`, `contains` and `is_empty`. The solids asked about last are kept compiled, so that a loop over one
/// solid compiles it once. `progress` must outlive them.
[[nodiscard]] sml::Answers make_answers(Progress* progress);

}  // namespace raymo::app
