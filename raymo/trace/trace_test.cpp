#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "raymo/csg/model.hpp"
#include "raymo/curves/samples.hpp"
#include "raymo/trace/packet.hpp"
#include "raymo/trace/test_ends.hpp"

namespace raymo::trace {
namespace {

using csg::Op;
using csg::Solid;

using test::check_ends;
using test::ends;
using test::primitive;
using test::scene_of;
Solid block(Vec3 size) { return primitive("block", {size, false}); }
Solid sphere(double r) { return primitive("sphere", {r}); }
Solid cylinder(double r, double h) { return primitive("cylinder", {r, h, false}); }
Solid moved(const Solid& s, Vec3 by) { return csg::transform(s, translation(by)).value(); }
Solid turned(const Solid& s, Vec3 axis, double degrees) {
    return csg::transform(s, rotation(unit(axis), degrees)).value();
}
RayPacket packed(const std::vector<RayQuery>& queries) {
    RayPacket rays;
    for (std::size_t i = 0; i < kRays; ++i) rays.set(static_cast<int>(i), queries[i]);
    return rays;
}
Solid join(Solid a, Solid b) { return csg::boolean(Op::unite, {std::move(a), std::move(b)}); }
Solid cut(Solid a, Solid b) { return csg::boolean(Op::difference, {std::move(a), std::move(b)}); }
Solid meet(Solid a, Solid b) {
    return csg::boolean(Op::intersection, {std::move(a), std::move(b)});
}

}  // namespace

TEST_CASE("trace: a drilled bar leaves two pieces along the bar") {
    const Solid bar = block({10, 2, 2});
    const Solid drill = moved(cylinder(1.0, 4.0), {5, 1, -1});
    check_ends(ends(cut(bar, drill), {{-5, 1, 1}, {1, 0, 0}}), {5, 9, 11, 15});
}

TEST_CASE("trace: faces that coincide leave nothing behind") {
    const Solid a = block({10, 10, 10});
    const Solid b = moved(a, {10, 0, 0});
    const Ray along{{-5, 5, 5}, {1, 0, 0}};
    check_ends(ends(join(a, b), along), {5, 25});
    check_ends(ends(cut(a, a), along), {});
    check_ends(ends(meet(a, b), along), {});
    check_ends(ends(meet(a, a), along), {5, 15});
    check_ends(ends(cut(a, b), along), {5, 15});
    for (const double degrees : {30.0, 45.0, 123.456}) {
        const Ray oblique{{-50, -40, -30}, {0.71, 0.52, 0.41}};
        const auto whole = ends(turned(block({20, 10, 10}), {1, 2, 3}, degrees), oblique);
        check_ends(ends(turned(join(a, b), {1, 2, 3}, degrees), oblique), whole);
        check_ends(
            ends(join(turned(a, {1, 2, 3}, degrees), turned(b, {1, 2, 3}, degrees)), oblique),
            whole);
        check_ends(ends(turned(meet(a, b), {1, 2, 3}, degrees), oblique), {});
    }
}

TEST_CASE("trace: a ray in a shared face meets the union whole and the intersection not at all") {
    const Solid a = block({10, 10, 10});
    const Solid b = moved(a, {0, 0, 10});
    const Ray in_face{{-5, 5, 10}, {1, 0, 0}};
    check_ends(ends(join(a, b), in_face), {5, 15});
    check_ends(ends(meet(a, b), in_face), {});
    const Ray skew{{-5, -3, 10}, {1, 0.8, 0}};
    CHECK(ends(join(turned(a, {0, 1, 0}, 0.0), b), skew).size() == 2);
}

TEST_CASE("trace: a ray that glances off where two cutters abut ends at them") {
    // A shallow step cut by two blocks side by side; the rays rise nearly in the face that these share.
    const double depth = 1e-6;
    const auto step = [&](double x) { return moved(block({1, 2, 2}), {x, -1, -depth}); };
    const auto base = moved(block({4, 4, 2}), {-2, -2, -2});
    const Affine map = rotation(unit({1, 2, 3}), 40);
    const auto place = [&](const Solid& s) { return csg::transform(s, map).value(); };
    const Solid solid =
        csg::boolean(Op::difference, {place(base), place(step(-1)), place(step(0))});
    std::mt19937_64 random(6);
    std::uniform_real_distribution<double> any(-1, 1);
    for (int i = 0; i < 4000; ++i) {
        const double slope = std::pow(10.0, -10.5 + 1.5 * any(random));
        const Vec3 through{1e-15 * any(random), 0.9 * any(random), 1e-5 * any(random)};
        const Vec3 d{any(random) < 0 ? slope : -slope, 0.5 * any(random), 1};
        const auto found = ends(solid, {map(through - d), map.linear * d});
        REQUIRE(found.size() == 2);
        CHECK(std::fabs(through.z - d.z + found[1] * d.z + depth) < 1e-9);
    }
}

TEST_CASE("trace: a distant eye costs no accuracy") {
    check_ends(ends(sphere(1.0), {{-1e12, 0.6, 0}, {1, 0, 0}}), {1e12 - 0.8, 1e12 + 0.8});
    const auto far = ends(cut(sphere(1.0), sphere(0.5)), {{-1e12, 0, 0}, {1, 0, 0}});
    CHECK(far.size() == 4);
}

TEST_CASE("trace: a ray that starts on a surface does not meet it again") {
    const auto compiled = compile(scene_of({sphere(1.0), moved(block({8, 8, 1}), {-4, -4, -2})}));
    REQUIRE(compiled.has_value());
    Tracer tracer(*compiled);
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> uniform(-1, 1);
    int met = 0;
    for (int i = 0; i < 20000; ++i) {
        RayQuery query;
        query.ray = {{0, 0, 5}, Vec3{uniform(random), uniform(random), 0} * 0.2 + Vec3{0, 0, -1}};
        Hit hit;
        if (!tracer.first_hit(query, hit)) continue;
        RayQuery next;
        next.ray = {hit.point, Vec3{uniform(random), uniform(random), uniform(random)}};
        next.on_surface = true;
        next.start_error = hit.point_error;
        if (hit.part != 0 || dot(next.ray.direction, hit.normal) <= 0.0) continue;
        Hit second;
        if (tracer.first_hit(next, second)) {
            CHECK(second.part == 1);  // the sphere is convex: only the block is left to meet
            ++met;
        }
    }
    CHECK(met > 300);
}

TEST_CASE("trace: packets and single rays give the same bits") {
    std::vector<Solid> parts;
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int i = 0; i < 60; ++i) {
        const Vec3 at{uniform(random) * 10, uniform(random) * 10, uniform(random) * 10};
        const Vec3 axis{uniform(random), uniform(random), uniform(random) + 0.1};
        Solid s;
        switch (i % 5) {
            case 0:
                s = sphere(1.0);
                break;
            case 1:
                s = block({1, 2, 1.5});
                break;
            case 2:
                s = cylinder(0.7, 2.0);
                break;
            case 3:
                s = primitive("cone", {1.0, 0.3, 2.0});
                break;
            default:
                s = primitive("torus", {1.0, 0.3});
                break;
        }
        s = moved(turned(s, axis, 360 * uniform(random)), at);
        parts.push_back(i % 3 == 0 ? cut(s, moved(sphere(0.8), at)) : s);
    }
    const auto compiled = compile(scene_of(parts));
    REQUIRE(compiled.has_value());
    Tracer tracer(*compiled);
    int hits = 0;
    for (int k = 0; k < 2000; ++k) {
        std::vector<RayQuery> queries(kRays);
        const Vec3 eye{-20, uniform(random) * 10, uniform(random) * 10};
        const Vec3 aim{10, uniform(random) * 10, uniform(random) * 10};
        for (RayQuery& q : queries) {
            q.ray = {eye, aim - eye + Vec3{0, uniform(random), uniform(random)}};
        }
        const RayPacket rays = packed(queries);
        HitPacket hits_together;
        const LaneBits all_found = tracer.first_hits(rays, kAllLanes, hits_together);
        CHECK(tracer.occluded(rays, kAllLanes) == all_found);
        for (std::size_t i = 0; i < kRays; ++i) {
            Hit alone;
            const bool found = (all_found >> i & 1U) != 0;
            REQUIRE(tracer.first_hit(queries[i], alone) == found);
            CHECK(tracer.occluded(queries[i]) == found);
            if (!found) continue;
            ++hits;
            const Hit together = hits_together.hit(static_cast<int>(i));
            CHECK(alone.t == together.t);
            CHECK(alone.error == together.error);
            CHECK(alone.normal == together.normal);
            CHECK(alone.surface == together.surface);
            CHECK(dot(alone.normal, queries[i].ray.direction) <= 0.0);
        }
    }
    CHECK(hits > 2000);
}

