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
    const auto end_of_heap = [] { return reinterpret_cast<std::uintptr_t>(sbrk(0)); };
    // Small models stay in so much before the first large page. Pages before that are left to nobody and never touched, so
    // that larger ones get there soon.
    constexpr std::uintptr_t kSmall = kMiB / 2;
    const std::uintptr_t first = (end_of_heap() + kSmall + kLarge - 1) / kLarge * kLarge;
    static_cast<void>(sbrk(static_cast<std::intptr_t>(first - kSmall - end_of_heap())));
    // More than what is left of the heap, so that it must grow; and all of it small, as it is touched before the advice.
    static_assert(kLargestShared <= kSmall);
    if (void* block = std::malloc(kLargestShared - 4096)) std::free(block);
    mallopt(M_TOP_PAD, kMiB / 8);  // as it was: other threads have heaps of their own
    const std::uintptr_t last = end_of_heap() / kLarge * kLarge;
    // Only advice: whether it is followed changes nothing but the time.
    if (first < last) {
        static_cast<void>(madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE));
    }
#endif
}

}  // namespace raymo::app
