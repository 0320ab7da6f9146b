// Text to tokens, one at a time: nothing is stored, so the length of a text costs no memory.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>

#include "raymo/sml/diagnostics.hpp"
#include "raymo/sml/token.hpp"

namespace raymo::sml {

/// Reads tokens from a text that is valid UTF-8 (see first_invalid_utf8). Lexical errors are reported where they stand
/// and reading goes on behind them.
class Lexer {
public:
    Lexer(std::string_view text, std::uint32_t file, Reporter& reporter);

    [[nodiscard]] Token next();
    /// Goes on inside a string behind the `}` that closed an interpolation and ended at `position`.
    [[nodiscard]] Token resume_string(std::uint32_t position);
    /// The characters that a string token stands for, escapes replaced.
    [[nodiscard]] std::string string_value(const Token& token) const;
    /// While quiet, errors are not reported: the text is being skipped.
    void set_quiet(bool quiet) { quiet_ = quiet; }
    /// Goes to the end of the line.
    void skip_line() {
        at_ = static_cast<std::uint32_t>(std::min(text_.find('\n', at_), text_.size()));
    }
    [[nodiscard]] std::string_view text() const { return text_; }

private:
    void skip_blanks(Token& token);
    void line_comment(Token& token, bool own_line);
    void block_comment();
    void number(Token& token);
    void string_body(Token& token);
    void escape();
    void word(Token& token);
    void mark(Token& token);
    void bad_character(Token& token);
    void error(std::uint32_t begin, std::uint32_t end, std::string message, std::string hint = {});

    [[nodiscard]] char peek(std::uint32_t ahead = 0) const {
        return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
    }
    [[nodiscard]] bool at_name_character(bool first, std::uint32_t& length) const;

    std::string_view text_;
    std::uint32_t file_;
    std::uint32_t at_ = 0;
    Reporter* reporter_;
    bool quiet_ = false;
};

/// Offset of the first byte that is not UTF-8, or npos.
[[nodiscard]] std::size_t first_invalid_utf8(std::string_view text);
/// Decodes the code point that begins at `at`; `length` gets its bytes. The text must be valid UTF-8.
[[nodiscard]] char32_t code_point(std::string_view text, std::size_t at, std::uint32_t& length);
void append_utf8(std::string& out, char32_t c);

/// Factor of a unit to mm or degrees; 0 when there is no such unit.
[[nodiscard]] double unit_factor(std::string_view unit);

}  // namespace raymo::sml
