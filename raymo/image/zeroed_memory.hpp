// Memory for large arrays of numbers that start at 0.
//
// Fresh pages come from the system filled with zeros, one fault a page: at 12 bytes a pixel that costs as much as a
// preview's rays. So nothing is cleared twice: malloc's memory may have been used, or look so, and calloc clears it.
#pragma once

#include <cstddef>
#include <limits>
#include <new>

namespace raymo::image {

/// `bytes` > 0 of zeros, or null. To be freed with free_zeroed and the same number.
[[nodiscard]] void* allocate_zeroed(std::size_t bytes);
void free_zeroed(void* memory, std::size_t bytes);

/// Allocator for vectors of plain numbers that are 0 when made; elements are not written again by a constructor
/// without value. Only for types for which all bits 0 is the value 0, and only for vectors that do not grow.
template <class T>
struct Zeroed {
    using value_type = T;

    Zeroed() = default;
    template <class U>
    explicit(false) Zeroed(const Zeroed<U>&) {}

    [[nodiscard]] T* allocate(std::size_t count) {
        if (void* memory = allocate_zeroed(count * sizeof(T))) return static_cast<T*>(memory);
        // As every container does when there is no memory.
        throw_out_of_memory();
        return nullptr;
    }
    void deallocate(T* memory, std::size_t count) { free_zeroed(memory, count * sizeof(T)); }
    void construct(T*) {}
    template <class... Args>
    void construct(T* place, Args&&... args) {
        ::new (static_cast<void*>(place)) T(static_cast<Args&&>(args)...);
    }
    template <class U>
    friend bool operator==(const Zeroed&, const Zeroed<U>&) {
        return true;
    }

private:
    /// Fails in the way operator new does, by asking it for more than there is: this layer is compiled without exceptions.
    static void throw_out_of_memory() {
        ::operator delete(::operator new(std::numeric_limits<std::ptrdiff_t>::max()));
    }
};

}  // namespace raymo::image
