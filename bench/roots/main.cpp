// raymo_roots: what the real roots of a polynomial in [0, 1] cost, by find_roots and by its peers [Wijk86 3.5, proposition 5].
//
//     raymo_roots [--runs 9]
//
// One thread, CPU time, all methods in turns, medians. The peers get the coefficients of the powers, which they need, for
// nothing. Exit status 1 when find_roots and Sturm's method count
// differently in more than one of 1,000 polynomials, or eight side by side not as one by one.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <functional>
#include <random>
#include <vector>

#include "raymo/curves/roots.hpp"
#include "raymo/curves/sturm.hpp"
#include "roots/lanes.hpp"
#include "roots/peers.hpp"

namespace {

using namespace raymo::curves;

double cpu_seconds() {
    std::timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

enum class Set { random, miss, none, twice };
constexpr const char* kNames[] = {"random", "miss", "none", "double"};

/// random: coefficients in (-1, 1). miss: the same and 0.9, one in ten has a root. none: those of `miss` without a root.
/// twice: two roots, or nearly, 2e-5 to 2e-3 apart.
template <int N>
std::vector<Bernstein<N>> polynomials(Set set, std::size_t count) {
    std::mt19937_64 random(1986);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    std::vector<Bernstein<N>> list;
    while (list.size() < count) {
        Bernstein<N> p;
        for (double& c : p) c = any(random) + (set == Set::random ? 0.0 : 0.9);
        if (set == Set::none) {
            RootList<N> roots;
            find_roots<N>(p, 0.0, roots);
            if (roots.count > 0) continue;
        }
        if (set == Set::twice) {
            const double centre = 0.5 + 0.5 * any(random);
            const double apart = 2.0 * std::pow(10.0, any(random) - 4.0);
            const double square = 0.25 * apart * apart * (random() % 2 == 0 ? 1.0 : -1.0);
            Bernstein<N - 2> rest;
            for (double& c : rest) c = any(random) + 1.2;
            const double other = 1.0 - centre;
            p = product(std::array<double, 3>{centre * centre - square, -centre * other - square,
                                              other * other - square},
                        rest);
        }
        list.push_back(p);
    }
    return list;
}

struct Method {
    const char* name;
    std::function<long()> run;  ///< through all polynomials; the number of roots
    long roots = 0;
    std::vector<double> seconds{};
};

template <int N>
bool measure(Set set, int runs) {
    constexpr std::size_t kCount = 30'000;
    constexpr std::size_t kFew = 3'000;  // for the slow ones
    const std::vector<Bernstein<N>> list = polynomials<N>(set, kCount);
    std::vector<Powers<N>> powers;
    for (const Bernstein<N>& p : list) powers.push_back(powers_of<N>(p));
    const auto sturm = [&](SturmFinish finish) {
        return [&powers, finish] {
            long roots = 0;
            for (const Powers<N>& f : powers) roots += sturm_roots<N>(f, finish).count;
            return roots;
        };
    };
    Method methods[] = {{"find_roots",
                         [&] {
                             long roots = 0;
                             for (const Bernstein<N>& p : list) {
                                 RootList<N> found;
                                 find_roots<N>(p, 0.0, found);
                                 roots += found.count;
                             }
                             return roots;
                         }},
                        {"Sturm", sturm(SturmFinish::bisection)},
                        {"Sturm and Newton", sturm(SturmFinish::newton)},
                        {"Laguerre",
                         [&] {
                             long roots = 0;
                             for (std::size_t i = 0; i < kFew; ++i)
                                 roots += raymo::bench::laguerre_roots<N>(powers[i]).count;
                             return roots;
                         }},
                        {"companion", [&] {
                             long roots = 0;
                             for (std::size_t i = 0; i < kFew; ++i)
                                 roots += raymo::bench::companion_roots<N>(powers[i]).count;
                             return roots;
                         }}};
    for (int run = 0; run < runs; ++run) {
        for (Method& method : methods) {
            const double start = cpu_seconds();
            method.roots = method.run();
            method.seconds.push_back(cpu_seconds() - start);
        }
    }
    std::printf("| %d | %s |", N, kNames[static_cast<int>(set)]);
    double own = 0.0;
    for (Method& method : methods) {
        std::sort(method.seconds.begin(), method.seconds.end());
        const bool few = &method >= &methods[3];
        const double each = 1e9 * method.seconds[method.seconds.size() / 2] /
                            static_cast<double>(few ? kFew : kCount);
        if (&method == &methods[0]) {
            own = each;
            std::printf(" %.1f |", each);
        } else {
            std::printf(" %.0f (%.1f) |", each, each / own);
        }
    }
    std::printf(" %.3f |\n", static_cast<double>(methods[0].roots) / kCount);
    std::fflush(stdout);
    // Touches are told and not counted by Sturm, who in turn miscounts close pairs.
    return std::labs(methods[0].roots - methods[1].roots) <= static_cast<long>(kCount / 1000);
}

template <int N>
bool measure_degree(int runs) {
    bool agree = true;
    for (const Set set : {Set::random, Set::miss, Set::none, Set::twice})
        agree &= measure<N>(set, runs);
    return agree;
}

/// What is decided at once, one by one and eight side by side: nothing, or one crossing and its place.
template <int N>
bool measure_lanes(Set set, int runs) {
    constexpr std::size_t kCount = 30'000;
    std::vector<Bernstein<N>> list;
    for (const Bernstein<N>& p : polynomials<N>(set, 2 * kCount)) {
        if (sign_changes(p) <= 1 && list.size() < kCount / 4) list.push_back(p);
    }
    list.resize(list.size() / 8 * 8);
    std::vector<double> blocks(list.size() * (N + 1));
    for (std::size_t k = 0; k < list.size(); ++k) {
        for (std::size_t i = 0; i <= N; ++i)
            blocks[k / 8 * 8 * (N + 1) + 8 * i + k % 8] = list[k][i];
    }
    std::vector<double> one_by_one, together;
    std::size_t roots = 0;
    raymo::bench::LaneCounts counts;
    for (int run = 0; run < runs; ++run) {
        double start = cpu_seconds();
        roots = 0;
        for (const Bernstein<N>& p : list) {
            RootList<N> found;
            find_roots<N>(p, 0.0, found);
            roots += static_cast<std::size_t>(found.count);
        }
        one_by_one.push_back(cpu_seconds() - start);
        start = cpu_seconds();
        counts = raymo::bench::count_in_lanes(N, blocks.data(), list.size());
        together.push_back(cpu_seconds() - start);
    }
    std::sort(one_by_one.begin(), one_by_one.end());
    std::sort(together.begin(), together.end());
    const auto half = static_cast<std::size_t>(runs) / 2;
    const double scale = 1e9 / static_cast<double>(list.size());
    std::printf("| %d | %s | %.1f | %.1f | %.1f | %.3f |\n", N, kNames[static_cast<int>(set)],
                scale * one_by_one[half], scale * together[half], one_by_one[half] / together[half],
                static_cast<double>(roots) / static_cast<double>(list.size()));
    return roots == counts.one && counts.none + counts.one == list.size();
}

}  // namespace

int main(int argc, char** argv) {
    int runs = 9;
    if (argc == 3 && std::strcmp(argv[1], "--runs") == 0) {
        runs = std::max(1, std::atoi(argv[2]));
    } else if (argc != 1) {
        std::fprintf(stderr, "usage: raymo_roots [--runs 9]\n");
        return 2;
    }
    std::printf(
        "ns a polynomial, and times find_roots\n\n"
        "| degree | set | find_roots | Sturm, bisection | Sturm, Newton | Laguerre | companion | "
        "roots |\n"
        "|---|---|---|---|---|---|---|---|\n");
    bool agree = measure_degree<3>(runs);
    agree &= measure_degree<4>(runs);
    agree &= measure_degree<6>(runs);
    agree &= measure_degree<10>(runs);
    std::printf(
        "\nDecided at once: ns a polynomial\n\n"
        "| degree | set | one by one | eight side by side | times | roots |\n"
        "|---|---|---|---|---|---|\n");
    for (const Set set : {Set::random, Set::miss}) {
        agree &= measure_lanes<3>(set, runs);
        agree &= measure_lanes<4>(set, runs);
    }
    return agree ? 0 : 1;
}
