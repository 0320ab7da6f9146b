#include "apps/raymo/system/memory_limit.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <new>
#include <string>

#include "apps/raymo/exit_code.hpp"
#include "apps/raymo/system/interrupt.hpp"
#include "apps/raymo/text.hpp"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define RAYMO_SHADOW_MEMORY 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define RAYMO_SHADOW_MEMORY 1
#endif
#endif

namespace raymo::app {
namespace {

constexpr double kGiB = 1024.0 * 1024.0 * 1024.0;
constexpr double kStack = 16.0 * 1024.0 * 1024.0;  // of a thread, with its share of the allocator

// Written before there is any need for it: nothing can be allocated then.
std::array<char, 160> message{"error: out of memory\n"};

}  // namespace

double default_memory_limit() {
    const double machine =
        static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
    return machine > 0.0 ? std::min(4.0 * kGiB, 0.8 * machine) : 4.0 * kGiB;
}

void limit_memory(double bytes, int threads) {
    const std::string text =
        "error: the memory limit of " + number(std::round(bytes / kGiB * 1000.0) / 1000.0) +
        " GiB was reached\nhint: give more with --memory-limit, or make the model or the picture "
        "smaller\n";
    const std::size_t length = std::min(text.size(), message.size() - 1);
    std::memcpy(message.data(), text.data(), length);
    message[length] = '\0';
    std::set_new_handler(out_of_memory);
#ifndef RAYMO_SHADOW_MEMORY
    // RLIMIT_DATA counts what is private and writable, not what allocators and libraries merely
    // reserve.
    rlimit limit{};
    if (getrlimit(RLIMIT_DATA, &limit) != 0) return;
    const double wanted = std::min(bytes + kStack * threads, 9e18);
    const auto data = static_cast<rlim_t>(wanted);
    if (limit.rlim_max == RLIM_INFINITY || data < limit.rlim_max) limit.rlim_cur = data;
    setrlimit(RLIMIT_DATA, &limit);
#else
    static_cast<void>(threads);
#endif
}

double peak_memory() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) * 1024.0;
}

void out_of_memory() {
    remove_guarded_files();
    if (write(STDERR_FILENO, message.data(), std::strlen(message.data())) < 0) _exit(kModelWrong);
    _exit(kModelWrong);
}

}  // namespace raymo::app
