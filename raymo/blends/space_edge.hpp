// Edges along curves in space: where two surfaces meet that share neither a direction nor an axis.
//
// Such a curve has no parameter of its own. It is followed step by step, each of one length h: the next point is where both
// distances are 0 on the sphere of radius h about the last one, found by Newton's method from the point ahead. Equal steps make
// the points a smooth function of their number, so that splines through them are as good as their order promises.
// All branches are found that one of a family of lines or circles on the first surface meets: those meetings are roots of
// polynomials and none is missed.
#pragma once

#include <memory>
#include <vector>

#include "raymo/blends/surface.hpp"
#include "raymo/math/aabb.hpp"

namespace raymo::blends {

class SpaceEdge {
public:
    SpaceEdge(Surface a, Surface b, std::vector<Vec3> nodes, bool is_closed, bool is_smooth)
        : a_(a), b_(b), nodes_(std::move(nodes)), is_closed_(is_closed), is_smooth_(is_smooth) {}

    [[nodiscard]] bool is_closed() const { return is_closed_; }
    /// False where the curve turns sharply, as where two branches cross because the surfaces touch.
    [[nodiscard]] bool is_smooth() const { return is_smooth_; }
    /// Parameters run from 0 to this; of a closed curve any parameter is good.
    [[nodiscard]] double last() const {
        return static_cast<double>(is_closed_ ? nodes_.size() : nodes_.size() - 1);
    }
    /// The point at a parameter: a node at whole numbers. Exact but for rounding.
    [[nodiscard]] Vec3 point(double t) const;
    /// Unit; the way in which the parameter grows.
    [[nodiscard]] Vec3 tangent(double t) const;
    /// Length of a parameter's step of 1.
    [[nodiscard]] double speed() const { return norm(nodes_[1] - nodes_[0]); }

private:
    Surface a_, b_;
    std::vector<Vec3> nodes_;  ///< at equal distances; more than two
    bool is_closed_;
    bool is_smooth_;
};

using SpaceEdgePtr = std::shared_ptr<const SpaceEdge>;

/// The curves in which two surfaces meet within a bounded box, and a step beyond it. `finest`: steps are not much longer than
/// this part of it and as short as curvature asks for. Curves that run through a point where the surfaces touch end there.
[[nodiscard]] std::vector<SpaceEdgePtr> space_edges(const Surface& a, const Surface& b,
                                                    const Aabb& box);

/// The point next to `p` where both distances are as given, in the plane through p at right angles to `across`. False when
/// there is none, or Newton's method finds none.
[[nodiscard]] bool to_distances(const Surface& a, double from_a, const Surface& b, double from_b,
                                Vec3 across, Vec3& p);

}  // namespace raymo::blends
