#include "apps/raymo/system/executor.hpp"

#include <sched.h>

#include <algorithm>
#include <atomic>

// Debian's oneTBB is not built for the thread sanitizer, which would call its synchronisation
// races: there the threads are our own.
#if defined(__SANITIZE_THREAD__)
#define RAYMO_OWN_THREADS 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define RAYMO_OWN_THREADS 1
#endif
#endif

#ifdef RAYMO_OWN_THREADS
#include <thread>
#include <vector>
#else
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/partitioner.h>
#include <oneapi/tbb/task_arena.h>
#endif

namespace raymo::app {
namespace {

using Task = std::function<void(std::size_t, std::size_t)>;

#ifdef RAYMO_OWN_THREADS
class Parallel final : public Executor {
public:
    explicit Parallel(int threads) : threads_(static_cast<std::size_t>(threads)) {}
    [[nodiscard]] std::size_t workers() const override { return threads_; }
    void for_each(std::size_t count, const Task& task) override {
        std::atomic<std::size_t> next{0};
        const auto work = [&](std::size_t worker) {
            for (std::size_t i = next++; i < count; i = next++) task(i, worker);
        };
        std::vector<std::jthread> others;
        for (std::size_t w = 1; w < std::min(threads_, count); ++w) others.emplace_back(work, w);
        work(0);
    }

private:
    std::size_t threads_;
};
#else
/// Each worker is one oneTBB task that takes index after index: tasks start in order, and a
/// worker's scratch memory is used by one thread at a time.
class Parallel final : public Executor {
public:
    explicit Parallel(int threads)
        : allowed_(oneapi::tbb::global_control::max_allowed_parallelism,
                   static_cast<std::size_t>(threads)),
          arena_(threads),
          threads_(static_cast<std::size_t>(threads)) {}
    [[nodiscard]] std::size_t workers() const override { return threads_; }
    void for_each(std::size_t count, const Task& task) override {
        std::atomic<std::size_t> next{0};
        const auto work = [&](std::size_t worker) {
            for (std::size_t i = next++; i < count; i = next++) task(i, worker);
        };
        const std::size_t workers = std::min(threads_, count);
        if (workers <= 1) {
            work(0);
            return;
        }
        arena_.execute([&] {
            oneapi::tbb::parallel_for(std::size_t{0}, workers, work,
                                      oneapi::tbb::simple_partitioner{});
        });
    }

private:
    oneapi::tbb::global_control allowed_;  // more threads than processors are the user's choice
    oneapi::tbb::task_arena arena_;
    std::size_t threads_;
};
#endif

}  // namespace

int available_processors() {
    cpu_set_t set;
    CPU_ZERO(&set);
    if (sched_getaffinity(0, sizeof set, &set) != 0) return 1;
    return std::max(CPU_COUNT(&set), 1);
}

std::unique_ptr<Executor> make_executor(int threads) {
    if (threads <= 1) return std::make_unique<Executor>();
    return std::make_unique<Parallel>(threads);
}

}  // namespace raymo::app
