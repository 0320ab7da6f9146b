// Contours as values: an immutable, shared tree of outlines and their Booleans.
//
// What is swept along a contour of several outlines is the same Boolean of what each sweeps, exactly; so no curve is ever cut
// by another one.
#pragma once

#include <memory>
#include <span>

#include "raymo/curves/outline.hpp"

namespace raymo::curves {

enum class ContourOp : std::uint8_t { outline, unite, difference, intersection };

struct ContourNode;
/// Never null where a contour is asked for.
using Contour = std::shared_ptr<const ContourNode>;

struct ContourNode {
    ContourOp op = ContourOp::outline;
    OutlinePtr outline;             ///< of an outline
    std::vector<Contour> operands;  ///< of the others: at least one
};

[[nodiscard]] Contour contour_of(Outline outline);
/// operands.size() >= 1.
[[nodiscard]] Contour combined(ContourOp op, std::vector<Contour> operands);
/// The image under an affine map; curves that several operands share are mapped once each.
[[nodiscard]] Contour mapped(const Contour& contour, const Affine2& map);
/// Whether any of its curves is open.
[[nodiscard]] bool is_open(const Contour& contour);

}  // namespace raymo::curves