/// Whether each ray of a bundle of parallel rays meets something, in packets and alone, which must be the same.
int count_met(const Solid& solid, Vec3 from, Vec3 direction, Vec3 spread) {
    scene::Scene scene = scene_of({solid});
    scene.materials.resize(1);
    const auto compiled = compile(scene);
    REQUIRE(compiled.has_value());
    Tracer tracer(*compiled);
    int met = 0;
    for (int row = 0; row < 8; ++row) {
        std::vector<RayQuery> queries(kRays);
        for (std::size_t i = 0; i < kRays; ++i) {
            queries[i].ray = {from + spread * ((2.0 * static_cast<double>(i) + 1.0) / kRays - 1.0) +
                                  cross(unit(direction), spread) * ((row - 3.5) / 4.0),
                              direction};
        }
        HitPacket hits;
        const LaneBits found = tracer.first_hits(packed(queries), kAllLanes, hits);
        for (std::size_t i = 0; i < kRays; ++i) {
            Hit alone;
            const bool hit = tracer.first_hit(queries[i], alone);
            CHECK(hit == ((found >> i & 1U) != 0));
            if (!hit) continue;
            ++met;
            CHECK(alone.t == hits.hit(static_cast<int>(i)).t);
            CHECK(alone.surface == hits.hit(static_cast<int>(i)).surface);
        }
    }
    return met;
}

