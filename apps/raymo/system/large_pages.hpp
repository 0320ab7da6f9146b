// Large pages for small objects.
#pragma once

namespace raymo::app {

/// Lets the allocator take its memory from one stretch for which the system is asked for large pages: a model is made
/// of very many small nodes, and a fault for every 4 KB of them costs as much as making them. The stretch counts
/// against the limit of memory (`limit` in bytes), so it is a small part of that. Without effect where the allocator is
/// another one.
void use_large_pages(double limit);

}  // namespace raymo::app
