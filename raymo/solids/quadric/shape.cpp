#include "raymo/solids/quadric/shape.hpp"

#include <cmath>
#include <limits>
#include <span>

#include "raymo/math/tolerance.hpp"

namespace raymo::solids {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

/// A principal value below this part of the largest one is taken as 0: 64 roundings.
constexpr double kNoValue = 128.0 * kUnitRoundoff;
/// Along axes with a value below this part of the largest one the solid is long, and its centre may be far from what the
/// user looks at; see QuadricShape::frame.
constexpr double kWeakValue = 0x1p-8;

/// A sum of products with twice the working precision [OgitaRumpOishi05].
class LongSum {
public:
    void add(double a, double b) {
        const double product = a * b;
        add(product);
        rest_ += std::fma(a, b, -product);
    }
    void add(double a) {
        const double sum = sum_ + a;
        const double part = sum - sum_;
        rest_ += (sum_ - (sum - part)) + (a - part);
        sum_ = sum;
    }
    /// The product of three numbers.
    void add(double a, double b, double c) {
        const double product = a * b;
        add(product, c);
        add(std::fma(a, b, -product), c);
    }
    [[nodiscard]] double value() const { return sum_ + rest_; }

private:
    double sum_ = 0.0;
    double rest_ = 0.0;
};

/// Sets the element (i, j) of `m` to zero by a rotation about the third axis, and turns `axes`
/// likewise.
void rotate_away(std::array<std::array<double, 3>, 3>& m, std::array<Vec3, 3>& axes, std::size_t i,
                 std::size_t j) {
    const double off = m[i][j];
    if (off == 0.0) return;
    const std::size_t k = 3 - i - j;
    const double theta = (m[j][j] - m[i][i]) / (2.0 * off);
    const double t = std::isinf(theta)
                         ? 0.0
                         : std::copysign(1.0, theta) / (std::fabs(theta) + std::hypot(theta, 1.0));
    const double c = 1.0 / std::hypot(t, 1.0);
    const double s = t * c;
    m[i][i] -= t * off;
    m[j][j] += t * off;
    m[i][j] = m[j][i] = 0.0;
    const double ik = m[i][k], jk = m[j][k];
    m[i][k] = m[k][i] = c * ik - s * jk;
    m[j][k] = m[k][j] = s * ik + c * jk;
    const Vec3 ai = axes[i], aj = axes[j];
    axes[i] = ai * c - aj * s;
    axes[j] = ai * s + aj * c;
}

void find_axes(const Mat3& a, QuadricShape& shape) {
    std::array<std::array<double, 3>, 3> m{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) m[i][j] = a.row[i][static_cast<int>(j)];
    }
    shape.axis = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    // Convergence is quadratic; 8 sweeps reach rounding from any start, and then rotations change
    // nothing.
    for (int sweep = 0; sweep < 8; ++sweep) {
        rotate_away(m, shape.axis, 0, 1);
        rotate_away(m, shape.axis, 0, 2);
        rotate_away(m, shape.axis, 1, 2);
    }
    // Axes that no rotation has touched have exact values. The others carry the rounding of the user's own computation of
    // the entries, which had to cancel where a value is meant to be 0.
    const double largest = std::max({std::fabs(m[0][0]), std::fabs(m[1][1]), std::fabs(m[2][2])});
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 v = abs(shape.axis[i]);
        const bool turned = max_norm(v) != v.x + v.y + v.z;
        const bool zero = turned && std::fabs(m[i][i]) <= kNoValue * largest;
        shape.value[i] = zero ? 0.0 : m[i][i];
    }
}

/// A frame of this size neither overflows nor underflows.
bool is_usable(double length) { return length > 1e-90 && length < 1e90; }

/// A length of the size of the surface: largest semi-axis of an ellipsoid, waist of a hyperboloid, radius of curvature at
/// the vertex of a paraboloid, 1 for a cone.
double size_of(const QuadricShape& shape) {
    double least = kInf, most = 0.0;
    for (const double v : shape.value) {
        if (v == 0.0) continue;
        least = std::min(least, std::fabs(v));
        most = std::max(most, std::fabs(v));
    }
    if (most == 0.0) return 1.0;
    double length = 0.0;
    if (shape.has_slope()) {
        length = 2.0 * norm(shape.slope) / most;
    } else if (std::fabs(shape.level) >= shape.level_error) {
        length = std::sqrt(std::fabs(shape.level) / (shape.has_negative_value() ? most : least));
    }
    return is_usable(length) ? length : 1.0;
}

/// a + b for b >= 0; with the error of the sum, where much larger numbers cancel. `error`: relative, of b beside its rounding.
double outward_sum(double a, double b, double error) {
    const double sum = a + b;
    if (!(std::fabs(sum) < 0x1p-8 * b)) return sum;
    return sum + (32.0 * kUnitRoundoff + error) * (std::fabs(a) + b);
}

}  // namespace

QuadraticForm moved(const QuadraticForm& form, Vec3 origin, double scale) {
    QuadraticForm out;
    LongSum level;
    level.add(form.c);
    double largest = 0.0;
    for (int i = 0; i < 3; ++i) {
        const Vec3 row = form.a.row[static_cast<std::size_t>(i)];
        LongSum slope;
        slope.add(form.b[i]);
        for (int j = 0; j < 3; ++j) {
            slope.add(row[j], origin[j]);
            level.add(row[j], origin[j], origin[i]);
        }
        level.add(2.0 * form.b[i], origin[i]);
        out.b[i] = slope.value() * scale;
        out.a.row[static_cast<std::size_t>(i)] = row * scale * scale;
        largest = std::max(
            {largest, max_norm(out.a.row[static_cast<std::size_t>(i)]), std::fabs(out.b[i])});
    }
    out.c = level.value();
    largest = std::max(largest, std::fabs(out.c));
    if (!(largest > 0.0) || !std::isfinite(largest)) return out;
    const int exponent = -std::ilogb(largest);
    for (Vec3& row : out.a.row) {
        for (int j = 0; j < 3; ++j) row[j] = std::ldexp(row[j], exponent);
    }
    for (int i = 0; i < 3; ++i) out.b[i] = std::ldexp(out.b[i], exponent);
    out.c = std::ldexp(out.c, exponent);
    return out;
}

