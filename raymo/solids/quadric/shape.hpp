// What kind of surface a polynomial of degree 2 describes.
#pragma once

#include <array>

#include "raymo/solids/quadric/quadratic_form.hpp"

namespace raymo::solids {

/// f in its principal axes: with x = centre + y,
///     f(x) = sum_i value_i (axis_i . y)^2 + 2 slope . y + level
/// where value_i is exactly 0 when it is 0 to within the rounding of the coefficients, `slope` lies
/// in the span of the axes with value 0 and is exactly 0 likewise, and level is 0 where slope is
/// not.
struct QuadricShape {
    std::array<double, 3> value{};
    std::array<Vec3, 3> axis{};
    Vec3 centre;
    Vec3 slope;
    double level = 0.0;
    double level_error =
        0.0;  ///< rounding of `level`, from coefficients known to within one rounding

    [[nodiscard]] bool has_negative_value() const;
    [[nodiscard]] bool has_slope() const { return max_norm(slope) > 0.0; }
    /// False when f >= 0 everywhere, to within rounding.
    [[nodiscard]] bool has_interior() const;
    /// The largest of n.x over the solid f <= 0; infinite where there is none. The solid must have
    /// an interior.
    [[nodiscard]] double support(Vec3 n) const;
    /// Where the canonical frame of f stands, and the size of the surface there.
    struct Frame {
        Vec3 origin;
        double size;
    };
    /// A good frame for f, whose shape this is: at its centre or vertex; or, where that is far away along axes with little
    /// or no value compared to the size of the surface, beside it, in reach of the user's own origin.
    [[nodiscard]] Frame frame(const QuadraticForm& form) const;
};

/// Principal axes by Jacobi's rotations, which leave what is zero zero. Coefficients must be
/// finite.
[[nodiscard]] QuadricShape analyse(const QuadraticForm& form);

/// f(origin + scale y) as a polynomial in y, with twice the working precision, then divided by a
/// power of two so that its largest coefficient is in [1, 2). `scale` must be a power of two.
[[nodiscard]] QuadraticForm moved(const QuadraticForm& form, Vec3 origin, double scale);

}  // namespace raymo::solids
