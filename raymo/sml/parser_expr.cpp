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
    if (!at(TokenKind::kw_in) || !continues()) return left;
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
            unexpected("an expression", "statements stand on lines of their own");
            return invalid();
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
        if (in_error_ || stopped_) return invalid();
        if (!at(TokenKind::close_brace)) {
            unexpected("`}` at the end of `${...}`");
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
