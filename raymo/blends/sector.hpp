// All that lies between the ball's path and an edge: the solid from which a wedge is made.
//
// In the plane across the path the wedge is bounded by the profile (the ball, a chamfer or a conic) and the two faces, from contact to
// contact. It lies in the sector between a near side (near_side.hpp), which is the profile itself, or, of a ball, goes from
// its centre through both contacts; and a far side beyond the faces (far_side.hpp), which may be anything: chains of arcs
// there, a little deep in the material (or, of a round, out in the open). Along the path all of them are cubics, so that bicubic
// patches bound the solid.
//
// Why that is enough. The near side of a ball lies in the tube as far as the contacts, that of a chamfer or conic is what is to be
// seen, and the chains lie beyond the faces. So nothing else of the boundary is in the space that neither the faces' solids nor
// the tube take, but for the contacts: of each part of that space the sectors hold all or nothing, and they wind once around the
// wedge and not around what is on the other side of the profile, as long as the near side runs ahead. Near
// the edge sectors may well cross, as they do where the edge bends more sharply than the path: the surface folds, but winds
// once around all the same.
//
// It is checked, from place to place and closer wherever things change quickly, that the near side runs ahead and is where it
// should be, and that the chains are beyond the faces but within what these bound.
#pragma once

#include "raymo/blends/spine.hpp"

namespace raymo::blends {

/// The solid, from parameter lo to hi; closed up at both ends unless that is a whole ring. Error: out_of_range, the edge bends too sharply for a
/// ball of this radius, or for its chamfer or conic. Cost: some milliseconds, of conics some ten.
[[nodiscard]] Result<csg::Solid> sector_solid(const Spine& spine, const Form& form, double lo,
                                              double hi, SourceSpan span);

}  // namespace raymo::blends
