#include "raymo/solids/sweep/swept_spheres.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace raymo::solids {
namespace {

/// Spans are halved at most so often.
constexpr int kMostHalvings = 5;
/// What opening one more box costs, beside looking at a piece.
constexpr double kBoxCost = 0.15;

double half_area(const Aabb& box) {
    const Vec3 s = box.size();
    return s.x * s.y + s.y * s.z + s.z * s.x;
}

/// Largest value on [0, 1] of the cubic in Bernstein form.
double largest(double c0, double c1, double c2, double c3) {
    double most = std::max(c0, c3);
    if (std::max(c1, c2) <= most) return most;
    // c' / 3 = a (1 - u)^2 + 2 b u (1 - u) + c u^2.
    const double a = c1 - c0;
    const double b = c2 - c1;
    const double c = c3 - c2;
    const double disc = b * b - a * c;
    if (!(disc >= 0.0)) return most;
    const double root = std::sqrt(disc);
    // With w = u / (1 - u):  c w^2 + 2 b w + a = 0.
    const double q = -(b + std::copysign(root, b));
    for (const double w : {q / c, a / q}) {
        if (!(w > 0.0)) continue;
        const double u = std::isinf(w) ? 1.0 : w / (1.0 + w);
        const double v = 1.0 - u;
        const double p0 = v * (v * c0 + u * c1) + u * (v * c1 + u * c2);
        const double p1 = v * (v * c1 + u * c2) + u * (v * c2 + u * c3);
        most = std::max(most, v * p0 + u * p1);
    }
    return most;
}

void cut_into_pieces(const SweptSpan& span, std::vector<SweptPiece>& out) {
    struct Part {
        Cubics cubics;
        int depth;
    };
    std::array<Part, kMostHalvings + 1> open;
    std::size_t count = 0;
    open[count++] = {span.cubics, 0};
    while (count > 0) {
        const Part at = open[--count];
        if (at.depth < kMostHalvings) {
            Part left{{}, at.depth + 1};
            Part right{{}, at.depth + 1};
            split(at.cubics, 0.5, left.cubics, right.cubics);
            const double whole = half_area(box_of(at.cubics));
            const double parts = half_area(box_of(left.cubics)) + half_area(box_of(right.cubics));
            if (parts < (1.0 - kBoxCost) * whole) {
                open[count++] = right;
                open[count++] = left;
                continue;
            }
        }
        out.push_back({at.cubics, span.cut, false, false});
    }
}

}  // namespace

double reach(const Cubics& q, Vec3 n, double length) {
    std::array<double, 4> f;
    for (std::size_t i = 0; i < 4; ++i) {
        f[i] = n.x * q.c[i][0] + n.y * q.c[i][1] + n.z * q.c[i][2] + length * q.c[i][3];
    }
    return largest(f[0], f[1], f[2], f[3]);
}

Aabb box_of(const Cubics& cubics) {
    Aabb box;
    for (int i = 0; i < 3; ++i) {
        Vec3 n;
        n[i] = 1.0;
        box.hi[i] = reach(cubics, n, 1.0);
        box.lo[i] = -reach(cubics, -n, 1.0);
    }
    return box;
}

double SweptSpheres::bytes() const {
    std::size_t nodes = 0;
    for (const auto& level : levels) nodes += level.capacity();
    return static_cast<double>(sizeof(SweptSpheres) + spans.capacity() * sizeof(SweptSpan) +
                               pieces.capacity() * sizeof(SweptPiece) + nodes * sizeof(SweptNode));
}

void SweptSpheres::finish() {
    pieces.clear();
    levels.clear();
    for (const SweptSpan& span : spans) cut_into_pieces(span, pieces);
    if (!closed && !flat) {
        pieces.front().begins = true;
        pieces.back().ends = true;
    }
    constexpr std::size_t kWidth = SweptNode::kWidth;
    std::vector<SweptNode> lowest((pieces.size() + kWidth - 1) / kWidth);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        lowest[i / kWidth].set(i % kWidth, box_of(pieces[i].cubics));
    }
    levels.push_back(std::move(lowest));
    while (levels.back().size() > 1) {
        const std::vector<SweptNode>& under = levels.back();
        std::vector<SweptNode> level((under.size() + kWidth - 1) / kWidth);
        for (std::size_t i = 0; i < under.size(); ++i) {
            for (std::size_t a = 0; a < 3; ++a) {
                level[i / kWidth].lo[a][i % kWidth] =
                    *std::min_element(std::begin(under[i].lo[a]), std::end(under[i].lo[a]));
                level[i / kWidth].hi[a][i % kWidth] =
                    *std::max_element(std::begin(under[i].hi[a]), std::end(under[i].hi[a]));
            }
        }
        levels.push_back(std::move(level));
    }
}

}  // namespace raymo::solids
