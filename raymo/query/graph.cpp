#include "raymo/query/graph.hpp"

#include <algorithm>
#include <cmath>

#include "raymo/math/tolerance.hpp"

namespace raymo::query {
namespace {

constexpr std::size_t kTreeFrom = 16;  // operands from which a tree of boxes pays
constexpr std::size_t kTreeLeaf = 4;

/// The child that decides where points are: below any paint.
const csg::Node* unpainted(const csg::Node* node) {
    while (node->kind == csg::NodeKind::paint) node = &csg::as_paint(*node).child.node();
    return node;
}

/// Boxes are computed with a few roundings; a solid that touches its box must not be cut off by
/// them.
Aabb widened(Aabb box) {
    if (box.empty()) return box;
    for (int i = 0; i < 3; ++i) {
        const double a = std::fabs(box.lo[i]);
        const double b = std::fabs(box.hi[i]);
        const double size = std::max(std::isfinite(a) ? a : 0.0, std::isfinite(b) ? b : 0.0);
        box.lo[i] -= kPointError * size;
        box.hi[i] += kPointError * size;
    }
    return box;
}

/// Middle of a box along an axis; any number where the box is infinite.
double middle(const Aabb& box, int axis) {
    const double m = 0.5 * box.lo[axis] + 0.5 * box.hi[axis];
    return std::isfinite(m) ? m : 0.0;
}

}  // namespace

std::uint32_t Graph::add(const csg::Solid& solid) {
    const csg::Node* root = unpainted(&solid.node());
    std::vector<std::pair<const csg::Node*, std::size_t>> open{
        {root, 0}};  // a node and its next operand
    while (!open.empty()) {
        auto& [node, next] = open.back();
        if (known_.contains(node)) {
            open.pop_back();
            continue;
        }
        const csg::Node* child = nullptr;
        if (node->kind == csg::NodeKind::transform && next == 0) {
            child = &csg::as_transform(*node).child.node();
        } else if (node->kind == csg::NodeKind::boolean) {
            const auto& operands = csg::as_boolean(*node).operands;
            if (next < operands.size()) child = &operands[next].node();
        }
        if (child != nullptr) {
            ++next;
            child = unpainted(child);
            if (!known_.contains(child)) open.emplace_back(child, 0);
            continue;
        }
        const std::uint32_t index = append(*node);
        known_.emplace(node, index);
        open.pop_back();
    }
    return known_.at(root);
}

std::uint32_t Graph::append(const csg::Node& node) {
    if (node.kind == csg::NodeKind::boolean) {
        std::vector<std::uint32_t> operands;
        for (const csg::Solid& s : csg::as_boolean(node).operands) {
            operands.push_back(known_.at(unpainted(&s.node())));
        }
        return append_boolean(node.op, operands, &node);
    }
    Node flat;
    flat.kind = node.kind;
    flat.source = &node;
    if (node.kind == csg::NodeKind::leaf) {
        const solids::AnySolid& solid = csg::as_leaf(node).solid;
        flat.box = widened(std::visit(
            [&](const auto& kernel) { return kernel.bounds(solid.to_object); }, solid.kernel));
    } else {
        const csg::TransformNode& transform = csg::as_transform(node);
        flat.first = known_.at(unpainted(&transform.child.node()));
        flat.map = static_cast<std::uint32_t>(inverses_.size());
        inverses_.push_back(raymo::inverse(transform.map.linear));
        const Aabb& inner = nodes_[flat.first].box;
        flat.box = inner.empty() ? inner : widened(transformed(transform.map, inner));
    }
    nodes_.push_back(flat);
    return static_cast<std::uint32_t>(nodes_.size() - 1);
}

std::uint32_t Graph::unite(std::vector<std::uint32_t> operands) {
    return append_boolean(csg::Op::unite, operands, nullptr);
}

std::uint32_t Graph::append_boolean(csg::Op op, std::span<const std::uint32_t> operands,
                                    const csg::Node* source) {
    Node flat;
    flat.kind = csg::NodeKind::boolean;
    flat.op = op;
    flat.source = source;
    flat.first = static_cast<std::uint32_t>(operands_.size());
    flat.count = static_cast<std::uint32_t>(operands.size());
    operands_.insert(operands_.end(), operands.begin(), operands.end());
    if (op == csg::Op::unite) {
        for (const std::uint32_t i : operands) {
            // An empty box may have its sides exchanged at finite places, which a hull would take in.
            if (!nodes_[i].box.empty()) flat.box = hull(flat.box, nodes_[i].box);
        }
    } else if (!operands.empty()) {
        flat.box = nodes_[operands[0]].box;
        if (op == csg::Op::intersection) {
            for (const std::uint32_t i : operands) flat.box = overlap(flat.box, nodes_[i].box);
        }
    }
    if (op != csg::Op::intersection && operands.size() >= kTreeFrom) {
        flat.tree = build_tree(operands.subspan(op == csg::Op::unite ? 0 : 1));
    }
    nodes_.push_back(flat);
    return static_cast<std::uint32_t>(nodes_.size() - 1);
}

std::uint32_t Graph::build_tree(std::span<const std::uint32_t> operands) {
    const auto root = static_cast<std::uint32_t>(tree_.size());
    struct Range {
        std::uint32_t begin, end, node;
    };
    const auto base = static_cast<std::uint32_t>(order_.size());
    order_.insert(order_.end(), operands.begin(), operands.end());
    std::vector<Range> open{{base, static_cast<std::uint32_t>(order_.size()), root}};
    tree_.emplace_back();
    while (!open.empty()) {
        const Range range = open.back();
        open.pop_back();
        Aabb box;
        Aabb middles;
        for (std::uint32_t i = range.begin; i < range.end; ++i) {
            const Aabb& b = nodes_[order_[i]].box;
            if (b.empty()) continue;
            box = hull(box, b);
            middles.include({middle(b, 0), middle(b, 1), middle(b, 2)});
        }
        tree_[range.node].box = box;
        if (range.end - range.begin <= kTreeLeaf || box.empty()) {
            tree_[range.node].first = range.begin;
            tree_[range.node].count = range.end - range.begin;
            continue;
        }
        const Vec3 size = middles.size();
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
        const std::uint32_t half = range.begin + (range.end - range.begin) / 2;
        std::nth_element(order_.begin() + range.begin, order_.begin() + half,
                         order_.begin() + range.end, [&](std::uint32_t a, std::uint32_t b) {
                             return middle(nodes_[a].box, axis) < middle(nodes_[b].box, axis);
                         });
        const auto left = static_cast<std::uint32_t>(tree_.size());
        tree_.emplace_back();
        tree_.emplace_back();
        tree_[range.node].first = left;
        open.push_back({range.begin, half, left});
        open.push_back({half, range.end, left + 1});
    }
    return root;
}

void Graph::near(const Node& node, Vec3 p, Vec3 reach, std::vector<std::uint32_t>& out) const {
    std::uint32_t
        open[64];  // halving 2^32 operands leaves at most 32 levels, one waiting sibling each
    int size = 0;
    open[size++] = node.tree;
    while (size > 0) {
        const TreeNode& t = tree_[open[--size]];
        if (!touches(t.box, p, reach)) continue;
        if (t.count > 0) {
            for (std::uint32_t i = t.first; i < t.first + t.count; ++i) {
                if (touches(nodes_[order_[i]].box, p, reach)) out.push_back(order_[i]);
            }
            continue;
        }
        open[size++] = t.first;
        open[size++] = t.first + 1;
    }
}

}  // namespace raymo::query
