// What expressions begin with: literals, brackets, lists, records, strings, choices and functions.

#include <fmt/core.h>

#include "raymo/sml/parser.hpp"

namespace raymo::sml {

NodeId Parser::primary() {
    const std::uint32_t begin = token_.begin;
    switch (token_.kind) {
        case TokenKind::number: {
            const double value = token_.number;
            advance();
            const NodeId node = make(NodeKind::number, begin);
            ast_[node].number = value;
            return node;
        }
        case TokenKind::string:
            return string();
        case TokenKind::kw_true:
        case TokenKind::kw_false: {
            const bool value = at(TokenKind::kw_true);
            advance();
            const NodeId node = make(NodeKind::boolean, begin);
            ast_[node].flag = value;
            return node;
        }
        case TokenKind::kw_nothing:
            advance();
            return make(NodeKind::nothing, begin);
        case TokenKind::name: {
            const Symbol symbol = symbol_of(token_);
            advance();
            const NodeId node = make(NodeKind::name, begin);
            ast_[node].symbol = symbol;
            return node;
        }
        case TokenKind::open_paren:
            return bracketed();
        case TokenKind::open_bracket:
            return list_or_comprehension();
        case TokenKind::open_brace:
            return record();
        case TokenKind::kw_if:
            return choice();
        case TokenKind::kw_fn:
            return lambda();
        case TokenKind::kw_let:
        case TokenKind::kw_for:
        case TokenKind::kw_while:
        default:
            unexpected("an expression");
            return invalid();
    }
}

NodeId Parser::bracketed() {
    const Token opening = token_;
    const Lines lines(*this, false);
    advance();
    if (at(TokenKind::close_paren)) {
        unexpected("an expression", "an empty list is []");
        return invalid();
    }
    const NodeId first = expression();
    if (!at(TokenKind::comma)) {
        expect_closing(TokenKind::close_paren, opening);
        ast_[first].begin = opening.begin;
        ast_[first].end = previous_end_;
        return first;
    }
    std::vector<NodeId> elements{first};
    while (accept(TokenKind::comma) && !at(TokenKind::close_paren) && !in_error_) {
        elements.push_back(expression());
    }
    expect_closing(TokenKind::close_paren, opening);
    return make(NodeKind::vector, opening.begin, elements);
}

NodeId Parser::list_or_comprehension() {
    const Token opening = token_;
    const Lines lines(*this, false);
    advance();
    if (at(TokenKind::kw_for)) {
        const NodeId node = clauses(opening.begin);
        expect_closing(TokenKind::close_bracket, opening);
        ast_[node].end = previous_end_;
        return node;
    }
    std::vector<NodeId> elements;
    while (!at(TokenKind::close_bracket) && !stopped_ && !in_error_) {
        elements.push_back(expression());
        if (!accept(TokenKind::comma)) break;
    }
    expect_closing(TokenKind::close_bracket, opening);
    return make(NodeKind::list, opening.begin, elements);
}

NodeId Parser::clauses(std::uint32_t begin) {
    std::vector<NodeId> nodes;
    while ((at(TokenKind::kw_for) || at(TokenKind::kw_if)) && !in_error_) {
        const std::uint32_t clause_begin = token_.begin;
        const bool is_for = at(TokenKind::kw_for);
        advance();
        if (is_for) {
            const NodeId names = pattern();
            expect(TokenKind::kw_in, "after the name in `for`");
            const NodeId source = range();
            nodes.push_back(make(NodeKind::each_clause, clause_begin, {names, source}));
        } else {
            const NodeId condition = expression();
            nodes.push_back(make(NodeKind::if_clause, clause_begin, {condition}));
        }
        if (nodes.size() > 50) {
            error(clause_begin, token_.begin, "too many clauses in one list",
                  "give a part of it a name with `let`");
        }
    }
    expect(TokenKind::colon, "before the value of each element");
    nodes.push_back(expression());
    return make(NodeKind::comprehension, begin, nodes);
}

NodeId Parser::record() {
    const Token opening = token_;
    const Lines lines(*this, false);
    advance();
    std::vector<NodeId> fields;
    while (!at(TokenKind::close_brace) && !stopped_ && !in_error_) {
        const Token name = token_;
        if (!at(TokenKind::name)) {
            unexpected("the name of a field");
            break;
        }
        const Symbol symbol = symbol_of(name);
        advance();
        NodeId value = kNoNode;
        if (accept(TokenKind::colon)) {
            value = expression();
        } else {  // {width} is {width: width}
            value = make(NodeKind::name, name.begin);
            ast_[value].symbol = symbol;
        }
        const NodeId field = make(NodeKind::field, name.begin, {value});
        ast_[field].symbol = symbol;
        for (const NodeId earlier : fields) {
            if (ast_[earlier].symbol != symbol || in_error_) continue;
            error(name.begin, name.end,
                  fmt::format("the field `{}` is given twice", symbols_.text(symbol)));
        }
        fields.push_back(field);
        if (!accept(TokenKind::comma)) break;
        if (fields.size() > 1000) {
            error(name.begin, name.end, "a record has at most 1000 fields", "use a list");
        }
    }
    expect_closing(TokenKind::close_brace, opening);
    return make(NodeKind::record, opening.begin, fields);
}

NodeId Parser::string() {
    const std::uint32_t begin = token_.begin;
    std::vector<NodeId> parts;
    bool interpolated = false;
    while (true) {
        const Token piece = token_;
        const Symbol symbol = symbols_.intern(lexer_.string_value(piece));
        const std::uint32_t piece_begin = piece.begin;
        if (!piece.string_continues) {
            advance();
            const NodeId node = make(NodeKind::string, piece_begin);
            ast_[node].symbol = symbol;
            parts.push_back(node);
            break;
        }
        interpolated = true;
        previous_end_ = piece.end;
        const NodeId text = make(NodeKind::string, piece_begin);
        ast_[text].symbol = symbol;
        parts.push_back(text);
        const Lines lines(*this, false);
        const int brackets = open_brackets_;
        advance();
        parts.push_back(expression());
        if (!at(TokenKind::close_brace)) unexpected("`}` at the end of `${...}`");
        if (in_error_ || stopped_) {
            // What is left of the string is no program.
            if (!token_.newline_before) {
                lexer_.skip_line();
                advance();
            }
            open_brackets_ = brackets;
            return invalid();
        }
        open_brackets_ = brackets;
        token_ = lexer_.resume_string(token_.end);
    }
    if (!interpolated) return parts.front();
    return make(NodeKind::interpolation, begin, parts);
}

NodeId Parser::choice() {
    const std::uint32_t begin = token_.begin;
    advance();
    const NodeId condition = expression();
    expect(TokenKind::kw_then, "in an `if` that gives a value");
    const NodeId yes = expression();
    if (!at(TokenKind::kw_else)) {
        unexpected("`else`", "an `if` that gives a value needs both: if c then a else b");
        return invalid();
    }
    advance();
    const NodeId no = expression();
    return make(NodeKind::choice, begin, {condition, yes, no});
}

NodeId Parser::lambda() {
    const std::uint32_t begin = token_.begin;
    advance();
    return function_body(begin, kNoSymbol);
}

NodeId Parser::function_body(std::uint32_t begin, Symbol name) {
    std::vector<NodeId> nodes;
    FunctionInfo info;
    info.name = name;
    const Token opening = token_;
    if (!expect(TokenKind::open_paren, "before the parameters of a function")) return invalid();
    {
        const Lines lines(*this, false);
        bool defaults = false;
        while (!at(TokenKind::close_paren) && !stopped_ && !in_error_) {
            const Token parameter = token_;
            if (!expect(TokenKind::name, "as a parameter")) break;
            const Symbol symbol = symbol_of(parameter);
            for (const NodeId earlier : nodes) {
                if (ast_[earlier].symbol != symbol || in_error_) continue;
                error(parameter.begin, parameter.end,
                      fmt::format("the parameter `{}` is there twice", symbols_.text(symbol)));
            }
            NodeId node = kNoNode;
            if (accept(TokenKind::assign)) {
                defaults = true;
                const NodeId value = expression();
                node = make(NodeKind::parameter, parameter.begin, {value});
            } else {
                if (defaults && !in_error_) {
                    error(parameter.begin, parameter.end,
                          "a parameter without a default can not follow one with a default",
                          "give it a default, or move it to the front");
                }
                node = make(NodeKind::parameter, parameter.begin);
                ++info.required_count;
            }
            ast_[node].symbol = symbol;
            nodes.push_back(node);
            if (nodes.size() > 200) {
                error(parameter.begin, parameter.end, "a function has at most 200 parameters",
                      "pass a record or a list");
            }
            if (!accept(TokenKind::comma)) break;
        }
        expect_closing(TokenKind::close_paren, opening);
    }
    info.parameter_count = static_cast<std::uint32_t>(nodes.size());
    if (name != kNoSymbol && accept(TokenKind::assign)) {
        nodes.push_back(expression());
    } else if (at(TokenKind::open_brace)) {
        nodes.push_back(block());
    } else if (name == kNoSymbol) {
        nodes.push_back(expression());
    } else {
        unexpected("`{` or `=` after the parameters");
        return invalid();
    }
    const NodeId node = make(NodeKind::lambda, begin, nodes);
    info.lambda = node;
    ast_[node].slot = static_cast<std::uint32_t>(ast_.functions.size());
    ast_.functions.push_back(std::move(info));
    return node;
}

}  // namespace raymo::sml
