#include "raymo/drawings/typeset.hpp"

#include <array>
#include <charconv>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "raymo/core/shown.hpp"

namespace raymo::drawings {
namespace {

constexpr std::size_t kCharactersAtATime = 1024;

Failure wrong(int argument, std::string message, std::string label, std::string hint = {}) {
    return Failure(Error{ErrorCode::out_of_range,
                         std::move(message),
                         std::move(label),
                         std::move(hint),
                         argument,
                         {}});
}

Result<void> check(const TextStyle& style) {
    // Written so that NaN fails too.
    if (!(style.size > 0.0))
        return wrong(1, "the size must be greater than 0", "this is " + shown(style.size));
    if (!(style.size >= 1e-60 && style.size <= 1e60))
        return wrong(1, "the size must be between 1e-60 and 1e60", "this is " + shown(style.size));
    const std::array factors{std::pair{2, style.spacing}, std::pair{3, style.line_spacing}};
    for (const auto& [argument, factor] : factors) {
        if (!(factor >= 0.0 && factor <= 1e6))
            return wrong(argument, "the spacing must be from 0 to 1000000",
                         "this is " + shown(factor), "1 is what the font says");
    }
    return {};
}

/// "U+00E9": at least four digits.
std::string name_of(char32_t c) {
    std::array<char, 16> digits{};
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(),
                                   static_cast<std::uint32_t>(c), 16)
                         .ptr;
    std::string out(digits.data(), end);
    for (char& digit : out) {
        if (digit >= 'a') digit = static_cast<char>(digit - 'a' + 'A');
    }
    return "U+" + std::string(out.size() < 4 ? 4 - out.size() : 0, '0') + out;
}

/// Characters that show nothing, whatever the font has for them: a soft hyphen shows only where a line is broken.
bool is_ignorable(char32_t c) {
    return c == U'\r' || c == 0xAD || (c >= 0x200B && c <= 0x200F) ||
           (c >= 0x202A && c <= 0x202E) || (c >= 0x2060 && c <= 0x2064) ||
           (c >= 0xFE00 && c <= 0xFE0F) || c == 0xFEFF;
}

/// Hebrew, Arabic and what stands between them in Unicode, with the forms of their letters.
bool runs_leftwards(char32_t c) {
    return (c >= 0x0590 && c <= 0x08FF) || (c >= 0xFB1D && c <= 0xFDFF) ||
           (c >= 0xFE70 && c <= 0xFEFC);
}

class Setter {
public:
    Setter(Font& font, const TextStyle& style)
        : font_(font), style_(style), scale_(style.size / font.capital_height()) {}

    Result<void> add(char32_t c, std::size_t number) {
        if (c == U'\n') {
            finish_line();
            return {};
        }
        if (is_ignorable(c)) return {};
        const std::uint32_t glyph = font_.glyph_of(c == U'\t' ? U' ' : c);
        if (glyph == 0) {
            return Failure(Error{ErrorCode::bad_argument,
                                 "the font \"" + font_.name() + "\" has no character " + name_of(c),
                                 "this has it as character " + std::to_string(number + 1),
                                 "leave it out, or choose another font with `font:`",
                                 0,
                                 {}});
        }
        made_.is_backwards = made_.is_backwards || runs_leftwards(c);
        const auto advance = font_.advance(glyph);
        if (!advance) return blame_font(advance.error());
        if (previous_ != 0) pen_ += font_.kerning(previous_, glyph);
        bool is_new = false;
        auto outline = font_.outline(glyph, style_.size, is_new);
        if (!outline) return blame_font(outline.error());
        if (is_new) made_.bytes += curves::bytes_of(**outline);
        if (*outline != nullptr) line_.push_back({*std::move(outline), pen_});
        pen_ += *advance * style_.spacing * (c == U'\t' ? 4.0 : 1.0);
        previous_ = glyph;
        return {};
    }

    SetText take() {
        finish_line();
        if (letters_.empty()) return std::move(made_);
        for (const curves::Contour& letter : letters_) made_.bytes += curves::bytes_of(*letter);
        const bool is_many = letters_.size() > 1;
        made_.contour = curves::combined(curves::ContourOp::unite, std::move(letters_));
        if (is_many) made_.bytes += curves::bytes_of(*made_.contour);
        return std::move(made_);
    }

private:
    struct Letter {
        curves::OutlinePtr outline;
        double x;  ///< in units of the font, from the beginning of the line
    };

    static Failure blame_font(Error error) {
        error.argument = 4;
        return Failure(std::move(error));
    }
    void finish_line() {
        const double start = style_.align == Align::left     ? 0.0
                             : style_.align == Align::centre ? -0.5 * pen_
                                                             : -pen_;
        const double y = -lines_ * font_.line_height() * style_.line_spacing * scale_;
        for (Letter& letter : line_)
            letters_.push_back(
                curves::contour_of(std::move(letter.outline), {(start + letter.x) * scale_, y}));
        line_.clear();
        made_.width = std::max(made_.width, pen_ * scale_);
        pen_ = 0.0;
        previous_ = 0;
        ++lines_;
    }

    Font& font_;
    const TextStyle& style_;
    double scale_;
    double pen_ = 0.0;
    double lines_ = 0.0;
    std::uint32_t previous_ = 0;
    std::vector<Letter> line_;
    std::vector<curves::Contour> letters_;
    SetText made_;
};

}  // namespace

Result<SetText> typeset(Font& font, std::u32string_view text, const TextStyle& style,
                        const std::function<bool()>& go_on) {
    if (auto checked = check(style); !checked) return Failure(std::move(checked).error());
    Setter setter(font, style);
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (i % kCharactersAtATime == 0 && !go_on()) return fail(ErrorCode::cancelled, "stopped");
        if (auto added = setter.add(text[i], i); !added) return Failure(std::move(added).error());
    }
    return setter.take();
}

}  // namespace raymo::drawings
