// The stretches of edges that are to be blended.
#pragma once

#include <vector>

#include "raymo/blends/blend.hpp"
#include "raymo/blends/body.hpp"
#include "raymo/blends/edge.hpp"
#include "raymo/blends/space_edge.hpp"

namespace raymo::blends {

/// Which of the four sectors about an edge are solid: bit 2 a + b, where a (b) is 1 on the inner side of face a (b).
using Sectors = std::uint8_t;
inline constexpr Sectors kUnknownSectors = 0x80;

/// Faces that meet at a smaller sine are continued by each other; there is no edge.
inline constexpr double kSmooth = 0x1p-20;

/// Where a stretch ends.
struct End {
    double at = 0.0;  ///< parameter of the edge
    Sectors beyond =
        0;  ///< what the edge looks like there, seen as of a concave edge (Segment::is_convex)
    std::vector<std::size_t> faces;  ///< others that are met there
    Vec3 point;
    /// In a corner of planes: how far from here the ball of the corner is that touches another of them, in parameters along the
    /// segment; it does not roll on from there. Negative where it rolls past the end (corner.hpp).
    double rest = 0.0;
    std::optional<std::size_t> rest_face;  ///< which it touches there
};

/// A stretch of an edge along which it is convex or concave all the way. The sides of both faces are turned so that the solid
/// of a convex edge is where both distances are negative, and the empty space at a concave one where both are positive.
struct Segment {
    EdgeCurve edge;      ///< unless `space` is set; of that only the sides count then
    SpaceEdgePtr space;  ///< a curve that is neither a line nor a circle
    std::size_t face_a = 0, face_b = 0;
    bool is_convex = true;
    bool is_closed = false;  ///< runs back into itself
    double lo = 0.0, hi = 0.0;
    End ends[2];              ///< unless closed
    Vec3 centre;              ///< its point at the middle parameter
    bool is_used_up = false;  ///< no ball rolls along it: its corners have become one (corner.hpp)

    [[nodiscard]] Vec3 point(double t) const { return space ? space->point(t) : edge.point(t); }
    /// Unit; the way in which the parameter grows.
    [[nodiscard]] Vec3 tangent(double t) const {
        return space ? space->tangent(t) : edge.tangent(t);
    }
    /// Length of a parameter's step of 1.
    [[nodiscard]] double speed() const { return space ? 1.0 : edge.speed(); }
    /// The parameter at which a closed curve has come round.
    [[nodiscard]] double period() const;

    /// The sign of the distances from both faces to the centre of the ball.
    [[nodiscard]] double sign() const { return is_convex ? -1.0 : 1.0; }
    [[nodiscard]] double middle() const { return 0.5 * (lo + hi); }
    /// The way between the places where balls rest at its ends, in parameters: below 0 where they are past each other.
    [[nodiscard]] double rolled() const { return hi - ends[1].rest - (lo + ends[0].rest); }
};

/// All stretches between faces of different operands, or of all faces. `reach`: the size of what is to be blended, for how close
/// to an edge its sectors are looked at. The box of the body must be bounded. Error: cancelled, by `spend`.
[[nodiscard]] Result<std::vector<Segment>> find_segments(const Body& body, bool within_operands,
                                                         double reach, const Spend& spend = {});

}  // namespace raymo::blends
