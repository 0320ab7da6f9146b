#include "apps/raymo/system/watch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/raymo/system/interrupt.hpp"

namespace raymo::app {
namespace {

using namespace std::chrono_literals;

std::string clock_time(double seconds) {
    if (!(seconds < 359'999.0)) return "--:--";
    const auto whole = static_cast<long>(std::ceil(seconds));
    const auto two = [](long n) { return (n < 10 ? "0" : "") + std::to_string(n); };
    if (whole < 3600) return std::to_string(whole / 60) + ":" + two(whole % 60);
    return std::to_string(whole / 3600) + ":" + two(whole / 60 % 60) + ":" + two(whole % 60);
}

}  // namespace

std::string progress_line(const std::string& what, double fraction, double seconds_left,
                          int columns) {
    fraction = std::clamp(fraction, 0.0, 1.0);
    const std::string percent = std::to_string(static_cast<int>(fraction * 100.0)) + " %";
    const std::string head = what + "  ";
    const std::string tail = std::string(2 + (5 - std::min<std::size_t>(percent.size(), 5)), ' ') +
                             percent + "  " + clock_time(seconds_left) + " left";
    const int room = columns - 1 - static_cast<int>(head.size() + tail.size()) - 2;
    const int width = std::min(room, 40);
    if (width < 5) return percent.substr(0, static_cast<std::size_t>(std::max(columns - 1, 0)));
    const int full = static_cast<int>(fraction * width);
    return head + "[" + std::string(static_cast<std::size_t>(full), '#') +
           std::string(static_cast<std::size_t>(width - full), '.') + "]" + tail;
}

Watch::Watch(Console& console, std::string what, std::optional<Clock::time_point> deadline)
    : console_(console),
      what_(std::move(what)),
      deadline_(deadline),
      visible_(console.error_is_terminal() && !console.quiet),
      next_draw_(start_ + 500ms) {}

Watch::~Watch() {
    if (drawn_) console_.raw("\r\033[K");
}

bool Watch::cancelled() const {
    if (interrupted()) return true;
    if (!deadline_ || Clock::now() < *deadline_) return false;
    late_.store(true, std::memory_order_relaxed);
    return true;
}

void Watch::report(double fraction) {
    if (!visible_) return;
    const Clock::time_point now = Clock::now();
    const std::unique_lock lock(drawing_, std::try_to_lock);
    if (!lock || now < next_draw_) return;
    next_draw_ = now + 100ms;
    draw(fraction, now);
}

void Watch::draw(double fraction, Clock::time_point now) {
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const double left = fraction > 0.0 ? elapsed * (1.0 - fraction) / fraction : HUGE_VAL;
    console_.raw("\r\033[K" + progress_line(what_, fraction, left, console_.columns()));
    drawn_ = true;
}

}  // namespace raymo::app