TEST_CASE("trace: what products in a union take away counts behind a shared cutter, too") {
    const Solid far = meet(moved(sphere(1), {0, 30, 0}), moved(sphere(1), {0.5, 30, 0}));
    const Solid bar = cut(block({10, 10, 10}), moved(block({40, 20, 20}), {2, -5, -5}));
    const Solid all = csg::paint(cut(join(far, bar), moved(block({4, 20, 20}), {-1, -5, -5})), 0);
    CHECK(count_met(all, {-10, 5, 5}, {1, 0, 0}, {0, 2, 0}) == 0);
}

TEST_CASE("trace: packets go through products of solids that are met several times") {
    const Solid ring = primitive("torus", {3.0, 1.0});
    const Solid tyre = primitive("torus", {3.2, 0.9});
    const Solid product =
        cut(cut(meet(ring, tyre), cylinder(3.0, 5.0)), moved(sphere(1), {3, 0, 0}));
    CHECK(count_met(product, {-10, 0.1, 0.2}, {1, 0.02, 0.01}, {0, 3, 0}) > 5);
    // Holes that are as deep as the plate: faces coincide at both ends.
    const Solid plate = cut(cut(block({10, 10, 1}), moved(cylinder(1, 1), {3, 3, 0})),
                            moved(block({4, 4, 1}), {5, 5, 0}));
    CHECK(count_met(plate, {3, 3, 9}, {0, 0, -1}, {0.5, 0, 0}) == 0);
    CHECK(count_met(plate, {5, 5, 9}, {0, 0, -1}, {4, 0, 0}) > 10);
}

