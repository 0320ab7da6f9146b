// Pairs of solids that meet in an edge, each with one surface that matters: all pairs of the five surfaces with a common axis or
// a common direction.
#pragma once

#include <optional>
#include <string>

#include "tests/laws/law.hpp"
#include "tests/laws/rolled.hpp"

namespace raymo::laws {

/// How far away the other faces of the operands are, and how far the edges reach, when the surfaces' sizes are about 1.
inline constexpr double kFar = 24.0, kReach = 8.0;

struct Operand {
    ModelPtr model;
    RealSurface surface;
};

struct Pair {
    Operand a, b;
    bool is_circle = false;
    Affine map;
    double scale = 1;
    csg::Op op = csg::Op::unite;
    RealSection section;
    RealVec along;  ///< unit, the axis or the direction
    RealVec edge;

    /// The image of a point of the section, run on by t: an angle, or a length in units of the scale.
    [[nodiscard]] RealVec place(RealVec p, double t) const;
};

/// The kinds of pairs.
inline constexpr int kPairKinds = 16;
/// "sphere and torus, one axis"
[[nodiscard]] std::string pair_name(int kind);
/// A pair of a kind that meets in an edge, which is crossed at some angle; under a random similarity. Empty when the sizes and
/// places that were drawn have no such edge.
[[nodiscard]] std::optional<Pair> any_pair(int kind, Random& random);

}  // namespace raymo::laws
