#include "raymo/trace/frames.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "raymo/math/tolerance.hpp"
#include "raymo/trace/blocks.hpp"

namespace raymo::trace {
namespace {

using Long = long double;

/// An entry of I - A B, `one` on the diagonal, of a row of A and a column of B.
Long residual(double one, Vec3 row, Vec3 column) {
    return one - static_cast<Long>(row.x) * column.x - static_cast<Long>(row.y) * column.y -
           static_cast<Long>(row.z) * column.z;
}

/// The inverse, with one step of Newton's method X + X (I - A X) against the cancellation in the cofactors of maps that
/// stretch very differently along oblique axes [Higham02 14.1].
Mat3 refined_inverse(const Mat3& a) {
    const Mat3 x = inverse(a);
    Mat3 out;
    for (int j = 0; j < 3; ++j) {
        const Vec3 column = x.column(j);
        const Long rest_0 = residual(j == 0 ? 1.0 : 0.0, a.row[0], column);
        const Long rest_1 = residual(j == 1 ? 1.0 : 0.0, a.row[1], column);
        const Long rest_2 = residual(j == 2 ? 1.0 : 0.0, a.row[2], column);
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 row = x.row[i];
            out.row[i][j] =
                static_cast<double>(row[j] + row.x * rest_0 + row.y * rest_1 + row.z * rest_2);
        }
    }
    return out;
}

bool is_diagonal(const Mat3& m) {
    return m.row[0].y == 0.0 && m.row[0].z == 0.0 && m.row[1].x == 0.0 && m.row[1].z == 0.0 &&
           m.row[2].x == 0.0 && m.row[2].y == 0.0;
}

}  // namespace

Frame frame_of(const Affine& map, std::uint32_t type, std::uint32_t index) {
    Frame frame{};
    frame.to_local = refined_inverse(map.linear);
    frame.type = type;
    frame.index = index;
    frame.in_blocks = answers_blocks(type);
    frame.reach = 2.0;
    const std::array<Vec3, 3>& row = frame.to_local.row;
    frame.diagonal = is_diagonal(frame.to_local);
    // How far the map is from the true inverse, seen from the leaf: the residual I - X A, summed up by rows.
    constexpr Long kLong = std::numeric_limits<Long>::epsilon();
    for (std::size_t r = 0; r < 3; ++r) {
        Long sum = 0;
        for (int c = 0; c < 3; ++c) {
            const Vec3 column = map.linear.column(c);
            const Long entry = residual(static_cast<int>(r) == c ? 1.0 : 0.0, row[r], column);
            // Rounding of the entry; that of its own is nothing beside it.
            const double size = dot(abs(row[r]), abs(column));
            sum += std::fabs(entry) + 4.5 * kLong * size;
        }
        frame.error[static_cast<int>(r)] = 2.0 * static_cast<double>(sum) + 8.0 * kUnitRoundoff;
    }
    // The greatest stretch is that of a row when the rows are orthogonal; the root of the sum of squares is a bound.
    frame.row_length = {norm(row[0]), norm(row[1]), norm(row[2])};
    const double long_row = max_norm(frame.row_length);
    const Vec3 unit[3] = {row[0] / long_row, row[1] / long_row, row[2] / long_row};
    const auto orthogonal = [&](std::size_t a, std::size_t b) {
        return std::fabs(dot(unit[a], unit[b])) <= 0x1p-40;
    };
    frame.stretch = orthogonal(0, 1) && orthogonal(1, 2) && orthogonal(2, 0)
                        ? 1.0
                        : norm(frame.row_length / long_row);
    return frame;
}

// The normal n of the plane under the map M becomes n M^-1: not that of a turned frame, of which each entry is known to one
// rounding of 1, since maps that stretch make much of those that are small.
HalfSpace half_space(const Placement& place, Vec3 normal, std::uint32_t index) {
    const Mat3 inv = refined_inverse(place.map.linear);
    const Vec3 image = transposed_times(inv, normal);
    const Vec3 n = unit(image);
    HalfSpace out{};
    Frame& frame = out.frame;
    frame.to_local.row[2] = n;
    make_frame(n, frame.to_local.row[0], frame.to_local.row[1]);
    frame.type = kHalfspace;
    frame.index = index;
    frame.in_blocks = answers_blocks(kHalfspace);
    frame.reach = std::numeric_limits<double>::infinity();
    frame.row_length = {1.0, 1.0, 1.0};
    constexpr double kRounding = 8.0 * kUnitRoundoff;
    frame.error = {kRounding, kRounding, kRounding};
    frame.diagonal = is_diagonal(frame.to_local);
    frame.stretch = 1.0 + kRounding;

    // Of the entries of n and of M^-1, of those of M, and of the length of 1.
    const Mat3 size = abs(inv);
    const Vec3 given = transposed_times(size, abs(normal)) * (kInputError + kRounding);
    const Vec3 map = transposed_times(size, transposed_times(place.linear_error, abs(n)));
    out.tilt = given * (1.0 / norm(image)) + map + abs(n) * kRounding;
    return out;
}

void place_half_space(const Frame& frame, Vec3& centre, double& displacement) {
    const Vec3 n = frame.to_local.row[2];
    const double depth = dot(n, centre);
    const double shown = std::clamp(depth, -kOutside, kOutside);
    if (std::fabs(depth) - displacement > kOutside) displacement = 0.0;
    centre = n * shown;
}

}  // namespace raymo::trace
