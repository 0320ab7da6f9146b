#include "raymo/csg/model.hpp"

#include <algorithm>
#include <utility>

#include "raymo/core/assert.hpp"

namespace raymo::csg {

/// Turns owned nodes into handles and back; only this file counts references.
struct NodeAccess {
    static Solid adopt(const Node* node) { return Solid(node); }
    static const Node* release(Solid& solid) { return std::exchange(solid.node_, nullptr); }
};

namespace {

/// Takes one reference away; true when it was the last.
bool drop(const Node* node) {
    return node->references.fetch_sub(1, std::memory_order_acq_rel) == 1;
}

/// Deletes a node that nobody refers to, and what only it referred to. A chain may be a million nodes long, so nodes to be
/// deleted are kept in a list, not on the call stack.
void destroy(const Node* first) {
    std::vector<const Node*> doomed{first};
    const auto let_go = [&](Solid& child) {
        const Node* node = NodeAccess::release(child);
        if (node != nullptr && drop(node)) doomed.push_back(node);
    };
    while (!doomed.empty()) {
        Node* node =
            const_cast<Node*>(doomed.back());  // no handle is left that could see it change
        doomed.pop_back();
        switch (node->kind) {
            case NodeKind::leaf:
                delete static_cast<LeafNode*>(node);
                break;
            case NodeKind::transform: {
                auto* transform = static_cast<TransformNode*>(node);
                let_go(transform->child);
                delete transform;
                break;
            }
            case NodeKind::boolean: {
                auto* boolean = static_cast<BooleanNode*>(node);
                for (Solid& operand : boolean->operands) let_go(operand);
                delete boolean;
                break;
            }
            case NodeKind::paint: {
                auto* paint = static_cast<PaintNode*>(node);
                let_go(paint->child);
                delete paint;
                break;
            }
        }
    }
}

/// Moves a solid that nobody else refers to within its own node, where that rounds nothing.
bool move_in_place(const Solid& solid, Vec3 by, SourceSpan span) {
    const Node& seen = solid.node();
    if (seen.references.load(std::memory_order_acquire) != 1) return false;
    auto& node = const_cast<Node&>(seen);  // no other handle could see it change
    const bool is_transform = node.kind == NodeKind::transform;
    if (!is_transform && node.kind != NodeKind::leaf) return false;
    Affine& map = is_transform ? static_cast<TransformNode&>(node).map
                               : static_cast<LeafNode&>(node).solid.to_object;
    if (map.offset != Vec3{}) return false;
    map.offset = by;
    if (is_transform) node.span = span;  // a leaf keeps the call that made it
    return true;
}

void count_child(Node& parent, const Solid& child) {
    parent.leaf_count += child.node().leaf_count;
    parent.node_count += child.node().node_count;
}

}  // namespace

Solid::Solid(const Solid& other) noexcept : node_(other.node_) {
    if (node_ != nullptr) node_->references.fetch_add(1, std::memory_order_relaxed);
}

Solid::~Solid() {
    if (node_ == nullptr || !drop(node_)) return;
    if (node_->kind == NodeKind::leaf) {
        delete static_cast<const LeafNode*>(node_);
    } else {
        destroy(node_);
    }
}

Result<Solid> primitive(std::uint32_t index, std::span<const solids::Argument> arguments,
                        SourceSpan span) {
    RAYMO_ASSERT(index < solids::inventory().size());
    auto made = solids::inventory()[index].make(arguments);
    if (!made) return Failure(std::move(made).error());
    const Mat3& linear = made->to_object.linear;
    if (!is_invertible(linear) || !is_finite(made->to_object.offset)) {
        return fail(ErrorCode::out_of_range,
                    std::string(solids::inventory()[index].schema->name) +
                        ": its sizes are too large, too small or too different to be computed with",
                    "give sizes between 1e-90 and 1e90");
    }
    auto* leaf = new LeafNode;
    leaf->span = span;
    leaf->solid = std::move(*made);
    leaf->primitive = index;
    return NodeAccess::adopt(leaf);
}

Result<Solid> transform(Solid child, const Affine& map, SourceSpan span) {
    RAYMO_ASSERT(static_cast<bool>(child));
    if (!is_finite(map.offset) || !is_invertible(map.linear)) {
        return fail(ErrorCode::singular,
                    "transform: the transformation can not be undone, it makes the solid flat",
                    "no scale may be 0, and the axes must keep different directions");
    }
    if (map.linear == Mat3{} && move_in_place(child, map.offset, span)) return child;
    auto* node = new TransformNode;
    node->span = span;
    node->map = map;
    node->leaf_count = 0.0;
    count_child(*node, child);
    node->child = std::move(child);
    return NodeAccess::adopt(node);
}

Solid boolean(Op op, std::vector<Solid> operands, SourceSpan span) {
    RAYMO_ASSERT(!operands.empty());
    auto* node = new BooleanNode;
    node->span = span;
    node->op = op;
    node->leaf_count = 0.0;
    for (const Solid& operand : operands) count_child(*node, operand);
    node->operands = std::move(operands);
    return NodeAccess::adopt(node);
}

Solid paint(Solid child, MaterialId material, SourceSpan span) {
    RAYMO_ASSERT(static_cast<bool>(child));
    auto* node = new PaintNode;
    node->span = span;
    node->material = material;
    node->leaf_count = 0.0;
    count_child(*node, child);
    node->child = std::move(child);
    return NodeAccess::adopt(node);
}

}  // namespace raymo::csg
