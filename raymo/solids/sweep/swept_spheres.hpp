// What a sweep is prepared to: its path in the canonical frame, cut into short pieces under a tree of boxes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "raymo/math/aabb.hpp"
#include "raymo/solids/slabs.hpp"
#include "raymo/solids/sweep/cubics.hpp"

namespace raymo::solids {

/// The half-space n.x >= c that cuts the spheres near a flat end; n has unit length.
struct CapPlane {
    Vec3 n;
    double c = 0.0;
    friend bool operator==(const CapPlane&, const CapPlane&) = default;
};

/// A part of the path, and which flat caps cut its spheres: bit 0 the first, bit 1 the last.
struct SweptSpan {
    Cubics cubics;
    std::uint8_t cut = 0;
    friend bool operator==(const SweptSpan&, const SweptSpan&) = default;
};

struct SweptPiece {
    Cubics cubics;
    std::uint8_t cut = 0;
    bool begins = false;  ///< the path's round first end is at u = 0
    bool ends = false;    ///< its round last end is at u = 1
};

/// Boxes of up to eight neighbours in the order of the path.
using SweptNode = EightBoxes;

/// Immutable once built, and shared by the copies of a kernel.
struct SweptSpheres {
    std::vector<SweptSpan> spans;
    bool closed = false;
    bool flat = false;
    std::array<CapPlane, 2> caps;  ///< of flat ends

    // What follows from the above.
    std::vector<SweptPiece> pieces;
    /// levels[0][k] has the boxes of pieces 8 k ... 8 k + 7, levels[l][k] those of the nodes 8 k ... of level l - 1; the
    /// last level is one node.
    std::vector<std::vector<SweptNode>> levels;

    /// Cuts the spans into pieces and builds the tree.
    void finish();
    /// Memory it takes.
    [[nodiscard]] double bytes() const;
    /// The same solid: what is built from the same spans is the same.
    [[nodiscard]] bool equals(const SweptSpheres& other) const {
        return spans == other.spans && closed == other.closed && flat == other.flat &&
               caps == other.caps;
    }
};

/// Box of the spheres; flat caps are not looked at.
[[nodiscard]] Aabb box_of(const Cubics& cubics);
/// Largest n.r(u) + |n| a(u).
[[nodiscard]] double reach(const Cubics& cubics, Vec3 n, double length);

}  // namespace raymo::solids
