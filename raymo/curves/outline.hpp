// Curves of the plane as a designer writes them: chains of rational cubic spans.
//
// One kind of span serves all: segments and parabolas are cubics of lower degree, circles are rational. A line meets it where
// a cubic in Bernstein form is zero, whatever its weights.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "raymo/math/vec2.hpp"

namespace raymo::curves {

/// P(u) = (x(u), y(u)) / w(u), each a cubic in Bernstein form. `x` and `y` are already multiplied by the
/// weights; w > 0, and 1 at both ends.
struct Span2 {
    std::array<double, 4> x{}, y{};
    std::array<double, 4> w{1.0, 1.0, 1.0, 1.0};

    [[nodiscard]] Vec2 point(std::size_t i) const { return {x[i] / w[i], y[i] / w[i]}; }
    friend bool operator==(const Span2&, const Span2&) = default;
};

/// From a to b.
[[nodiscard]] Span2 segment(Vec2 a, Vec2 b);
/// The cubic with these control points.
[[nodiscard]] Span2 cubic(Vec2 a, Vec2 b, Vec2 c, Vec2 d);
/// The parabola with these control points.
[[nodiscard]] Span2 quadratic(Vec2 a, Vec2 b, Vec2 c);
/// The arc of a circle about `centre`, from `from` to `to` degrees, at most 90 degrees.
[[nodiscard]] Span2 arc(Vec2 centre, double radius, double from, double to);
/// The image under an affine map.
[[nodiscard]] Span2 mapped(const Span2& span, const Affine2& map);
/// The same curve, run through from its end.
[[nodiscard]] Span2 reversed(const Span2& span);

/// Spans end to end: each begins exactly where the one before it ends, and the first, of a closed curve, where the last
/// ends. Never empty.
struct Curve {
    std::vector<Span2> spans;
    bool closed = false;

    friend bool operator==(const Curve&, const Curve&) = default;
};

/// Which points curves that cross each other or themselves enclose.
enum class Fill : std::uint8_t {
    even_odd,  ///< those from which a line outwards crosses an odd number of times
    non_zero,  ///< those about which the curves turn, summed up, other than 0 times
};

/// The curves that bound one region of the plane.
struct Outline {
    std::vector<Curve> curves;
    Fill fill = Fill::even_odd;

    friend bool operator==(const Outline&, const Outline&) = default;
};

using OutlinePtr = std::shared_ptr<const Outline>;

}  // namespace raymo::curves
