// Tokens to nodes, by recursive descent. After an error the rest of the statement is skipped, so that every independent
// error of a text is reported. Nesting is limited to kMaxNesting, the number of nodes to kMaxNodes: no text, however
// long, exhausts stack or memory.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "raymo/sml/ast.hpp"
#include "raymo/sml/lexer.hpp"

namespace raymo::sml {

inline constexpr int kMaxNesting = 200;
inline constexpr std::size_t kMaxNodes = 20'000'000;

class Parser {
public:
    Parser(std::string_view text, std::uint32_t file, Ast& ast, Symbols& symbols,
           Reporter& reporter);

    /// The whole text: a block.
    [[nodiscard]] NodeId program();
    /// The whole text: one expression; for parameters given from outside.
    [[nodiscard]] NodeId lone_expression();

private:
    // Counts nesting; false past the limit (reported once).
    class Nesting {
    public:
        explicit Nesting(Parser& parser) : parser_(parser) { ++parser_.nesting_; }
        ~Nesting() { --parser_.nesting_; }
        Nesting(const Nesting&) = delete;
        Nesting& operator=(const Nesting&) = delete;
        [[nodiscard]] bool too_deep() const;

    private:
        Parser& parser_;
    };
    // Inside brackets a new line does not end a statement; inside a block it does again. In both, `in` is an
    // operator, whatever it is around them.
    class Lines {
    public:
        Lines(Parser& parser, bool end_statements)
            : parser_(parser),
              before_(parser.lines_end_statements_),
              in_before_(parser.in_is_operator_) {
            parser_.lines_end_statements_ = end_statements;
            parser_.in_is_operator_ = true;
        }
        ~Lines() {
            parser_.lines_end_statements_ = before_;
            parser_.in_is_operator_ = in_before_;
        }
        Lines(const Lines&) = delete;
        Lines& operator=(const Lines&) = delete;

    private:
        Parser& parser_;
        bool before_;
        bool in_before_;
    };

    // Statements (parser_stmt.cpp)
    void statements(std::vector<NodeId>& out, TokenKind closing);
    void stray_bracket();
    NodeId statement();
    NodeId block();
    NodeId declaration(NodeKind kind);
    NodeId function_statement();
    NodeId if_statement();
    NodeId for_statement();
    NodeId while_statement();
    NodeId param_statement();
    NodeId named_value(NodeKind kind);
    NodeId import_statement();
    NodeId import_names_statement();
    NodeId simple_statement();
    NodeId pattern();
    NodeId binding();
    void end_of_statement();
    void skip_statement(int brackets, std::size_t indent);
    [[nodiscard]] std::size_t indent_of(std::uint32_t offset) const;
    [[nodiscard]] static bool begins_statement(TokenKind kind);

    // Expressions (parser_expr.cpp), from the loosest to the tightest
    NodeId expression();
    NodeId logical(bool is_or);
    NodeId negation();
    NodeId comparison();
    NodeId membership();
    NodeId range();
    NodeId chain(int level);
    NodeId unary();
    NodeId power();
    NodeId postfix();
    NodeId postfix_step(NodeId receiver);
    NodeId primary();
    NodeId bracketed();
    NodeId list_or_comprehension();
    NodeId clauses(std::uint32_t begin);
    NodeId record();
    NodeId string();
    NodeId choice();
    NodeId lambda();
    NodeId function_body(std::uint32_t begin, Symbol name);
    void arguments(std::vector<NodeId>& out);

    // Tokens
    void advance();
    [[nodiscard]] bool at(TokenKind kind) const { return token_.kind == kind; }
    /// True when the next token goes on with the expression before it.
    [[nodiscard]] bool continues() const {
        return !(lines_end_statements_ && token_.newline_before);
    }
    bool accept(TokenKind kind);
    /// Reports "expected X ..., found Y" unless the token is there.
    bool expect(TokenKind kind, std::string_view where);
    bool expect_closing(TokenKind kind, const Token& opening);
    void unexpected(std::string_view expected, std::string hint = {});
    void error(std::uint32_t begin, std::uint32_t end, std::string message, std::string hint = {});
    [[nodiscard]] std::string found() const;
    [[nodiscard]] Symbol symbol_of(const Token& token);

    // Nodes
    NodeId make(NodeKind kind, std::uint32_t begin, std::initializer_list<NodeId> children = {});
    NodeId make(NodeKind kind, std::uint32_t begin, const std::vector<NodeId>& children);
    NodeId make_range(NodeKind kind, std::uint32_t begin, const NodeId* children,
                      std::size_t count);
    NodeId invalid();

    Lexer lexer_;
    std::uint32_t file_;
    Ast& ast_;
    Symbols& symbols_;
    Reporter& reporter_;
    Token token_;
    std::uint32_t previous_end_ = 0;
    int nesting_ = 0;
    int open_brackets_ = 0;              ///< ( [ { read and not closed yet
    std::uint32_t statement_begin_ = 0;  ///< of the statement that is read
    bool lines_end_statements_ = true;
    bool in_is_operator_ = true;  ///< not behind a param's default, where `in` begins its limits
    bool in_error_ =
        false;              ///< the statement has an error already: the rest of it says nothing new
    bool stopped_ = false;  ///< a limit was passed: nothing more is read
};

}  // namespace raymo::sml
