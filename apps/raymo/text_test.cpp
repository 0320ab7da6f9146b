#include "apps/raymo/text.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace raymo::app {
namespace {

TEST_CASE("text: numbers read back as the same double") {
    std::mt19937_64 random(7);
    for (int i = 0; i < 10'000; ++i) {
        const double v =
            std::ldexp(static_cast<double>(random()), static_cast<int>(random() % 1800) - 900);
        if (!std::isfinite(v)) continue;
        CHECK(parse_number(number(v)) == v);
        CHECK(parse_number(number(-v)) == -v);
    }
    CHECK(number(0.1) == "0.1");
    CHECK(json_number(std::numeric_limits<double>::infinity()) == "null");
    CHECK(json_vector({1, -2.5, 1e300}) == "[1,-2.5,1e+300]");
}

TEST_CASE("text: only a whole finite number is one") {
    CHECK(parse_number("1e3") == 1000.0);
    CHECK(parse_number("+1.5") == 1.5);
    for (const char* bad :
         {"", "x", "1x", "1 ", " 1", "nan", "inf", "1e999", "+-1", "0x10", "--1"}) {
        CAPTURE(bad);
        CHECK_FALSE(parse_number(bad).has_value());
    }
    CHECK(parse_whole("18446744073709551615") == std::numeric_limits<std::uint64_t>::max());
    for (const char* bad : {"", "-1", "1.5", "18446744073709551616", "1e3"}) {
        CAPTURE(bad);
        CHECK_FALSE(parse_whole(bad).has_value());
    }
}

TEST_CASE("text: vectors have three numbers") {
    CHECK(parse_vector("1,-2,3.5") == Vec3{1, -2, 3.5});
    for (const char* bad : {"", "1,2", "1,2,3,4", "1,,3", "1,2,", "a,b,c"}) {
        CAPTURE(bad);
        CHECK_FALSE(parse_vector(bad).has_value());
    }
}

TEST_CASE("text: JSON strings hold any bytes") {
    CHECK(json_string("a\"b\\c\n\t\x01") == "\"a\\\"b\\\\c\\n\\t\\u0001\"");
    CHECK(json_string("\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80") ==
          "\"\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80\"");
    CHECK(json_string("a\xff\xc3") == "\"a\\ufffd\\ufffd\"");
    CHECK(json_string("\xed\xa0\x80") == "\"\\ufffd\\ufffd\\ufffd\"");  // half a surrogate pair
}

TEST_CASE("text: suggestions are near or none") {
    const std::vector<std::string> known{"render", "rays", "check"};
    CHECK(did_you_mean("rendr", known) == "did you mean `render`?");
    CHECK(did_you_mean("chek", known) == "did you mean `check`?");
    CHECK(did_you_mean("banana", known).empty());
    CHECK(did_you_mean(std::string(100'000, 'x'), known).empty());
}

}  // namespace
}  // namespace raymo::app