TEST_CASE("trace: from within glass, packets and single rays give the same bits") {
    scene::Scene scene;
    scene.materials.resize(2);
    scene.materials.edit(0).transmission = 0.9;
    scene.parts.push_back({"slab", csg::paint(moved(block({10, 1, 10}), {-5, -2, -5}), 0), {}});
    scene.parts.push_back({"ball", csg::paint(moved(sphere(1.5), {0, 1, 0}), 0), {}});
    scene.parts.push_back({"core", csg::paint(moved(sphere(0.6), {0, 1, 0}), 1), {}});
    scene.parts.push_back(
        {"pair", join(moved(sphere(1.0), {3, 1, 0}), moved(sphere(1.0), {4, 1, 0})), {}});
    const auto compiled = compile(scene);
    REQUIRE(compiled.has_value());
    Tracer tracer(*compiled);
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    int exits = 0;
    for (int k = 0; k < 4000; ++k) {
        std::vector<RayQuery> queries(kRays);
        for (RayQuery& q : queries) {
            RayQuery eye;
            eye.ray = {{uniform(random), -8, uniform(random)},
                       {0.3 * uniform(random), 1, 0.3 * uniform(random)}};
            q = eye;
            Hit hit;
            if (k % 2 == 0 || !tracer.first_hit(eye, hit)) continue;
            q.ray = {hit.point, {uniform(random), uniform(random), uniform(random)}};
            q.on_surface = true;
            q.start_error = hit.point_error;
        }
        const RayPacket rays = packed(queries);
        HitPacket hits_together;
        const LaneBits all_found = tracer.first_hits(rays, kAllLanes, hits_together);
        for (std::size_t i = 0; i < kRays; ++i) {
            Hit alone;
            const bool found = (all_found >> i & 1U) != 0;
            REQUIRE(tracer.first_hit(queries[i], alone) == found);
            if (!found) continue;
            const Hit together = hits_together.hit(static_cast<int>(i));
            exits += alone.entering ? 0 : 1;
            CHECK(alone.t == together.t);
            CHECK(alone.entering == together.entering);
            CHECK(alone.part == together.part);
            CHECK(alone.medium_before == together.medium_before);
            CHECK(alone.medium_after == together.medium_after);
            CHECK(alone.normal == together.normal);
        }
    }
    CHECK(exits > 1000);
}

TEST_CASE("trace: told which leaf they start in, packets give the same bits; told wrongly too") {
    scene::Scene scene;
    scene.materials.resize(1);
    scene.materials.edit(0).transmission = 0.9;
    // The pane and the ring stand apart, though the ring goes round the ball; the ball and the block overlap.
    scene.parts.push_back({"pane", csg::paint(moved(block({10, 1, 10}), {-5, -4, -5}), 0), {}});
    scene.parts.push_back({"ring", csg::paint(primitive("torus", {2.0, 0.5}), 0), {}});
    scene.parts.push_back({"ball", csg::paint(moved(sphere(0.8), {0, 4, 0}), 0), {}});
    scene.parts.push_back({"block", csg::paint(moved(block({1, 1, 1}), {0, 4, 0}), 0), {}});
    const auto compiled = compile(scene);
    REQUIRE(compiled.has_value());
    Tracer tracer(*compiled);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    int within = 0;
    for (int k = 0; k < 4000; ++k) {
        std::vector<RayQuery> queries(kRays);
        std::uint32_t leaf = SurfaceId::kNone;
        for (RayQuery& q : queries) {
            RayQuery eye;
            const double y = std::array{-8.0, 0.0, 8.0}[static_cast<std::size_t>(k % 3)];
            eye.ray = {{3 * uniform(random), y, 3 * uniform(random)},
                       {uniform(random), uniform(random), uniform(random)}};
            q = eye;
            Hit hit;
            if (!tracer.first_hit(eye, hit)) continue;
            // Into the leaf that was met, but for a few.
            Vec3 d{uniform(random), uniform(random), uniform(random)};
            const bool inwards = dot(d, hit.normal) < 0.0;
            if (!inwards && k % 5 != 0) d = -d;
            q.ray = {hit.point, d};
            q.on_surface = true;
            q.start_error = hit.point_error;
            leaf = hit.surface.leaf;
        }
        RayPacket rays = packed(queries);
        HitPacket plain;
        const LaneBits found = tracer.first_hits(rays, kAllLanes, plain);
        rays.within = leaf;
        HitPacket hinted;
        REQUIRE(tracer.first_hits(rays, kAllLanes, hinted) == found);
        for (LaneBits rest = found; rest != 0; rest &= rest - 1) {
            const int i = lowest_lane(rest);
            const Hit a = plain.hit(i);
            const Hit b = hinted.hit(i);
            CHECK(a.t == b.t);
            CHECK(a.error == b.error);
            CHECK(a.normal == b.normal);
            CHECK(a.point == b.point);
            CHECK(a.surface == b.surface);
            CHECK(a.medium_before == b.medium_before);
            CHECK(a.medium_after == b.medium_after);
            within += b.entering ? 0 : 1;
        }
    }
    CHECK(within > 1000);
}

