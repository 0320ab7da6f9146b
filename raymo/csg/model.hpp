// Solids as values: a shared graph of primitives, transformations and Booleans. A node that is shared never changes.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "raymo/core/result.hpp"
#include "raymo/core/source_span.hpp"
#include "raymo/math/affine.hpp"
#include "raymo/solids/inventory.hpp"

namespace raymo::csg {

/// Booleans on any number of operands. `difference` takes all later operands from the first.
enum class Op : std::uint8_t { unite, difference, intersection };

/// Index into the scene's table of materials.
using MaterialId = std::uint32_t;
inline constexpr MaterialId kNoMaterial = 0xffffffffU;

enum class NodeKind : std::uint8_t { leaf, transform, boolean, paint };

struct Node;

/// A solid: a counted reference to a node, which does not change while there are others. Copying costs nothing but the
/// count; equal handles are the same node. A default-constructed Solid is null and only good for assignment.
class Solid {
public:
    Solid() = default;
    Solid(const Solid& other) noexcept;
    Solid(Solid&& other) noexcept : node_(other.node_) { other.node_ = nullptr; }
    Solid& operator=(Solid other) noexcept {
        std::swap(node_, other.node_);
        return *this;
    }
    ~Solid();

    [[nodiscard]] explicit operator bool() const { return node_ != nullptr; }
    [[nodiscard]] const Node& node() const { return *node_; }
    friend bool operator==(const Solid&, const Solid&) = default;

private:
    friend struct NodeAccess;
    explicit Solid(const Node* node) noexcept : node_(node) {}

    const Node* node_ = nullptr;
};

/// Common head of all nodes. The concrete type follows from `kind`; see the as_... functions.
struct Node {
    mutable std::atomic<std::uint32_t> references{1};
    NodeKind kind;
    Op op = Op::unite;  ///< of a boolean
    SourceSpan span;    ///< the expression that made the node
    /// Nodes below, each counted as often as it is instanced. Exact up to 10^7; who asks wants to know if they are too many.
    float node_count = 1.0F;
    double leaf_count = 1.0;  ///< leaves below, counted the same way; may be huge

    explicit Node(NodeKind k) : kind(k) {}
};

struct LeafNode : Node {
    LeafNode() : Node(NodeKind::leaf) {}
    solids::AnySolid solid;
    std::uint32_t primitive = 0;  ///< index into solids::inventory()
};
struct TransformNode : Node {
    TransformNode() : Node(NodeKind::transform) {}
    Affine map;  ///< child's frame -> this frame; invertible
    Solid child;
};
struct BooleanNode : Node {
    BooleanNode() : Node(NodeKind::boolean) {}
    std::vector<Solid>
        operands;  ///< at least one; order matters for `difference` and for coincident materials
};
struct PaintNode : Node {
    PaintNode() : Node(NodeKind::paint) {}
    MaterialId material = kNoMaterial;
    Solid child;
};

[[nodiscard]] inline const LeafNode& as_leaf(const Node& n) {
    return static_cast<const LeafNode&>(n);
}
[[nodiscard]] inline const TransformNode& as_transform(const Node& n) {
    return static_cast<const TransformNode&>(n);
}
[[nodiscard]] inline const BooleanNode& as_boolean(const Node& n) {
    return static_cast<const BooleanNode&>(n);
}
[[nodiscard]] inline const PaintNode& as_paint(const Node& n) {
    return static_cast<const PaintNode&>(n);
}

/// A leaf of the inventory's kind `primitive`. Errors: those of the primitive's schema and prepare().
[[nodiscard]] Result<Solid> primitive(std::uint32_t index,
                                      std::span<const solids::Argument> arguments,
                                      SourceSpan span = {});
/// The image of a solid. A leaf or a transformation that stands at the origin and has no other owner is moved as it is,
/// without a node of its own. Error: singular when the map can not be inverted to working precision or is not finite.
[[nodiscard]] Result<Solid> transform(Solid child, const Affine& map, SourceSpan span = {});
/// operands.size() >= 1. An operand that is itself a boolean stays shared; it is not opened up.
[[nodiscard]] Solid boolean(Op op, std::vector<Solid> operands, SourceSpan span = {});
/// Gives a material to every leaf below that has none yet: the innermost paint wins.
[[nodiscard]] Solid paint(Solid child, MaterialId material, SourceSpan span = {});

/// Box around the solid: unions by hull, intersections by overlap, differences by their first operand; leaves exact
/// under their whole transformation. May be infinite. Cost: one visit per path for trees of up to 10^6 nodes, beyond
/// that one visit per node with boxes of boxes.
[[nodiscard]] Aabb bounds(const Solid& solid);

}  // namespace raymo::csg
