#include "raymo/drawings/typeset.hpp"

#include <doctest/doctest.h>

#include "raymo/drawings/test_fonts.hpp"

namespace raymo::drawings {
namespace {

FontPtr sans() { return *Font::open("DejaVu Sans", dejavu()); }
bool always() { return true; }

SetText set(Font& font, std::u32string_view text, TextStyle style = {}) {
    return *typeset(font, text, style, &always);
}

TEST_CASE("capitals are as high as the size, and stand on the base line") {
    const FontPtr font = sans();
    const Box2 box = curves::box_of(set(*font, U"H", {.size = 7.0}).contour);
    CHECK(box.lo.y == 0.0);
    CHECK(box.hi.y == 7.0);
}

TEST_CASE("letters stand apart by their widths and kerning, times the spacing") {
    const FontPtr font = sans();
    const double unit = 10.0 / 1493.0;
    const auto x = [&](const SetText& set) { return set.contour->operands[1]->at.x / unit; };
    CHECK(x(set(*font, U"HH")) == doctest::Approx(1540.0).epsilon(1e-14));
    const double kern = font->kerning(font->glyph_of(U'A'), font->glyph_of(U'V'));
    CHECK(x(set(*font, U"AV")) == doctest::Approx(1401.0 + kern).epsilon(1e-14));
    CHECK(x(set(*font, U"HH", {.spacing = 1.5})) == doctest::Approx(2310.0).epsilon(1e-14));
    CHECK(set(*font, U"HH").width == doctest::Approx(3080.0 * unit).epsilon(1e-14));
    CHECK(set(*font, U"H\tH").width == doctest::Approx(set(*font, U"H    H").width).epsilon(1e-14));
}

TEST_CASE("lines are aligned by what their pens go, and follow each other downwards") {
    const FontPtr font = sans();
    for (const Align align : {Align::left, Align::centre, Align::right}) {
        const SetText made =
            set(*font, U"HHHH\nH\r\n\nHH", {.size = 5, .line_spacing = 2, .align = align});
        REQUIRE(made.contour->operands.size() == 7);
        const double h = set(*font, U"H", {.size = 5}).width;
        const double part = align == Align::left ? 0.0 : align == Align::centre ? 0.5 : 1.0;
        const auto at = [&](std::size_t i) { return made.contour->operands[i]->at; };
        CHECK(at(0).x == doctest::Approx(-4.0 * h * part));
        CHECK(at(4).x == doctest::Approx(-h * part));
        CHECK(at(5).x == doctest::Approx(-2.0 * h * part));
        const double line = 2.0 * font->line_height() * 5.0 / font->capital_height();
        CHECK(at(0).y == 0.0);
        CHECK(at(4).y == doctest::Approx(-line));
        CHECK(at(5).y == doctest::Approx(-3.0 * line));
        CHECK(made.width == doctest::Approx(4.0 * h));
    }
}

TEST_CASE("equal letters are one outline, whatever the text, and what is made is counted once") {
    const FontPtr font = sans();
    const SetText first = set(*font, U"abab");
    const auto& letters = first.contour->operands;
    CHECK(letters[0]->outline == letters[2]->outline);
    const SetText second = set(*font, U"ba");
    CHECK(second.contour->operands[1]->outline == letters[0]->outline);
    CHECK(first.bytes == curves::bytes_of(first.contour));
    CHECK(second.bytes < curves::bytes_of(second.contour));
    CHECK(set(*font, U"a").contour->outline == letters[0]->outline);
}

TEST_CASE("what shows nothing is no contour") {
    const FontPtr font = sans();
    for (const std::u32string_view text : {U"", U" ", U"\n\n", U" \t "})
        CHECK(set(*font, text).contour == nullptr);
    CHECK(set(*font, U"  ").width > 0.0);
    CHECK(set(*font, U"").width == 0.0);
    // Not even where the font has a glyph for it.
    CHECK(font->glyph_of(0xad) != 0);
    CHECK(set(*font, U"\u00ad\u200d\r").contour == nullptr);
    CHECK(set(*font, U"\u05d0").is_backwards);
    CHECK(set(*font, U"a\u0644").is_backwards);
    CHECK_FALSE(set(*font, U"\u0416\u00e9").is_backwards);
    CHECK(set(*font, U"A\u00adV").width == set(*font, U"AV").width);
}

TEST_CASE("errors name the character, the style and the font") {
    const FontPtr font = sans();
    const auto missing = typeset(*font, U"ab\u4e00", {}, &always);
    REQUIRE_FALSE(missing.has_value());
    CHECK(missing.error().message == "the font \"DejaVu Sans\" has no character U+4E00");
    CHECK(missing.error().label == "this has it as character 3");
    CHECK(missing.error().argument == 0);
    CHECK(typeset(*font, U"\U000F1234", {}, &always).error().message ==
          "the font \"DejaVu Sans\" has no character U+F1234");
    for (const double size : {0.0, -1.0, 1e61, 1e-61, std::nan("")}) {
        const auto made = typeset(*font, U"a", {.size = size}, &always);
        REQUIRE_FALSE(made.has_value());
        CHECK(made.error().argument == 1);
    }
    CHECK(typeset(*font, U"a", {.spacing = -1.0}, &always).error().argument == 2);
    CHECK(typeset(*font, U"a", {.line_spacing = 1e7}, &always).error().argument == 3);
    CHECK(typeset(*font, U"a", {}, [] { return false; }).error().code == ErrorCode::cancelled);
}

}  // namespace
}  // namespace raymo::drawings
