#include "raymo/sml/ast.hpp"

#include <fmt/core.h>

#include <array>

#include "raymo/sml/text.hpp"

namespace raymo::sml {

std::string_view spelling(Operator op) {
    static constexpr auto kTexts =
        std::to_array<std::string_view>({"=", "+", "-", "*", "/", "%", "&", "^", "==", "!=", "<",
                                         "<=", ">", ">=", "in", "..", "..<"});
    return kTexts[static_cast<std::size_t>(op)];
}

std::string_view kind_name(NodeKind kind) {
    static constexpr auto kNames = std::to_array<std::string_view>({
#define NODE(kind, children) #kind,
#include "raymo/sml/ast_nodes.def"
#undef NODE
    });
    return kNames[static_cast<std::size_t>(kind)];
}

std::string dump(const Ast& ast, NodeId root, const Symbols& symbols) {
    struct Visit {
        NodeId node;
        std::size_t depth;
    };
    std::string out;
    std::vector<Visit> open{{root, 0}};
    while (!open.empty()) {
        const Visit visit = open.back();
        open.pop_back();
        const Node& n = ast[visit.node];
        out.append(2 * visit.depth, ' ');
        out += fmt::format("{} {}..{}", kind_name(n.kind), n.begin, n.end);
        if (n.op != Operator::none) out += fmt::format(" {}", spelling(n.op));
        if (n.kind == NodeKind::number) out += ' ' + number_text(n.number);
        if (n.kind == NodeKind::boolean) out += n.flag ? " true" : " false";
        if (n.kind == NodeKind::string) {
            out += ' ' + quoted(symbols.text(n.symbol));
        } else if (n.symbol != kNoSymbol) {
            out += ' ' + symbols.text(n.symbol);
        }
        out += '\n';
        const auto children = ast.children_of(n);
        for (auto child = children.rbegin(); child != children.rend(); ++child) {
            open.push_back({*child, visit.depth + 1});
        }
    }
    return out;
}

}  // namespace raymo::sml