TEST_CASE("trace: from within parts that overlap the media are those that all of the line tells") {
    scene::Scene scene;
    scene.materials.resize(3);
    for (std::size_t i = 0; i < 3; ++i) scene.materials.edit(i).transmission = 0.9;
    const Solid solids[] = {primitive("prism", {curves::sample_disc(), 2.0}),
                            primitive("revolve", {curves::sample_half_disc(), 360.0}),
                            primitive("prism", {curves::sample_rectangle(), 2.0})};
    for (csg::MaterialId m = 0; m < 3; ++m) {
        const Vec3 middle = csg::bounds(solids[m]).centre();
        const Vec3 by{0.2 * static_cast<double>(m), 0.1, 0.15 * static_cast<double>(m)};
        scene.parts.push_back({"part", csg::paint(moved(solids[m], by - middle), m), {}});
    }
    const auto compiled = compile(scene);
    REQUIRE(compiled.has_value());
    Tracer tracer(*compiled);
    std::mt19937_64 random(9);
    std::uniform_real_distribution<double> uniform(-1, 1);
    int overlaps = 0;
    for (int k = 0; k < 2000; ++k) {
        const Ray ray{{0.5 * uniform(random), 0.5 * uniform(random), 0.5 * uniform(random)},
                      {uniform(random), uniform(random), uniform(random)}};
        std::vector<std::vector<PartSpan>> by_part;
        tracer.spans(ray, by_part);
        std::vector<Hit> truth;
        for (const auto& spans : by_part) {
            for (const PartSpan& span : spans) {
                truth.push_back(span.enter);
                truth.push_back(span.exit);
            }
        }
        std::sort(truth.begin(), truth.end(), [](const Hit& a, const Hit& b) { return a.t < b.t; });
        for (std::size_t i = 1; i < truth.size(); ++i) {
            if (!(truth[i].t - truth[i - 1].t > 1e-3)) continue;
            RayQuery query;
            query.ray = {ray.origin + ray.direction * (0.5 * (truth[i].t + truth[i - 1].t)),
                         ray.direction};
            Hit hit;
            REQUIRE(tracer.first_hit(query, hit));
            CHECK(hit.part == truth[i].part);
            CHECK(hit.medium_before == truth[i].medium_before);
            CHECK(hit.medium_after == truth[i].medium_after);
            HitPacket together;
            REQUIRE(tracer.first_hits(packed(std::vector<RayQuery>(kRays, query)), kAllLanes,
                                      together) == kAllLanes);
            CHECK(together.medium_before[3] == truth[i].medium_before);
            overlaps += hit.medium_before != Hit::kAir && hit.medium_after != Hit::kAir ? 1 : 0;
        }
    }
    CHECK(overlaps > 1000);
}

TEST_CASE("trace: a solid without end is an error that names it; cut to size it is fine") {
    const Solid half = primitive("halfspace", {Vec3{0, 0, 1}, 0.0});
    const auto open = compile(scene_of({half}));
    REQUIRE(!open.has_value());
    CHECK(open.error().code == ErrorCode::unbounded);
    CHECK(open.error().message.find("halfspace") != std::string::npos);
    check_ends(ends(meet(sphere(2.0), half), {{0, 0, 5}, {0, 0, -1}}), {5, 7});
    check_ends(ends(cut(sphere(2.0), half), {{0, 0, 5}, {0, 0, -1}}), {3, 5});
}