QuadricShape analyse(const QuadraticForm& form) {
    QuadricShape shape;
    find_axes(form.a, shape);
    for (std::size_t i = 0; i < 3; ++i) {
        if (shape.value[i] == 0.0) continue;
        shape.centre -= shape.axis[i] * (dot(shape.axis[i], form.b) / shape.value[i]);
    }
    const Vec3 x = abs(shape.centre);
    const Vec3 slope_size = abs(form.a) * x + abs(form.b);
    for (std::size_t i = 0; i < 3; ++i) {
        if (shape.value[i] != 0.0) continue;
        const double part = dot(shape.axis[i], form.half_gradient(shape.centre));
        const double rounding = 16.0 * kUnitRoundoff * dot(abs(shape.axis[i]), slope_size);
        if (std::fabs(part) > rounding) shape.slope += shape.axis[i] * part;
    }
    shape.level = form(shape.centre);
    shape.level_error = 16.0 * kUnitRoundoff * form.magnitude(shape.centre);
    if (shape.has_slope()) {
        // The vertex, where f = 0.
        shape.centre -= shape.slope * (0.5 * shape.level / dot(shape.slope, shape.slope));
        shape.level = 0.0;
    }
    return shape;
}

QuadricShape::Frame QuadricShape::frame(const QuadraticForm& form) const {
    const double largest =
        std::max({std::fabs(value[0]), std::fabs(value[1]), std::fabs(value[2])});
    Vec3 place;
    std::array<bool, 3> placed{};
    for (std::size_t i = 0; i < 3; ++i) {
        if (value[i] == 0.0) continue;
        const double offset = -dot(axis[i], form.b) / value[i];
        // Along a long axis the centre is no better than the user's own origin when that is no farther from the centre
        // than the surface is, offset^2 value = level. A paraboloid has no such centre.
        placed[i] =
            std::fabs(value[i]) >= kWeakValue * largest ||
            (!has_slope() && offset * offset * std::fabs(value[i]) > 16.0 * std::fabs(level));
        if (placed[i]) place += axis[i] * offset;
    }
    const double size = size_of(*this);
    // Along the axes that are left, on to the surface, if that is near.
    Vec3 rest = form.half_gradient(place);
    for (std::size_t i = 0; i < 3; ++i) {
        if (placed[i]) rest -= axis[i] * dot(axis[i], rest);
    }
    const double steepness = dot(rest, rest);
    if (!(steepness > 0.0)) return {place, size};
    const double height = form(place);
    const Vec3 step = rest * (-0.5 * height / steepness);
    // Rounding in a frame of this size costs dot(step, step) / size at `place`, and the user's own numbers have that of
    // their distance from the origin.
    const bool near = dot(step, step) <= 256.0 * size * (norm(place) + size);
    if (near || largest == 0.0) return {place + step, size};
    // What the slope does is hardly seen here: the surface is a cylinder's as far as one looks.
    const double radius = has_slope() ? std::sqrt(std::fabs(height) / largest) : size;
    return {place, is_usable(radius) ? radius : size};
}

bool QuadricShape::has_negative_value() const {
    return value[0] < 0.0 || value[1] < 0.0 || value[2] < 0.0;
}

bool QuadricShape::has_interior() const {
    return has_negative_value() || has_slope() || level < -level_error;
}

double QuadricShape::support(Vec3 n) const {
    // With a negative value the solid holds a double cone, so it is unbounded in every direction.
    if (max_norm(n) == 0.0) return 0.0;
    if (has_negative_value()) return kInf;
    double along_axes = 0.0;  // sum over positive values of (axis_i . n)^2 / value_i
    Vec3 rest = n;            // part of n along axes with value 0
    for (std::size_t i = 0; i < 3; ++i) {
        if (value[i] == 0.0) continue;
        const double part = dot(axis[i], n);
        along_axes += part * part / value[i];
        rest -= axis[i] * part;
    }
    const double rounding = 16.0 * kUnitRoundoff * max_norm(n);
    const bool crosswise = max_norm(rest) > rounding;
    if (!has_slope()) {
        // An ellipsoid or a cylinder over an ellipse, or a slab: y^T V y <= -level.
        if (crosswise) return kInf;
        const double extent = std::sqrt(along_axes * std::max(0.0, -level));
        return outward_sum(dot(n, centre), extent, level_error / std::fabs(level));
    }
    // Paraboloid: slope . y <= - (1/2) sum value_i y_i^2. Finite for n = k slope + (axes with
    // value), k > 0: n.y = k slope.y + m.y <= -(k/2) sum value_i y_i^2 + m.y  <=  sum m_i^2 /
    // value_i / (2 k).
    const double k = dot(rest, slope) / dot(slope, slope);
    if (max_norm(rest - slope * k) > rounding) return kInf;
    if (!crosswise) return along_axes > 0.0 ? kInf : dot(n, centre);
    return k > 0.0 ? outward_sum(dot(n, centre), along_axes / (2.0 * k), 0.0) : kInf;
}

}  // namespace raymo::solids
