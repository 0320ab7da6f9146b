// Where balls rest in a corner of planes.
//
// A corner K = { x: n_i.x <= k_i }, i = 0 .. m - 1, whose planes meet in one point, to within roundings. The centres of balls of
// radius r within it are the inner corner K_r = { n_i.x <= k_i - r }, and what they cover, the corner's opening, is all that
// is no farther than r from K_r. The foot of a point on K_r is held there by at most three planes (Caratheodory: the way
// to the foot is a positive sum of the normals of planes that hold it, and three of them are enough). So
//     the opening of K  =  the intersection of the openings of all its pairs and triples of planes,
// and what is taken away from K is the union of what each pair and each triple takes away: wedges, and corners of balls. None
// of these takes away too much, wherever it ends, and only those that hold a foot are needed:
//     at each vertex of K_r one ball, for all the planes through it;
//     along each of its edges a wedge: those without end belong to edges of K, the others are bridges, between
//     planes that are not neighbours at the corner.
// Where vertices nearly coincide bridges are short, and as each may be run on at both ends no sliver stays between two balls.
//
// The planes are neighbours in a ring. The line on which a ball touches two neighbours p and q is an edge of K_r up to where the
// first of the others is touched: there is the vertex. It takes with it all planes that are touched there, and between each two
// of these that are no neighbours the next vertex is looked for in the same way, on their line, among the planes between them. So
// each step is a minimum over one coordinate, and what comes out is a subdivision of the ring, whatever is rounded.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "raymo/math/vec.hpp"

namespace raymo::blends {

/// A side of a corner: n.x <= level, with the corner in the origin.
struct CornerPlane {
    Vec3 normal;  ///< unit
    double level = 0.0;
};

struct InnerCorner {
    struct Vertex {
        Vec3 at;
        std::vector<std::size_t> planes;  ///< through it: three or more, in the order of the ring
    };
    /// An edge between planes that are no neighbours. Its ends may be the same but for rounding.
    struct Bridge {
        std::size_t planes[2];
        std::size_t vertices[2];
    };
    std::vector<Vertex> vertices;
    std::vector<Bridge> bridges;
    std::vector<std::size_t> first;  ///< vertex on the edge of planes i and i + 1
};

/// The inner corner at a distance of `radius` from all planes, which are three or more, in the order in which they are
/// neighbours. `edge`: along the edge of the first two, away from the corner. Planes that miss a vertex by less than roundings of their
/// normals ask for, or by less than `slack`, go through it. Empty where the planes are no such corner. Cost: planes^2.
[[nodiscard]] std::optional<InnerCorner> inner_corner(const std::vector<CornerPlane>& planes,
                                                      Vec3 edge, double radius, double slack);

}  // namespace raymo::blends
