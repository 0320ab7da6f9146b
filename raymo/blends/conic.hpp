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
// h are linear in the section it is so there. Otherwise it is followed by cubics, within 1e-10 of its size. Along a curve in space
// the section is the plane across the path of the ball, and all is as in any other (profile_curve.hpp).
#pragma once

#include "raymo/blends/wedge.hpp"

namespace raymo::blends {

/// The function g of a surface, from the distance to it and back.
class Level {
public:
    /// `radius`: R; 0 where the function is the distance.
    explicit Level(double radius) : radius_(radius) {}

    [[nodiscard]] bool is_linear() const { return radius_ == 0.0; }
    [[nodiscard]] double at(double distance) const {
        return is_linear() ? distance : distance * (2.0 * radius_ + distance);
    }
    [[nodiscard]] double distance(double level) const;

private:
    double radius_;
};
/// Of a surface in space.
[[nodiscard]] Level level_of(const Surface& surface);

/// A conic by its points' distances from both surfaces.
class ConicDistances {
public:
    /// `reach_a`: how far contact 1 is from surface a; `reach_b`: contact 0 from surface b. `shape` < 1.
    ConicDistances(Level a, double reach_a, Level b, double reach_b, double shape);

    struct Pair {
        double a, b;
    };
    /// From contact 1 (0) to contact 0 (1), and a little beyond both.
    [[nodiscard]] Pair at(double t) const;
    /// The parameter in a stretch of it at the part v of that stretch's own rational parabola, with weights 1 at both ends: of a
    /// circle, places at v and 1 - v are equally far from the middle.
    [[nodiscard]] double part(double from, double to, double v) const;

private:
    [[nodiscard]] double weight_at(double t) const {
        const double s = 1.0 - t;
        return s * s + 2.0 * weight_ * s * t + t * t;
    }

    Level a_, b_;
    double range_a_, range_b_;
    double weight_;
};

/// Appends the conic from contact 1 to contact 0 of a straight or circular segment.
void append_conic(curves::Curve& curve, const Segment& segment, const Wedge& wedge, double shape);

}  // namespace raymo::blends
