// Operators and what follows a value: calls, fields, indices.

#include <fmt/core.h>

#include "raymo/sml/parser.hpp"

namespace raymo::sml {
namespace {

Operator sum_operator(TokenKind kind) {
    switch (kind) {
        case TokenKind::plus:
            return Operator::add;
        case TokenKind::minus:
            return Operator::subtract;
        default:
            return Operator::none;
    }
}

Operator product_operator(TokenKind kind) {
    switch (kind) {
        case TokenKind::star:
            return Operator::multiply;
        case TokenKind::slash:
            return Operator::divide;
        case TokenKind::percent:
            return Operator::modulo;
        case TokenKind::ampersand:
            return Operator::intersect;
        default:
            return Operator::none;
    }
}

Operator comparison_operator(TokenKind kind) {
    switch (kind) {
        case TokenKind::equal:
            return Operator::equal;
        case TokenKind::not_equal:
            return Operator::not_equal;
        case TokenKind::less:
            return Operator::less;
        case TokenKind::less_equal:
            return Operator::less_equal;
        case TokenKind::greater:
            return Operator::greater;
        case TokenKind::greater_equal:
            return Operator::greater_equal;
        default:
            return Operator::none;
    }
}

}  // namespace

bool Parser::Nesting::too_deep() const {
    if (parser_.nesting_ <= kMaxNesting) return false;
    if (!parser_.stopped_) {
        parser_.in_error_ = false;
        parser_.reporter_.error(ErrorCode::limit,
                                {parser_.file_, parser_.token_.begin, parser_.token_.end},
                                fmt::format("nested more than {} deep", kMaxNesting),
                                "give a part of it a name with `let`");
        parser_.stopped_ = true;
        parser_.in_error_ = true;
        parser_.token_.kind = TokenKind::end;
    }
    return true;
}

NodeId Parser::expression() {
    const Nesting nesting(*this);
    if (nesting.too_deep()) return invalid();
    return logical(true);
}

NodeId Parser::logical(bool is_or) {
    const std::uint32_t begin = token_.begin;
    const TokenKind word = is_or ? TokenKind::kw_or : TokenKind::kw_and;
    const NodeId first = is_or ? logical(false) : negation();
    if (!at(word) || !continues()) return first;
    std::vector<NodeId> conditions{first};
    while (at(word) && continues()) {
        advance();
        conditions.push_back(is_or ? logical(false) : negation());
    }
    return make(is_or ? NodeKind::any_of : NodeKind::all_of, begin, conditions);
}

NodeId Parser::negation() {
    if (!at(TokenKind::kw_not)) return comparison();
    const Nesting nesting(*this);
    if (nesting.too_deep()) return invalid();
    const std::uint32_t begin = token_.begin;
    advance();
    const NodeId condition = negation();
    return make(NodeKind::negation, begin, {condition});
}

NodeId Parser::comparison() {
    const std::uint32_t begin = token_.begin;
    const NodeId left = membership();
    const Operator op = comparison_operator(token_.kind);
    if (op == Operator::none || !continues()) return left;
    advance();
    const NodeId right = membership();
    const NodeId node = make(NodeKind::binary, begin, {left, right});
    ast_[node].op = op;
    if (comparison_operator(token_.kind) != Operator::none && continues()) {
        error(token_.begin, token_.end, "comparisons do not chain", "write `a < b and b < c`");
    }
    return node;
}

NodeId Parser::membership() {
    const std::uint32_t begin = token_.begin;
    const NodeId left = range();
    if (!at(TokenKind::kw_in) || !in_is_operator_ || !continues()) return left;
    advance();
    const NodeId right = range();
    const NodeId node = make(NodeKind::binary, begin, {left, right});
    ast_[node].op = Operator::in;
    return node;
}

NodeId Parser::range() {
    const std::uint32_t begin = token_.begin;
    const NodeId low = chain(0);
    if ((!at(TokenKind::dot_dot) && !at(TokenKind::dot_dot_less)) || !continues()) return low;
    const Operator op = at(TokenKind::dot_dot) ? Operator::range_closed : Operator::range_open;
    advance();
    std::vector<NodeId> parts{low, chain(0)};
    if (at(TokenKind::name) && continues() &&
        lexer_.text().substr(token_.begin, token_.end - token_.begin) == "step") {
        advance();
        parts.push_back(chain(0));
    }
    const NodeId node = make(NodeKind::range, begin, parts);
    ast_[node].op = op;
    return node;
}

NodeId Parser::chain(int level) {
    const std::uint32_t begin = token_.begin;
    const auto next_operator = [&] {
        if (!continues()) return Operator::none;
        return level == 0 ? sum_operator(token_.kind) : product_operator(token_.kind);
    };
    const auto operand = [&] { return level == 0 ? chain(1) : unary(); };
    const NodeId first = operand();
    Operator op = next_operator();
    if (op == Operator::none) return first;
    const std::uint32_t op_begin = token_.begin;
    advance();
    const NodeId second = operand();
    Operator following = next_operator();
    if (following == Operator::none) {
        const NodeId node = make(NodeKind::binary, begin, {first, second});
        ast_[node].op = op;
        return node;
    }
    std::vector<NodeId> nodes{first, make(NodeKind::operand, op_begin, {second})};
    ast_[nodes.back()].op = op;
    while (following != Operator::none && !stopped_) {
        const std::uint32_t following_begin = token_.begin;
        advance();
        const NodeId value = operand();
        nodes.push_back(make(NodeKind::operand, following_begin, {value}));
        ast_[nodes.back()].op = following;
        following = next_operator();
    }
    return make(NodeKind::chain, begin, nodes);
}

NodeId Parser::unary() {
    if (!at(TokenKind::minus) && !at(TokenKind::plus)) return power();
    const Nesting nesting(*this);
    if (nesting.too_deep()) return invalid();
    const std::uint32_t begin = token_.begin;
    if (at(TokenKind::plus)) {
        if (token_.newline_before && lines_end_statements_) {
            error(token_.begin, token_.end, "a statement can not begin with `+`",
                  "to go on with the line above, end that line with the `+`");
        } else {
            error(token_.begin, token_.end, "there is no unary `+`", "leave it out");
        }
    }
    advance();
    const NodeId value = unary();
    return make(NodeKind::minus, begin, {value});
}

NodeId Parser::power() {
    const std::uint32_t begin = token_.begin;
    const NodeId base = postfix();
    if (!at(TokenKind::caret) || !continues()) return base;
    const Nesting nesting(*this);
    if (nesting.too_deep()) return invalid();
    advance();
    const NodeId exponent = unary();  // right-associative, and 2 ^ -1 is allowed
    const NodeId node = make(NodeKind::binary, begin, {base, exponent});
    ast_[node].op = Operator::power;
    return node;
}

NodeId Parser::postfix() {
    NodeId node = primary();
    while (!stopped_) {
        const NodeId next = postfix_step(node);
        if (next == node) return node;
        node = next;
    }
    return node;
}

NodeId Parser::postfix_step(NodeId receiver) {
    const std::uint32_t begin = ast_[receiver].begin;
    if (at(TokenKind::open_paren) && continues()) {
        std::vector<NodeId> nodes{receiver};
        arguments(nodes);
        return make(NodeKind::call, begin, nodes);
    }
    if (at(TokenKind::open_bracket) && continues()) {
        const Token opening = token_;
        const Lines lines(*this, false);
        advance();
        const NodeId index = expression();
        expect_closing(TokenKind::close_bracket, opening);
        return make(NodeKind::index, begin, {receiver, index});
    }
    if (!at(TokenKind::dot)) return receiver;
    advance();
    // A keyword may be a field's name: gear.view
    const bool is_word = at(TokenKind::name) ||
                         (token_.kind >= TokenKind::kw_let && token_.kind <= TokenKind::kw_nothing);
    if (!is_word) {
        unexpected("a field or a function after `.`");
        return receiver;
    }
    const Symbol symbol = symbol_of(token_);
    advance();
    NodeId node = kNoNode;
    if (at(TokenKind::open_paren) && continues()) {
        std::vector<NodeId> nodes{receiver};
        arguments(nodes);
        node = make(NodeKind::method, begin, nodes);
    } else {
        node = make(NodeKind::member, begin, {receiver});
    }
    ast_[node].symbol = symbol;
    return node;
}

void Parser::arguments(std::vector<NodeId>& out) {
    const Token opening = token_;
    const Lines lines(*this, false);
    advance();
    bool named = false;
    while (!at(TokenKind::close_paren) && !stopped_ && !in_error_) {
        const Token first = token_;
        const NodeId value = expression();
        if (at(TokenKind::colon) && ast_[value].kind == NodeKind::name &&
            ast_[value].begin == first.begin && ast_[value].end == first.end) {
            const Symbol name = ast_[value].symbol;
            advance();
            const NodeId given = expression();
            const NodeId node = make(NodeKind::argument, first.begin, {given});
            ast_[node].symbol = name;
            out.push_back(node);
            named = true;
        } else {
            if (named && !in_error_) {
                error(ast_[value].begin, ast_[value].end,
                      "an argument without a name can not follow one with a name",
                      "give its name, or move it to the front");
            }
            if (at(TokenKind::assign) && ast_[value].kind == NodeKind::name) {
                error(token_.begin, token_.end, "an argument is named with a colon",
                      fmt::format("write `{}: ...`", symbols_.text(ast_[value].symbol)));
            }
            out.push_back(value);
        }
        if (!accept(TokenKind::comma)) break;
    }
    expect_closing(TokenKind::close_paren, opening);
}

}  // namespace raymo::sml
