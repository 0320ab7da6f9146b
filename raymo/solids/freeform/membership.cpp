// Points and a closed surface of patches.
//
// A point is on the surface when some place of a patch is within its error; patches are halved near it until their control
// points are, or are all further away. Else the lines through it tell whether it is inside, the first of some that is not
// in doubt there.
#include <algorithm>
#include <cmath>

#include "raymo/solids/freeform/freeform.hpp"

namespace raymo::solids {
namespace {

/// Parts of one leaf that are looked at, at most; only a point that is as far from all of a part needs more, and it is on
/// the surface as far as anyone can tell.
constexpr int kMostParts = 4000;
constexpr std::size_t kMostHalvings = 128;

struct Part {
    std::array<Vec3, 16> b;  ///< seen from the point
};

void halve(Part& c, bool in_u, Part& other) {
    const std::size_t stride = in_u ? 4 : 1;
    const std::size_t across = in_u ? 1 : 4;
    for (std::size_t n = 0; n < 4; ++n) {
        Vec3* p = c.b.data() + n * across;
        Vec3* q = other.b.data() + n * across;
        const Vec3 p0 = p[0], p1 = p[stride], p2 = p[2 * stride], p3 = p[3 * stride];
        const Vec3 a = (p0 + p1) * 0.5, m = (p1 + p2) * 0.5, b = (p2 + p3) * 0.5;
        const Vec3 am = (a + m) * 0.5, mb = (m + b) * 0.5;
        p[stride] = a;
        p[2 * stride] = am;
        p[3 * stride] = q[0] = (am + mb) * 0.5;
        q[stride] = mb;
        q[2 * stride] = b;
        q[3 * stride] = p3;
    }
}

double edge(const Part& c, std::size_t stride, std::size_t across) {
    double most = 0.0;
    for (std::size_t n = 0; n < 4; ++n) {
        for (std::size_t m = 0; m < 3; ++m) {
            const std::size_t k = n * across + m * stride;
            const Vec3 d = c.b[k + stride] - c.b[k];
            most = std::max(most, dot(d, d));
        }
    }
    return most;
}

/// Whether a leaf is within r of the origin of `from`.
bool is_near(const FreeformSurface& surface, const FreeformLeaf& leaf, Vec3 from, double r) {
    const Vec3 n = cross(leaf.du, leaf.dv);
    const double beyond = 0.5 * (leaf.spread_u + leaf.spread_v) + r;
    if (std::fabs(dot(from - leaf.middle, n)) > (beyond * (1.0 + 0x1p-40)) * norm(n) + 0x1p-48)
        return false;
    const Patch patch = restricted(surface.patches[leaf.patch], leaf.part);
    std::array<Part, kMostHalvings> open;
    std::size_t count = 1;
    for (std::size_t k = 0; k < 16; ++k) open[0].b[k] = patch.point(k / 4, k % 4) - from;
    for (int looked = 0; count > 0; ++looked) {
        Part& at = open[count - 1];
        Aabb box;
        for (const Vec3 b : at.b) box.include(b);
        const Vec3 outside = max(max(box.lo, -box.hi), Vec3{});
        if (dot(outside, outside) > r * r) {
            --count;
            continue;
        }
        for (const std::size_t k :
             {std::size_t{0}, std::size_t{3}, std::size_t{12}, std::size_t{15}}) {
            if (dot(at.b[k], at.b[k]) <= r * r) return true;
        }
        const double along_u = edge(at, 4, 1);
        const double along_v = edge(at, 1, 4);
        if (std::max(along_u, along_v) <= 0.01 * r * r) return true;
        if (looked >= kMostParts || count == kMostHalvings) return true;
        halve(at, along_u >= along_v, open[count]);
        ++count;
    }
    return false;
}

}  // namespace

Where Freeform::where(Vec3 p, Vec3 e) const {
    if (!(max_norm(p) <= 2.0)) return Where::out;
    const FreeformSurface& surface = *surface_;
    const double r = norm(e) + kFreeformOwnError;
    std::array<std::uint32_t, kMostFreeformWaiting> open;
    std::size_t count = 1;
    open[0] = 0;
    const auto margin = static_cast<float>(r * (1.0 + 0x1p-20));
    while (count > 0) {
        const FreeformNode& node = surface.nodes[open[--count]];
        for (std::size_t i = 0; i < EightBoxes::kWidth; ++i) {
            bool within = true;
            for (std::size_t a = 0; a < 3; ++a) {
                const auto x = static_cast<float>(p[static_cast<int>(a)]);
                within = within && x >= node.boxes.lo[a][i] - margin &&
                         x <= node.boxes.hi[a][i] + margin;
            }
            if (!within) continue;
            if ((node.child[i] & FreeformNode::kLeaf) == 0) {
                open[count++] = node.child[i];
            } else if (is_near(surface, surface.leaves[node.child[i] & ~FreeformNode::kLeaf], p,
                               r)) {
                return Where::on;
            }
        }
    }
    static constexpr std::array<Vec3, 8> kDirections{
        Vec3{0.5377, 0.7123, 0.4511},  Vec3{-0.6631, 0.2719, 0.6977}, Vec3{0.1931, -0.8467, 0.4957},
        Vec3{0.9127, -0.1187, 0.3911}, Vec3{-0.3457, -0.5399, 0.767}, Vec3{0.8081, 0.5711, -0.1439},
        Vec3{-0.0773, 0.9533, 0.2917}, Vec3{0.4349, 0.3083, 0.8461}};
    for (const Vec3 d : kDirections) {
        const double dd = dot(d, d);
        const double shift = dot(p, d) / dd;
        const Vec3 o = p - d * shift;
        SpanList found;
        spans({o.x, o.y, o.z, d.x, d.y, d.z, 0.0, 0.0, 0.0, dd, kFromTheBeginning}, found);
        if (found.degenerate()) continue;
        bool inside = false;
        bool clear = !found.touched() || shift < found.touch_lo() || shift > found.touch_hi();
        for (std::size_t i = 0; i < found.size(); ++i) {
            inside = inside || (shift > found[i].enter.s && shift < found[i].exit.s);
            for (const SpanEnd& end : {found[i].enter, found[i].exit})
                clear = clear && std::fabs(end.s - shift) > end.error;
        }
        if (clear) return inside ? Where::in : Where::out;
    }
    return Where::on;
}

}  // namespace raymo::solids
