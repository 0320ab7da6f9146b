// Polynomials of degree 2 in space.
#pragma once

#include "raymo/math/affine.hpp"

namespace raymo::solids {

/// f(x) = x^T A x + 2 b.x + c with symmetric A. Default: the unit ball's, |x|^2 - 1.
struct QuadraticForm {
    Mat3 a;
    Vec3 b;
    double c = -1.0;

    [[nodiscard]] constexpr double operator()(Vec3 x) const {
        return dot(x, a * x) + 2.0 * dot(b, x) + c;
    }
    /// Half the gradient: A x + b.
    [[nodiscard]] constexpr Vec3 half_gradient(Vec3 x) const { return a * x + b; }
    /// Sum of the absolute values of all terms of f(x): what rounding errors are relative to.
    [[nodiscard]] double magnitude(Vec3 x) const {
        const Vec3 y = abs(x);
        return dot(y, abs(a) * y) + 2.0 * dot(abs(b), y) + std::fabs(c);
    }
    friend bool operator==(const QuadraticForm&, const QuadraticForm&) = default;
};

}  // namespace raymo::solids
