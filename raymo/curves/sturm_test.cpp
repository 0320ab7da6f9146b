#include "raymo/curves/sturm.hpp"

#include <doctest/doctest.h>

#include <random>

#include "raymo/curves/roots.hpp"

namespace raymo::curves {
namespace {

TEST_CASE("Sturm's chain counts distinct zeros") {
    // (x - 1/4) (x - 1/2)^2 (x - 3/4) = x^4 - 2 x^3 + 23/16 x^2 - 7/16 x + 3/64
    const Powers<4> f{3.0 / 64, -7.0 / 16, 23.0 / 16, -2.0, 1.0};
    const SturmChain<4> chain(f);
    CHECK(chain.changes(0.0) - chain.changes(1.0) == 3);
    CHECK(chain.changes(0.0) - chain.changes(0.3) == 1);
    CHECK(chain.changes(0.3) - chain.changes(0.6) == 1);
    // x^4 + 1: a chain that leaves degrees out.
    const SturmChain<4> none(Powers<4>{1, 0, 0, 0, 1});
    CHECK(none.changes(-10.0) - none.changes(10.0) == 0);
    // x^4 - 1/16
    const SturmChain<4> two(Powers<4>{-1.0 / 16, 0, 0, 0, 1});
    CHECK(two.changes(-10.0) - two.changes(10.0) == 2);
    CHECK(two.changes(0.0) - two.changes(1.0) == 1);
}

TEST_CASE("powers of x from Bernstein form") {
    // 1 - 3 u + 5 u^2
    const Powers<2> f = powers_of<2>({1.0, -0.5, 3.0});
    CHECK(f[0] == 1.0);
    CHECK(f[1] == -3.0);
    CHECK(f[2] == 5.0);
}

TEST_CASE("Sturm and Descartes find the same roots of polynomials at random") {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    int roots = 0;
    for (int i = 0; i < 20000; ++i) {
        Bernstein<6> p;
        for (double& c : p) c = any(random);
        RootList<6> told;
        find_roots<6>(p, 0.0, told);
        for (const SturmFinish finish : {SturmFinish::newton, SturmFinish::bisection}) {
            const SturmRoots<6> found = sturm_roots<6>(powers_of<6>(p), finish);
            REQUIRE(found.count == told.count);
            for (std::size_t k = 0; k < static_cast<std::size_t>(found.count); ++k) {
                CHECK(std::fabs(found.u[k] - told.root[k].u) <= 1e-9);
                ++roots;
            }
        }
    }
    CHECK(roots > 20000);
}

}  // namespace
}  // namespace raymo::curves
