// Where points are with respect to solids.
//
// Each leaf near the point says in, on or out, on meaning that its boundary passes within the
// rounding error of the point. The Booleans combine these as Kleene's three-valued logic does (on =
// not known): union is the larger, intersection the smaller of  out < on < in, and a complement
// turns them round. An answer of in or out is certain then. An answer of on is certain when one
// leaf only was on. When several were (the shared face of two abutting blocks, a - a, an edge) the
// point's neighbourhood decides: from the point out, in many generic directions and in directions
// taken from the leaves (towards their centres and across), every leaf that is on is asked for its
// state just beside the point. All sides in: in. All sides out: out. Both: on. A solid whose
// thickness in all of these directions lies below the error is nothing.
#pragma once

#include <vector>

#include "raymo/core/progress.hpp"
#include "raymo/query/graph.hpp"
#include "raymo/scene/scene.hpp"

namespace raymo::query {

using solids::Where;

/// Answers for points. Holds scratch memory, so one per thread.
class Locator {
public:
    /// For one solid, which is part 0.
    explicit Locator(const csg::Solid& solid);
    /// For all parts of a scene.
    explicit Locator(const scene::Scene& scene);

    /// Where the point is in the union of all parts. p must be finite.
    /// Cost: the operands whose boxes hold the point, found through trees of boxes.
    [[nodiscard]] Where where(Vec3 p) { return locate(all_, p); }
    [[nodiscard]] Where where(std::size_t part, Vec3 p) { return locate(roots_[part], p); }
    /// in or out when all points within `reach` of p (component by component) are, else on.
    [[nodiscard]] Where where_all(Vec3 p, Vec3 reach);

    /// Lets all later answers together meet at most `nodes` nodes, and lets the user stop them. Until
    /// this is called there is no limit. `progress` may be null.
    void allow(std::uint64_t nodes, const Progress* progress) {
        steps_left_ = nodes;
        progress_ = progress;
    }
    /// True when what was allowed has been used up, or the user has stopped it: the answers since
    /// then are `on` and mean nothing.
    [[nodiscard]] bool exhausted() const { return steps_left_ == 0; }

    [[nodiscard]] const Graph& graph() const { return graph_; }
    [[nodiscard]] std::uint32_t root() const { return all_; }

private:
    /// A point in the frame of some node, how far the true one may be, and the direction of
    /// interest.
    struct Place {
        Vec3 p;
        Vec3 error;
        Vec3 direction;
        Vec3 direction_error;
        Mat3 outward;  ///< linear map from this frame to the world
    };
    struct Frame {
        std::uint32_t node;
        std::uint32_t next;  ///< operands done
        std::size_t nearby;  ///< begin of the operands in nearby_, for a node with a tree
        Where value;
        Place place;
    };

    [[nodiscard]] Where locate(std::uint32_t root, Vec3 p);
    [[nodiscard]] Where evaluate(std::uint32_t root, const Place& start, bool beside);
    [[nodiscard]] bool spend();
    [[nodiscard]] bool next_operand(Frame& frame, std::uint32_t& operand);
    [[nodiscard]] Where leaf(const csg::LeafNode& node, const Place& outer, bool beside);

    std::vector<csg::Solid> keep_;
    Graph graph_;
    std::vector<std::uint32_t> roots_;
    std::uint32_t all_ = 0;
    std::vector<Frame> frames_;
    std::vector<std::uint32_t> nearby_;
    std::uint64_t steps_left_ = ~std::uint64_t{0};
    const Progress* progress_ = nullptr;
    std::uint64_t leaves_on_ = 0;  ///< leaves that were on in the last evaluation
    std::vector<Vec3> towards_;    ///< world directions from the point to their centres (a few)
};

}  // namespace raymo::query
