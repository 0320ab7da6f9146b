#include "raymo/drawings/svg_values.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "raymo/drawings/svg_style.hpp"

namespace raymo::drawings {
namespace {

bool always(double) { return true; }

TEST_CASE("lengths come in px, of which 96 are an inch, or as parts") {
    CHECK(read_length("12")->of(1.0) == 12.0);
    CHECK(read_length(" 12px ")->of(1.0) == 12.0);
    CHECK(read_length("1in")->of(1.0) == doctest::Approx(96.0).epsilon(1e-15));
    CHECK(read_length("7mm")->millimetres() == 7.0);
    CHECK(read_length("2in")->millimetres() == 50.8);
    CHECK(read_length("25.4mm")->of(1.0) == doctest::Approx(96.0).epsilon(1e-15));
    CHECK(read_length("2.54cm")->of(1.0) == doctest::Approx(96.0).epsilon(1e-15));
    CHECK(read_length("72pt")->of(1.0) == doctest::Approx(96.0).epsilon(1e-15));
    CHECK(read_length("6pc")->of(1.0) == doctest::Approx(96.0).epsilon(1e-15));
    CHECK(read_length("101.6Q")->of(1.0) == doctest::Approx(96.0).epsilon(1e-15));
    CHECK(read_length("1e1mm")->of(1.0) == doctest::Approx(960 / 25.4).epsilon(1e-15));
    CHECK(read_length("50%")->of(30.0) == 15.0);
    for (const char* bad : {"", "mm", "1em", "1 mm", "12px;", "1%%", "--1", "1..2"})
        CHECK_FALSE(read_length(bad).has_value());
    CHECK(read_length("3furlongs").error().what ==
          "\"furlongs\" is none of the units px, mm, cm, in, pt, pc, Q and %");
    CHECK(read_length("3furlongs").error().at == 1);
}

TEST_CASE("numbers too small to be told from 0 are 0, those too large are errors") {
    const std::string zeros(400, '0');
    for (const std::string& small :
         {"0." + zeros + "1", std::string("1e-400"), "-." + zeros + "1e5", "1" + zeros + "e-1000",
          "5e-9" + zeros}) {
        CAPTURE(small);
        Scanner scanner(small);
        const auto read = scanner.number();
        REQUIRE(read.has_value());
        CHECK(*read == 0.0);
    }
    for (const std::string& large : {"1" + zeros, "0." + zeros + "1e1000", "-1" + zeros + ".5e-5",
                                     std::string("1e400"), "1e9" + zeros}) {
        CAPTURE(large);
        Scanner scanner(large);
        CHECK(scanner.number().error().what == "the number is too large");
    }
    const std::string shifted = "0." + zeros + "1e402";
    CHECK(*Scanner(shifted).number() == 10.0);
}

TEST_CASE("transformations are applied from the last to the first") {
    const auto at = [](std::string_view text, Vec2 p) { return (*read_transform(text))(p); };
    CHECK(at("", {1, 2}) == Vec2{1, 2});
    CHECK(at(" none ", {1, 2}) == Vec2{1, 2});
    CHECK_FALSE(read_transform("nonesuch").has_value());
    CHECK_FALSE(read_transform("none scale(2)").has_value());
    CHECK(at("translate(10)", {1, 2}) == Vec2{11, 2});
    CHECK(at("translate(10 20)scale(2)", {1, 2}) == Vec2{12, 24});
    CHECK(at("scale(2,3) , translate(1 , 1)", {1, 2}) == Vec2{4, 9});
    CHECK(at("rotate(90)", {1, 0}) == Vec2{0, 1});
    CHECK(at("rotate(90 1 1)", {1, 0}) == Vec2{2, 1});
    CHECK(at("matrix(1 2 3 4 5 6)", {1, 1}) == Vec2{9, 12});
    CHECK(at("skewX(45)", {0, 2}).x == doctest::Approx(2.0).epsilon(1e-15));
    CHECK(at("skewY(45)", {2, 0}).y == doctest::Approx(2.0).epsilon(1e-15));
    const auto misfit = [](std::string_view text) {
        const auto out = read_transform(text);
        REQUIRE_FALSE(out.has_value());
        return std::to_string(out.error().at) + ": " + out.error().what;
    };
    CHECK(misfit("turn(3)") ==
          "0: the transformations are matrix, translate, scale, rotate, skewX "
          "and skewY, not \"turn\"");
    CHECK(misfit("rotate 3") == "7: \"(\" is missing before \"3\"");
    CHECK(misfit("rotate(3") == "8: a number is missing at the end");
    CHECK(misfit("scale()") == "0: scale takes 1 or 2 numbers, not 0");
    CHECK(misfit("scale(2) skewX(90)") ==
          "9: the skewX by 90 degrees is a right angle, which has no tangent");
    CHECK(misfit("skewY(-270)") ==
          "0: the skewY by -270 degrees is a right angle, which has no tangent");
    CHECK(at("rotate(90)", {0, 1}) == Vec2{-1, 0});
    CHECK(misfit("matrix(1 2 3)") == "0: matrix takes 6 numbers, not 3");
    CHECK(misfit("rotate(1 2)") == "0: rotate takes 1 or 3 numbers, not 2");
    CHECK_FALSE(read_transform("translate(1 2 3 4 5 6 7 8)").has_value());
}

TEST_CASE("view boxes and aspect ratios") {
    CHECK(read_view_box("1 2,3 4")->height == 4.0);
    for (const char* bad : {"", "1 2 3", "1 2 3 4 5", "0 0 0 1", "0 0 1 -1", "a"})
        CHECK_FALSE(read_view_box(bad).has_value());
    CHECK(read_aspect("none")->is_free);
    CHECK(read_aspect("xMinYMax slice")->covers);
    CHECK(read_aspect("xMinYMax")->x == 0.0);
    CHECK(read_aspect("defer xMinYMax meet")->y == 1.0);
    for (const char* bad : {"", "middle", "xMinYMax grow", "xminymax"})
        CHECK_FALSE(read_aspect(bad).has_value());
}

TEST_CASE("styles: what is said last, and nearer to the element, goes before") {
    Style style;
    style.set_all("fill : none; stroke:red;;fill-rule:evenodd!important; display: none");
    CHECK(*style.is_filled == false);
    CHECK(*style.is_even_odd);
    CHECK_FALSE(*style.is_shown);
    CHECK_FALSE(style.is_visible.has_value());
    style.set_all("fill:#fff;display:inline;fill-rule:inherit");
    CHECK(*style.is_filled);
    CHECK(*style.is_shown);
    CHECK(*style.is_even_odd);

    // Neither capitals nor comments matter, and what is important stays.
    for (const char* none : {"fill:NONE", "FILL:none", "/*x*/fill:none", "fill:/* ; */none",
                             "fill:none!IMPORTANT;fill:red", "fill: Transparent"}) {
        CAPTURE(none);
        Style said;
        said.set_all(none);
        CHECK(*said.is_filled == false);
    }
    Style attribute;
    attribute.set("fill", "NONE/**/");
    CHECK(*attribute.is_filled == false);
    StyleSheet strict;
    REQUIRE(strict.add("path { fill: none !important } #a { fill: red }", &always));
    Style stays = strict.of("path", "a", "");
    CHECK(*stays.is_filled == false);
    Style own;
    own.set_all("fill: red");
    stays.override_by(own);
    CHECK(*stays.is_filled == false);
    own.set_all("fill: red !important");
    stays.override_by(own);
    CHECK(*stays.is_filled);

    StyleSheet sheet;
    const bool is_read = sheet.add(
        "/* a { fill: none } */ @import 'x'; @media print { path { fill: none } }"
        ".out, #two { fill: none } path.out { fill: red } g > path { display: none }"
        "* { visibility: hidden } rect { visibility: visible",
        &always);
    REQUIRE(is_read);
    CHECK(sheet.of("circle", "", "").is_filled == std::nullopt);
    CHECK(*sheet.of("circle", "", "x out").is_filled == false);
    CHECK(*sheet.of("path", "", "out").is_filled == true);
    CHECK(*sheet.of("path", "two", "out").is_filled == false);
    CHECK(sheet.of("path", "", "").is_shown == std::nullopt);
    CHECK(*sheet.of("path", "", "").is_visible == false);
    CHECK(*sheet.of("rect", "", "").is_visible);
    CHECK(sheet.left_out() == 1);
    StyleSheet more;
    REQUIRE(more.add("g path { stroke: red } a:hover, p[x], .b { fill: none }", &always));
    CHECK(more.left_out() == 2);
    CHECK(more.size() == 1);
}

TEST_CASE("style sheets: rules are counted, may be stopped, and are kept if they say something") {
    std::string text;
    for (int i = 0; i < 5000; ++i) text += ".c" + std::to_string(i) + "{stroke:red}";
    StyleSheet idle;
    REQUIRE(idle.add(text, &always));
    CHECK(idle.size() == 0);
    CHECK_FALSE(idle.add(text, [](double) { return false; }));
    for (int i = 0; i < 5000; ++i) text += ".c" + std::to_string(i) + ", #d{fill:none}";
    StyleSheet sheet;
    double most = 0.0;
    REQUIRE(sheet.add(text, [&](double bytes) {
        most = bytes;
        return true;
    }));
    CHECK(sheet.size() == 10000);
    CHECK(most > 0.8 * sheet.bytes());
    CHECK(sheet.bytes() > 10000.0 * sizeof(Style));
}

}  // namespace
}  // namespace raymo::drawings
