// All that lies between a ball's path and an edge: the solid from which the tube takes what is left of the wedge.
//
// In the plane across the path the wedge is bounded by the ball and the two faces, from contact to contact. So it lies in the sector
// between the two lines from the centre through the contacts, and where these leave the ball the wedge has its two tips. The solid
// swept by such sectors is bounded by two ruled surfaces from the path through the contacts, and beyond the faces by anything:
// chains of arcs there, a little deep in the material (or, of a round, out in the open). Along the path all of them are
// cubics, so that bicubic patches bound the solid.
//
// Why that is enough. The ruled surfaces lie in the tube as far as the contacts, and the chains beyond the faces. So nothing of
// the boundary is in the space that neither the faces' solids nor the tube take, but for the contacts: of each part of that
// space the sectors hold all or nothing, and they wind once around the wedge and not around what is on the other side of the
// contacts, as long as the ruled surfaces run ahead there. Near the edge sectors may well cross, as they do where the edge bends more
// sharply than the path: the surface folds, but winds once around all the same.
//
// What is off at a contact by d opens or closes a gap of d^2 / 2 r: 2^-16 of the radius makes that 2^-33.
//
// It is checked, from place to place and closer wherever things change quickly, that the ruled surfaces run ahead and hold the
// contacts, and that the chains are beyond the faces but within what these bound.
#pragma once

#include "raymo/blends/spine.hpp"

namespace raymo::blends {

/// The solid, from parameter lo to hi; closed up at both ends unless that is a whole ring. Error: out_of_range, the edge bends too sharply for a ball of this radius. Cost: some
/// milliseconds.
[[nodiscard]] Result<csg::Solid> sector_solid(const Spine& spine, double lo, double hi,
                                              SourceSpan span);

}  // namespace raymo::blends