TEST_CASE("trace: shared solids become instances that answer like copies") {
    // 2 * 128^3 leaves: far more than are flattened.
    Solid s = join(sphere(0.3), moved(block({0.2, 0.2, 0.2}), {0.3, 0, 0}));
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<Solid> row;
        for (int i = 0; i < 128; ++i) {
            Vec3 by;
            by[axis] = i;
            row.push_back(moved(s, by));
        }
        s = csg::boolean(Op::unite, row);
    }
    const auto compiled = compile(scene_of({s}));
    REQUIRE(compiled.has_value());
    CHECK(compiled->leaf_count() == 2.0 * 128 * 128 * 128);
    CHECK(compiled->stored_leaves() < 2000);
    Tracer tracer(*compiled);
    std::vector<std::vector<PartSpan>> spans;
    tracer.spans({{-1, 5, 7}, {1, 0, 0}}, spans);
    REQUIRE(spans[0].size() == 128);
    for (std::size_t i = 0; i < 128; ++i) {
        CHECK(spans[0][i].enter.t == doctest::Approx(0.7 + static_cast<double>(i)).epsilon(1e-12));
    }
    RayQuery query;
    query.ray = {{-1, 5, 7}, {1, 0, 0}};
    Hit hit;
    REQUIRE(tracer.first_hit(query, hit));
    CHECK(hit.t == doctest::Approx(0.7).epsilon(1e-12));
    CHECK(tracer.leaf_info(hit.surface).primitive == "sphere");
    CHECK(hit.normal.x == doctest::Approx(-1.0));
}

TEST_CASE("trace: instances in instances keep their surfaces") {
    Solid s = sphere(1.0);
    for (int i = 0; i < 30; ++i) s = join(s, moved(s, {std::ldexp(3.0, i), 0, 0}));
    const auto compiled = compile(scene_of({s}));
    REQUIRE(compiled.has_value());
    Tracer tracer(*compiled);
    for (const double k : {0.0, 1.0, 12345.0, 1048576.0 * 512.0}) {
        RayQuery query;
        query.ray = {{3.0 * k, -10, 0}, {0, 1, 0}};
        Hit hit;
        REQUIRE(tracer.first_hit(query, hit));
        CHECK(hit.t == doctest::Approx(9.0).epsilon(1e-6));
    }
}

TEST_CASE("trace: a cutter where nothing is to be cut does not show") {
    scene::Scene scene;
    scene.materials.resize(2);
    const Solid cap =
        cut(moved(sphere(10), {0, 0, 5}), csg::paint(moved(block({18, 18, 15}), {-9, -9, 0}), 0));
    const Solid base = csg::paint(moved(block({40, 40, 5}), {-20, -20, -5}), 1);
    scene.parts.push_back({"p", join(cap, base), {}});
    const auto compiled = compile(scene);
    REQUIRE(compiled.has_value());
    Tracer tracer(*compiled);
    std::vector<std::vector<PartSpan>> spans;
    tracer.spans({{8.5, 8.5, 50}, {0, 0, -1}}, spans);
    REQUIRE(!spans[0].empty());
    CHECK(spans[0].back().enter.material == 1);
    CHECK(spans[0].back().enter.t == doctest::Approx(50.0));
}

TEST_CASE("trace: a cutter borrows only from what it cuts") {
    scene::Scene scene;
    scene.materials.resize(1);
    const Solid red = meet(csg::paint(moved(block({30, 30, 2}), {-15, -15, -1}), 0),
                           primitive("torus", {10.0, 1.0}));
    const Solid pocket =
        cut(moved(block({4, 4, 2}), {-2, -2, -1}), moved(block({2, 2, 2}), {-1, -1, 0}));
    scene.parts.push_back({"p", join(red, pocket), {}});
    const auto compiled = compile(scene);
    REQUIRE(compiled.has_value());
    Tracer tracer(*compiled);
    std::vector<std::vector<PartSpan>> spans;
    tracer.spans({{0.3, 0.2, 50}, {0, 0, -1}}, spans);
    REQUIRE(spans[0].size() == 1);
    CHECK(spans[0][0].enter.t == doctest::Approx(50.0));
    CHECK(spans[0][0].enter.material == csg::kNoMaterial);
}

