// The algebraic blend: a conic of the two surfaces' own functions.
//
// Let g and h be 0 on the surfaces and grow away from them as polynomials of the place: a plane's distance e, and (R + e)^2 - R^2
// for a sphere, a cylinder or a torus' tube of radius R; a cone's distance, too. Let a be the value of g where the blend leaves
// h = 0, and b that of h where it leaves g = 0. Then
//     (g/a + h/b - 1)^2 = 2 (1 - mu) (g/a) (h/b),  g/a + h/b <= 1
// touches both surfaces there, whatever mu < 1: a chamfer for mu towards 1, an ellipse between, a parabola for -1 [Liming44],
// [Middleditch85], [Hoffmann86]. We let it touch where the ball of the same radius does; between planes mu = -cos(angle of the
// normals) makes it the ball's arc.
//
// In (g/a, h/b) this is the rational parabola from (1, 0) to (0, 1) with control point (0, 0) and weight sqrt((1 - mu) / 2). Where g and
// h are linear in the section it is so there. Otherwise it is followed by cubics, within 1e-10 of its size.
#pragma once

#include "raymo/blends/wedge.hpp"

namespace raymo::blends {

/// Appends the conic from contact 1 to contact 0 of a straight or circular segment.
void append_conic(curves::Curve& curve, const Segment& segment, const Wedge& wedge, double shape);

}  // namespace raymo::blends
