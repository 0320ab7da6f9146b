// Booleans whose edges are rolled by a ball, cut by a chamfer or replaced by a conic.
//
// Two faces of a body meet in an edge. Where it is convex a ball of radius r that rolls within the solid, touching both faces,
// leaves a wedge of material that it can not reach: the round takes that away. Where it is concave a ball that rolls outside
// leaves a wedge of space: the fillet fills that. Rounds and fillets are solids like all others, bounded by the tube that the ball
// sweeps: a cylinder along a straight edge, a torus along a circle (section.hpp). So a blended Boolean is a Boolean again, exact,
// and can be operand of others; its edges blend like any.
//
// At the end of an edge, where a third face is met, the wedge is run on and cut as the solid's own edges there ask for: into
// the material or out of it, in a mitre with the wedge of the next edge, or, where all edges of a corner are blended alike, to
// the balls that touch its faces (corner.hpp).
//
// Ref: geometry of rolling balls [Rossignac86]; [Wijk86 5].
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "raymo/csg/model.hpp"

namespace raymo::blends {

enum class Profile : std::uint8_t {
    ball,     ///< an arc of a circle of the given radius
    conic,    ///< an ellipse, parabola or hyperbola with the same contacts
    chamfer,  ///< straight from contact to contact
};

struct Form {
    double radius =
        1.0;  ///< of the ball, > 0; also decides where the other profiles begin and end [mm]
    Profile profile = Profile::ball;
    /// Of a conic, -1 < shape < 1: 0 an ellipse, towards 1 flatter, towards -1 closer to the edge.
    double shape = 0.0;
    std::optional<Vec3> near;  ///< only the edge nearest to this point
    csg::Solid where;          ///< if any: only edges with their middle inside
};

/// Called with work that has been done, in units of some 100 ns; false: stop, with the error `cancelled`. May be empty.
using Spend = std::function<bool(double)>;

struct Blended {
    csg::Solid solid;
    std::size_t edges = 0;  ///< blended; 0: the Boolean is as it was
};

/// The Boolean of the operands with the edges blended that arise between faces of different operands. Errors name the two
/// surfaces: radius too large (with the largest that works, or one that does), faces that touch without crossing, faces that can not be
/// blended; unbounded; limit.
/// Cost: about 1 us for each pair of faces whose boxes meet and each face beside them; to find the largest radius up to 1.5 s.
[[nodiscard]] Result<Blended> blended(csg::Op op, std::vector<csg::Solid> operands,
                                      const Form& form, SourceSpan span = {},
                                      const Spend& spend = {});

enum class Edges : std::uint8_t { convex, concave };
/// The solid with all its edges of one kind blended, between faces of whatever leaves. Errors: as above.
[[nodiscard]] Result<Blended> blended_edges(const csg::Solid& solid, Edges edges, const Form& form,
                                            SourceSpan span = {}, const Spend& spend = {});

}  // namespace raymo::blends
