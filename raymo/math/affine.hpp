// Invertible affine maps  x -> L x + b  with column vectors.
#pragma once

#include <array>

#include "raymo/core/result.hpp"
#include "raymo/math/aabb.hpp"
#include "raymo/math/vec.hpp"

namespace raymo {

/// A 3x3 matrix by rows.
struct Mat3 {
    std::array<Vec3, 3> row{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

    [[nodiscard]] static constexpr Mat3 diagonal(double x, double y, double z) {
        return {{Vec3{x, 0, 0}, Vec3{0, y, 0}, Vec3{0, 0, z}}};
    }
    [[nodiscard]] constexpr Vec3 column(int j) const { return {row[0][j], row[1][j], row[2][j]}; }
    friend constexpr bool operator==(const Mat3&, const Mat3&) = default;
};

constexpr Vec3 operator*(const Mat3& m, Vec3 v) {
    return {dot(m.row[0], v), dot(m.row[1], v), dot(m.row[2], v)};
}
/// m^T v.
constexpr Vec3 transposed_times(const Mat3& m, Vec3 v) {
    return m.row[0] * v.x + m.row[1] * v.y + m.row[2] * v.z;
}
[[nodiscard]] Mat3 operator*(const Mat3& a, const Mat3& b);
[[nodiscard]] Mat3 abs(const Mat3& m);
[[nodiscard]] double determinant(const Mat3& m);
/// Inverse by cofactors of the row-equilibrated matrix. m must be invertible (see is_invertible).
[[nodiscard]] Mat3 inverse(const Mat3& m);
/// False when m is singular to working precision: |det| is within rounding of zero for its row lengths,
/// or an entry is not finite, or the inverse is not.
[[nodiscard]] bool is_invertible(const Mat3& m);

struct Affine {
    Mat3 linear;
    Vec3 offset;

    [[nodiscard]] constexpr Vec3 operator()(Vec3 p) const { return linear * p + offset; }
    friend constexpr bool operator==(const Affine&, const Affine&) = default;
};

/// First b, then a.
[[nodiscard]] Affine operator*(const Affine& a, const Affine& b);
[[nodiscard]] Affine inverse(const Affine& a);

[[nodiscard]] Affine translation(Vec3 by);
[[nodiscard]] Affine scaling(Vec3 by);
/// Right-handed rotation by `degrees` about the unit `axis` through the origin. Multiples of 90 degrees about a
/// coordinate axis are exact.
[[nodiscard]] Affine rotation(Vec3 axis, double degrees);
/// Reflection in the plane through the origin with the given normal (any length > 0).
[[nodiscard]] Affine reflection(Vec3 normal);

/// Box of the image of a box: exact for boxes, a bound for what is inside them. Infinite sides stay infinite.
[[nodiscard]] Aabb transformed(const Affine& a, const Aabb& box);

/// sin and cos of an angle in degrees, exact at multiples of 90 degrees (and sin 30).
struct SinCos {
    double sin;
    double cos;
};
[[nodiscard]] SinCos sin_cos_degrees(double degrees);

}  // namespace raymo
