// The side of the sectors (sector.hpp) that is beyond the faces: chains of arcs from the one end of the near side, along face a
// to behind the edge, and along face b back to the other end.
#pragma once

#include <vector>

#include "raymo/blends/spine.hpp"

namespace raymo::blends {

/// How the chains are made: of so many cubics each, and how deep beyond the faces, as part of the radius. A face that bends much
/// along the section asks for many or for much depth, a thin solid for little.
struct Chains {
    std::size_t arcs;
    double depth;
};

/// The control points of the chains' cubics, end to end.
using FarPlace = std::vector<Vec3>;

class FarSide {
public:
    FarSide(const Spine& spine, Chains chains) : spine_(spine), chains_(chains) {}

    [[nodiscard]] std::size_t arcs() const { return 2 * chains_.arcs; }
    /// At a station, between these ends. False: it can not be followed there.
    [[nodiscard]] bool place(const Station& station, Vec3 end_a, Vec3 end_b, FarPlace& out) const;
    /// Whether the chains at u of the curves of the control points are beyond the faces, and within what they bound.
    [[nodiscard]] bool is_beyond(const std::vector<Cubic>& lines, double u) const;

private:
    [[nodiscard]] double depth() const { return chains_.depth * spine_.radius(); }
    /// The distance of a point beyond face a or b: positive where the wedge is not.
    [[nodiscard]] double beyond(std::size_t which, Vec3 p) const {
        return -spine_.segment().sign() * spine_.side(which) * spine_.surface(which).distance(p);
    }
    /// Moves a point to its depth beyond a face, in the plane across a direction.
    [[nodiscard]] bool to_depth(std::size_t which, Vec3 across, Vec3& p) const;

    const Spine& spine_;
    Chains chains_;
};

}  // namespace raymo::blends
