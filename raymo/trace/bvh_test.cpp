#include "raymo/trace/bvh.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

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

bool holds(const Boxf& outer, const Boxf& inner) {
    for (std::size_t a = 0; a < 3; ++a) {
        if (inner.lo[a] < outer.lo[a] || inner.hi[a] > outer.hi[a]) return false;
    }
    return true;
}
Boxf child_box(const BvhNode& node, std::size_t c) {
    return {{node.lo[0][c], node.lo[1][c], node.lo[2][c]},
            {node.hi[0][c], node.hi[1][c], node.hi[2][c]}};
}

/// Every box lies in one range, within the boxes of all nodes above it; every node is reached once.
void check_tree(const std::vector<Boxf>& boxes) {
    CAPTURE(boxes.size());
    const Bvh tree = build_bvh(boxes);
    REQUIRE(tree.order.size() == boxes.size());
    std::vector<int> found(boxes.size());
    std::vector<int> reached(tree.nodes.size());
    const Boxf all{{-kInf, -kInf, -kInf}, {kInf, kInf, kInf}};
    std::vector<std::pair<std::uint32_t, Boxf>> open{{0U, all}};
    int outside = 0;
    while (!open.empty()) {
        const auto [index, around] = open.back();
        open.pop_back();
        REQUIRE(index < tree.nodes.size());
        REQUIRE(++reached[index] == 1);
        const BvhNode& node = tree.nodes[index];
        for (std::size_t c = 0; c < BvhNode::kWidth; ++c) {
            const Boxf box = child_box(node, c);
            if (box.lo[0] > box.hi[0]) continue;
            outside += holds(around, box) ? 0 : 1;
            REQUIRE(node.count[c] <= kMaxRange);
            if (node.count[c] == 0) open.emplace_back(node.ref[c], box);
            for (std::uint32_t k = 0; k < node.count[c]; ++k) {
                const std::uint32_t which = tree.order[node.ref[c] + k];
                ++found[which];
                outside += holds(box, boxes[which]) ? 0 : 1;
            }
        }
    }
    CHECK(outside == 0);
    CHECK(std::all_of(found.begin(), found.end(), [](int n) { return n == 1; }));
    CHECK(std::all_of(reached.begin(), reached.end(), [](int n) { return n == 1; }));
}

}  // namespace

TEST_CASE("bvh: every box is found once, within the boxes above it") {
    std::mt19937 random(7);
    const auto number = [&](double from, double to) {
        return static_cast<float>(std::uniform_real_distribution<double>(from, to)(random));
    };
    for (const std::size_t count : {0U, 1U, 2U, 3U, 4U, 5U, 9U, 40U, 1000U, 5000U}) {
        for (int kind = 0; kind < 4; ++kind) {
            std::vector<Boxf> boxes(count);
            for (Boxf& box : boxes) {
                for (std::size_t a = 0; a < 3; ++a) {
                    // Strewn; on a line; on a grid, many at one place; all at one place.
                    const float at = kind == 0            ? number(-1, 1)
                                     : kind == 1 && a > 0 ? 0.25F
                                     : kind == 1          ? number(-1, 1)
                                     : kind == 2          ? std::round(number(-2, 2))
                                                          : 0.5F;
                    const float half = kind == 3 ? 0.125F : number(0, 0.2);
                    box.lo[a] = at - half;
                    box.hi[a] = at + half;
                }
            }
            CAPTURE(kind);
            check_tree(boxes);
        }
    }
}

TEST_CASE("bvh: boxes are rounded to the nearest floats outside") {
    for (const double v : {0.0, 0.1, 0.75, 1.0, 1.0 / 3.0, 16777217.0, 1e-40, 1e-46, 1e-320, 3.4e38,
                           1e39, static_cast<double>(kInf)}) {
        check_rounded(v);
        check_rounded(-v);
    }
}

}  // namespace raymo::trace
