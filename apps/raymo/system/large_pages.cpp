#include "apps/raymo/system/large_pages.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>
#endif

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace raymo::app {

void use_large_pages([[maybe_unused]] double limit) {
#if defined(__GLIBC__) && defined(MADV_HUGEPAGE)
    constexpr int kMiB = 1 << 20;
    constexpr std::uintptr_t kLarge = 2U * kMiB;
    const int stretch = static_cast<int>(std::min(limit / 16.0, 64.0 * kMiB));
    if (stretch < 8 * kMiB) return;
    // Vectors up to this size live in the stretch too and leave their room to others; larger ones are mapped by
    // themselves and given back.
    constexpr int kLargestShared = kMiB / 2;
    mallopt(M_MMAP_THRESHOLD, kLargestShared);
    mallopt(M_TRIM_THRESHOLD, 4 * stretch);  // the stretch itself is not to be given back
    mallopt(M_TOP_PAD, stretch);
    const auto begin = reinterpret_cast<std::uintptr_t>(sbrk(0));
    // More than what is left of the heap, so that it must grow.
    if (void* block = std::malloc(kLargestShared - 4096)) std::free(block);
    const auto end = reinterpret_cast<std::uintptr_t>(sbrk(0));
    mallopt(M_TOP_PAD, kMiB / 8);  // as it was: other threads have heaps of their own
    // Small models stay below the first large page.
    const std::uintptr_t first = (begin + kMiB / 2 + kLarge - 1) / kLarge * kLarge;
    const std::uintptr_t last = end / kLarge * kLarge;
    // Only advice: whether it is followed changes nothing but the time.
    if (first < last) {
        static_cast<void>(madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE));
    }
#endif
}

}  // namespace raymo::app
