#include "raymo/image/zeroed_memory.hpp"

#include <cstdlib>
#ifdef __linux__
#include <sys/mman.h>
#endif

namespace raymo::image {

#ifdef MAP_ANONYMOUS
namespace {

/// From here on memory is mapped, as it comes filled with zeros. What is smaller may well fit into memory that was used.
constexpr std::size_t kMapped = 2U << 20U;

}  // namespace

void* allocate_zeroed(std::size_t bytes) {
    if (bytes < kMapped) return std::calloc(bytes, 1);
    void* const found =
        ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return found == MAP_FAILED ? nullptr : found;
}

void free_zeroed(void* memory, std::size_t bytes) {
    if (bytes < kMapped) {
        std::free(memory);
    } else if (memory != nullptr) {
        ::munmap(memory, bytes);
    }
}
#else
void* allocate_zeroed(std::size_t bytes) { return std::calloc(bytes, 1); }

void free_zeroed(void* memory, std::size_t) { std::free(memory); }
#endif

}  // namespace raymo::image
