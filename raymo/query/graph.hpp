// The graph of solids laid out in arrays, with boxes, for questions about points.
//
// Every shared node stands here once, whatever the number of its instances, in its own frame.
// Booleans with many operands get a tree of boxes over them, so that a point meets only the
// operands near it.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "raymo/csg/model.hpp"

namespace raymo::query {

class Graph {
public:
    struct Node {
        csg::NodeKind kind =
            csg::NodeKind::leaf;  ///< never `paint`: paint does not change where a point is
        csg::Op op = csg::Op::unite;
        std::uint32_t first = 0;  ///< boolean: first of its operands(); transform: the child
        std::uint32_t count = 0;  ///< boolean: number of operands
        std::uint32_t tree =
            kNone;  ///< boolean with many operands: root of the tree over those that are united
        std::uint32_t map = 0;  ///< transform: index for inverse()
        const csg::Node* source = nullptr;
        Aabb box;  ///< contains the solid, in the node's own frame
    };
    static constexpr std::uint32_t kNone = 0xffffffffU;

    /// Adds a solid and all below it; returns its index. The solid must live as long as the graph.
    /// Cost: O(n log n) in nodes that are not yet there; no recursion.
    std::uint32_t add(const csg::Solid& solid);
    /// Adds a union of nodes that are already there.
    std::uint32_t unite(std::vector<std::uint32_t> operands);

    [[nodiscard]] const Node& operator[](std::uint32_t index) const { return nodes_[index]; }
    [[nodiscard]] std::uint32_t operand(std::uint32_t place) const { return operands_[place]; }
    /// Inverse of the linear part of a transform node's map.
    [[nodiscard]] const Mat3& inverse(std::uint32_t map) const { return inverses_[map]; }
    /// Appends the operands of the node (all of a union, all but the first of a difference) whose
    /// boxes come within `reach` of p. The node must have a tree.
    void near(const Node& node, Vec3 p, Vec3 reach, std::vector<std::uint32_t>& out) const;

private:
    struct TreeNode {
        Aabb box;
        std::uint32_t first =
            0;  ///< leaf: first of order_; else: the left child; the right one follows it
        std::uint32_t count = 0;  ///< leaf: number of operands, > 0; else 0
    };

    std::uint32_t append(const csg::Node& node);
    std::uint32_t append_boolean(csg::Op op, std::span<const std::uint32_t> operands,
                                 const csg::Node* source);
    std::uint32_t build_tree(std::span<const std::uint32_t> operands);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> operands_;
    std::vector<Mat3> inverses_;
    std::vector<TreeNode> tree_;
    std::vector<std::uint32_t> order_;
    std::unordered_map<const csg::Node*, std::uint32_t> known_;
};

/// True when a point within `reach` of p, component by component, may lie in the box.
[[nodiscard]] inline bool touches(const Aabb& box, Vec3 p, Vec3 reach) {
    return box.lo.x - reach.x <= p.x && p.x <= box.hi.x + reach.x && box.lo.y - reach.y <= p.y &&
           p.y <= box.hi.y + reach.y && box.lo.z - reach.z <= p.z && p.z <= box.hi.z + reach.z;
}

}  // namespace raymo::query
