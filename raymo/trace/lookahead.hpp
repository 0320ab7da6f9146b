// Fetches nodes of a solid's graph into the caches before a walk over its leaves comes to them.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "raymo/csg/model.hpp"

namespace raymo::trace {

/// Goes down ahead of a walk over the operands of a Boolean, through what lies around their leaves. A node tells where the
/// next one is; so all operands that are near are followed by one node at every step, and none is waited for.
class Lookahead {
public:
    /// The walk comes to operand number `next`.
    void step(std::span<const csg::Solid> operands, std::size_t next) {
        for (const csg::Node*& node : ahead_) {
            if (node != nullptr && (node = below(*node)) != nullptr) fetch(node);
        }
        if (next + kAhead >= operands.size()) return;
        const csg::Node*& last = ahead_[next % kAhead];
        last = &operands[next + kAhead].node();
        fetch(last);
    }

private:
    static constexpr std::size_t kAhead = 8;  ///< operands; few have more nodes around their leaf

    [[nodiscard]] static const csg::Node* below(const csg::Node& node) {
        if (node.kind == csg::NodeKind::transform) return &csg::as_transform(node).child.node();
        if (node.kind == csg::NodeKind::paint) return &csg::as_paint(node).child.node();
        return nullptr;
    }
    static void fetch(const csg::Node* node) {
        constexpr std::size_t kLine = 64;
        const char* const lines = reinterpret_cast<const char*>(node);
        for (std::size_t i = 0; i < sizeof(csg::LeafNode); i += kLine)
            __builtin_prefetch(lines + i);
    }

    std::array<const csg::Node*, kAhead> ahead_{};
};

}  // namespace raymo::trace
