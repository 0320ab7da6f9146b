#include "raymo/math/pair.hpp"

#include <doctest/doctest.h>

#include <limits>

namespace raymo {
namespace {

TEST_CASE("pairs compute what their numbers compute, bit for bit") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    const double numbers[] = {0.0,    -0.0,   1.0,      -1.0 / 3.0, 0.7,
                              5e-324, -1e308, infinity, -infinity,  nan};
    const auto same = [](double a, double b) {
        return a == b ? std::signbit(a) == std::signbit(b) : a != a && b != b;
    };
    for (const double a : numbers) {
        for (const double b : numbers) {
            const Pair x{a, b};
            const Pair y{b, 0.1};
            const Pair sum = x + y;
            CHECK(same(sum[0], a + b));
            CHECK(same(sum[1], b + 0.1));
            const Pair product = x * y;
            CHECK(same(product[0], a * b));
            CHECK(same(product[1], b * 0.1));
            const Pair least = pair_min(x, y);
            CHECK(same(least[0], lane_min(a, b)));
            CHECK(same(least[1], lane_min(b, 0.1)));
            const Pair most = pair_max(x, y);
            CHECK(same(most[0], lane_max(a, b)));
            CHECK(same(most[1], lane_max(b, 0.1)));
            CHECK(same(pair_abs(x)[0], std::fabs(a)));
            CHECK(same(pair_abs(x)[1], std::fabs(b)));
            CHECK(same(swapped(x)[0], b));
            CHECK(same(swapped(x)[1], a));
            CHECK(same(pair_of(a)[1], a));
        }
    }
}

}  // namespace
}  // namespace raymo
