// Points and a sweep: whether they are in it, and which ball they lie on.
//
// A point p is inside by more than g when for some u  |p - r|^2 < (a - g)^2, a > g, and outside by more than g when for all u
// F(p, u) > 2 a g + g^2. The path is halved until the Bernstein coefficients of F decide for each part, or a part is shorter
// than g; the cubics are halved, not F, so that near p all numbers are as small as the distances.
#include <algorithm>
#include <cmath>
#include <limits>

#include "raymo/core/small_list.hpp"
#include "raymo/curves/roots.hpp"
#include "raymo/math/tolerance.hpp"
#include "raymo/solids/sweep/sweep.hpp"

namespace raymo::solids {
namespace {

/// Parts of one piece that are looked at, at most; only a point that is as far from all of a part as its radius needs more,
/// and is on the boundary as far as anyone can tell.
constexpr int kMostParts = 2000;
constexpr int kMostHalvings = 48;

/// Rounding of F, in the canonical frame.
constexpr double kTiny = 64.0 * kUnitRoundoff;

/// At the edge of a flat cap, a point that is nearer to a ball's surface than this is on it.
constexpr double kCapEdge = 0x1p-40;
/// More than a crossing is off its surface by the ray's own error: nearer to a cap's plane it is not certain on which side a point is.
constexpr double kCapSlack = 0x1p-22;

/// A point that is no farther from a ball's surface than this is on it, as far as crossings are known to be on their surface.
constexpr double kOnBall = 0x1p-42;

Cubics seen_from(Vec3 p, const Cubics& q) {
    Cubics out = q;
    for (std::size_t i = 0; i < 4; ++i) {
        for (int k = 0; k < 3; ++k) out.c[i][static_cast<std::size_t>(k)] -= p[k];
    }
    return out;
}

/// F as a sextic of u.
std::array<double, 7> field_of(const Cubics& q) {
    std::array<double, 7> f{};
    for (std::size_t k = 0; k < 3; ++k) add_square(q, k, 1.0, f);
    add_square(q, 3, -1.0, f);
    return f;
}

double distance(const Cubics& q, std::size_t i) {
    return std::sqrt(q.c[i][0] * q.c[i][0] + q.c[i][1] * q.c[i][1] + q.c[i][2] * q.c[i][2]);
}

/// Where the origin is, with respect to the balls of a piece. `slack`: what counts as on.
Where where_in(const Cubics& whole, double slack) {
    struct Part {
        Cubics q;
        int depth;
    };
    std::array<Part, kMostHalvings + 2> open;
    std::size_t count = 0;
    open[count++] = {whole, 0};
    Where found = Where::out;
    for (int looked = 0; count > 0; ++looked) {
        const Part at = open[--count];
        for (const std::size_t i : {std::size_t{0}, std::size_t{3}}) {
            if (distance(at.q, i) < std::fabs(at.q.c[i][3]) - slack) return Where::in;
        }
        const std::array<double, 7> f = field_of(at.q);
        double size = 0.0;
        double radius = 0.0;
        double extent = 0.0;
        for (std::size_t i = 0; i < 4; ++i) {
            const double d = distance(at.q, i);
            radius = std::max(radius, std::fabs(at.q.c[i][3]));
            size = std::max(size, d * d);
            for (std::size_t k = 0; k < 4; ++k)
                extent = std::max(extent, std::fabs(at.q.c[i][k] - at.q.c[0][k]));
        }
        const double margin =
            slack * (2.0 * radius + slack) + 8.0 * kUnitRoundoff * (size + radius * radius);
        const auto [least, most] = std::minmax_element(f.begin(), f.end());
        if (*least > margin) continue;
        if (*most<margin&& * least> - margin) {
            found = Where::on;
            continue;
        }
        if (extent < 0.125 * slack || at.depth >= kMostHalvings || looked >= kMostParts) {
            found = Where::on;
            continue;
        }
        split(at.q, 0.5, open[count + 1].q, open[count].q);
        open[count].depth = open[count + 1].depth = at.depth + 1;
        count += 2;
    }
    return found;
}

/// Calls visit(piece) for those whose box, grown by `margin`, holds p, until it returns false.
template <class Visit>
void pieces_at(const SweptSpheres& spheres, Vec3 p, double margin, const Visit& visit) {
    struct Todo {
        std::uint32_t level, node;
    };
    std::array<Todo, 8 * 11> open;
    std::size_t count = 0;
    open[count++] = {static_cast<std::uint32_t>(spheres.levels.size() - 1), 0};
    while (count > 0) {
        const Todo at = open[--count];
        const SweptNode& node = spheres.levels[at.level][at.node];
        for (std::uint32_t c = 0; c < SweptNode::kWidth; ++c) {
            bool holds = true;
            for (int a = 0; a < 3; ++a) {
                holds = holds && p[a] >= static_cast<double>(node.lo[a][c]) - margin &&
                        p[a] <= static_cast<double>(node.hi[a][c]) + margin;
            }
            if (!holds) continue;
            const auto child = at.node * static_cast<std::uint32_t>(SweptNode::kWidth) + c;
            if (at.level > 0) {
                open[count++] = {at.level - 1, child};
            } else if (!visit(spheres.pieces[child])) {
                return;
            }
        }
    }
}

/// The ball on whose surface a point is.
struct Nearest {
    /// Balls that hold the point deeper are cut off there.
    double least = -std::numeric_limits<double>::infinity();
    double distance = std::numeric_limits<double>::infinity();  ///< from its surface
    Vec3 outward;
    Vec3 tangent;
};

void look_nearer(const Cubics& q, double u, Nearest& best) {
    const CubicsJet j = jet_at(q, u);
    const Vec3 outward{-j.value[0], -j.value[1], -j.value[2]};
    const double distance = std::sqrt(dot(outward, outward)) - std::fabs(j.value[3]);
    if (!(distance < best.distance && distance >= best.least)) return;
    best = {best.least, distance, outward, {j.first[0], j.first[1], j.first[2]}};
}

/// The balls at both ends of a piece.
void look_at_ends(const Cubics& q, Nearest& best) {
    for (const std::size_t i : {std::size_t{0}, std::size_t{3}}) {
        const double d = distance(q, i) - std::fabs(q.c[i][3]);
        if (d < best.distance && d >= best.least) look_nearer(q, i == 0 ? 0.0 : 1.0, best);
    }
}

/// Half of F's first derivative where a piece begins, over 3; and where it ends.
std::array<double, 2> slopes_at_ends(const Cubics& q) {
    std::array<double, 2> out{};
    for (std::size_t k = 0; k < 4; ++k) {
        const double sign = k < 3 ? 1.0 : -1.0;
        out[0] += sign * q.c[0][k] * (q.c[1][k] - q.c[0][k]);
        out[1] += sign * q.c[3][k] * (q.c[3][k] - q.c[2][k]);
    }
    return out;
}

/// Half of F's first and second derivatives.
std::array<double, 2> slopes(const CubicsJet& j) {
    std::array<double, 2> out{-j.value[3] * j.first[3],
                              -j.first[3] * j.first[3] - j.value[3] * j.second[3]};
    for (std::size_t k = 0; k < 3; ++k) {
        out[0] += j.value[k] * j.first[k];
        out[1] += j.first[k] * j.first[k] + j.value[k] * j.second[k];
    }
    return out;
}

/// The ball of a piece on whose surface the origin is, by Newton's method from where a line through the slopes at both ends is
/// zero. Of a point on the boundary any such ball will do: none holds it deeper. False: there is none, or another search is wanted.
bool look_quickly(const Cubics& q, Nearest& best) {
    constexpr int kMostSteps = 6;
    const auto [begin, end] = slopes_at_ends(q);
    if (!(begin <= 0.0 && end >= 0.0 && end - begin > 0.0)) return false;
    double u = begin / (begin - end);
    for (int i = 0; i < kMostSteps; ++i) {
        const CubicsJet j = jet_at(q, u);
        const auto [first, second] = slopes(j);
        if (!(second > 0.0)) return false;
        const double step = -first / second;
        u += step;
        if (!(u >= 0.0 && u <= 1.0)) return false;
        if (std::fabs(step) > 0x1p-30) continue;
        // The rest of the way is a line.
        const Vec3 outward = Vec3{j.value[0], j.value[1], j.value[2]} * -1.0 -
                             Vec3{j.first[0], j.first[1], j.first[2]} * step;
        const double distance = norm(outward) - std::fabs(j.value[3] + j.first[3] * step);
        if (std::fabs(distance) > kOnBall) return false;
        best = {best.least, distance, outward, {j.first[0], j.first[1], j.first[2]}};
        return true;
    }
    return false;
}

/// The balls between.
void look_between(const Cubics& q, Nearest& best) {
    const std::array<double, 7> field = field_of(q);
    // |p - r| - a >= F / (2 a + |p - r| - a): where that is no less than what is known already, nothing is nearer.
    double radius = 0.0;
    for (std::size_t i = 0; i < 4; ++i) radius = std::max(radius, std::fabs(q.c[i][3]));
    const double known = std::max(best.distance, 0.0);
    if (*std::min_element(field.begin(), field.end()) > known * (2.0 * radius + known) + kTiny)
        return;
    const std::array<double, 6> slope = curves::derivative(field);
    curves::RootList<5> roots;
    curves::find_roots<5>(slope, 0.0, roots);
    for (const curves::Root& root : roots) {
        double u = root.u;
        look_nearer(q, u, best);
        // Once more from the cubics themselves, which lose less than the products of their coefficients.
        const auto [first, second] = slopes(jet_at(q, u));
        if (second > 0.0) look_nearer(q, std::clamp(u - first / second, 0.0, 1.0), best);
    }
}

}  // namespace

Where Sweep::Kernel::where(Vec3 p, Vec3 e) const {
    const double slack = norm(e) + 32.0 * kUnitRoundoff * (1.0 + max_norm(p));
    Where found = Where::out;
    pieces_at(*spheres_, p, slack, [&](const SweptPiece& piece) {
        Where most = Where::in;
        for (std::size_t k = 0; k < 2; ++k) {
            if ((piece.cut >> k & 1U) == 0) continue;
            const double height = dot(spheres_->caps[k].n, p) - spheres_->caps[k].c;
            if (height < -slack) return true;
            if (height <= slack) most = Where::on;
        }
        found = std::max(found, std::min(most, where_in(seen_from(p, piece.cubics), slack)));
        return found != Where::in;
    });
    return found;
}

Vec3 Sweep::Kernel::normal(Vec3 p, std::uint16_t face) const {
    const SweptSpheres& spheres = *spheres_;
    if (spheres.flat && !spheres.closed && face > 0) return -spheres.caps[face - 1U].n;
    Nearest best;
    if (face == 1) {
        look_nearer(seen_from(p, spheres.pieces.front().cubics), 0.0, best);
    } else if (face == 2) {
        look_nearer(seen_from(p, spheres.pieces.back().cubics), 1.0, best);
    } else {
        // How deep a piece's balls may hold p where flat caps cut them; infinite where what is left of them does not reach.
        const auto least_of = [&](const SweptPiece& piece) {
            constexpr double kInfinity = std::numeric_limits<double>::infinity();
            double least = -kInfinity;
            for (std::size_t k = 0; k < 2; ++k) {
                if ((piece.cut >> k & 1U) == 0) continue;
                const double height = dot(spheres.caps[k].n, p) - spheres.caps[k].c;
                if (height < -kCapSlack) return kInfinity;
                least = std::max(least, -std::min(std::fabs(height), kCapSlack) - kCapEdge);
            }
            return least;
        };
        SmallList<const SweptPiece*, 64> near;
        bool is_found = false;
        pieces_at(spheres, p, kBoxMargin, [&](const SweptPiece& piece) {
            if (least_of(piece) > 0.0) return true;
            near.push_back(&piece);
            is_found = look_quickly(seen_from(p, piece.cubics), best);
            return !is_found;
        });
        // The balls at the ends of pieces are looked at first: what they tell spares looking between most of them.
        const auto look = [&](const SweptPiece& piece, const auto& at) {
            best.least = least_of(piece);
            at(seen_from(p, piece.cubics), best);
        };
        if (!is_found) {
            for (const SweptPiece* piece : near) look(*piece, look_at_ends);
            for (const SweptPiece* piece : near) look(*piece, look_between);
        }
        if (std::isinf(best.distance)) {
            best.least = -std::numeric_limits<double>::infinity();
            for (const SweptPiece& piece : spheres.pieces) {
                const Cubics q = seen_from(p, piece.cubics);
                look_at_ends(q, best);
                look_between(q, best);
            }
        }
    }
    if (max_norm(best.outward) > 0.0) return best.outward;
    // A ball of no size: at a tip, away from the path; and anywhere, if need be.
    if (max_norm(best.tangent) > 0.0) return face == 2 ? best.tangent : -best.tangent;
    return {0.0, 0.0, 1.0};
}

}  // namespace raymo::solids
