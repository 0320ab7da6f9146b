#include "raymo/sml/lexer.hpp"

#include <fmt/core.h>

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "raymo/sml/suggest.hpp"

namespace raymo::sml {
namespace {

struct Spelling {
    std::string_view text;
    TokenKind kind;
};

constexpr auto kKeywords = std::to_array<Spelling>({
#define TOKEN(kind, text)
#define KEYWORD(kind, text) {text, TokenKind::kind},
#define MARK(kind, text)
#include "raymo/sml/tokens.def"
#undef KEYWORD
#undef MARK
});
constexpr auto kMarks = std::to_array<Spelling>({
#define KEYWORD(kind, text)
#define MARK(kind, text) {text, TokenKind::kind},
#include "raymo/sml/tokens.def"
#undef KEYWORD
#undef MARK
#undef TOKEN
});

struct Unit {
    std::string_view name;
    double factor;
};
constexpr std::array<Unit, 9> kUnits{{{"mm", 1.0},
                                      {"cm", 10.0},
                                      {"m", 1000.0},
                                      {"in", 25.4},
                                      {"ft", 304.8},
                                      {"um", 0.001},
                                      {"deg", 1.0},
                                      {"rad", 180.0 / std::numbers::pi},
                                      {"turn", 360.0}}};

constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
constexpr bool is_ascii_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

struct CodeRange {
    char32_t first, last;
};
// Spaces, punctuation, signs and pictures: what is beyond ASCII and no letter.
constexpr auto kNoLetters = std::to_array<CodeRange>(
    {{0x80, 0xA9},     {0xAB, 0xB4},     {0xB6, 0xB9},       {0xBB, 0xBF},
     {0xD7, 0xD7},     {0xF7, 0xF7},     {0x2000, 0x206F},   {0x20A0, 0x20CF},
     {0x2190, 0x2BFF}, {0x2E00, 0x2E7F}, {0x3000, 0x3004},   {0x3008, 0x3020},
     {0xE000, 0xF8FF}, {0xFE00, 0xFE0F}, {0xFEFF, 0xFEFF},   {0xFF00, 0xFF0F},
     {0xFF1A, 0xFF20}, {0xFFF0, 0xFFFF}, {0x1F000, 0x1FAFF}, {0xE0000, 0x10FFFF}});

bool is_letter(char32_t c) {
    return std::none_of(kNoLetters.begin(), kNoLetters.end(),
                        [c](const CodeRange& r) { return r.first <= c && c <= r.last; });
}

std::string_view mend_of(char32_t c) {
    switch (c) {
        case 0x201C:
        case 0x201D:
        case 0x201E:
        case 0xAB:
        case 0xBB:
        case '\'':
        case 0x2018:
        case 0x2019:
            return "strings are written in straight double quotes: \"text\"";
        case 0x2212:
        case 0x2013:
        case 0x2014:
            return "write a plain minus: -";
        case 0xD7:
            return "write a product as a * b";
        case 0xF7:
            return "write a division as a / b";
        case 0xA0:
        case 0x3000:
            return "replace this special space by a plain one";
        case '#':
            return "comments begin with //";
        case '!':
            return "write `not a`, or `a != b`";
        case '|':
            return "write `or`; a union of solids is a + b";
        case '?':
            return "write `if c then a else b`";
        default:
            return {};
    }
}

}  // namespace

std::string_view describe(TokenKind kind) {
    static constexpr auto kTexts = std::to_array<std::string_view>({
#define TOKEN(kind, text) text,
#define KEYWORD(kind, text) "`" text "`",
#define MARK(kind, text) "`" text "`",
#include "raymo/sml/tokens.def"
#undef TOKEN
#undef KEYWORD
#undef MARK
    });
    return kTexts[static_cast<std::size_t>(kind)];
}

std::string_view kind_name(TokenKind kind) {
    static constexpr auto kNames = std::to_array<std::string_view>({
#define TOKEN(kind, text) #kind,
#define KEYWORD(kind, text) text,
#define MARK(kind, text) text,
#include "raymo/sml/tokens.def"
#undef TOKEN
#undef KEYWORD
#undef MARK
    });
    return kNames[static_cast<std::size_t>(kind)];
}

double unit_factor(std::string_view unit) {
    for (const Unit& u : kUnits) {
        if (u.name == unit) return u.factor;
    }
    return 0.0;
}

Lexer::Lexer(std::string_view text, std::uint32_t file, Reporter& reporter)
    : text_(text), file_(file), reporter_(&reporter) {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
}

void Lexer::error(std::uint32_t begin, std::uint32_t end, std::string message, std::string hint) {
    if (quiet_) return;
    reporter_->error(ErrorCode::syntax, {file_, begin, end}, std::move(message), std::move(hint));
}

bool Lexer::at_name_character(bool first, std::uint32_t& length) const {
    const char c = peek();
    length = 1;
    if (is_ascii_letter(c)) return true;
    if (is_digit(c)) return !first;
    if (static_cast<unsigned char>(c) < 0x80) return false;
    return is_letter(code_point(text_, at_, length));
}

void Lexer::line_comment(Token& token, bool own_line) {
    const std::uint32_t begin = at_;
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
    std::uint32_t end = at_;
    if (end > begin && text_[end - 1] == '\r') --end;
    if (end - begin < 3 || text_[begin + 2] != '/') {
        if (own_line) token.doc_before = {};
        return;
    }
    if (own_line) {
        token.doc_before = {token.doc_before.empty() ? begin : token.doc_before.begin, end};
    } else {
        token.doc_behind_previous = {begin, end};
    }
}

void Lexer::block_comment() {
    const std::uint32_t begin = at_;
    const std::size_t close = text_.find("*/", at_ + 2);
    if (close == std::string_view::npos) {
        error(begin, begin + 2, "the comment is not closed", "end it with */");
        at_ = static_cast<std::uint32_t>(text_.size());
        return;
    }
    at_ = static_cast<std::uint32_t>(close) + 2;
}

void Lexer::skip_blanks(Token& token) {
    token.newline_before = at_ == 0;
    while (at_ < text_.size()) {
        const char c = text_[at_];
        if (c == '\n') {
            // An empty line parts a documentation comment from what follows.
            std::uint32_t next = at_ + 1;
            while (next < text_.size() &&
                   (text_[next] == ' ' || text_[next] == '\t' || text_[next] == '\r')) {
                ++next;
            }
            if (next < text_.size() && text_[next] == '\n') token.doc_before = {};
            token.newline_before = true;
            ++at_;
        } else if (c == ' ' || c == '\t' || c == '\r') {
            ++at_;
        } else if (c == '/' && peek(1) == '/') {
            line_comment(token, token.newline_before);
        } else if (c == '/' && peek(1) == '*') {
            const std::uint32_t begin = at_;
            block_comment();
            if (text_.substr(begin, at_ - begin).find('\n') != std::string_view::npos) {
                token.newline_before = true;
            }
        } else {
            break;
        }
    }
}

void Lexer::number(Token& token) {
    std::string digits;
    const auto take_digits = [&] {
        while (is_digit(peek()) || (peek() == '_' && is_digit(peek(1)))) {
            if (peek() != '_') digits.push_back(peek());
            ++at_;
        }
    };
    take_digits();
    if (peek() == '.' && is_digit(peek(1))) {
        digits.push_back('.');
        ++at_;
        take_digits();
    }
    if (peek() == 'e' || peek() == 'E') {
        const bool signed_exponent = (peek(1) == '+' || peek(1) == '-') && is_digit(peek(2));
        if (signed_exponent || is_digit(peek(1))) {
            digits.push_back('e');
            ++at_;
            if (signed_exponent) {
                if (peek() == '-') digits.push_back('-');
                ++at_;
            }
            take_digits();
        }
    }
    const std::uint32_t unit_begin = at_;
    std::uint32_t length = 0;
    while (at_name_character(false, length)) at_ += length;
    double value = 0.0;
    const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    // Out of range is either an overflow or an underflow; only the first is an error.
    if (parsed.ec == std::errc::result_out_of_range) {
        const bool tiny = digits.find("e-") != std::string::npos || digits.front() == '0' ||
                          digits.front() == '.';
        value = tiny ? 0.0 : HUGE_VAL;
    }
    double factor = 1.0;
    if (unit_begin != at_) {
        const std::string_view unit = text_.substr(unit_begin, at_ - unit_begin);
        factor = unit_factor(unit);
        if (factor == 0.0) {
            Suggestion suggestion(unit);
            for (const Unit& u : kUnits) suggestion.consider(u.name);
            error(
                unit_begin, at_, fmt::format("unknown unit `{}`", shortened(unit)),
                suggestion.found() ? suggestion.hint() : "units are mm cm m in ft um deg rad turn");
            factor = 1.0;
        }
    }
    token.kind = TokenKind::number;
    token.number = value * factor;
    if (!std::isfinite(token.number)) {
        error(token.begin, at_, "the number is too large", "numbers go up to 1.7e308");
        token.number = 0.0;
    }
}

void Lexer::escape() {
    const std::uint32_t begin = at_;
    ++at_;
    switch (peek()) {
        case 'n':
        case 't':
        case '"':
        case '\\':
        case '$':
            ++at_;
            return;
        case 'u': {
            ++at_;
            char32_t value = 0;
            int digits = 0;
            bool good = peek() == '{';
            if (good) ++at_;
            while (good && std::isxdigit(static_cast<unsigned char>(peek())) != 0) {
                const char c = peek();
                const int digit = is_digit(c) ? c - '0' : (c | 0x20) - 'a' + 10;
                if (++digits <= 6) value = value * 16 + static_cast<char32_t>(digit);
                ++at_;
            }
            good = good && peek() == '}' && digits >= 1 && digits <= 6 && value <= 0x10FFFF &&
                   (value < 0xD800 || value > 0xDFFF);
            if (good) {
                ++at_;
                return;
            }
            error(begin, at_, "the escape is no Unicode character",
                  "write it in hexadecimal: \\u{e9} is é");
            return;
        }
        default: {
            std::uint32_t length = 0;
            if (at_ < text_.size() && peek() != '\n') {
                static_cast<void>(code_point(text_, at_, length));
                at_ += length;
            }
            error(begin, at_, "unknown escape in a string",
                  "escapes are \\n \\t \\\" \\\\ \\$ \\u{...}");
        }
    }
}

void Lexer::string_body(Token& token) {
    token.kind = TokenKind::string;
    token.string_continues = false;
    while (true) {
        if (at_ >= text_.size() || text_[at_] == '\n') {
            error(token.begin, token.begin + 1, "the string is not closed",
                  "end it with \" on the same line");
            break;
        }
        const char c = text_[at_];
        if (c == '"') {
            ++at_;
            break;
        }
        if (c == '$' && peek(1) == '{') {
            at_ += 2;
            token.string_continues = true;
            break;
        }
        if (c == '\\') {
            escape();
        } else {
            ++at_;
        }
    }
    token.end = at_;
}

std::string Lexer::string_value(const Token& token) const {
    std::string out;
    std::uint32_t i = token.begin + 1;  // behind the opening " or }
    while (i < token.end) {
        const char c = text_[i];
        if (c == '"' || (c == '$' && i + 1 < token.end && text_[i + 1] == '{')) break;
        if (c != '\\') {
            if (c != '\r') out.push_back(c);
            ++i;
            continue;
        }
        const char kind = i + 1 < token.end ? text_[i + 1] : '\0';
        i += 2;
        if (kind == 'n') {
            out.push_back('\n');
        } else if (kind == 't') {
            out.push_back('\t');
        } else if (kind == 'u') {
            std::uint32_t value = 0;
            const char* const begin = text_.data() + i + 1;
            const auto parsed = std::from_chars(begin, text_.data() + token.end, value, 16);
            if (i < token.end && text_[i] == '{' && parsed.ec == std::errc()) {
                append_utf8(out, static_cast<char32_t>(value & 0x1FFFFF));
                i = static_cast<std::uint32_t>(parsed.ptr - text_.data()) + 1;
            }
        } else if (kind != '\0') {
            out.push_back(kind);
        }
    }
    return out;
}

Token Lexer::resume_string(std::uint32_t position) {
    Token token;
    token.begin = position - 1;
    at_ = position;
    string_body(token);
    return token;
}

void Lexer::word(Token& token) {
    std::uint32_t length = 0;
    while (at_name_character(false, length)) at_ += length;
    const std::string_view text = text_.substr(token.begin, at_ - token.begin);
    token.kind = TokenKind::name;
    for (const Spelling& keyword : kKeywords) {
        if (keyword.text == text) token.kind = keyword.kind;
    }
}

void Lexer::bad_character(Token& token) {
    std::uint32_t length = 1;
    const char32_t c = code_point(text_, at_, length);
    at_ += length;
    token.kind = TokenKind::invalid;
    const std::string shown = c < 0x20 || c == 0x7F
                                  ? fmt::format("U+{:04X}", static_cast<std::uint32_t>(c))
                                  : std::string(text_.substr(token.begin, length));
    error(token.begin, at_, fmt::format("the character `{}` has no meaning here", shown),
          std::string(mend_of(c)));
}

void Lexer::mark(Token& token) {
    const std::string_view rest = text_.substr(at_);
    std::size_t best = 0;
    for (const Spelling& m : kMarks) {
        if (m.text.size() > best && rest.starts_with(m.text)) {
            best = m.text.size();
            token.kind = m.kind;
        }
    }
    if (best == 0) {
        bad_character(token);
        return;
    }
    at_ += static_cast<std::uint32_t>(best);
}

Token Lexer::next() {
    Token token;
    skip_blanks(token);
    token.begin = at_;
    std::uint32_t length = 0;
    if (at_ >= text_.size()) {
        token.kind = TokenKind::end;
        token.newline_before = true;
    } else if (is_digit(peek()) || (peek() == '.' && is_digit(peek(1)))) {
        number(token);
    } else if (peek() == '"') {
        ++at_;
        string_body(token);
    } else if (at_name_character(true, length)) {
        word(token);
    } else {
        mark(token);
    }
    token.end = at_;
    return token;
}

}  // namespace raymo::sml
