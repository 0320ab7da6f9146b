// How a surface is cut into leaves, and their tree.
//
// A patch is halved, in u or in v, until over each part both derivatives stay within an eighth of their size of what they
// are in its middle, or the part is an eighth of the patch. A line that meets such a part at more than about 15 degrees can
// meet it only once (search.cpp). The derivatives lie in the convex hull of the 12 differences of control points.
//
// The tree is built from the root. The leaves of a node are sorted along an axis and cut in two, where the sum of the parts'
// areas times their counts is least, until each part fits in a child; only cuts that leave full children are looked at, so
// that few nodes suffice.
#include "raymo/solids/freeform/surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace raymo::solids {
namespace {

constexpr double kNearlyFlat = 0.125;
/// In each direction. Of many patches each shows little of the surface; and there are 2^22 leaves at most.
int most_halvings(std::size_t patches) { return patches <= 0x10000 ? 3 : 2; }

/// A ball around vectors.
struct Ball {
    Vec3 centre;
    double radius = 0.0;
};
Ball ball_of(const std::array<Vec3, 12>& vectors) {
    Aabb box;
    for (const Vec3 v : vectors) box.include(v);
    Ball out{box.centre(), 0.0};
    for (const Vec3 v : vectors) out.radius = std::max(out.radius, norm(v - out.centre));
    // Rounding, here and where it is used.
    out.radius += 0x1p-46;
    return out;
}

/// How much the derivatives change along u and along v, in parts of their size.
void changes(const Patch& p, const Ball& du, const Ball& dv, double& along_u, double& along_v) {
    double uu = 0.0, vv = 0.0, uv = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            const Vec3 b = p.point(i, j);
            if (i < 2) uu = std::max(uu, norm(b - p.point(i + 1, j) * 2.0 + p.point(i + 2, j)));
            if (j < 2) vv = std::max(vv, norm(b - p.point(i, j + 1) * 2.0 + p.point(i, j + 2)));
            if (i < 3 && j < 3) {
                uv = std::max(uv, norm((p.point(i + 1, j + 1) - p.point(i + 1, j)) -
                                       (p.point(i, j + 1) - b)));
            }
        }
    }
    const double su = std::max(norm(du.centre), 1e-30);
    const double sv = std::max(norm(dv.centre), 1e-30);
    along_u = std::max(6.0 * uu / su, 9.0 * uv / sv);
    along_v = std::max(9.0 * uv / su, 6.0 * vv / sv);
}

struct Open {
    PatchPart part = kWholePatch;
    int halved_u = 0, halved_v = 0;
};

void cut(const Patch& patch, std::uint32_t number, int halvings, std::vector<FreeformLeaf>& out,
         std::vector<Aabb>& boxes) {
    std::vector<Open> open{Open{}};
    while (!open.empty()) {
        const Open at = open.back();
        open.pop_back();
        const Patch part = restricted(patch, at.part);
        const auto slopes =
            slopes_of([&](std::size_t i, std::size_t j) { return part.point(i, j); });
        const Ball du = ball_of(slopes.du);
        const Ball dv = ball_of(slopes.dv);
        const bool flat = du.radius <= kNearlyFlat * norm(du.centre) &&
                          dv.radius <= kNearlyFlat * norm(dv.centre);
        double along_u = 0.0, along_v = 0.0;
        changes(part, du, dv, along_u, along_v);
        const bool can_u = at.halved_u < halvings;
        const bool can_v = at.halved_v < halvings;
        if (flat || (!can_u && !can_v)) {
            FreeformLeaf leaf;
            leaf.middle = part.at(0.5, 0.5).at;
            leaf.du = du.centre;
            leaf.dv = dv.centre;
            leaf.spread_u = du.radius;
            leaf.spread_v = dv.radius;
            leaf.reach = 0.5 * (norm(leaf.du) + norm(leaf.dv) + leaf.spread_u + leaf.spread_v);
            leaf.part = at.part;
            leaf.patch = number;
            out.push_back(leaf);
            boxes.push_back(part.control_box());
            continue;
        }
        Open one = at, other = at;
        if (can_u && (along_u >= along_v || !can_v)) {
            one.part.u1 = other.part.u0 = 0.5 * (at.part.u0 + at.part.u1);
            ++one.halved_u, ++other.halved_u;
        } else {
            one.part.v1 = other.part.v0 = 0.5 * (at.part.v0 + at.part.v1);
            ++one.halved_v, ++other.halved_v;
        }
        open.push_back(other);
        open.push_back(one);
    }
}

