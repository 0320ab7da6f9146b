// Ctrl-C, and what must not be left behind by it.
//
// The first signal raises a flag that all work polls; should the work not have ended 25 ms later,
// or should the user press Ctrl-C again, the process removes its temporary files and ends at once.
#pragma once

#include <string>

namespace raymo::app {

/// Listens to SIGINT, SIGTERM and SIGHUP and ignores SIGPIPE. Called by main alone.
void install_signal_handlers();

/// True once the user wants to stop.
[[nodiscard]] bool interrupted();
/// The work has stopped in time: the process will not be ended by force while it says so and leaves.
void stopped_in_time();

/// A file that is removed when the process ends before its time. Up to 16 at once; false when there
/// is no room.
bool guard_file(const std::string& path);
void unguard_file(const std::string& path);
/// Removes all guarded files. Safe in a signal handler.
void remove_guarded_files();

}  // namespace raymo::app
