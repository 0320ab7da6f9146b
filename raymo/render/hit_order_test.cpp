#include "raymo/render/hit_order.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <random>
#include <vector>

namespace raymo::render {
namespace {

using trace::Hit;
using trace::RayPacket;

/// A batch of packets with random hits; every number of a hit tells which it is.
struct Batch {
    std::vector<RayPacket> rays{HitOrder::kPackets};
    std::map<std::uint32_t, Hit> taken;  ///< by packet * kRays + lane
    HitOrder order;

    Batch(std::uint64_t seed, std::uint32_t leaves) {
        std::mt19937_64 random(seed);
        order.clear();
        for (std::size_t p = 0; p < HitOrder::kPackets; ++p) {
            const auto lanes = static_cast<LaneBits>(random());
            if (lanes == 0 || random() % 8 == 0) continue;  // nothing was met
            const std::uint32_t few = 1 + static_cast<std::uint32_t>(random() % 6);
            std::map<std::uint32_t, int> met;
            std::map<std::uint32_t, Hit> hits;
            for (int i = 0; i < kRays; ++i) {
                Hit hit;
                const double x = static_cast<double>(p) * kRays + i;
                hit.t = x;
                hit.point = {x + 0.1, x + 0.2, x + 0.3};
                hit.normal = {x + 0.4, x + 0.5, x + 0.6};
                hit.point_error = x + 0.7;
                hit.entering = random() % 2 == 0;
                hit.material = static_cast<csg::MaterialId>(random());
                hit.medium_before = static_cast<csg::MaterialId>(random());
                hit.medium_after = static_cast<csg::MaterialId>(random());
                hit.surface.leaf = static_cast<std::uint32_t>(random() % few * 977 % leaves);
                order.next().set(i, hit);
                for (int a = 0; a < 3; ++a) rays[p].d[a][i] = x + 1000.0 * (a + 1);
                if ((lanes >> i & 1U) == 0) continue;
                ++met[hit.surface.leaf];
                hits[static_cast<std::uint32_t>(p * kRays) + static_cast<std::uint32_t>(i)] = hit;
            }
            const bool several = met.size() > 2;
            CHECK(order.add(p, lanes) == several);
            if (several) taken.merge(hits);
        }
        order.sort();
    }
};

}  // namespace

TEST_CASE("hit order: each hit that was taken comes once, as it was, and leaf by leaf") {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        const auto batch = std::make_unique<Batch>(seed, seed % 3 == 0 ? 4U : 5000U);
        REQUIRE(batch->order.size() == batch->taken.size());
        std::vector<std::uint32_t> leaves;
        std::map<std::uint32_t, int> seen;
        const auto hits = std::make_unique<trace::HitPacket>();
        alignas(64) double view[3][kRays];
        std::uint32_t owner[kRays];
        for (std::size_t first = 0; first < batch->order.size(); first += kRays) {
            const LaneBits lanes = batch->order.take(first, batch->rays.data(), *hits, view, owner);
            const std::size_t left = batch->order.size() - first;
            REQUIRE(lanes == trace::first_lanes(std::min<std::size_t>(left, kRays)));
            for (int i = 0; i < trace::lane_count(lanes); ++i) {
                REQUIRE(++seen[owner[i]] == 1);
                const auto known = batch->taken.find(owner[i]);
                REQUIRE(known != batch->taken.end());
                const Hit& a = known->second;
                const Hit b = hits->hit(i);
                CHECK(a.t == b.t);
                CHECK(a.point == b.point);
                CHECK(a.normal == b.normal);
                CHECK(a.point_error == b.point_error);
                CHECK(a.entering == b.entering);
                CHECK(a.material == b.material);
                CHECK(a.medium_before == b.medium_before);
                CHECK(a.medium_after == b.medium_after);
                CHECK(a.surface.leaf == b.surface.leaf);
                for (int axis = 0; axis < 3; ++axis)
                    CHECK(view[axis][i] == owner[i] + 1000.0 * (axis + 1));
                leaves.push_back(b.surface.leaf);
            }
        }
        CHECK(std::is_sorted(leaves.begin(), leaves.end()));
    }
}

TEST_CASE("hit order: nothing was met, nothing is taken") {
    const auto order = std::make_unique<HitOrder>();
    order->clear();
    order->sort();
    CHECK(order->size() == 0);
}

}  // namespace raymo::render