double half_area(const Aabb& box) {
    const Vec3 d = box.size();
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

struct Range {
    std::uint32_t first, last;
    Aabb box;
    [[nodiscard]] std::uint32_t count() const { return last - first; }
};

class Builder {
public:
    Builder(const std::vector<Aabb>& boxes, std::vector<FreeformNode>& nodes)
        : boxes_(boxes), nodes_(nodes), order_(boxes.size()) {
        for (std::uint32_t i = 0; i < order_.size(); ++i) order_[i] = i;
    }

    void run() {
        struct Todo {
            std::uint32_t node;
            Range range;
        };
        nodes_.emplace_back();
        std::vector<Todo> open{{0, range(0, static_cast<std::uint32_t>(order_.size()))}};
        while (!open.empty()) {
            const Todo at = open.back();
            open.pop_back();
            std::uint32_t unit = 1;
            while (unit * EightBoxes::kWidth < at.range.count()) unit *= EightBoxes::kWidth;
            std::array<Range, EightBoxes::kWidth> parts;
            std::size_t count = 0;
            parts[count++] = at.range;
            for (std::size_t i = 0; i < count;) {
                if (parts[i].count() <= unit) {
                    ++i;
                    continue;
                }
                const std::uint32_t middle = split(parts[i], unit);
                parts[count++] = range(middle, parts[i].last);
                parts[i] = range(parts[i].first, middle);
            }
            for (std::size_t i = 0; i < count; ++i) {
                std::uint32_t child;
                if (parts[i].count() == 1) {
                    child = FreeformNode::kLeaf | order_[parts[i].first];
                } else {
                    child = static_cast<std::uint32_t>(nodes_.size());
                    nodes_.emplace_back();
                    open.push_back({child, parts[i]});
                }
                nodes_[at.node].boxes.set(i, parts[i].box);
                nodes_[at.node].child[i] = child;
            }
        }
    }

private:
    [[nodiscard]] Range range(std::uint32_t first, std::uint32_t last) const {
        Range out{first, last, {}};
        for (std::uint32_t i = first; i < last; ++i) out.box = hull(out.box, boxes_[order_[i]]);
        return out;
    }

    /// Sorts the leaves of a range into two, the first of which has a multiple of `unit`; where the second begins.
    std::uint32_t split(const Range& at, std::uint32_t unit) {
        std::uint32_t best = at.first + unit;
        double least = std::numeric_limits<double>::infinity();
        int best_axis = 0;
        for (int axis = 0; axis < 3; ++axis) {
            sort(at, axis);
            Aabb left;
            std::vector<Range> from_left;
            for (std::uint32_t i = at.first; i < at.last; ++i) {
                if (i > at.first && (i - at.first) % unit == 0)
                    from_left.push_back({at.first, i, left});
                left = hull(left, boxes_[order_[i]]);
            }
            Aabb right;
            for (std::uint32_t i = at.last; i-- > at.first;) {
                right = hull(right, boxes_[order_[i]]);
                if (i == at.first || (i - at.first) % unit != 0) continue;
                const Range& other = from_left[(i - at.first) / unit - 1];
                const double cost =
                    half_area(other.box) * other.count() + half_area(right) * (at.last - i);
                if (cost < least) {
                    least = cost;
                    best = i;
                    best_axis = axis;
                }
            }
        }
        sort(at, best_axis);
        return best;
    }
    void sort(const Range& at, int axis) {
        std::sort(order_.begin() + at.first, order_.begin() + at.last,
                  [&](std::uint32_t a, std::uint32_t b) {
                      const double x = boxes_[a].centre()[axis];
                      const double y = boxes_[b].centre()[axis];
                      return x != y ? x < y : a < b;
                  });
    }

    const std::vector<Aabb>& boxes_;
    std::vector<FreeformNode>& nodes_;
    std::vector<std::uint32_t> order_;
};

}  // namespace

void FreeformSurface::finish() {
    patches.clear();
    leaves.clear();
    nodes.clear();
    first_leaf.clear();
    std::vector<Aabb> boxes;
    for (const meshes::Net& net : shell.patches) {
        Patch patch;
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t j = 0; j < 4; ++j) patch.set(i, j, shell.points[net[4 * i + j]]);
        }
        patch.find_bend();
        first_leaf.push_back(static_cast<std::uint32_t>(leaves.size()));
        cut(patch, static_cast<std::uint32_t>(patches.size()), most_halvings(shell.patches.size()),
            leaves, boxes);
        patches.push_back(patch);
    }
    first_leaf.push_back(static_cast<std::uint32_t>(leaves.size()));
    Builder(boxes, nodes).run();
}

double FreeformSurface::bytes() const {
    return static_cast<double>(
        sizeof(FreeformSurface) + shell.points.capacity() * sizeof(Vec3) +
        shell.patches.capacity() * sizeof(meshes::Net) + patches.capacity() * sizeof(Patch) +
        leaves.capacity() * sizeof(FreeformLeaf) + nodes.capacity() * sizeof(FreeformNode) +
        first_leaf.capacity() * sizeof(std::uint32_t));
}

}  // namespace raymo::solids
