// Boxes around solids.
//
// The exact box of a transformed solid needs the whole map from each leaf to the outside, so one visit for every path from
// the root to a leaf. A graph that shares solids may have exponentially many paths; beyond kMaxPaths each node is visited
// once, and the box of a transformed solid is the box of its transformed box.
#include <algorithm>
#include <unordered_map>
#include <utility>
#include <variant>
#include <vector>

#include "raymo/csg/model.hpp"

namespace raymo::csg {
namespace {

constexpr double kMaxPaths = 1e6;

Aabb leaf_box(const Node& node, const Affine& map) {
    const LeafNode& leaf = as_leaf(node);
    const Affine whole = map * leaf.solid.to_object;
    return std::visit([&](const auto& kernel) { return kernel.bounds(whole); }, leaf.solid.kernel);
}

std::size_t operand_count(const Node& node) {
    switch (node.kind) {
        case NodeKind::leaf:
            return 0;
        case NodeKind::transform:
        case NodeKind::paint:
            return 1;
        case NodeKind::boolean:
            // Only the first operand of a difference matters.
            return node.op == Op::difference ? 1 : as_boolean(node).operands.size();
    }
    return 0;
}

const Node& operand(const Node& node, std::size_t i) {
    if (node.kind == NodeKind::transform) return as_transform(node).child.node();
    if (node.kind == NodeKind::paint) return as_paint(node).child.node();
    return as_boolean(node).operands[i].node();
}

Aabb joined(Op op, const Aabb& a, const Aabb& b) {
    if (op == Op::intersection) return overlap(a, b);
    return a.empty() ? b : (b.empty() ? a : hull(a, b));
}

Aabb bounds_by_path(const Node& root) {
    struct Visit {
        const Node* node;
        std::size_t map;  ///< index of the map from the node's frame to the outside
        std::size_t next = 0;
        Aabb box = {};
    };
    std::vector<Affine> maps{Affine{}};  // of the transforms that are being visited
    std::vector<Visit> open{{&root, 0}};
    Aabb result;
    while (!open.empty()) {
        Visit& visit = open.back();
        const Node& node = *visit.node;
        if (visit.next < operand_count(node)) {
            if (visit.next > 0 && node.op == Op::intersection && visit.box.empty()) {
                visit.next = operand_count(node);
                continue;
            }
            std::size_t map = visit.map;
            if (node.kind == NodeKind::transform) {
                maps.push_back(maps[map] * as_transform(node).map);
                map = maps.size() - 1;
            }
            const Node& child = operand(node, visit.next++);
            open.push_back({&child, map});
            continue;
        }
        const Aabb box = node.kind == NodeKind::leaf ? leaf_box(node, maps[visit.map]) : visit.box;
        if (node.kind == NodeKind::transform) maps.pop_back();
        open.pop_back();
        if (open.empty()) {
            result = box;
        } else {
            Visit& parent = open.back();
            parent.box = parent.next == 1 ? box : joined(parent.node->op, parent.box, box);
        }
    }
    return result;
}

Aabb bounds_by_node(const Node& root) {
    std::unordered_map<const Node*, Aabb> boxes;
    std::vector<std::pair<const Node*, std::size_t>> open{{&root, 0}};
    while (!open.empty()) {
        auto& [node, next] = open.back();
        if (next < operand_count(*node)) {
            const Node& child = operand(*node, next++);
            if (!boxes.contains(&child)) open.emplace_back(&child, 0);
            continue;
        }
        Aabb box;
        if (node->kind == NodeKind::leaf) {
            box = leaf_box(*node, {});
        } else {
            box = boxes[&operand(*node, 0)];
            for (std::size_t i = 1; i < operand_count(*node); ++i) {
                box = joined(node->op, box, boxes[&operand(*node, i)]);
            }
            if (node->kind == NodeKind::transform) box = transformed(as_transform(*node).map, box);
        }
        boxes[node] = box;
        open.pop_back();
    }
    return boxes[&root];
}

}  // namespace

Aabb bounds(const Solid& solid) {
    const Node& root = solid.node();
    return root.node_count <= kMaxPaths ? bounds_by_path(root) : bounds_by_node(root);
}

}  // namespace raymo::csg
