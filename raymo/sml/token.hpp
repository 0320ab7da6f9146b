// The words of the language.
#pragma once

#include <cstdint>
#include <string_view>

namespace raymo::sml {

enum class TokenKind : std::uint8_t {
#define TOKEN(kind, text) kind,
#define KEYWORD(kind, text) kind,
#define MARK(kind, text) kind,
#include "raymo/sml/tokens.def"
#undef TOKEN
#undef KEYWORD
#undef MARK
};

/// As shown in messages: "`let`", "a name".
[[nodiscard]] std::string_view describe(TokenKind kind);
/// The enumerator, for dumps.
[[nodiscard]] std::string_view kind_name(TokenKind kind);

/// A range of bytes of a text; empty when begin == end.
struct TextRange {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    [[nodiscard]] constexpr bool empty() const { return begin == end; }
};

struct Token {
    TokenKind kind = TokenKind::end;
    bool newline_before = false;    ///< first on its line
    bool string_continues = false;  ///< string: an interpolation `${` follows
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    double number = 0.0;            ///< number: value in mm or degrees
    TextRange doc_before;           ///< `///` lines directly above
    TextRange doc_behind_previous;  ///< `///` at the end of the line of the token before this one
};

}  // namespace raymo::sml
