#include "raymo/render/sampling.hpp"

#include <doctest/doctest.h>

#include <set>
#include <vector>

using namespace raymo::render;

TEST_CASE("samples: every elementary rectangle of the first 2^n points holds one") {
    for (const std::uint64_t seed : {1ULL, 2ULL, 977ULL}) {
        for (unsigned n = 0; n <= 8; ++n) {
            const unsigned count = 1U << n;
            for (unsigned a = 0; a <= n; ++a) {
                const unsigned columns = 1U << a;
                const unsigned rows = count / columns;
                std::vector<int> hits(count, 0);
                for (unsigned k = 0; k < count; ++k) {
                    const Point2 p = sample_point(k, seed);
                    REQUIRE(p.u >= 0.0);
                    REQUIRE(p.u < 1.0);
                    REQUIRE(p.v < 1.0);
                    const auto x = static_cast<unsigned>(p.u * columns);
                    const auto y = static_cast<unsigned>(p.v * rows);
                    ++hits[y * columns + x];
                }
                int wrong = 0;
                for (const int h : hits) wrong += h != 1;
                CHECK(wrong == 0);
            }
        }
    }
}

TEST_CASE("samples: another seed gives other points in another order") {
    std::set<double> seen;
    for (std::uint64_t seed = 0; seed < 100; ++seed) seen.insert(sample_point(0, seed).u);
    CHECK(seen.size() == 100);
    CHECK(sample_point(3, 5).u == sample_point(3, 5).u);
}

TEST_CASE("samples: blocks that continue a sequence are stratified too") {
    // What the samples of one pixel do with an area light: 4 pixels' samples of 4 light samples are
    // 16 together.
    for (unsigned s = 0; s < 4; ++s) {
        std::vector<int> quarter(4, 0);
        for (unsigned k = 0; k < 4; ++k) {
            const Point2 p = sample_point(4 * s + k, 11);
            ++quarter[static_cast<unsigned>(p.u * 2) + 2 * static_cast<unsigned>(p.v * 2)];
        }
        for (const int q : quarter) CHECK(q == 1);
    }
}
