#include "apps/raymo/system/interrupt.hpp"

#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstring>

#include "apps/raymo/exit_code.hpp"

namespace raymo::app {
namespace {

std::atomic<bool> stop{false};
static_assert(std::atomic<bool>::is_always_lock_free);

struct Guarded {
    std::array<char, 4096> path{};
    std::atomic<bool> in_use{false};
};
std::array<Guarded, 16> guarded;

void leave_now(int) {
    remove_guarded_files();
    constexpr char kMessage[] = "\r\033[Kinterrupted\n";
    const bool terminal = isatty(STDERR_FILENO) == 1;
    const char* text = terminal ? kMessage : kMessage + 4;
    if (write(STDERR_FILENO, text, std::strlen(text)) < 0) _exit(kInterrupted);
    _exit(kInterrupted);
}

void ask_to_stop(int signal) {
    if (stop.exchange(true)) {
        remove_guarded_files();
        std::signal(signal, SIG_DFL);
        std::raise(signal);
        return;
    }
    itimerval soon{};
    soon.it_value.tv_usec = 25'000;
    setitimer(ITIMER_REAL, &soon, nullptr);
}

}  // namespace

void install_signal_handlers() {
    struct sigaction action {};
    sigemptyset(&action.sa_mask);
    action.sa_handler = ask_to_stop;  // without SA_RESTART: a waiting read ends
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    struct sigaction former {};
    sigaction(SIGHUP, nullptr, &former);
    if (former.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);  // nohup stays in force
    action.sa_handler = leave_now;
    sigaction(SIGALRM, &action, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
}

bool interrupted() { return stop.load(std::memory_order_relaxed); }

void stopped_in_time() {
    const itimerval none{};
    setitimer(ITIMER_REAL, &none, nullptr);
}

bool guard_file(const std::string& path) {
    for (Guarded& g : guarded) {
        if (g.in_use.load() || path.size() + 1 > g.path.size()) continue;
        std::memcpy(g.path.data(), path.c_str(), path.size() + 1);
        g.in_use.store(true);
        return true;
    }
    return false;
}

void unguard_file(const std::string& path) {
    for (Guarded& g : guarded) {
        if (!g.in_use.load() || path != g.path.data()) continue;
        g.in_use.store(false);
        return;
    }
}

void remove_guarded_files() {
    for (Guarded& g : guarded) {
        if (g.in_use.load()) unlink(g.path.data());
    }
}

}  // namespace raymo::app
