// Threads for the layers below, which know none.
#pragma once

#include <memory>

#include "raymo/core/executor.hpp"

namespace raymo::app {

/// Processors that this process may use, at least 1.
[[nodiscard]] int available_processors();

/// Spreads tasks over that many threads, in order of their index; with one, runs them in the
/// caller's and starts nothing.
[[nodiscard]] std::unique_ptr<Executor> make_executor(int threads);

}  // namespace raymo::app
