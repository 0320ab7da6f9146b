// What a chamfer or a conic leaves of two solids, by its definition alone.
//
// Let x be outside of P and Q, and c the nearest centre of a ball of radius r that touches both (rolled.hpp): then x is in the plane
// across the balls' path at c. There the ball touches in A and B. A chamfer fills what is beyond the line AB, as seen from c, up to
// P and Q. A conic fills, with g and h the functions that are 0 on P and Q, divided by their values at B and at A,
//     g + h <= 1  and  (g + h - 1)^2 >= 2 (1 - shape) g h.
// The functions are the distance e from a plane or a cone, and (R + e)^2 - R^2 for all that is round, e being the distance from the
// surface's own inner side. No curve is followed; all in extended precision. What is beyond one of the solids, as seen from c, is none
// of its concern.
#pragma once

#include "tests/laws/rolled.hpp"

namespace raymo::laws {

class Profiled {
public:
    /// `shape`: of a conic; a chamfer has none. `rolled` has been rolled.
    Profiled(const Rolled& rolled, Real radius, std::optional<Real> shape)
        : rolled_(rolled), radius_(radius), shape_(shape) {}

    /// Where x is in the union with its edges filled, unless within `margin` of the boundary.
    [[nodiscard]] Side filled(RealVec x, Real margin) const;
    /// How far from the centre c, along a unit vector in the plane across, the filling begins; the radius where it does not.
    [[nodiscard]] Real begins(RealVec c, RealVec way) const;

private:
    struct Section {
        RealVec centre, a, b;
        RealVec outward;  ///< from the centre across the chord, unit
    };
    [[nodiscard]] Section section_at(RealVec centre) const;
    /// Positive where it is filled.
    [[nodiscard]] Real level(const Section& section, RealVec x) const;
    /// Whether nothing is between the centre and x.
    [[nodiscard]] bool is_seen(const Section& section, RealVec x, Real margin) const;

    const Rolled& rolled_;
    Real radius_;
    std::optional<Real> shape_;
};

}  // namespace raymo::laws
