#include "raymo/image/zeroed_memory.hpp"

#include <cstdint>
#include <cstdlib>
#ifdef __linux__
#include <sys/mman.h>
#endif

namespace raymo::image {

#ifdef MADV_HUGEPAGE
namespace {

constexpr std::size_t kLarge = 2U << 20U;

std::size_t whole_pages(std::size_t bytes) { return (bytes + kLarge - 1) / kLarge * kLarge; }

/// Small pages, where there is no room for more than is wanted.
void* map_anywhere(std::size_t bytes) {
    void* const found =
        ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return found == MAP_FAILED ? nullptr : found;
}

/// Pages of their own, from the beginning of a large one on if there is room for it. Null: there is no room at all.
void* map(std::size_t bytes) {
    const std::size_t wanted = whole_pages(bytes);
    const std::size_t room = wanted + kLarge;
    if (room < bytes) return nullptr;
    void* const found =
        ::mmap(nullptr, room, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (found == MAP_FAILED) return map_anywhere(wanted);
    char* const start = static_cast<char*>(found);
    const std::size_t before = whole_pages(reinterpret_cast<std::uintptr_t>(start)) -
                               reinterpret_cast<std::uintptr_t>(start);
    char* const first = start + before;
    if (before > 0) ::munmap(start, before);
    if (before < kLarge) ::munmap(first + wanted, kLarge - before);
    // Only advice: whether it is followed changes nothing but the time. A small rest is left to small pages.
    const std::size_t large = (bytes + kLarge / 2) / kLarge * kLarge;
    static_cast<void>(::madvise(first, large, MADV_HUGEPAGE));
    return first;
}

}  // namespace

void* allocate_zeroed(std::size_t bytes) {
    return bytes >= kLarge ? map(bytes) : std::calloc(bytes, 1);
}

void free_zeroed(void* memory, std::size_t bytes) {
    if (bytes < kLarge) {
        std::free(memory);
    } else if (memory != nullptr) {
        ::munmap(memory, whole_pages(bytes));
    }
}
#else
void* allocate_zeroed(std::size_t bytes) { return std::calloc(bytes, 1); }

void free_zeroed(void* memory, std::size_t) { std::free(memory); }
#endif

}  // namespace raymo::image
