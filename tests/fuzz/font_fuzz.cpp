// libFuzzer: whatever the bytes, a font is read or refused, and its letters are finite, closed curves.
#include <cstddef>
#include <cstdint>
#include <string>

#include "raymo/drawings/typeset.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace raymo;
    const auto font =
        drawings::Font::open("fuzz", std::string(reinterpret_cast<const char*>(data), size));
    if (!font) {
        if (font.error().message.empty()) __builtin_trap();
        return 0;
    }
    if (!((*font)->capital_height() > 0.0 && (*font)->line_height() > 0.0)) __builtin_trap();
    std::u32string text = U"AV\n";
    for (char32_t c = 0x20; c < 0x100; ++c) {
        if ((*font)->glyph_of(c) != 0) text += c;
    }
    int questions = 0;
    const auto set = drawings::typeset(**font, text, {}, [&] { return ++questions < 100; });
    for (std::uint32_t glyph = 0; glyph < 64; ++glyph) {
        bool is_new = false;
        const auto outline = (*font)->outline(glyph, 10.0, is_new);
        if (!outline || *outline == nullptr) continue;
        for (const curves::Curve& curve : (*outline)->curves) {
            if (!curve.closed || curve.spans.empty()) __builtin_trap();
            for (std::size_t i = 0; i < curve.spans.size(); ++i) {
                const curves::Span2& next = curve.spans[(i + 1) % curve.spans.size()];
                if (!(curve.spans[i].point(3) == next.point(0))) __builtin_trap();
                for (std::size_t k = 0; k < 4; ++k) {
                    if (!is_finite(curve.spans[i].point(k))) __builtin_trap();
                }
            }
        }
    }
    return 0;
}
