// The wedge between two faces and the ball that rolls along them: what a round takes away and a fillet adds.
#pragma once

#include <optional>

#include "raymo/blends/segment.hpp"

namespace raymo::blends {

/// How far a wedge reaches beyond the faces, as part of its radius: far more than roundings, far less than anything seen.
inline constexpr double kBeyond = 0x1p-20;

/// A face is in a ball's way when it comes nearer to its centre than the radius by more than this part of it.
inline constexpr double kPress = 0x1p-20;

/// A wedge in the section of its edge. It reaches a little beyond both faces, to the side where the Boolean does not care, so
/// that it has no face in common with what it is joined to.
struct Wedge {
    double radius = 0.0;
    Vec2 centre;      ///< of the ball
    Vec2 contact[2];  ///< where it touches face a and face b
    Vec2 behind[2];   ///< the contacts, moved beyond the faces
    Vec2 corner;      ///< where the faces meet, moved so, too
};

/// Empty where no such ball touches both faces next to the edge.
[[nodiscard]] std::optional<Wedge> wedge_of(const Segment& segment, double radius);

/// A ball that touches both faces of an edge, in space.
struct Touch {
    Vec3 centre;
    Vec3 contact[2];
    Vec3 outward[2];  ///< of the faces at their contacts, by the segment's sides
};
/// The ball whose centre is in the plane across the edge at a parameter.
[[nodiscard]] std::optional<Touch> touch_at(const Body& body, const Segment& segment, double radius,
                                            double t);

/// The same along a line or a circle, of the wedge there.
[[nodiscard]] Touch touch_at(const Segment& segment, const Wedge& wedge, double t);
/// What it takes to find one of these, in units of some 100 ns.
[[nodiscard]] double touch_work(const Body& body, const Segment& segment);

/// How a ball fits a body; the worst of what was found.
enum class Fit : std::uint8_t {
    good,
    none,          ///< no ball of that radius touches both faces
    off_face,      ///< it would touch a face where there is none any more
    blocked,       ///< another face is in its way
    touching,      ///< the faces meet at too small an angle
    endless_bend,  ///< the edge could not be followed where it bends
    stopped,       ///< `spend` did not allow to find out
};
struct Fitting {
    Fit fit = Fit::good;
    std::size_t face = 0;   ///< which, if off_face or blocked
    std::size_t found = 0;  ///< next to which face
};
/// Tries the ball along the segment, away from its ends: at several places, and wherever a third face is near. `first`: of the
/// faces, with which to begin.
[[nodiscard]] Fitting fitting_of(const Body& body, const Segment& segment, double radius,
                                 const Spend& spend = {}, std::size_t first = 0);

/// How far a ball that fits and its contacts are away from the edge, at most.
[[nodiscard]] double extent_of(const Body& body, const Segment& segment, double radius);

/// The wedge of a straight or circular segment from parameter lo to hi: a prism or a surface of revolution.
[[nodiscard]] Result<csg::Solid> solid_of(const Segment& segment, const Form& form, double lo,
                                          double hi, SourceSpan span);

/// How far a wedge has to be run on beyond an end, in parameters, so that all of it is past `surface`; at most `limit`.
[[nodiscard]] double reach_past(const Body& body, const Segment& segment, double radius,
                                std::size_t end, const Surface& surface, double limit);

}  // namespace raymo::blends
