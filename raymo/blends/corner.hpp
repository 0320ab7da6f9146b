// Corners in which all edges are blended alike: where they are, and what balls leave of them.
//
// A corner is a point where three or more edges of one kind end, each of them between two faces that are neighbours in a ring:
// seen from the corner the solid (of a concave corner the empty space) is a convex cone. What the edges' wedges leave there
// is between the faces and the balls that touch them. Where one ball touches all faces, of whatever kind, its corner is the
// cone from the centre over its contacts, up to the faces. Planes that no ball touches all of have several balls, with
// bridges between them (inner_corner.hpp).
//
// Along an edge of planes the ball rolls from where it rests in the one corner to where it rests in the other. Where these places
// are past each other it does not roll there at all, and the edge is used up: the planes of both corners make one corner, whose inner
// corner tells what comes instead, as long as each of them still has its two edges in it. So the corners of
// planes that miss one point by little are as good as those that do not. Where a face has nothing left but edges that are used up the
// ball is too large.
#pragma once

#include <vector>

#include "raymo/blends/inner_corner.hpp"
#include "raymo/blends/segment.hpp"
#include "raymo/blends/wedge.hpp"

namespace raymo::blends {

struct Corner {
    /// A face, with the side that the segments gave it.
    struct Side {
        std::size_t face = 0;
        double side = 1.0;
    };
    /// Between sides i and i + 1.
    struct Edge {
        std::size_t segment = 0;
        std::size_t end = 0;
    };
    Vec3 point;  ///< where it is; of several that became one: where one of them was
    bool is_convex = true;
    std::vector<Side> sides;  ///< in the order in which they are neighbours
    std::vector<Edge> edges;
    Vec3 away{};    ///< along the first of these
    Vec3 middle{};  ///< unit: between all of them
};

/// The corners at the ends of these segments, for balls of this radius. Where all sides are planes the segments' ends are
/// told how far from there a ball comes to rest (End::rest), and segments that they are used up. Error, for balls only: more
/// than three faces, some of whose edges are of the other kind or not among the segments.
[[nodiscard]] Result<std::vector<Corner>> find_corners(const Body& body,
                                                       std::vector<Segment>& segments,
                                                       Profile profile, double radius);

/// How the balls of a corner and those of its bridges fit the body.
[[nodiscard]] Fitting fitting_of(const Body& body, const Corner& corner, double radius);

/// What a ball leaves of a corner beside the wedges of its edges. Errors: no ball of this radius touches the faces; more than
/// three faces, not all planes, that no ball touches all of.
[[nodiscard]] Result<std::vector<csg::Solid>> solids_of(const Body& body, const Corner& corner,
                                                        const Form& form, SourceSpan span);

[[nodiscard]] const Surface& surface_of(const Body& body, const Corner::Side& side);
/// 1 of a convex corner: its planes' normals by their sides point out of the cone that balls are in; -1 of a concave one.
[[nodiscard]] double sign_of(const Corner& corner);
/// How far surfaces that go through one point are off it by rounding [mm].
[[nodiscard]] double slack_of(const Body& body, Vec3 at);
/// "(1, 0, 2.5)": a point for messages, where what rounding left of 0, up to `grain`, is none.
[[nodiscard]] std::string place_text(Vec3 at, double grain);
/// Whether a corner is a ring of planes, and where the balls in it are then, from its point. Empty where the planes are no corner.
[[nodiscard]] bool is_of_planes(const Body& body, const Corner& corner);
[[nodiscard]] std::optional<InnerCorner> inner_of(const Body& body, const Corner& corner,
                                                  double radius);

/// "the corner at (1, 2, 3), where the top of the block, ... and the side of the cylinder meet"
[[nodiscard]] std::string name_of(const Body& body, const Corner& corner);

}  // namespace raymo::blends