TEST_CASE("trace: maps that stretch along oblique axes keep coincident faces together") {
    const auto body = [&](bool detour) {
        Solid s =
            turned(turned(moved(block({10, 10, 10}), {-5, -5, -5}), {1, 0, 0}, 30), {0, 1, 0}, 40);
        if (detour) s = turned(turned(s, {0, 0, 1}, 17), {0, 0, 1}, -17);
        s = csg::transform(s, scaling({1, 1e-5, 1e-5})).value();
        return turned(turned(s, {1, 0, 0}, 20), {0, 1, 0}, 50);
    };
    const auto compiled = compile(scene_of({cut(body(false), body(true))}));
    REQUIRE(compiled.has_value());
    Tracer tracer(*compiled);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> uniform(-5, 5);
    std::vector<std::vector<PartSpan>> spans;
    for (int i = 0; i < 2000; ++i) {
        const Vec3 aim{uniform(random) * 0.5, 0, uniform(random) * -0.5};
        tracer.spans({{uniform(random), uniform(random), 50}, aim - Vec3{0, 0, 50}}, spans);
        CHECK(spans[0].empty());
    }
}

TEST_CASE("trace: one solid written in two ways cancels, at the limb too") {
    const auto there_and_back = [](const Solid& s) {
        return moved(moved(s, {100, 100, 100}), {-100, -100, -100});
    };
    for (const Solid& s : {sphere(1.0), moved(cylinder(1.0, 2.0), {0, 0, -1}),
                           turned(block({1, 2, 3}), {1, 2, 3}, 40)}) {
        const auto compiled = compile(
            scene_of({cut(s, there_and_back(s)), moved(cut(there_and_back(s), s), {0, 0, 9})}));
        REQUIRE(compiled.has_value());
        Tracer tracer(*compiled);
        std::vector<std::vector<PartSpan>> spans;
        for (int k = 0; k < 4000; ++k) {
            tracer.spans({{-5, 1.0 - 1e-16 * k * k, 0}, {1, 0, 0}}, spans);
            CHECK(spans[0].empty());
            tracer.spans({{-5, 1.0 - 1e-16 * k * k, 9}, {1, 0, 0}}, spans);
            CHECK(spans[1].empty());
        }
    }
}

TEST_CASE("trace: transformations that together leave no size are an error") {
    const Solid thin = csg::transform(block({10, 10, 10}), scaling({1, 1, 1e-60})).value();
    const auto gone = compile(scene_of({csg::transform(thin, scaling({1, 1, 1e-60})).value()}));
    REQUIRE(!gone.has_value());
    CHECK(gone.error().code == ErrorCode::singular);
}

TEST_CASE("trace: a cutter without material shows what it cuts") {
    scene::Scene scene;
    scene.materials.resize(3);
    const Solid bar = csg::boolean(Op::unite, {csg::paint(block({5, 2, 2}), 0),
                                               csg::paint(moved(block({5, 2, 2}), {5, 0, 0}), 1)});
    const Solid drill = moved(block({10, 1, 10}), {0, 0.5, 1});
    scene.parts.push_back({"bar", cut(bar, drill), {}});
    scene.parts.push_back({"other", moved(cut(bar, csg::paint(drill, 2)), {0, 10, 0}), {}});
    const auto compiled = compile(scene);
    REQUIRE(compiled.has_value());
    Tracer tracer(*compiled);
    const auto material_at = [&](double x, double y) {
        RayQuery query;
        query.ray = {{x, y, 50}, {0, 0, -1}};
        Hit hit;
        REQUIRE(tracer.first_hit(query, hit));
        CHECK(hit.point.z == doctest::Approx(1.0));
        return hit.material;
    };
    CHECK(material_at(2, 1) == 0);
    CHECK(material_at(7, 1) == 1);
    CHECK(material_at(2, 11) == 2);
}

}  // namespace raymo::trace
