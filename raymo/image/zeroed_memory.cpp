#include "raymo/image/zeroed_memory.hpp"

#include <cstdint>
#include <cstdlib>
#ifdef __linux__
#include <sys/mman.h>
#endif

namespace raymo::image {

void* allocate_zeroed(std::size_t bytes) {
    void* memory = std::calloc(bytes, 1);
#ifdef MADV_HUGEPAGE
    constexpr std::uintptr_t kLarge = 2U << 20U;
    const auto start = reinterpret_cast<std::uintptr_t>(memory);
    const std::uintptr_t first = (start + kLarge - 1) / kLarge * kLarge;
    const std::uintptr_t last = (start + bytes) / kLarge * kLarge;
    // Only advice: whether it is followed changes nothing but the time.
    if (memory != nullptr && last > first) {
        static_cast<void>(::madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE));
    }
#endif
    return memory;
}

void free_zeroed(void* memory) { std::free(memory); }

}  // namespace raymo::image
