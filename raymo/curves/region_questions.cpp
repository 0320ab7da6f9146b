// Points, directions and areas: what is asked of a region beside lines.
#include <algorithm>
#include <cmath>

#include "raymo/curves/region.hpp"
#include "raymo/curves/roots.hpp"
#include "raymo/math/tolerance.hpp"

namespace raymo::curves {
namespace {

/// Halvings after which a piece is no longer than the rounding of its points.
constexpr int kMostHalvings = 60;

bool holds(const Box2& box, Vec2 p, Vec2 e) {
    return p.x >= box.lo.x - e.x && p.x <= box.hi.x + e.x && p.y >= box.lo.y - e.y &&
           p.y <= box.hi.y + e.y;
}

/// Whether the curve comes within e of p in both coordinates. Halves that can not are left out; few are left that may, as
/// a halved piece is half as long and four times as flat.
bool is_near(const Span2& piece, Vec2 p, Vec2 e) {
    struct Part {
        Span2 span;
        int halvings;
    };
    std::array<Part, kMostHalvings + 2> open;
    std::size_t count = 0;
    open[count++] = {piece, 0};
    while (count > 0) {
        const Part part = open[--count];
        const Box2 box = box_of(part.span);
        if (!holds(box, p, e)) continue;
        const Vec2 size = box.size();
        const bool ends_near = holds({part.span.point(0), part.span.point(0)}, p, e) ||
                               holds({part.span.point(3), part.span.point(3)}, p, e);
        if (ends_near || (size.x <= e.x && size.y <= e.y) || part.halvings == kMostHalvings)
            return true;
        Part left{{}, part.halvings + 1};
        Part right{{}, part.halvings + 1};
        split(part.span.x, 0.5, left.span.x, right.span.x);
        split(part.span.y, 0.5, left.span.y, right.span.y);
        split(part.span.w, 0.5, left.span.w, right.span.w);
        open[count++] = right;
        open[count++] = left;
    }
    return false;
}

/// Where a monotone piece has coordinate `at` (of `x`, times weights); the nearer end when it has not.
double parameter_at(const std::array<double, 4>& x, const std::array<double, 4>& w, double at) {
    const Bernstein<3> f = sum_of(x, w, -at);
    if ((f[0] < 0.0) == (f[3] < 0.0)) return std::fabs(f[0]) <= std::fabs(f[3]) ? 0.0 : 1.0;
    return crossing_of<3>(f);
}

/// The parameter of a monotone piece next to p, which lies on or near it.
double nearest_parameter(const Piece& piece, Vec2 p) {
    const Vec2 size = box_of(piece).size();
    return size.x >= size.y ? parameter_at(piece.x, piece.w, p.x)
                            : parameter_at(piece.y, piece.w, p.y);
}

}  // namespace

Side Region::where(Vec2 p, Vec2 e) const {
    const double least = 8.0 * kUnitRoundoff * std::max(1.0, max_norm(p));
    const Vec2 margin{std::max(e.x, least), std::max(e.y, least)};
    bool on = false;
    int winding = 0;
    walk(
        [&](const Box2& box) {
            return !on && box.hi.x >= p.x - margin.x && box.lo.y <= p.y + margin.y &&
                   box.hi.y >= p.y - margin.y;
        },
        [&](std::uint32_t i) {
            const Piece& piece = pieces_[i];
            const Box2 box = box_of(piece);
            if (holds(box, p, margin) && is_near(piece, p, margin)) {
                on = true;
                return;
            }
            // Crossings of the half-line from p to the right.
            const Bernstein<3> f = sum_of(piece.y, piece.w, -p.y);
            const bool rises = f[0] < 0.0;
            if (rises == (f[3] < 0.0)) return;
            const bool right =
                box.lo.x > p.x || (box.hi.x > p.x && point_at(piece, crossing_of<3>(f)).x > p.x);
            if (right) winding += rises ? 1 : -1;
        });
    if (on) return Side::on;
    return encloses(winding) ? Side::in : Side::out;
}

double Region::support(Vec2 n) const {
    double most = -Aabb::kInf;
    walk(
        [&](const Box2& box) {
            const double bound =
                n.x * (n.x < 0.0 ? box.lo.x : box.hi.x) + n.y * (n.y < 0.0 ? box.lo.y : box.hi.y);
            return bound > most;
        },
        [&](std::uint32_t i) {
            const Piece& piece = pieces_[i];
            most = std::max({most, dot(n, piece.point(0)), dot(n, piece.point(3))});
            std::array<double, 4> f{};
            for (std::size_t k = 0; k < 4; ++k) f[k] = n.x * piece.x[k] + n.y * piece.y[k];
            const Bernstein<5> slope =
                sum_of(product(derivative(f), piece.w), product(f, derivative(piece.w)), -1.0);
            RootList<5> roots;
            find_roots<5>(slope, 0.0, roots);
            for (const Root& root : roots) most = std::max(most, dot(n, point_at(piece, root.u)));
        });
    return most;
}

Vec2 Region::normal(Vec2 p, std::uint32_t run, std::uint32_t modulus) const {
    double least = Aabb::kInf;
    std::uint32_t best = 0;
    double best_u = 0.0;
    // Hits lie within rounding of their curve; points that are asked for otherwise may be further off.
    for (double margin = 0x1p-40; margin <= 0x1p12; margin *= 0x1p13) {
        walk(
            [&](const Box2& box) {
                return holds(box, p, {margin, margin});
            },
            [&](std::uint32_t i) {
                const Piece& piece = pieces_[i];
                if (piece.run % modulus != run) return;
                const double u = nearest_parameter(piece, p);
                const double distance = norm(point_at(piece, u) - p);
                if (distance >= least) return;
                least = distance;
                best = i;
                best_u = u;
            });
        if (least <= margin) break;
    }
    Vec2 t = tangent(pieces_[best], best_u);
    if (!(max_norm(t) > 0.0)) t = {1.0, 0.0};
    return {t.y, -t.x};
}

// By Green's theorem half the integral of x dy - y dx; for rational pieces it is not a polynomial, so Gauss' rule of eight
// points on each half of a piece: exact for polynomial cubics (degree 5), and to the last bits on arcs of 90 degrees.
bool Region::is_flat() const {
    // Mostly the area tells; of a figure of eight it may be 0.
    const Vec2 size = box().size();
    if (std::fabs(signed_area()) > 0x1p-40 * size.x * size.y) return false;
    return std::all_of(pieces_.begin(), pieces_.end(),
                       [this](const Piece& piece) { return left_side(piece) == 0.0; });
}

double Region::left_side(const Piece& piece) const {
    const Vec2 at = point_at(piece, 0.5);
    const Vec2 t = tangent(piece, 0.5);
    const double length = norm(piece.point(3) - piece.point(0));
    const Vec2 step = Vec2{-t.y, t.x} * (0x1p-20 * length / norm(t));
    const bool left = where(at + step, {}) == Side::in;
    const bool right = where(at - step, {}) == Side::in;
    return left == right ? 0.0 : (left ? 1.0 : -1.0);
}

double Region::signed_area() const {
    static constexpr std::array<double, 4> kPlace{0.1834346424956498, 0.5255324099163290,
                                                  0.7966664774136267, 0.9602898564975363};
    static constexpr std::array<double, 4> kWeight{0.3626837833783620, 0.3137066458778873,
                                                   0.2223810344533745, 0.1012285362903763};
    double sum = 0.0;
    for (const Piece& piece : pieces_) {
        const auto at = [&](double u) {
            const double w = value_at(piece.w, u);
            const double dw = value_at(derivative(piece.w), u);
            const Vec2 p = point_at(piece, u);
            const Vec2 d{(value_at(derivative(piece.x), u) - p.x * dw) / w,
                         (value_at(derivative(piece.y), u) - p.y * dw) / w};
            return cross(p, d);
        };
        for (const double middle : {0.25, 0.75}) {
            for (std::size_t i = 0; i < 4; ++i) {
                const double off = 0.25 * kPlace[i];
                sum += 0.125 * kWeight[i] * (at(middle - off) + at(middle + off));
            }
        }
    }
    return sum;
}

}  // namespace raymo::curves
