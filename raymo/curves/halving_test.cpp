#include "raymo/curves/halving.hpp"

#include <doctest/doctest.h>

#include <random>
#include <type_traits>

namespace raymo::curves {
namespace {

TEST_CASE("halves are those of de Casteljau's construction, times 2^N") {
    std::mt19937_64 random(3);
    const auto check = [&]<int N>(std::integral_constant<int, N>) {
        Bernstein<N> p, left, right;
        for (double& c : p)
            c = static_cast<double>(random() % 2000) - 1000.0;  // all sums are exact
        split(p, 0.5, left, right);
        Bernstein<N> low, high;
        Halves<N> halves{low, high, {}, {}};
        halve<N>(p, halves);
        for (std::size_t i = 0; i <= N; ++i) {
            CHECK(low[i] == std::ldexp(left[i], N));
            CHECK(high[i] == std::ldexp(right[i], N));
        }
        CHECK(double{halves.least[0]} == *std::min_element(low.begin(), low.end()));
        CHECK(double{halves.least[1]} == *std::min_element(high.begin(), high.end()));
        CHECK(double{halves.most[0]} == *std::max_element(low.begin(), low.end()));
        CHECK(double{halves.most[1]} == *std::max_element(high.begin(), high.end()));
    };
    for (int k = 0; k < 100; ++k) {
        check(std::integral_constant<int, 1>());
        check(std::integral_constant<int, 2>());
        check(std::integral_constant<int, 5>());
        check(std::integral_constant<int, 6>());
        check(std::integral_constant<int, 10>());
    }
}

}  // namespace
}  // namespace raymo::curves
