// What the parser makes: a flat table of nodes, so that neither size nor depth of a program costs recursion to hold or
// to free. Nodes speak of each other by number; every node has its place in the text.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "raymo/core/source_span.hpp"
#include "raymo/sml/symbols.hpp"
#include "raymo/sml/token.hpp"

namespace raymo::sml {

/// Limit on the height of a tree: what recursion over it may cost.
inline constexpr int kMaxHeight = 400;

using NodeId = std::uint32_t;
inline constexpr NodeId kNoNode = 0xffffffffU;

enum class NodeKind : std::uint8_t {
#define NODE(kind, children) kind,
#include "raymo/sml/ast_nodes.def"
#undef NODE
};

enum class Operator : std::uint8_t {
    none,
    add,
    subtract,
    multiply,
    divide,
    modulo,
    intersect,
    power,
    equal,
    not_equal,
    less,
    less_equal,
    greater,
    greater_equal,
    in,
    range_closed,
    range_open,
};
/// As written: "+".
[[nodiscard]] std::string_view spelling(Operator op);

/// Where the value of a name lives.
enum class Place : std::uint8_t {
    unresolved,
    local,     ///< slot of the frame
    captured,  ///< slot of the closure
    global,    ///< slot of the table of globals
    builtin,   ///< row of the table of builtins
};

struct Node {
    NodeKind kind = NodeKind::invalid;
    Operator op = Operator::none;
    Place place = Place::unresolved;
    /// boolean: value; binding, parameter: captured by a closure; binary, chain, minus, call: `number` is that of a formula
    bool flag = false;
    std::uint16_t file = 0;
    std::uint16_t height = 1;  ///< of the tree below; at most kMaxHeight
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    std::uint32_t first = 0;  ///< children: range of Ast::children
    std::uint32_t count = 0;
    Symbol symbol = kNoSymbol;
    std::uint32_t slot = 0;
    double number = 0.0;

    [[nodiscard]] SourceSpan span() const { return {file, begin, end}; }
};

/// A function's shape; filled in by the resolver.
struct FunctionInfo {
    struct Capture {
        bool from_local = true;  ///< from the frame of the enclosing function, or from its closure
        std::uint32_t slot = 0;
    };
    Symbol name = kNoSymbol;  ///< kNoSymbol: fn(x) ...
    NodeId lambda = kNoNode;
    std::uint32_t parameter_count = 0;
    std::uint32_t required_count = 0;
    std::uint32_t frame_size = 0;
    std::uint32_t entry = 0xffffffffU;  ///< index into Ast::entries: parameters that live in cells
    std::vector<Capture> captures;
};

/// Which argument of a call goes to which parameter; made before the program runs where the callee is known.
struct CallPlan {
    std::uint32_t callee = 0;  ///< builtin row, or index of FunctionInfo
    bool is_builtin = false;
    bool is_known = false;  ///< the callee can be no other: nothing left to look up
    std::vector<std::uint16_t> parameter_of;  ///< by argument, the receiver first
    std::uint32_t slots = 0;  ///< parameters, and behind them the rest arguments of a builtin
};
inline constexpr std::uint32_t kNoPlan = 0xffffffffU;

/// Documentation of a declaration.
struct DocOf {
    NodeId node;
    TextRange text;
};

struct Ast {
    std::vector<Node> nodes;
    std::vector<NodeId> children;
    std::vector<FunctionInfo> functions;
    std::vector<CallPlan> plans;
    std::vector<DocOf> docs;
    /// By block or for_each or comprehension clause: see Resolver. Slots of the frame that need a fresh cell on entry.
    struct Entry {
        std::vector<std::uint32_t> cells;
        std::vector<NodeId> functions;  ///< `function` statements, made on entry
    };
    std::vector<Entry> entries;  ///< Node::slot of a block is an index, or kNoPlan

    [[nodiscard]] std::span<const NodeId> children_of(const Node& n) const {
        return {children.data() + n.first, n.count};
    }
    [[nodiscard]] NodeId child(const Node& n, std::uint32_t i) const {
        return children[n.first + i];
    }
    [[nodiscard]] const Node& operator[](NodeId id) const { return nodes[id]; }
    [[nodiscard]] Node& operator[](NodeId id) { return nodes[id]; }
};

[[nodiscard]] std::string_view kind_name(NodeKind kind);
/// One node a line, indented by depth: kind, place as begin..end, name or value.
[[nodiscard]] std::string dump(const Ast& ast, NodeId root, const Symbols& symbols);

}  // namespace raymo::sml
