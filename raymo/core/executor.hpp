// How work is spread over threads, without the layers below apps knowing any threads.
#pragma once

#include <cstddef>
#include <functional>

namespace raymo {

/// Runs independent tasks. The base class runs them one after another in the calling thread.
class Executor {
public:
    virtual ~Executor() = default;
    /// Number of workers; the `worker` that a task is handed is below this.
    [[nodiscard]] virtual std::size_t workers() const { return 1; }
    /// Calls `task(index, worker)` once for every index in [0, count); returns when all are done. A worker runs one task
    /// at a time, so scratch memory can be kept per worker.
    virtual void for_each(std::size_t count,
                          const std::function<void(std::size_t index, std::size_t worker)>& task) {
        for (std::size_t i = 0; i < count; ++i) task(i, 0);
    }
};

}  // namespace raymo
