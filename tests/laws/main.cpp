// raymo_laws: the laws that solids, Booleans and rays obey, tried on many models and rays.
//
//     raymo_laws             a seeded sample, some seconds
//     raymo_laws --full      at least 10^6 rays for every solid and 10^5 random trees
//     raymo_laws --seed N    other models and rays        --only WORD    laws whose name holds the word
//
// Prints one line a law. Exit code 1 when a law has an exception.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "tests/laws/law.hpp"

int main(int argc, char** argv) {
    using namespace raymo::laws;
    bool full = false;
    std::uint64_t seed = 1;
    std::string_view only;
    for (int i = 1; i < argc; ++i) {
        const std::string_view word = argv[i];
        if (word == "--full") {
            full = true;
        } else if (word == "--seed" && i + 1 < argc) {
            seed = std::strtoull(argv[++i], nullptr, 10);
        } else if (word == "--only" && i + 1 < argc) {
            only = argv[++i];
        } else {
            std::fprintf(stderr, "usage: raymo_laws [--full] [--seed N] [--only WORD]\n");
            return 2;
        }
    }
    std::vector<Law> laws;
    add_solid_laws(laws);
    add_drawing_laws(laws);
    add_tree_laws(laws);
    add_identity_laws(laws);
    add_start_laws(laws);
    add_volume_laws(laws);
    add_root_laws(laws);
    add_blend_laws(laws);
    add_crossing_laws(laws);
    add_corner_laws(laws);

    int passed = 0, failed = 0;
    std::uint64_t number = 0;
    for (const Law& law : laws) {
        ++number;
        if (law.name.find(only) == std::string::npos) continue;
        Random random(seed * 1000003 + number);
        Tally tally;
        const auto begin = std::chrono::steady_clock::now();
        law.run(full ? law.full : law.full / 100 + 50, random, tally);
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
        // A law that judged nothing has not been kept.
        const bool kept = tally.exceptions == 0 && tally.samples > 0;
        ++(kept ? passed : failed);
        std::printf("%s %-58s %10llu rays %12llu judged %6llu exceptions %7.1f s\n",
                    kept ? "ok  " : "FAIL", law.name.c_str(),
                    static_cast<unsigned long long>(tally.rays),
                    static_cast<unsigned long long>(tally.samples),
                    static_cast<unsigned long long>(tally.exceptions), seconds.count());
        for (const std::string& report : tally.reports) std::printf("       %s\n", report.c_str());
        std::fflush(stdout);
    }
    std::printf("%d passed, %d failed\n", passed, failed);
    return failed == 0 ? 0 : 1;
}
