// Contours as values: an immutable, shared graph of outlines and their Booleans.
//
// What is swept along a contour of several outlines is the same Boolean of what each sweeps, exactly; so no curve is ever cut
// by another one. An outline keeps its pointer through Booleans and where it is moved, so that what is made of it can be
// shared, too: a page of text holds each letter once.
//
// Graphs may be a million nodes deep, and a node may be reached on 2^100 paths. Everything here takes each node once and
// keeps its place in a list, never on the call stack; that holds for freeing, too. A node is let go by one thread at a time.
#pragma once

#include <memory>
#include <span>
#include <unordered_set>
#include <utility>

#include "raymo/curves/outline.hpp"

namespace raymo::curves {

enum class ContourOp : std::uint8_t { outline, unite, difference, intersection };

struct ContourNode;
/// Never null where a contour is asked for.
using Contour = std::shared_ptr<const ContourNode>;

struct ContourNode {
    ContourOp op = ContourOp::outline;
    OutlinePtr outline;             ///< of an outline
    Vec2 at{};                      ///< of an outline: where its origin lies
    std::vector<Contour> operands;  ///< of the others: at least one

    ContourNode() = default;
    ContourNode(const ContourNode&) = delete;
    ContourNode& operator=(const ContourNode&) = delete;
    ~ContourNode();
};

[[nodiscard]] Contour contour_of(Outline outline);
[[nodiscard]] Contour contour_of(Curve curve);
[[nodiscard]] Contour contour_of(OutlinePtr outline, Vec2 at);
/// The outline of a node of that kind, where it lies.
[[nodiscard]] OutlinePtr placed_outline(const ContourNode& node);
/// operands.size() >= 1. A single operand is the result itself.
[[nodiscard]] Contour combined(ContourOp op, std::vector<Contour> operands);
/// The image under an affine map; nodes and outlines that several operands share are mapped once each. What is only moved
/// keeps its outlines.
[[nodiscard]] Contour mapped(const Contour& contour, const Affine2& map);
/// Whether a map only moves.
[[nodiscard]] constexpr bool is_move(const Affine2& map) {
    return map.xx == 1.0 && map.xy == 0.0 && map.yx == 0.0 && map.yy == 1.0;
}
/// Largest coordinate of its control points; infinite when one is not a number.
[[nodiscard]] double extent_of(const Contour& contour);
/// Box of the curves of an outline: exact but for rounding. Cost: about 1 us a span.
[[nodiscard]] Box2 box_of(const Outline& outline);
/// Box of a contour: unions by hull, intersections by overlap, differences by their first operand. May be empty.
[[nodiscard]] Box2 box_of(const Contour& contour);
/// Whether any of its curves is open.
[[nodiscard]] bool is_open(const Contour& contour);
/// The same Booleans of the same curves.
[[nodiscard]] bool is_equal(const Contour& a, const Contour& b);

/// Calls f(node) for every node once, operands before what is made of them.
template <class F>
void visit(const Contour& contour, F&& f) {
    std::unordered_set<const ContourNode*> done;
    std::vector<std::pair<const ContourNode*, std::size_t>> open{{contour.get(), 0}};
    while (!open.empty()) {
        const ContourNode* const node = open.back().first;
        if (open.back().second < node->operands.size()) {
            const ContourNode* const operand = node->operands[open.back().second++].get();
            if (!done.contains(operand)) open.emplace_back(operand, 0);
            continue;
        }
        open.pop_back();
        if (done.insert(node).second) f(*node);
    }
}

/// Lets go of a contour; calls f(node) for each node that nobody else holds, just before it goes.
template <class F>
void let_go(Contour contour, F&& f) {
    std::vector<Contour> doomed;
    doomed.push_back(std::move(contour));
    while (!doomed.empty()) {
        const Contour last = std::move(doomed.back());
        doomed.pop_back();
        if (last.use_count() != 1) continue;
        f(*last);
        // No handle is left that could see it change; nodes are not made const.
        auto& operands = const_cast<ContourNode&>(*last).operands;
        for (Contour& operand : operands) doomed.push_back(std::move(operand));
        operands.clear();
    }
}

/// Bytes of an outline, and of a node without its outline and its operands.
[[nodiscard]] double bytes_of(const Outline& outline);
[[nodiscard]] double bytes_of(const ContourNode& node);
/// Bytes of a whole contour: what a copy of it costs.
[[nodiscard]] double bytes_of(const Contour& contour);
/// Bytes that the image of a contour takes besides what it shares with the contour.
[[nodiscard]] double bytes_of_image(const Contour& contour, const Affine2& map);

}  // namespace raymo::curves
