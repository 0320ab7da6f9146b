#include <doctest/doctest.h>

#include <random>

#include "raymo/csg/model.hpp"
#include "raymo/trace/packet.hpp"
#include "raymo/trace/test_primitive.hpp"

namespace raymo::trace {
namespace {

using csg::Solid;

using test::primitive;
Solid sphere(double radius, Vec3 at) {
    return csg::transform(primitive("sphere", {radius}), translation(at)).value();
}
Solid slab(double thickness, double y) {
    return csg::transform(primitive("block", {Vec3{10, thickness, 10}, false}),
                          translation({-5, y, -5}))
        .value();
}
constexpr csg::MaterialId kGlass = 0;
constexpr csg::MaterialId kStone = 1;
void add(scene::Scene& scene, Solid solid, csg::MaterialId material) {
    scene.parts.push_back({"part", csg::paint(std::move(solid), material), {}});
}
scene::Scene with_glass() {
    scene::Scene scene;
    scene.materials.resize(2);
    scene.materials.edit(kGlass).transmission = 0.9;
    return scene;
}

/// What a ray crosses, found from surface to surface; t counts from its start. Empty and `blocked` if that is opaque.
std::vector<Hit> crossed(Tracer& tracer, RayQuery query, bool& blocked) {
    std::vector<Hit> out;
    blocked = false;
    double reached = 0.0;
    for (Hit hit; tracer.first_hit(query, hit);) {
        if (hit.material != kGlass) {
            blocked = true;
            return {};
        }
        query.ray.origin = hit.point;
        query.t_max -= hit.t;
        query.on_surface = true;
        query.start_error = hit.point_error;
        hit.t = reached += hit.t;
        out.push_back(hit);
    }
    return out;
}

constexpr int kHalf = kRays / 2;  ///< of a packet

struct Seen {
    int left_over = 0, blocked = 0, free = 0, crossings = 0;
};
void compare(Tracer& tracer, const std::vector<RayQuery>& queries, Seen& seen) {
    RayPacket rays;
    for (std::size_t i = 0; i < kRays; ++i) rays.set(static_cast<int>(i), queries[i]);
    PassagePacket passed;
    LaneBits blocked = 0;
    const LaneBits left_over = tracer.passages(rays, kAllLanes, passed, blocked);
    CHECK((left_over & blocked) == 0);
    for (std::size_t i = 0; i < kRays; ++i) {
        const auto has = [i](LaneBits lanes) { return (lanes >> i & 1U) != 0; };
        if (has(left_over)) {
            ++seen.left_over;
            continue;
        }
        bool hidden = false;
        const std::vector<Hit> expected = crossed(tracer, queries[i], hidden);
        REQUIRE(has(blocked) == hidden);
        if (hidden) {
            ++seen.blocked;
            continue;
        }
        ++seen.free;
        std::size_t next = 0;
        for (int k = 0; k < passed.count; ++k) {
            if (!has(passed.lanes[k])) continue;
            REQUIRE(next < expected.size());
            const Hit& one = expected[next++];
            const Hit hit = passed.hits[k].hit(static_cast<int>(i));
            CHECK(hit.t == doctest::Approx(one.t).epsilon(1e-9));
            CHECK(norm(hit.normal - one.normal) < 1e-7);
            CHECK(hit.entering == one.entering);
            CHECK(hit.part == one.part);
            CHECK(hit.material == one.material);
            CHECK(hit.medium_before == one.medium_before);
            CHECK(hit.medium_after == one.medium_after);
            CHECK(hit.surface == one.surface);
            ++seen.crossings;
        }
        CHECK(next == expected.size());
    }
}

}  // namespace

TEST_CASE("passages: what light passes on its way is what is met from surface to surface") {
    scene::Scene scene = with_glass();
    add(scene, slab(1, -2), kGlass);
    add(scene, sphere(1.5, {0, 1, 0}), kGlass);
    add(scene, sphere(0.6, {0, 1, 0}), kStone);  // in the ball of glass
    add(scene, sphere(0.8, {3, 1, 0}), kGlass);
    add(scene, sphere(0.8, {3, 3, 0.5}), kGlass);
    add(scene, csg::boolean(csg::Op::unite, {sphere(1, {-3, 1, 0}), sphere(1, {-4, 1, 0})}),
        kGlass);
    const auto compiled = compile(scene);
    REQUIRE(compiled.has_value());
    Tracer tracer(*compiled);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    Seen seen;
    for (int k = 0; k < 3000; ++k) {
        std::vector<RayQuery> queries(kRays);
        const Vec3 eye{4 * uniform(random), -8, 2 * uniform(random)};
        for (RayQuery& q : queries) {
            q.ray = {eye, {0.4 * uniform(random), 1, 0.2 * uniform(random)}};
            Hit hit;
            // From a surface, and also from within glass, towards a lamp near by.
            if (k % 2 != 0 && tracer.first_hit(q, hit)) {
                q.ray = {hit.point, {uniform(random), uniform(random), uniform(random)}};
                q.on_surface = true;
                q.start_error = hit.point_error;
            }
            q.t_max = 9 + 8 * uniform(random);
        }
        compare(tracer, queries, seen);
    }
    CHECK(seen.blocked > 200);
    CHECK(seen.free > 5000);
    CHECK(seen.crossings > 10000);
    // Only where the union of glass is met.
    CHECK(seen.left_over < 1000 * kRays);
}

TEST_CASE("passages: parts of glass that touch or overlap are left over or right") {
    for (const double gap : {0.0, 1e-15, -1e-15, 1e-9, -1e-9, -0.3}) {
        scene::Scene scene = with_glass();
        add(scene, slab(1, 0), kGlass);
        add(scene, slab(1, 1 + gap), kGlass);
        add(scene, slab(1, 6), kStone);
        const auto compiled = compile(scene);
        REQUIRE(compiled.has_value());
        Tracer tracer(*compiled);
        Seen seen;
        for (int k = -20; k <= 20; ++k) {
            std::vector<RayQuery> queries(kRays);
            for (std::size_t i = 0; i < kRays; ++i) {
                queries[i].ray = {{0.1 * k, -3, 0}, {0.01 * static_cast<double>(i), 1, 0.1}};
                queries[i].t_max = i % 2 == 0 ? 8.0 : 20.0;
            }
            compare(tracer, queries, seen);
        }
        CHECK(seen.blocked == 41 * kHalf);
        if (gap == 1e-9) CHECK(seen.free == 41 * kHalf);
        CHECK(seen.free + seen.left_over == 41 * kHalf);
    }
}

TEST_CASE("passages: more than a packet holds is left over") {
    scene::Scene scene = with_glass();
    for (int i = 0; i < 20; ++i) add(scene, slab(0.5, i), kGlass);
    const auto compiled = compile(scene);
    REQUIRE(compiled.has_value());
    Tracer tracer(*compiled);
    Seen seen;
    std::vector<RayQuery> queries(kRays);
    for (std::size_t i = 0; i < kRays; ++i) {
        queries[i].ray = {{0, -1, 0}, {0, 1, 0.01 * static_cast<double>(i)}};
        queries[i].t_max = i < kHalf ? 5.25 : 30.0;  // at the end within the fifth
    }
    compare(tracer, queries, seen);
    CHECK(seen.left_over == kHalf);
    CHECK(seen.free == kHalf);
    CHECK(seen.crossings == kHalf * 9);
}

}  // namespace raymo::trace
