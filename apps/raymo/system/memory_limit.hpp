// A bound on the memory of the whole process, so that a model too large ends with a message and not
// with a dead machine.
#pragma once

#include <cstddef>

namespace raymo::app {

/// 4 GiB, or four fifths of the machine's memory where that is less [bytes].
[[nodiscard]] double default_memory_limit();

/// From here on the process can not have more than `bytes` of memory of its own (`threads` stacks
/// come on top). Running out of it anywhere ends the process with a message that names the limit,
/// exit code 1, and no temporary files. Does nothing under a sanitizer, whose shadow memory is
/// counted too.
void limit_memory(double bytes, int threads);

/// The most that the process has had in memory at once [bytes].
[[nodiscard]] double peak_memory();

/// Ends the process as limit_memory() does; for an allocation that failed elsewhere.
[[noreturn]] void out_of_memory();

}  // namespace raymo::app
