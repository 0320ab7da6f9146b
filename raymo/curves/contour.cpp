#include "raymo/curves/contour.hpp"

#include <unordered_map>
#include <utility>

#include "raymo/core/assert.hpp"

namespace raymo::curves {
namespace {

/// Calls f(node) for every node once, operands first. Trees may be deep and may share nodes.
template <class F>
void visit(const Contour& root, F&& f) {
    std::unordered_map<const ContourNode*, bool> done;
    std::vector<std::pair<const Contour*, std::size_t>> open{{&root, 0}};
    while (!open.empty()) {
        auto& [contour, next] = open.back();
        const ContourNode& node = **contour;
        if (next < node.operands.size()) {
            const Contour& operand = node.operands[next++];
            if (!done.contains(operand.get())) open.emplace_back(&operand, 0);
            continue;
        }
        if (done.emplace(&node, true).second) f(node);
        open.pop_back();
    }
}

}  // namespace

Contour contour_of(Outline outline) {
    auto node = std::make_shared<ContourNode>();
    node->outline = std::make_shared<const Outline>(std::move(outline));
    return node;
}

Contour combined(ContourOp op, std::vector<Contour> operands) {
    RAYMO_ASSERT(op != ContourOp::outline && !operands.empty());
    auto node = std::make_shared<ContourNode>();
    node->op = op;
    node->operands = std::move(operands);
    return node;
}

Contour mapped(const Contour& contour, const Affine2& map) {
    std::unordered_map<const ContourNode*, Contour> images;
    visit(contour, [&](const ContourNode& node) {
        auto image = std::make_shared<ContourNode>();
        image->op = node.op;
        if (node.op == ContourOp::outline) {
            Outline outline = *node.outline;
            for (Curve& curve : outline.curves) {
                for (Span2& span : curve.spans) span = mapped(span, map);
            }
            image->outline = std::make_shared<const Outline>(std::move(outline));
        }
        for (const Contour& operand : node.operands)
            image->operands.push_back(images[operand.get()]);
        images[&node] = std::move(image);
    });
    return images[contour.get()];
}

bool is_open(const Contour& contour) {
    bool open = false;
    visit(contour, [&](const ContourNode& node) {
        if (node.op != ContourOp::outline) return;
        for (const Curve& curve : node.outline->curves) open = open || !curve.closed;
    });
    return open;
}

}  // namespace raymo::curves
