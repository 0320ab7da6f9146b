// raymo: the program. What it does is in run.cpp; here is only what belongs to the process.

#include <unistd.h>

#include <cstdio>
#include <exception>
#include <new>

#include "apps/raymo/run.hpp"
#include "apps/raymo/system/interrupt.hpp"
#include "apps/raymo/system/memory_limit.hpp"

int main(int argc, char** argv) {
    using namespace raymo::app;
    install_signal_handlers();
    try {
        Console console(STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO);
        const int code = run(Args(argv + (argc > 0 ? 1 : 0), argv + argc), console);
        if (!interrupted()) return code;
        stopped_in_time();
        console.raw("interrupted\n");
        return kInterrupted;
    } catch (const std::bad_alloc&) {
        out_of_memory();
    } catch (const std::exception& e) {
        std::fprintf(stderr, "error: %s\nThis is a bug in raymo.\n", e.what());
        return kBug;
    }
}
