#include "apps/raymo/system/heap.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace raymo::app {

void keep_heap() {
#ifdef __GLIBC__
    constexpr int kMiB = 1 << 20;
    mallopt(M_MMAP_THRESHOLD, 4 * kMiB);  // larger blocks are mapped by themselves, and given back
    mallopt(M_TRIM_THRESHOLD, 256 * kMiB);
    mallopt(M_TOP_PAD, kMiB);  // so often the system is asked for more
#endif
}

}  // namespace raymo::app
