// Paths of SVG as exact curves: lines, parabolas, cubics, and elliptic arcs as rational cubics [SVG11 8.3].
//
// An arc from a to b with the radii rx and ry, turned by phi, is an arc of the unit circle under the map
//     q -> m + M (c + q),    M = R(phi) diag(rx, ry),    m = (a + b) / 2,
// where c is the middle of the circle, seen from that of the chord. With p = M^-1 (a - m) the ends are seen at p and -p, so
//     c = +-sqrt(1 / |p|^2 - 1) (p.y, -p.x),
// and the sign says which of both circles. Radii that do not reach, |p| > 1, are made larger by |p| [SVG11 F.6].
// Arcs up to a quarter need neither c nor angles, which for a flat arc would lose digits: with |p| = sin h for half the angle
// h, the corner of the tangents is at tan(h) (-p.y, p.x) or opposite, and its weight is cos h.
#pragma once

#include <functional>
#include <string_view>

#include "raymo/curves/outline.hpp"
#include "raymo/drawings/svg_values.hpp"

namespace raymo::drawings {

/// Asked now and then in what takes long, with the bytes that have been made so far: no stops it.
using GoOn = std::function<bool(double bytes)>;

/// Draws curves end to end. What is filled is closed: each curve is led back to its beginning by a straight line.
class PathPen {
public:
    void move(Vec2 to);
    void line(Vec2 to);
    void parabola(Vec2 b, Vec2 to);
    void cubic(Vec2 b, Vec2 c, Vec2 to);
    /// `turn` in degrees. `is_large`: the longer way round; `is_positive`: towards y from x.
    void arc(Vec2 radii, double turn, bool is_large, bool is_positive, Vec2 to);
    /// A quarter of an ellipse whose tangents at both ends meet in `corner`.
    void quarter(Vec2 corner, Vec2 to);
    /// Back to where the curve began, which is where the next begins.
    void close();

    [[nodiscard]] Vec2 at() const { return at_; }
    [[nodiscard]] double bytes() const {
        return static_cast<double>(spans_ * sizeof(curves::Span2));
    }
    [[nodiscard]] curves::Outline take();

private:
    /// An arc of at most a quarter; `weight`: the cosine of half its angle.
    void add_arc(Vec2 corner, double weight, Vec2 to);
    void add(const curves::Span2& span);
    void finish();

    Vec2 at_, start_;
    std::size_t spans_ = 0;
    curves::Curve curve_;
    curves::Outline outline_;
};

/// The curves that the attribute `d` describes. Its last misfit has no text when `go_on` has said no.
[[nodiscard]] Read<curves::Outline> read_path(std::string_view d, const GoOn& go_on);
/// The polygon with the corners that the attribute `points` lists; without curves when there are less than 3.
/// Its misfit has no text when `go_on` has said no.
[[nodiscard]] Read<curves::Outline> read_polygon(std::string_view points, const GoOn& go_on);
/// A whole ellipse.
void draw_ellipse(PathPen& pen, Vec2 centre, Vec2 radii);
/// A rectangle, its corners rounded by quarters of an ellipse; radii up to half of the sides.
void draw_rectangle(PathPen& pen, Vec2 corner, Vec2 size, Vec2 radii);

}  // namespace raymo::drawings
