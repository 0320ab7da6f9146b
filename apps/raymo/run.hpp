// The whole program as a function.
#pragma once

#include "apps/raymo/options.hpp"
#include "apps/raymo/system/console.hpp"

namespace raymo::app {

/// `args` without the program's name. Returns the exit code (exit_code.hpp); nothing is thrown but std::bad_alloc.
[[nodiscard]] int run(const Args& args, Console& console);

}  // namespace raymo::app
