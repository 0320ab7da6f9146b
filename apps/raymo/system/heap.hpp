// How the allocator keeps its memory.
#pragma once

namespace raymo::app {

/// Lets the allocator keep what is given back to it, also in blocks of a few MB: a model is evaluated, compiled and drawn
/// in turn, and memory that was used before costs nothing, while the first touch of a new page costs as much as filling
/// it. Without effect where the allocator is another one than that of the GNU C library.
void keep_heap();

}  // namespace raymo::app
