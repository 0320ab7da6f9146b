#include "raymo/trace/bvh.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

namespace raymo::trace {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

/// How a box from v to v is rounded: its sides are the nearest floats that do not lie within it.
void check_rounded(double v) {
    CAPTURE(v);
    const Boxf box = outward({{v, v, v}, {v, v, v}}, 0.0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float lo = box.lo[axis];
        const float hi = box.hi[axis];
        CHECK(static_cast<double>(lo) <= v);
        CHECK(static_cast<double>(hi) >= v);
        if (static_cast<double>(lo) < v) CHECK(static_cast<double>(std::nextafter(lo, kInf)) > v);
        if (static_cast<double>(hi) > v) CHECK(static_cast<double>(std::nextafter(hi, -kInf)) < v);
    }
}

}  // namespace

TEST_CASE("bvh: boxes are rounded to the nearest floats outside") {
    for (const double v : {0.0, 0.1, 0.75, 1.0, 1.0 / 3.0, 16777217.0, 1e-40, 1e-46, 1e-320, 3.4e38,
                           1e39, static_cast<double>(kInf)}) {
        check_rounded(v);
        check_rounded(-v);
    }
}

}  // namespace raymo::trace
