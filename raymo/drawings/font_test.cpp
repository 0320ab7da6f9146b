#include "raymo/drawings/font.hpp"

#include <doctest/doctest.h>
#include <ft2build.h>
#include FT_FREETYPE_H

#include <cmath>

#include "raymo/curves/region.hpp"
#include "raymo/drawings/test_fonts.hpp"

namespace raymo::drawings {
namespace {

FontPtr sans() { return *Font::open("DejaVu Sans", dejavu()); }

double area_of(const curves::Outline& outline) {
    return (*curves::Region::make(outline, {}, 1.0))->signed_area();
}

/// The area within the glyph by its points as the file has them: between two points off the curve the middle is on it, and
/// each parabola is cut into `parts` chords.
class Polygonised {
public:
    Polygonised() {
        REQUIRE(FT_Init_FreeType(&library_) == 0);
        REQUIRE(FT_New_Memory_Face(library_, reinterpret_cast<const FT_Byte*>(bytes_.data()),
                                   static_cast<FT_Long>(bytes_.size()), 0, &face_) == 0);
    }
    ~Polygonised() { FT_Done_FreeType(library_); }
    double area(std::uint32_t glyph, int parts) {
        REQUIRE(FT_Load_Glyph(face_, glyph, FT_LOAD_NO_SCALE) == 0);
        const FT_Outline& drawn = face_->glyph->outline;
        double twice = 0.0;
        int first = 0;
        for (int c = 0; c < drawn.n_contours; ++c) {
            const int end = drawn.contours[c] + 1;
            std::vector<Vec2> on;  // points on the curve, with the parabolas' controls between them
            const auto point = [&](int i) {
                const FT_Vector& p = drawn.points[first + (i - first) % (end - first)];
                return Vec2{static_cast<double>(p.x), static_cast<double>(p.y)};
            };
            const auto is_on = [&](int i) {
                return (drawn.tags[first + (i - first) % (end - first)] & 1) != 0;
            };
            std::vector<Vec2> polygon;
            for (int i = first; i < end; ++i) {
                if (is_on(i)) {
                    polygon.push_back(point(i));
                    continue;
                }
                const int before = i == first ? end - 1 : i - 1;
                const Vec2 a = is_on(before) ? point(before) : 0.5 * (point(before) + point(i));
                const Vec2 b = is_on(i + 1) ? point(i + 1) : 0.5 * (point(i + 1) + point(i));
                for (int k = 0; k < parts; ++k) {
                    const double u = static_cast<double>(k) / parts;
                    polygon.push_back((1 - u) * (1 - u) * a + 2 * u * (1 - u) * point(i) +
                                      u * u * b);
                }
            }
            for (std::size_t i = 0; i < polygon.size(); ++i)
                twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
            first = end;
        }
        return 0.5 * twice;
    }

private:
    std::string bytes_ = dejavu();
    FT_Library library_ = nullptr;
    FT_Face face_ = nullptr;
};

TEST_CASE("the areas of all letters are the limits of those of polygons") {
    const FontPtr font = sans();
    Polygonised polygonised;
    int curved = 0;
    for (char32_t c = 0x21; c < 0x250; ++c) {
        const std::uint32_t glyph = font->glyph_of(c);
        if (glyph == 0) continue;
        bool is_new = false;
        const auto outline = *font->outline(glyph, 1493.0, is_new);
        if (outline == nullptr) continue;
        CAPTURE(static_cast<std::uint32_t>(c));
        const double exact = area_of(*outline);
        // The area between a parabola and n chords falls as 1 / n^2, exactly.
        const double coarse = polygonised.area(glyph, 1);
        const double fine = polygonised.area(glyph, 10);
        CHECK(exact == doctest::Approx((100.0 * fine - coarse) / 99.0).epsilon(1e-11));
        curved += std::fabs(exact - coarse) > 1.0 ? 1 : 0;
    }
    CHECK(curved > 200);
}

TEST_CASE("a font is in its own units: capitals, widths and kerning") {
    const FontPtr font = sans();
    CHECK(font->em() == 2048.0);
    CHECK(font->capital_height() == 1493.0);
    CHECK(font->line_height() > font->em());
    const std::uint32_t a = font->glyph_of(U'A');
    const std::uint32_t v = font->glyph_of(U'V');
    CHECK(*font->advance(a) == 1401.0);
    CHECK(font->kerning(a, v) < 0.0);
    const std::uint32_t h = font->glyph_of(U'H');
    CHECK(font->kerning(h, h) == 0.0);
    CHECK(font->glyph_of(U'\u4e00') == 0);
    CHECK_FALSE(font->advance(70000).has_value());
}

TEST_CASE("equal letters of one size are one outline while somebody holds it") {
    const FontPtr font = sans();
    const std::uint32_t g = font->glyph_of(U'g');
    bool is_new = false;
    auto first = *font->outline(g, 0.01, is_new);
    CHECK(is_new);
    CHECK(first->fill == curves::Fill::non_zero);
    CHECK(*font->outline(g, 0.01, is_new) == first);
    CHECK_FALSE(is_new);
    CHECK(*font->outline(g, 0.02, is_new) != first);
    CHECK(area_of(**font->outline(g, 0.02, is_new)) ==
          doctest::Approx(4.0 * area_of(*first)).epsilon(1e-13));
    for (int i = 0; i < 1000; ++i) CHECK(font->outline(g, 1.0 + i, is_new).has_value());
    first.reset();
    static_cast<void>(font->outline(g, 0.01, is_new));
    CHECK(is_new);
    CHECK(*font->outline(font->glyph_of(U' '), 0.01, is_new) == nullptr);
}

TEST_CASE("a letter in many sizes that are all held takes time in proportion") {
    // Looking at all sizes for each new one would take minutes for these.
    const FontPtr font = sans();
    const std::uint32_t dot = font->glyph_of(U'.');
    constexpr int kSizes = 100000;
    std::vector<curves::OutlinePtr> held;
    bool is_new = false;
    for (int i = 1; i <= kSizes; ++i) held.push_back(*font->outline(dot, i, is_new));
    for (int i = 1; i <= kSizes; i += 997) {
        CHECK(*font->outline(dot, i, is_new) == held[static_cast<std::size_t>(i - 1)]);
        CHECK_FALSE(is_new);
    }
}

TEST_CASE("every curve of a letter ends exactly where the next begins") {
    const FontPtr font = sans();
    for (char32_t c = 0x21; c < 0x7f; ++c) {
        bool is_new = false;
        const auto outline = *font->outline(font->glyph_of(c), 0.0048828125 * 0.7, is_new);
        for (const curves::Curve& curve : outline->curves) {
            CHECK(curve.closed);
            for (std::size_t i = 0; i < curve.spans.size(); ++i)
                CHECK(curve.spans[i].point(3) ==
                      curve.spans[(i + 1) % curve.spans.size()].point(0));
        }
    }
}

TEST_CASE("what is no font is an error, and so is one that is cut off") {
    for (const std::string& bytes :
         {std::string(), std::string("no font"), std::string(100, '\0'), dejavu().substr(0, 300)}) {
        const auto opened = Font::open("x.ttf", bytes);
        REQUIRE_FALSE(opened.has_value());
        CHECK(opened.error().message.starts_with("the font \"x.ttf\" "));
    }
    CHECK_FALSE(Font::open("x", dejavu(), 7).has_value());
    // Cut off among the glyphs: the tables lie behind each other.
    const std::string whole = dejavu();
    for (std::size_t size = 400; size < whole.size(); size = size * 3 / 2) {
        auto opened = Font::open("x", whole.substr(0, size));
        if (!opened) continue;
        for (std::uint32_t glyph = 0; glyph < 200; ++glyph) {
            bool is_new = false;
            static_cast<void>((*opened)->outline(glyph, 1.0, is_new));
        }
    }
}

}  // namespace
}  // namespace raymo::drawings
