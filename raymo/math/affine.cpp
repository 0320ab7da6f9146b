#include "raymo/math/affine.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

namespace raymo {

Mat3 operator*(const Mat3& a, const Mat3& b) {
    Mat3 c;
    for (std::size_t i = 0; i < 3; ++i) c.row[i] = transposed_times(b, a.row[i]);
    return c;
}

Mat3 abs(const Mat3& m) { return {{abs(m.row[0]), abs(m.row[1]), abs(m.row[2])}}; }

double determinant(const Mat3& m) { return dot(m.row[0], cross(m.row[1], m.row[2])); }

namespace {

/// Power of two near the size of v, so that dividing by it is exact; 0 for a zero vector.
double binary_size(Vec3 v) {
    const double size = max_norm(v);
    if (!(size > 0.0) || !std::isfinite(size)) return 0.0;
    if (size < std::numeric_limits<double>::min()) return std::ldexp(1.0, std::ilogb(size));
    constexpr std::uint64_t kExponent = 0x7ffULL << 52U;
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(size) & kExponent);
}

/// v / power, for a power of two: mostly without dividing, which gives the same.
Vec3 divided(Vec3 v, double power) {
    return power >= std::numeric_limits<double>::min() ? v * (1.0 / power) : v / power;
}

}  // namespace

Mat3 inverse(const Mat3& m) {
    // Rows are brought to size 1 by powers of two (exact), so that cofactors neither overflow nor underflow.
    std::array<double, 3> scale{};
    Mat3 s;
    for (std::size_t i = 0; i < 3; ++i) {
        scale[i] = binary_size(m.row[i]);
        s.row[i] = divided(m.row[i], scale[i]);
    }
    const Vec3 c0 = cross(s.row[1], s.row[2]);
    const Vec3 c1 = cross(s.row[2], s.row[0]);
    const Vec3 c2 = cross(s.row[0], s.row[1]);
    const double det = dot(s.row[0], c0);
    // Cofactor vectors are the columns of the inverse, times det.
    const Vec3 k0 = divided(c0 / det, scale[0]);
    const Vec3 k1 = divided(c1 / det, scale[1]);
    const Vec3 k2 = divided(c2 / det, scale[2]);
    return {{Vec3{k0.x, k1.x, k2.x}, Vec3{k0.y, k1.y, k2.y}, Vec3{k0.z, k1.z, k2.z}}};
}

bool is_invertible(const Mat3& m) {
    if (m == Mat3{}) return true;
    // Most maps turn: rows of about length 1, far from lying in a plane.
    const auto is_about_1 = [](Vec3 v) {
        const double size = max_norm(v);
        return size > 0.5 && size < 2.0;
    };
    if (is_about_1(m.row[0]) && is_about_1(m.row[1]) && is_about_1(m.row[2]) &&
        std::fabs(determinant(m)) > 0x1p-40) {
        return true;
    }
    Mat3 s;
    bool is_moderate = true;
    for (std::size_t i = 0; i < 3; ++i) {
        const double scale = binary_size(m.row[i]);
        if (scale == 0.0) return false;
        s.row[i] = divided(m.row[i], scale);
        is_moderate = is_moderate && scale > 0x1p-900 && scale < 0x1p900;
    }
    // The computed determinant of a matrix with entries below 2 is off by less than 32 * 2^-53 * 8.
    const double det = determinant(s);
    if (!(std::fabs(det) > 0x1p-45)) return false;
    // No entry of the inverse is then larger than 8 * 2^45 * 2^900.
    if (is_moderate) return true;
    const Mat3 inv = inverse(m);
    return is_finite(inv.row[0]) && is_finite(inv.row[1]) && is_finite(inv.row[2]);
}

Affine operator*(const Affine& a, const Affine& b) { return {a.linear * b.linear, a(b.offset)}; }

Affine inverse(const Affine& a) {
    const Mat3 inv = inverse(a.linear);
    return {inv, -(inv * a.offset)};
}

Affine translation(Vec3 by) { return {{}, by}; }
Affine scaling(Vec3 by) { return {Mat3::diagonal(by.x, by.y, by.z), {}}; }

SinCos sin_cos_degrees(double degrees) {
    const double turn =  // exact, in [-180, 180]
        std::fabs(degrees) <= 180.0 ? degrees : std::remainder(degrees, 360.0);
    if (turn == 0.0) return {0.0, 1.0};
    if (turn == 90.0) return {1.0, 0.0};
    if (turn == -90.0) return {-1.0, 0.0};
    if (std::fabs(turn) == 180.0) return {0.0, -1.0};
    if (std::fabs(turn) == 30.0) return {std::copysign(0.5, turn), std::sqrt(0.75)};
    if (std::fabs(turn) == 150.0) return {std::copysign(0.5, turn), -std::sqrt(0.75)};
    if (std::fabs(turn) == 60.0) return {std::copysign(std::sqrt(0.75), turn), 0.5};
    if (std::fabs(turn) == 120.0) return {std::copysign(std::sqrt(0.75), turn), -0.5};
    const double radians = turn * (std::numbers::pi / 180.0);
    return {std::sin(radians), std::cos(radians)};
}

Affine rotation(Vec3 axis, double degrees) {
    // Rodrigues' formula, R = c I + s [axis] + (1 - c) axis axis^T.
    const auto [s, c] = sin_cos_degrees(degrees);
    const Vec3 a = axis;
    const double k = 1.0 - c;
    return {{{Vec3{c + k * a.x * a.x, k * a.x * a.y - s * a.z, k * a.x * a.z + s * a.y},
              Vec3{k * a.y * a.x + s * a.z, c + k * a.y * a.y, k * a.y * a.z - s * a.x},
              Vec3{k * a.z * a.x - s * a.y, k * a.z * a.y + s * a.x, c + k * a.z * a.z}}},
            {}};
}

Affine reflection(Vec3 normal) {
    // I - 2 n n^T / (n.n); scaled first so that n.n neither overflows nor underflows.
    const Vec3 n = normal / max_norm(normal);
    const double k = 2.0 / dot(n, n);
    Mat3 m;
    for (int i = 0; i < 3; ++i) m.row[static_cast<std::size_t>(i)] -= n * (k * n[i]);
    return {m, {}};
}

Aabb transformed(const Affine& a, const Aabb& box) {
    if (box.empty()) return box;
    Aabb out{a.offset, a.offset};
    for (int i = 0; i < 3; ++i) {
        const Vec3 r = a.linear.row[static_cast<std::size_t>(i)];
        for (int j = 0; j < 3; ++j) {
            if (r[j] == 0.0) continue;  // 0 times an infinite side is 0 here
            const double p = r[j] * box.lo[j];
            const double q = r[j] * box.hi[j];
            out.lo[i] += std::min(p, q);
            out.hi[i] += std::max(p, q);
        }
    }
    return out;
}

}  // namespace raymo
