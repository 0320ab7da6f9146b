#include "raymo/sml/lexer.hpp"

#include <doctest/doctest.h>

namespace raymo::sml {
namespace {

struct Read {
    std::vector<Token> tokens;
    std::vector<Diagnostic> diagnostics;
};

Read read(std::string_view text) {
    Read out;
    Reporter reporter(out.diagnostics);
    Lexer lexer(text, 0, reporter);
    do {
        out.tokens.push_back(lexer.next());
    } while (out.tokens.back().kind != TokenKind::end);
    return out;
}

}  // namespace

TEST_CASE("lexer: a range is no decimal point, a method of a number neither") {
    const Read r = read("0..n 1.5 .5 1.max 0..<3");
    const std::vector<TokenKind> want{
        TokenKind::number, TokenKind::dot_dot,      TokenKind::name,   TokenKind::number,
        TokenKind::number, TokenKind::number,       TokenKind::dot,    TokenKind::name,
        TokenKind::number, TokenKind::dot_dot_less, TokenKind::number, TokenKind::end};
    REQUIRE(r.tokens.size() == want.size());
    for (std::size_t i = 0; i < want.size(); ++i) CHECK(r.tokens[i].kind == want[i]);
    CHECK(r.tokens[4].number == 0.5);
}

TEST_CASE("lexer: units stand at the number, `in` behind a blank is a word") {
    const Read r = read("12in 12 in 1e3mm 0.5turn");
    CHECK(r.tokens[0].number == doctest::Approx(304.8));
    CHECK(r.tokens[2].kind == TokenKind::kw_in);
    CHECK(r.tokens[3].number == 1000.0);
    CHECK(r.tokens[4].number == 180.0);
}

TEST_CASE("lexer: tokens know what stood before them") {
    const Read r = read("/// how wide\nparam w = 3 /// mm\nlet");
    CHECK(r.tokens[0].newline_before);
    CHECK(r.tokens[0].doc_before.end == 12);
    CHECK_FALSE(r.tokens[1].newline_before);
    CHECK(r.tokens[4].kind == TokenKind::kw_let);
    CHECK(r.tokens[4].doc_behind_previous.begin == 25);
}

TEST_CASE("lexer: texts that are not UTF-8 are found at their first wrong byte") {
    CHECK(first_invalid_utf8("abc \xC3\xA9 \xF0\x9F\x98\x80") == std::string_view::npos);
    CHECK(first_invalid_utf8("ab\xFF") == 2);
    CHECK(first_invalid_utf8("\xC0\x80") == 0);          // overlong
    CHECK(first_invalid_utf8("\xED\xA0\x80") == 0);      // surrogate
    CHECK(first_invalid_utf8("\xF4\x90\x80\x80") == 0);  // beyond U+10FFFF
    CHECK(first_invalid_utf8("a\xE2\x82") == 1);         // cut off
}

TEST_CASE("lexer: a string with an expression goes on behind it") {
    std::vector<Diagnostic> diagnostics;
    Reporter reporter(diagnostics);
    Lexer lexer("\"a${x}b\\n\"", 0, reporter);
    const Token head = lexer.next();
    CHECK(head.string_continues);
    CHECK(lexer.string_value(head) == "a");
    CHECK(lexer.next().kind == TokenKind::name);
    const Token brace = lexer.next();
    const Token tail = lexer.resume_string(brace.end);
    CHECK_FALSE(tail.string_continues);
    CHECK(lexer.string_value(tail) == "b\n");
    CHECK(diagnostics.empty());
}

}  // namespace raymo::sml
