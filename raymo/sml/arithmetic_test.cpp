#include "raymo/sml/arithmetic.hpp"

#include <doctest/doctest.h>

#include <array>
#include <bit>

using namespace raymo::sml;

TEST_CASE("arithmetic: the remainder of whole numbers is that of doubles, bit for bit") {
    constexpr std::array kNumbers{0.0,
                                  -0.0,
                                  1.0,
                                  -1.0,
                                  2.0,
                                  3.0,
                                  7919.0,
                                  0.5,
                                  -2.25,
                                  99991.0,
                                  2147483647.0,
                                  0x1p53 - 1,
                                  0x1p53,
                                  0x1p53 + 2,
                                  0x1p63,
                                  0x1p1000,
                                  -0x1p53,
                                  360.0,
                                  4503599627370497.5};
    for (const double a : kNumbers) {
        for (const double b : kNumbers) {
            if (b == 0.0) continue;
            const double r = std::fmod(a, b);
            const double expected = r != 0.0 && (r < 0.0) != (b < 0.0) ? r + b : r;
            CAPTURE(a);
            CAPTURE(b);
            CHECK(std::bit_cast<std::uint64_t>(remainder_of(a, b)) ==
                  std::bit_cast<std::uint64_t>(expected));
        }
    }
}

TEST_CASE("arithmetic: what has no finite result is left to the slow path") {
    double out = 0.0;
    CHECK(quick_arithmetic(Operator::add, 1, 2, out));
    CHECK(out == 3.0);
    CHECK_FALSE(quick_arithmetic(Operator::divide, 1, 0, out));
    CHECK_FALSE(quick_arithmetic(Operator::modulo, 1, 0, out));
    CHECK_FALSE(quick_arithmetic(Operator::multiply, 1e300, 1e300, out));
    CHECK_FALSE(quick_arithmetic(Operator::power, 2, 3, out));
}
