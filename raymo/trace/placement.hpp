// Affine maps that know how uncertain they are.
//
// Every entry of a transformation in the model carries kInputError (relative); products and sums
// add rounding. The bounds are carried entry by entry through the composition, as in a running
// error analysis [Higham02 3.3].
#pragma once

#include "raymo/math/affine.hpp"
#include "raymo/math/tolerance.hpp"

namespace raymo::trace {

struct Placement {
    Affine map;
    Mat3 linear_error = Mat3::diagonal(0, 0, 0);  ///< |entry - true entry|, at most
    Vec3 offset_error;

    /// First `inner` (a transformation of the model), then this.
    [[nodiscard]] Placement then_inner(const Affine& inner) const {
        constexpr double kEntry = kInputError + 4.0 * kUnitRoundoff;
        const Mat3 size = abs(map.linear);
        Placement out;
        out.map.offset = map(inner.offset);
        const Vec3 b = abs(inner.offset);
        out.offset_error = offset_error + linear_error * b + size * b * kEntry +
                           abs(out.map.offset) * (2.0 * kUnitRoundoff);
        if (inner.linear == Mat3{}) {
            out.map.linear = map.linear;
            out.linear_error = linear_error;
            return out;
        }
        if (is_move()) {
            out.map.linear = inner.linear;
            for (std::size_t i = 0; i < 3; ++i)
                out.linear_error.row[i] = abs(inner.linear.row[i]) * kEntry;
            return out;
        }
        out.map.linear = map.linear * inner.linear;
        const Mat3 inner_size = abs(inner.linear);
        out.linear_error = linear_error * inner_size;
        const Mat3 rounding = size * inner_size;
        for (std::size_t i = 0; i < 3; ++i) out.linear_error.row[i] += rounding.row[i] * kEntry;
        return out;
    }

private:
    /// Turns and scales nothing, for certain.
    [[nodiscard]] bool is_move() const {
        return map.linear == Mat3{} && linear_error == Mat3::diagonal(0, 0, 0);
    }
};

}  // namespace raymo::trace
