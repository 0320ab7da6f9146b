// The user's view of long work: a bar with the time left, and the ways to stop it.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>

#include "apps/raymo/system/console.hpp"
#include "raymo/core/progress.hpp"

namespace raymo::app {

/// Watches over one phase of the work. The bar appears after half a second, on a terminal only, and
/// is wiped away when the phase ends.
class Watch final : public Progress {
public:
    using Clock = std::chrono::steady_clock;

    /// `what` stands before the bar. `deadline`: the work is cancelled past it.
    Watch(Console& console, std::string what, std::optional<Clock::time_point> deadline = {});
    ~Watch() override;

    void report(double fraction) override;
    [[nodiscard]] bool cancelled() const override;
    /// Whether it was the deadline, and not the user, that cancelled.
    [[nodiscard]] bool late() const { return late_.load(std::memory_order_relaxed); }

private:
    void draw(double fraction, Clock::time_point now);

    Console& console_;
    std::string what_;
    std::optional<Clock::time_point> deadline_;
    Clock::time_point start_ = Clock::now();
    bool visible_;
    std::mutex drawing_;
    Clock::time_point next_draw_;
    bool drawn_ = false;
    mutable std::atomic<bool> late_{false};
};

/// A bar of that many columns, as "tracing  [#####.....]  52 %  1:05 left".
[[nodiscard]] std::string progress_line(const std::string& what, double fraction,
                                        double seconds_left, int columns);

}  // namespace raymo::app
