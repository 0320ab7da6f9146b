#include "raymo/sml/sml.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <memory>

#include "raymo/sml/evaluate.hpp"
#include "raymo/sml/parser.hpp"
#include "raymo/sml/program.hpp"

namespace raymo::sml {
namespace {

// A documentation comment without its slashes, lines joined.
std::string doc_text(std::string_view text) {
    std::string out;
    while (!text.empty()) {
        const std::size_t newline = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, newline);
        text.remove_prefix(std::min(newline + 1, text.size()));
        const std::size_t begin = line.find_first_not_of("/ \t\r");
        if (begin == std::string_view::npos) continue;
        const std::size_t end = line.find_last_not_of(" \t\r");
        if (!out.empty()) out += ' ';
        out += line.substr(begin, end + 1 - begin);
    }
    return out;
}

void collect_parameters(const Program& program, Outcome& outcome) {
    const Module& main = program.modules[0];
    if (main.root == kNoNode) return;
    for (const NodeId id : program.ast.children_of(program.ast[main.root])) {
        const Node& n = program.ast[id];
        if (n.kind != NodeKind::param) continue;
        const Node& name = program.ast[program.ast.child(n, 0)];
        std::string doc;
        for (const DocOf& d : program.ast.docs) {
            if (d.node != id) continue;
            doc = doc_text(std::string_view(outcome.sources[n.file].text)
                               .substr(d.text.begin, d.text.end - d.text.begin));
        }
        outcome.parameters.push_back({program.symbols.text(name.symbol), std::move(doc), n.span()});
    }
}

// Errors in the order of the texts. Warnings of the run stay where they are: before the error that ended it.
void order_by_place(std::vector<Diagnostic>& diagnostics) {
    std::stable_sort(diagnostics.begin(), diagnostics.end(),
                     [](const Diagnostic& a, const Diagnostic& b) {
                         const SourceSpan x = a.error.where;
                         const SourceSpan y = b.error.where;
                         return x.file != y.file ? x.file < y.file : x.begin < y.begin;
                     });
}

Outcome read(std::string path, std::string text, const Host& host, bool runs) {
    Outcome outcome;
    Reporter reporter(outcome.diagnostics);
    Program program;
    load(program, std::move(path), std::move(text), host, outcome.sources, reporter);
    resolve(program, outcome.sources, reporter);
    order_by_place(outcome.diagnostics);
    collect_parameters(program, outcome);
    outcome.ok = reporter.errors() == 0;
    if (!outcome.ok || !runs) return outcome;
    make_formulas(program);
    outcome.ok = Evaluator(program, host, outcome, reporter).run();
    if (!outcome.ok) outcome.scene = {};
    return outcome;
}

}  // namespace

Outcome evaluate(std::string path, std::string text, const Host& host) {
    return read(std::move(path), std::move(text), host, true);
}

Outcome check(std::string path, std::string text, const Host& host) {
    return read(std::move(path), std::move(text), host, false);
}

std::string dump_tokens(std::string_view text) {
    if (first_invalid_utf8(text) != std::string_view::npos) return "not a text in UTF-8\n";
    std::vector<Diagnostic> diagnostics;
    Reporter reporter(diagnostics);
    Lexer lexer(text, 0, reporter);
    std::string out;
    std::size_t line = 1;
    std::size_t line_begin = 0;
    std::size_t counted = 0;
    // Braces that are open inside each ${ of a string, to find the one that closes it.
    std::vector<int> interpolations;
    Token token = lexer.next();
    while (token.kind != TokenKind::end) {
        for (; counted < token.begin; ++counted) {
            if (text[counted] != '\n') continue;
            ++line;
            line_begin = counted + 1;
        }
        const auto column =
            1 + std::count_if(text.begin() + static_cast<long>(line_begin),
                              text.begin() + static_cast<long>(token.begin), [](char c) {
                                  return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
                              });
        const std::string_view shown = text.substr(token.begin, token.end - token.begin);
        out += fmt::format("{}:{} {} {}\n", line, column, kind_name(token.kind), shown);
        if (token.kind == TokenKind::string && token.string_continues) {
            interpolations.push_back(0);
        } else if (token.kind == TokenKind::open_brace && !interpolations.empty()) {
            ++interpolations.back();
        } else if (token.kind == TokenKind::close_brace && !interpolations.empty() &&
                   interpolations.back()-- == 0) {
            interpolations.pop_back();
            token = lexer.resume_string(token.end);
            continue;
        }
        token = lexer.next();
    }
    return out;
}

std::string dump_ast(std::string path, std::string text) {
    std::vector<Diagnostic> diagnostics;
    Reporter reporter(diagnostics);
    if (text.size() > kMaxTextBytes || first_invalid_utf8(text) != std::string_view::npos) {
        return fmt::format("{}: not a text in UTF-8\n", path);
    }
    Ast ast;
    Symbols symbols;
    Parser parser(text, 0, ast, symbols, reporter);
    return dump(ast, parser.program(), symbols);
}

}  // namespace raymo::sml
