#include "raymo/sml/parser.hpp"

#include <doctest/doctest.h>

#include "raymo/sml/sml.hpp"

namespace raymo::sml {
namespace {

std::vector<Diagnostic> errors_of(const std::string& text) {
    std::vector<Diagnostic> diagnostics;
    Reporter reporter(diagnostics);
    Ast ast;
    Symbols symbols;
    Parser parser(text, 0, ast, symbols, reporter);
    static_cast<void>(parser.program());
    return diagnostics;
}

}  // namespace

TEST_CASE("parser: the tree of a statement, with places") {
    CHECK(dump_ast("a", "let a = -b ^ 2 + f(1, k: x.y)\n") ==
          "block 0..29\n"
          "  let 0..29\n"
          "    binding 4..5 a\n"
          "    binary 8..29 +\n"
          "      minus 8..14\n"
          "        binary 9..14 ^\n"
          "          name 9..10 b\n"
          "          number 13..14 2\n"
          "      call 17..29\n"
          "        name 17..18 f\n"
          "        number 19..20 1\n"
          "        argument 22..28 k\n"
          "          member 25..28 y\n"
          "            name 25..26 x\n");
}

TEST_CASE("parser: any depth of brackets is an error, not a crash") {
    for (const char* opening :
         {"(", "[", "{a: ", "-", "not ", "f(", "if a then ", "fn(x) ", "\"${", "a ^ "}) {
        CAPTURE(opening);
        std::string text = "let a = ";
        for (int i = 0; i < 100000; ++i) text += opening;
        const auto errors = errors_of(text);
        REQUIRE_FALSE(errors.empty());
        CHECK(errors[0].error.code == ErrorCode::limit);
        CHECK(errors.size() < 5);
    }
}

TEST_CASE("parser: a block in a block in a block ...") {
    std::string text;
    for (int i = 0; i < 100000; ++i) text += "if a {\n";
    CHECK(errors_of(text)[0].error.code == ErrorCode::limit);
    std::string chain = "if a { } ";
    for (int i = 0; i < 100000; ++i) chain += "else if a { } ";
    CHECK(errors_of(chain)[0].error.code == ErrorCode::limit);
}

TEST_CASE("parser: a long sum is flat, a long chain of calls has a limit") {
    std::string sum = "let a = 1";
    for (int i = 0; i < 200000; ++i) sum += " + 1";
    CHECK(errors_of(sum).empty());
    std::string calls = "let a = b";
    for (int i = 0; i < 200000; ++i) calls += ".f()";
    CHECK(errors_of(calls)[0].error.code == ErrorCode::limit);
}

TEST_CASE("parser: at most a hundred errors") {
    std::string text;
    for (int i = 0; i < 1000; ++i) text += "let = 3\n";
    CHECK(errors_of(text).size() == Reporter::kMaxErrors);
}

}  // namespace raymo::sml
