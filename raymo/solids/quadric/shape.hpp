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
    /// A good origin for the canonical frame of f, whose shape this is: the centre or vertex, unless that is far away
    /// from the surface.
    [[nodiscard]] Vec3 origin(const QuadraticForm& form) const;
    /// A length of the size of the surface: largest semi-axis of an ellipsoid, waist of a
    /// hyperboloid, 1 for a cone.
    [[nodiscard]] double size() const;
};

/// Principal axes by Jacobi's rotations, which leave what is zero zero. Coefficients must be
/// finite.
[[nodiscard]] QuadricShape analyse(const QuadraticForm& form);

/// f(origin + scale y) as a polynomial in y, with twice the working precision, then divided by a
/// power of two so that its largest coefficient is in [1, 2). `scale` must be a power of two.
[[nodiscard]] QuadraticForm moved(const QuadraticForm& form, Vec3 origin, double scale);

}  // namespace raymo::solids
