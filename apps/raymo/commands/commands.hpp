// The commands. Each prints what is wrong and returns the program's exit code.
#pragma once

#include "apps/raymo/session.hpp"

namespace raymo::app {

/// Draws the model and writes the picture to every output.
[[nodiscard]] int run_render(Session& session);
/// Parses and evaluates; errors and warnings are all it prints.
[[nodiscard]] int run_check(Session& session);
/// Spans along the rays on standard input.
[[nodiscard]] int run_rays(Session& session);
/// Where the points on standard input are.
[[nodiscard]] int run_inside(Session& session);
/// What one stage makes of the model, as text.
[[nodiscard]] int run_dump(Session& session);

}  // namespace raymo::app
