#include <fmt/core.h>

#include "raymo/sml/parser.hpp"

namespace raymo::sml {

Parser::Parser(std::string_view text, std::uint32_t file, Ast& ast, Symbols& symbols,
               Reporter& reporter)
    : lexer_(text, file, reporter), file_(file), ast_(ast), symbols_(symbols), reporter_(reporter) {
    advance();
}

void Parser::advance() {
    previous_end_ = token_.end;
    if (stopped_) {
        token_.kind = TokenKind::end;
        return;
    }
    token_ = lexer_.next();
    while (token_.kind == TokenKind::invalid) {  // reported by the lexer
        in_error_ = true;
        token_ = lexer_.next();
    }
    switch (token_.kind) {
        case TokenKind::open_paren:
        case TokenKind::open_bracket:
        case TokenKind::open_brace:
            ++open_brackets_;
            break;
        case TokenKind::close_paren:
        case TokenKind::close_bracket:
        case TokenKind::close_brace:
            --open_brackets_;
            break;
        default:
            break;
    }
}

bool Parser::accept(TokenKind kind) {
    if (!at(kind)) return false;
    advance();
    return true;
}

std::string Parser::found() const {
    if (token_.kind == TokenKind::name || token_.kind == TokenKind::number) {
        return fmt::format(
            "`{}`", lexer_.text().substr(token_.begin,
                                         std::min<std::uint32_t>(token_.end - token_.begin, 60)));
    }
    return std::string(describe(token_.kind));
}

void Parser::error(std::uint32_t begin, std::uint32_t end, std::string message, std::string hint) {
    if (in_error_) return;
    in_error_ = true;
    reporter_.error(ErrorCode::syntax, {file_, begin, end}, std::move(message), std::move(hint));
    if (reporter_.full()) {
        stopped_ = true;
        token_.kind = TokenKind::end;
    }
}

void Parser::unexpected(std::string_view expected, std::string hint) {
    if (hint.empty() && at(TokenKind::assign)) hint = "to compare, write `==`";
    const bool line_ended = token_.newline_before && (lines_end_statements_ || at(TokenKind::end));
    // The place to mend is the end of the line before, where the statement began there.
    if (line_ended && previous_end_ > statement_begin_) {
        error(previous_end_ - 1, previous_end_,
              fmt::format("expected {}, found the end of the line", expected), std::move(hint));
        return;
    }
    error(token_.begin, token_.end, fmt::format("expected {}, found {}", expected, found()),
          std::move(hint));
}

bool Parser::expect(TokenKind kind, std::string_view where) {
    if (accept(kind)) return true;
    unexpected(fmt::format("{} {}", describe(kind), where));
    return false;
}

bool Parser::expect_closing(TokenKind kind, const Token& opening) {
    if (accept(kind)) return true;
    if (in_error_) return false;
    if (token_.newline_before || at(TokenKind::end)) {
        // The place to mend is where it was opened.
        error(opening.begin, opening.end, fmt::format("{} is not closed", describe(opening.kind)),
              fmt::format("add {} before the end of the statement", describe(kind)));
        return false;
    }
    unexpected(fmt::format("`,` or {}", describe(kind)));
    return false;
}

Symbol Parser::symbol_of(const Token& token) {
    return symbols_.intern(lexer_.text().substr(token.begin, token.end - token.begin));
}

NodeId Parser::make_range(NodeKind kind, std::uint32_t begin, const NodeId* children,
                          std::size_t count) {
    Node node;
    node.kind = kind;
    node.file = static_cast<std::uint16_t>(file_);
    node.begin = begin;
    node.end = std::max(previous_end_, begin);
    node.first = static_cast<std::uint32_t>(ast_.children.size());
    node.count = static_cast<std::uint32_t>(count);
    int height = 0;
    for (std::size_t i = 0; i < count; ++i) {
        ast_.children.push_back(children[i]);
        height = std::max(height, static_cast<int>(ast_[children[i]].height));
    }
    node.height = static_cast<std::uint16_t>(height + 1);
    if (!stopped_ && (height + 1 > kMaxHeight || ast_.nodes.size() >= kMaxNodes)) {
        in_error_ = false;
        const bool is_deep = height + 1 > kMaxHeight;
        reporter_.error(
            ErrorCode::limit, {file_, begin, node.end},
            is_deep ? fmt::format("nested more than {} deep", kMaxHeight)
                    : fmt::format("the program has more than {} parts", kMaxNodes),
            is_deep ? "give a part of it a name with `let`" : "make what repeats with a loop");
        stopped_ = true;
        in_error_ = true;
        token_.kind = TokenKind::end;
    }
    if (stopped_) node.height = 1;
    ast_.nodes.push_back(node);
    return static_cast<NodeId>(ast_.nodes.size() - 1);
}

NodeId Parser::make(NodeKind kind, std::uint32_t begin, std::initializer_list<NodeId> children) {
    return make_range(kind, begin, children.begin(), children.size());
}

NodeId Parser::make(NodeKind kind, std::uint32_t begin, const std::vector<NodeId>& children) {
    return make_range(kind, begin, children.data(), children.size());
}

NodeId Parser::invalid() { return make(NodeKind::invalid, token_.begin); }

bool Parser::begins_statement(TokenKind kind) {
    switch (kind) {
        case TokenKind::kw_let:
        case TokenKind::kw_var:
        case TokenKind::kw_fn:
        case TokenKind::kw_param:
        case TokenKind::kw_part:
        case TokenKind::kw_view:
        case TokenKind::kw_for:
        case TokenKind::kw_while:
        case TokenKind::kw_return:
        case TokenKind::kw_emit:
        case TokenKind::kw_import:
        case TokenKind::kw_from:
        case TokenKind::kw_assert:
            return true;
        default:
            return false;
    }
}

std::size_t Parser::indent_of(std::uint32_t offset) const {
    const std::size_t newline =
        offset == 0 ? std::string_view::npos : lexer_.text().rfind('\n', offset - 1);
    return newline == std::string_view::npos ? offset : offset - newline - 1;
}

// To the beginning of the next statement. Where a bracket was left open, a line that begins with a keyword or is not
// indented further than the broken statement is taken for a new one.
void Parser::skip_statement(int brackets, std::size_t indent) {
    while (!at(TokenKind::end) && !stopped_) {
        const bool closes = at(TokenKind::close_brace);
        if (closes && open_brackets_ < brackets) return;
        const bool is_bracket =
            closes || at(TokenKind::close_paren) || at(TokenKind::close_bracket);
        const bool ends = token_.newline_before || at(TokenKind::semicolon);
        if (open_brackets_ <= brackets && ends && !is_bracket) return;
        if (token_.newline_before &&
            (begins_statement(token_.kind) || (!is_bracket && indent_of(token_.begin) <= indent))) {
            return;
        }
        lexer_.set_quiet(true);
        advance();
        lexer_.set_quiet(false);
    }
}

// A bracket where a statement should begin. What follows `)` or `]` on its line belongs to whatever it was meant to
// close; a statement may follow `}`.
void Parser::stray_bracket() {
    const bool is_brace = at(TokenKind::close_brace);
    const std::size_t indent = indent_of(token_.begin);
    ++open_brackets_;
    const int brackets = open_brackets_;
    error(token_.begin, token_.end, fmt::format("this {} closes nothing", found()));
    advance();
    if (!is_brace && !token_.newline_before) {
        skip_statement(brackets, indent);
        open_brackets_ = brackets - (at(TokenKind::close_brace) ? 1 : 0);
    }
    in_error_ = false;
}

void Parser::statements(std::vector<NodeId>& out, TokenKind closing) {
    while (!stopped_ && !at(TokenKind::end) && !at(closing)) {
        if (accept(TokenKind::semicolon)) continue;
        if (at(TokenKind::close_brace) || at(TokenKind::close_paren) ||
            at(TokenKind::close_bracket)) {
            stray_bracket();
            continue;
        }
        // The bracket that may begin the statement is counted already.
        const bool opens =
            at(TokenKind::open_paren) || at(TokenKind::open_bracket) || at(TokenKind::open_brace);
        const int brackets = open_brackets_ - (opens ? 1 : 0);
        const TextRange doc = token_.doc_before;
        const std::uint32_t begin = token_.begin;
        const std::size_t indent = indent_of(token_.begin);
        statement_begin_ = begin;
        const NodeId node = statement();
        if (!in_error_) end_of_statement();
        if (in_error_) {
            skip_statement(brackets, indent);
            if (token_.begin == begin && !at(TokenKind::end)) advance();  // never stand still
            const bool next_opens = at(TokenKind::open_paren) || at(TokenKind::open_bracket) ||
                                    at(TokenKind::open_brace);
            const bool next_closes = at(TokenKind::close_brace);
            open_brackets_ = brackets + (next_opens ? 1 : 0) - (next_closes ? 1 : 0);
            in_error_ = false;
            continue;  // its names stay in the table of nodes; see resolve()
        }
        {
            const TextRange behind = token_.doc_behind_previous;
            if (!behind.empty() || !doc.empty())
                ast_.docs.push_back({node, doc.empty() ? behind : doc});
        }
        out.push_back(node);
    }
}

void Parser::end_of_statement() {
    if (accept(TokenKind::semicolon) || token_.newline_before || at(TokenKind::end) ||
        at(TokenKind::close_brace)) {
        return;
    }
    if (at(TokenKind::kw_then)) {
        unexpected("the end of the statement", "`then` belongs to an `if` that gives a value");
        return;
    }
    unexpected("the end of the statement");
}

NodeId Parser::program() {
    std::vector<NodeId> nodes;
    statements(nodes, TokenKind::end);
    const NodeId node = make(NodeKind::block, 0, nodes);
    ast_[node].slot = kNoPlan;
    return node;
}

NodeId Parser::lone_expression() {
    const NodeId node = expression();
    if (!in_error_ && !at(TokenKind::end)) unexpected("the end of the expression");
    return node;
}

NodeId Parser::block() {
    const Nesting nesting(*this);
    const Token opening = token_;
    if (nesting.too_deep() || !expect(TokenKind::open_brace, "at the beginning of a block")) {
        return invalid();
    }
    const Lines lines(*this, true);
    std::vector<NodeId> nodes;
    statements(nodes, TokenKind::close_brace);
    if (!accept(TokenKind::close_brace) && !stopped_) {
        error(opening.begin, opening.end, "`{` is not closed", "add `}` at the end of the block");
    }
    const NodeId node = make(NodeKind::block, opening.begin, nodes);
    ast_[node].slot = kNoPlan;
    return node;
}

NodeId Parser::statement() {
    switch (token_.kind) {
        case TokenKind::kw_let:
            return declaration(NodeKind::let);
        case TokenKind::kw_var:
            return declaration(NodeKind::var);
        case TokenKind::kw_fn:
            return function_statement();
        case TokenKind::kw_if:
            return if_statement();
        case TokenKind::kw_for:
            return for_statement();
        case TokenKind::kw_while:
            return while_statement();
        case TokenKind::kw_param:
            return param_statement();
        case TokenKind::kw_part:
            return named_value(NodeKind::part);
        case TokenKind::kw_view:
            return named_value(NodeKind::view);
        case TokenKind::kw_import:
            return import_statement();
        case TokenKind::kw_from:
            return import_names_statement();
        default:
            return simple_statement();
    }
}

NodeId Parser::binding() {
    const Token name = token_;
    if (!expect(TokenKind::name, "for the value")) return invalid();
    const NodeId node = make(NodeKind::binding, name.begin);
    ast_[node].symbol = symbol_of(name);
    return node;
}

NodeId Parser::pattern() {
    const Token opening = token_;
    const bool is_record = at(TokenKind::open_brace);
    if (!is_record && !at(TokenKind::open_paren) && !at(TokenKind::open_bracket)) return binding();
    const TokenKind closing = is_record                   ? TokenKind::close_brace
                              : at(TokenKind::open_paren) ? TokenKind::close_paren
                                                          : TokenKind::close_bracket;
    const Lines lines(*this, false);
    advance();
    std::vector<NodeId> names;
    do {
        names.push_back(binding());
    } while (!in_error_ && accept(TokenKind::comma) && !at(closing));
    expect_closing(closing, opening);
    return make(is_record ? NodeKind::record_pattern : NodeKind::list_pattern, opening.begin,
                names);
}

NodeId Parser::declaration(NodeKind kind) {
    const std::uint32_t begin = token_.begin;
    advance();
    const NodeId names = pattern();
    expect(TokenKind::assign, "and a value");
    const NodeId value = in_error_ ? invalid() : expression();
    return make(kind, begin, {names, value});
}

NodeId Parser::function_statement() {
    const std::uint32_t begin = token_.begin;
    const Token keyword = token_;
    advance();
    if (at(TokenKind::open_paren)) {
        error(keyword.begin, keyword.end, "a function needs a name here",
              "write `fn name(...)`, or `let name = fn(...) ...`");
        return invalid();
    }
    const NodeId name = binding();
    if (in_error_) return invalid();
    const NodeId body = function_body(begin, ast_[name].symbol);
    if (ast_[body].kind != NodeKind::lambda) return invalid();
    return make(NodeKind::function, begin, {name, body});
}

NodeId Parser::if_statement() {
    const Nesting nesting(*this);
    if (nesting.too_deep()) return invalid();
    const std::uint32_t begin = token_.begin;
    advance();
    const NodeId condition = expression();
    if (at(TokenKind::kw_then)) {  // a bare expression
        advance();
        const NodeId yes = expression();
        if (!at(TokenKind::kw_else)) {
            unexpected("`else`", "an `if` that gives a value needs both: if c then a else b");
            return invalid();
        }
        advance();
        const NodeId no = expression();
        const NodeId value = make(NodeKind::choice, begin, {condition, yes, no});
        return make(NodeKind::expression, begin, {value});
    }
    if (in_error_) return invalid();
    const NodeId yes = block();
    if (in_error_ || !accept(TokenKind::kw_else)) {
        return make(NodeKind::if_else, begin, {condition, yes});
    }
    const NodeId no = at(TokenKind::kw_if) ? if_statement() : block();
    return make(NodeKind::if_else, begin, {condition, yes, no});
}

NodeId Parser::for_statement() {
    const std::uint32_t begin = token_.begin;
    advance();
    const NodeId names = pattern();
    expect(TokenKind::kw_in, "after the name in `for`");
    const NodeId source = in_error_ ? invalid() : expression();
    const NodeId body = in_error_ ? invalid() : block();
    const NodeId node = make(NodeKind::for_each, begin, {names, source, body});
    return node;
}

NodeId Parser::while_statement() {
    const std::uint32_t begin = token_.begin;
    advance();
    const NodeId condition = expression();
    const NodeId body = in_error_ ? invalid() : block();
    return make(NodeKind::while_loop, begin, {condition, body});
}

NodeId Parser::param_statement() {
    const std::uint32_t begin = token_.begin;
    advance();
    const NodeId name = binding();
    expect(TokenKind::assign, "and a default");
    in_is_operator_ = false;
    std::vector<NodeId> nodes{name, in_error_ ? invalid() : expression()};
    in_is_operator_ = true;
    if (!in_error_ && accept(TokenKind::kw_in)) nodes.push_back(range());
    return make(NodeKind::param, begin, nodes);
}

NodeId Parser::named_value(NodeKind kind) {
    const std::uint32_t begin = token_.begin;
    advance();
    const NodeId name = binding();
    expect(TokenKind::assign, "and a value");
    const NodeId value = in_error_ ? invalid() : expression();
    return make(kind, begin, {name, value});
}

NodeId Parser::import_statement() {
    const std::uint32_t begin = token_.begin;
    advance();
    if (!at(TokenKind::string)) {
        unexpected("the path of a file in quotes");
        return invalid();
    }
    std::vector<NodeId> nodes{string()};
    if (accept(TokenKind::kw_as)) {
        nodes.push_back(binding());
    } else if (!in_error_) {
        unexpected("`as` and a name", "write `import \"gear.raymo\" as gear`");
    }
    return make(NodeKind::import, begin, nodes);
}

NodeId Parser::import_names_statement() {
    const std::uint32_t begin = token_.begin;
    advance();
    if (!at(TokenKind::string)) {
        unexpected("the path of a file in quotes");
        return invalid();
    }
    std::vector<NodeId> nodes{string()};
    expect(TokenKind::kw_import, "and the names to take");
    while (!in_error_) {
        nodes.push_back(binding());
        if (!accept(TokenKind::comma)) break;
    }
    return make(NodeKind::import_names, begin, nodes);
}

NodeId Parser::simple_statement() {
    const std::uint32_t begin = token_.begin;
    const TokenKind kind = token_.kind;
    const auto value_follows = [&] {
        return !token_.newline_before && !at(TokenKind::end) && !at(TokenKind::semicolon) &&
               !at(TokenKind::close_brace);
    };
    switch (kind) {
        case TokenKind::kw_break:
        case TokenKind::kw_continue:
            advance();
            return make(
                kind == TokenKind::kw_break ? NodeKind::break_loop : NodeKind::continue_loop,
                begin);
        case TokenKind::kw_return: {
            advance();
            if (!value_follows()) return make(NodeKind::give_back, begin);
            const NodeId value = expression();
            return make(NodeKind::give_back, begin, {value});
        }
        case TokenKind::kw_emit: {
            advance();
            const NodeId value = expression();
            return make(NodeKind::emit, begin, {value});
        }
        case TokenKind::kw_assert: {
            advance();
            std::vector<NodeId> nodes{expression()};
            if (accept(TokenKind::comma)) nodes.push_back(expression());
            return make(NodeKind::assertion, begin, nodes);
        }
        case TokenKind::kw_else:
            error(token_.begin, token_.end, "this `else` has no `if`",
                  "it follows the `}` of an `if`");
            advance();
            return invalid();
        default:
            break;
    }
    const NodeId target = expression();
    Operator op = Operator::none;
    switch (token_.kind) {
        case TokenKind::assign:
            break;
        case TokenKind::plus_assign:
            op = Operator::add;
            break;
        case TokenKind::minus_assign:
            op = Operator::subtract;
            break;
        case TokenKind::star_assign:
            op = Operator::multiply;
            break;
        case TokenKind::slash_assign:
            op = Operator::divide;
            break;
        case TokenKind::and_assign:
            op = Operator::intersect;
            break;
        default:
            return make(NodeKind::expression, begin, {target});
    }
    if (ast_[target].kind != NodeKind::name) {
        error(ast_[target].begin, ast_[target].end, "only a variable can be given a new value",
              "lists and records do not change: make a new one");
        return invalid();
    }
    advance();
    const NodeId value = expression();
    const NodeId node = make(NodeKind::assign, begin, {target, value});
    ast_[node].op = op;
    return node;
}

}  // namespace raymo::sml
