// The largest number that works: what is told has been tried, and little is tried.
#include "raymo/blends/largest.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <set>
#include <string>

namespace raymo::blends {
namespace {

TEST_CASE("largest: of three digits, tried itself, in few trials") {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> number(0.0, 1.0);
    for (int i = 0; i < 2000; ++i) {
        const double most = std::pow(10.0, 20.0 * number(random) - 10.0);
        const double limit = most * std::pow(10.0, -6.0 * number(random));
        std::set<double> tried;
        const double told = largest_that(
            [&](double x) {
                tried.insert(x);
                return x <= limit;
            },
            most * 1e-9, most);
        CAPTURE(most);
        CAPTURE(limit);
        CHECK(tried.size() <= 19);
        CHECK(*tried.rbegin() < most);
        CHECK(tried.count(told) == 1);
        CHECK(told <= limit);
        // The next number of three digits is too large.
        CHECK(told > 0.99 * std::min(limit, most));
        char text[32];
        std::snprintf(text, sizeof(text), "%.2e", told);
        CHECK(std::stod(text) == told);
    }
}

TEST_CASE("largest: round numbers stay round, and where none works it is 0") {
    const auto up_to = [](double limit) { return [limit](double x) { return x <= limit; }; };
    CHECK(largest_that(up_to(2.0), 1e-6, 3.0) == 2.0);
    CHECK(largest_that(up_to(0.5), 1e-6, 0.6) == 0.5);
    CHECK(largest_that(up_to(0.00023877), 1e-6, 3.0) == 0.000238);
    CHECK(largest_that(up_to(1e9), 1e-6, 3.0) == 3.0);
    int calls = 0;
    const auto never = [&](double) {
        ++calls;
        return false;
    };
    CHECK(largest_that(never, 0x1p-24, 1.0) == 0.0);
    CHECK(calls <= 8);
    // The least of all is tried, too.
    CHECK(largest_that(up_to(1.01), 1.0, 1.9) == 1.01);
    CHECK(largest_that(up_to(1.0), 1.0, 1.9) == 1.0);
    // At the ends of what numbers are.
    CHECK(largest_that(up_to(1.0), 1e-300, 1e300) == 1.0);
    CHECK(largest_that(up_to(2e-300), 1e-300, 1e-290) == doctest::Approx(2e-300));
    CHECK(largest_that(up_to(2e-306), 1e-307, 1e-290) == doctest::Approx(2e-306));
    CHECK(largest_that(never, 1e-307, 1e300) == 0.0);
    CHECK(largest_that(never, 1.0, 0.5) == 0.0);
}

}  // namespace
}  // namespace raymo::blends
