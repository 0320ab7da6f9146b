#include "raymo/curves/roots.hpp"

#include <doctest/doctest.h>

#include <random>

namespace raymo::curves {
namespace {

/// The product of (u - root) over some roots.
template <int N>
Bernstein<N> with_roots(const std::array<double, N>& roots) {
    std::array<double, 1> p{1.0};
    if constexpr (N == 1) {
        return product(p, std::array<double, 2>{-roots[0], 1.0 - roots[0]});
    } else {
        std::array<double, N - 1> rest{};
        std::copy_n(roots.begin() + 1, N - 1, rest.begin());
        return product(std::array<double, 2>{-roots[0], 1.0 - roots[0]}, with_roots<N - 1>(rest));
    }
}

TEST_CASE("roots of a product of lines are found in order") {
    RootList<6> list;
    find_roots<6>(with_roots<6>({0.1, 0.9, -0.5, 0.5, 0.3, 2.0}), 1e-16, list);
    REQUIRE(list.count == 4);
    const double expected[] = {0.1, 0.3, 0.5, 0.9};
    for (int i = 0; i < 4; ++i) {
        const Root& root = list.root[static_cast<std::size_t>(i)];
        CHECK(root.crosses);
        CHECK(root.u == doctest::Approx(expected[i]).epsilon(1e-13));
        CHECK(root.rises == (i % 2 == 0));
    }
}

TEST_CASE("a double root is a touch, a triple root one crossing") {
    RootList<2> twice;
    find_roots<2>(with_roots<2>({0.3, 0.3}), 1e-15, twice);
    REQUIRE(twice.count == 1);
    CHECK_FALSE(twice.root[0].crosses);
    CHECK(twice.root[0].lo <= 0.3);
    CHECK(twice.root[0].hi >= 0.3);
    RootList<3> thrice;
    find_roots<3>(with_roots<3>({0.3, 0.3, 0.3}), 1e-15, thrice);
    int crossings = 0;
    for (const Root& root : thrice) {
        if (!root.crosses) continue;
        ++crossings;
        CHECK(root.u == doctest::Approx(0.3).epsilon(1e-4));
    }
    CHECK(crossings == 1);
}

TEST_CASE("the number of crossings has the parity that the signs at the ends ask for") {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (int i = 0; i < 100000; ++i) {
        Bernstein<6> p;
        for (double& c : p) c = any(random) * std::ldexp(1.0, -static_cast<int>(random() % 40));
        if (random() % 4 == 0) p[random() % 7] = 0.0;
        RootList<6> list;
        find_roots<6>(p, 1e-17, list);
        int crossings = 0;
        bool negative = p[0] < 0.0;
        double last = -1.0;
        for (const Root& root : list) {
            CHECK(root.lo >= last - 1e-12);
            last = root.lo;
            if (!root.crosses) continue;
            ++crossings;
            CHECK(root.rises == negative);
            negative = !negative;
            CHECK(std::fabs(value_at(p, root.u)) <= 1e-12);
        }
        CHECK(negative == (p[6] < 0.0));
    }
}

}  // namespace
}  // namespace raymo::curves
