// Edges along curves in space: where two surfaces meet that share neither a direction nor an axis.
//
// Such a curve has no parameter of its own. It is followed step by step: the next point is where both distances are 0 on a
// sphere about the last one, found by Newton's method from the point ahead. Steps are as short as the curve's bends ask for.
// The parameter is the length of the polygon so far. [mm]
// Branches are found by families of lines or circles on both surfaces: their meetings with the other surface are roots of
// polynomials and none is missed. Where such a line passes the other surface by less than its neighbours are away, a branch may
// slip between them: from there one is looked for by Newton's method.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "raymo/blends/surface.hpp"
#include "raymo/math/aabb.hpp"

namespace raymo::blends {

class SpaceEdge {
public:
    SpaceEdge(Surface a, Surface b, std::vector<Vec3> nodes, bool is_closed, bool is_smooth);

    [[nodiscard]] bool is_closed() const { return is_closed_; }
    /// False where the curve turns too sharply to be followed, as where two branches cross because the surfaces touch.
    [[nodiscard]] bool is_smooth() const { return is_smooth_; }
    /// Parameters run from 0 to this; of a closed curve any parameter is good.
    [[nodiscard]] double last() const { return at_.back(); }
    /// The point at a parameter. Exact but for rounding.
    [[nodiscard]] Vec3 point(double t) const;
    /// Unit; the way in which the parameter grows.
    [[nodiscard]] Vec3 tangent(double t) const;

    /// Steps from node to node, at least two.
    [[nodiscard]] std::size_t steps() const { return at_.size() - 1; }
    /// The parameter of a node; of a closed curve they go on round it.
    [[nodiscard]] double node(std::size_t i) const {
        const std::size_t rounds = i / steps();
        return at_[i % steps()] + last() * static_cast<double>(rounds);
    }
    /// Length of the step at a parameter.
    [[nodiscard]] double step_at(double t) const;
    /// Where on this curve a point is that is on both surfaces, about; empty when it is on another curve.
    [[nodiscard]] std::optional<double> parameter_of(Vec3 p) const;

private:
    struct Place {
        std::size_t step;
        double part;  ///< of the step
    };
    [[nodiscard]] Place place_of(double t) const;

    Surface a_, b_;
    std::vector<Vec3> nodes_;  ///< of a closed curve the first is the last, too
    std::vector<double> at_;
    bool is_closed_;
    bool is_smooth_;
};

using SpaceEdgePtr = std::shared_ptr<const SpaceEdge>;

/// The curves in which two surfaces meet within a bounded box, and a step beyond it. Curves that run through a point where the surfaces touch end there.
[[nodiscard]] std::vector<SpaceEdgePtr> space_edges(const Surface& a, const Surface& b,
                                                    const Aabb& box);

/// The point next to `p` where both distances are as given, in the plane through p at right angles to `across`. False when
/// there is none, or Newton's method finds none.
[[nodiscard]] bool to_distances(const Surface& a, double from_a, const Surface& b, double from_b,
                                Vec3 across, Vec3& p);

}  // namespace raymo::blends
