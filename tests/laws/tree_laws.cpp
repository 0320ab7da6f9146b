// Random Booleans with many coincident faces, judged point by point; and packets against single rays.
#include <cstdio>
#include <cstring>
#include <numbers>

#include "raymo/trace/packet.hpp"
#include "tests/laws/rays.hpp"

namespace raymo::laws {
namespace {

ModelPtr any_tree(Random& random) { return grid_tree(random, 1 + random.below(4)); }

template <ModelPtr (*make)(Random&)>
void rays_and_points(std::uint64_t rays, Random& random, Tally& tally) {
    constexpr std::uint64_t kRaysEach = 12;
    while (tally.rays < rays) {
        Traced traced(make(random));
        if (!traced.ok()) {
            tally.exception(traced.error() + ": " + text(*traced.model()));
            continue;
        }
        for (std::uint64_t i = 0; i < kRaysEach; ++i) {
            const AimedRay aimed = any_ray(random, kGridSize, 0.5);
            judge_ray(traced, *traced.model(), aimed.ray, kGridSize, aimed.rounding, random, tally);
        }
    }
}

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }
bool same_bits(Vec3 a, Vec3 b) {
    return same_bits(a.x, b.x) && same_bits(a.y, b.y) && same_bits(a.z, b.z);
}

bool same_hit(const trace::Hit& a, const trace::Hit& b) {
    return same_bits(a.t, b.t) && same_bits(a.error, b.error) && same_bits(a.point, b.point) &&
           same_bits(a.point_error, b.point_error) && same_bits(a.normal, b.normal) &&
           a.entering == b.entering && a.part == b.part && a.material == b.material &&
           a.medium_before == b.medium_before && a.medium_after == b.medium_after &&
           a.surface == b.surface;
}

/// The same surface, to within the errors of both: a ray that was moved aside meets it a little beside.
bool same_place(const trace::Hit& a, const trace::Hit& b) {
    return std::fabs(a.t - b.t) <= a.error + b.error && a.surface == b.surface &&
           a.entering == b.entering && a.part == b.part && a.material == b.material;
}

/// Whether some of the rays beside this one, farther away than any ray is moved, meet nothing up to a hit of it and somewhat
/// farther: it grazes what it hits.
bool is_grazing(trace::Tracer& tracer, trace::RayQuery query, const trace::Hit& hit) {
    constexpr double kBeside = 1e-8 * kGridSize;
    const Vec3 origin = query.ray.origin;
    Vec3 u, v;
    make_frame(unit(query.ray.direction), u, v);
    query.t_max = hit.t + 1e-2 * kGridSize / norm(query.ray.direction);
    for (int i = 0; i < 8; ++i) {
        const double angle = i * std::numbers::pi / 4;
        query.ray.origin = origin + (u * std::cos(angle) + v * std::sin(angle)) * kBeside;
        trace::Hit other;
        if (!tracer.first_hit(query, other)) return true;
    }
    return false;
}

void packets(std::uint64_t rays, Random& random, Tally& tally) {
    std::uint64_t moved_aside = 0;
    constexpr std::size_t kMost = trace::kRays;
    while (tally.rays < rays) {
        Traced traced(random.chance(0.5) ? drilled(random)
                                         : grid_tree(random, 1 + random.below(5)));
        if (!traced.ok()) {
            tally.exception(traced.error() + ": " + text(*traced.model()));
            continue;
        }
        for (int packet = 0; packet < 40; ++packet) {
            // Close together, as pixels are, or not at all.
            const std::size_t count =
                random.chance(0.7) ? kMost
                                   : 1 + static_cast<std::size_t>(random.below(trace::kRays));
            const AimedRay first = any_ray(random, kGridSize, 0.5);
            const bool coherent = random.chance(0.6);
            const bool from_surface = random.chance(0.4);
            const Vec3 onwards = random.direction();
            std::vector<trace::RayQuery> queries(count);
            for (trace::RayQuery& query : queries) {
                query.ray = coherent ? first.ray : any_ray(random, kGridSize, 0.5).ray;
                if (coherent)
                    query.ray.direction += random.in_cube(0.01 * norm(query.ray.direction));
                if (random.chance(0.3)) query.t_max = random.uniform(0, 10);
                trace::Hit hit;
                if (!from_surface || !traced.tracer().first_hit(query, hit)) continue;
                query.ray = {hit.point,
                             coherent ? onwards + random.in_cube(0.01) : random.direction()};
                query.on_surface = true;
                query.start_error = hit.point_error;
            }
            trace::RayPacket packet_of_rays;
            for (std::size_t i = 0; i < kMost; ++i)
                packet_of_rays.set(static_cast<int>(i), queries[std::min(i, count - 1)]);
            // Some lanes are left out, in the middle too.
            trace::LaneBits lanes = trace::first_lanes(count);
            if (random.chance(0.3)) lanes &= static_cast<trace::LaneBits>(random.bits());
            if (lanes == 0) continue;
            trace::HitPacket together;
            const trace::LaneBits found =
                traced.tracer().first_hits(packet_of_rays, lanes, together);
            const trace::LaneBits blocked = traced.tracer().occluded(packet_of_rays, lanes);
            if (((found | blocked) & ~lanes) != 0)
                tally.exception("an answer that nobody asked for");
            for (std::size_t i = 0; i < count; ++i) {
                const auto answered = [i](trace::LaneBits bits) { return (bits >> i & 1U) != 0; };
                if (!answered(lanes)) continue;
                trace::Hit alone;
                const bool hit = traced.tracer().first_hit(queries[i], alone);
                ++tally.rays;
                ++tally.samples;
                const trace::Hit other = together.hit(static_cast<int>(i));
                const bool is_blocked = traced.tracer().occluded(queries[i]);
                if (hit && answered(found) && !same_hit(alone, other) && same_place(alone, other)) {
                    ++moved_aside;
                } else if ((hit != answered(found) || is_blocked != answered(blocked)) &&
                           (hit || answered(found)) &&
                           is_grazing(traced.tracer(), queries[i], hit ? alone : other)) {
                    ++moved_aside;
                    continue;
                } else if (hit != answered(found) || (hit && !same_hit(alone, other))) {
                    char what[200];
                    std::snprintf(what, sizeof what,
                                  "first_hits differs from first_hit: %.17g leaf %u face %d, "
                                  "alone %.17g leaf %u face %d; from %g on, t_max %g: ",
                                  answered(found) ? other.t : -1.0, other.surface.leaf,
                                  other.surface.face, hit ? alone.t : -1.0, alone.surface.leaf,
                                  alone.surface.face, queries[i].start_error, queries[i].t_max);
                    tally.exception(what + describe(*traced.model(), queries[i].ray));
                }
                if (is_blocked != answered(blocked)) {
                    tally.exception("occluded: packet differs from single: " +
                                    describe(*traced.model(), queries[i].ray));
                }
            }
        }
    }
    if (moved_aside * 100000 > tally.rays + 100000)
        tally.exception("more than one packet's ray in 10^5 differs from the single ray");
}

void from_far_away(std::uint64_t rays, Random& random, Tally& tally) {
    while (tally.rays < rays) {
        Traced traced(grid_tree(random, 1 + random.below(3)));
        if (!traced.ok()) {
            tally.exception(traced.error() + ": " + text(*traced.model()));
            continue;
        }
        for (int i = 0; i < 12; ++i) {
            AimedRay aimed = any_ray(random, kGridSize, 0.5);
            const double distance = std::pow(10.0, random.uniform(3, 12));
            aimed.ray.origin -= aimed.ray.direction * (distance / norm(aimed.ray.direction));
            judge_ray(traced, *traced.model(), aimed.ray, kGridSize, aimed.rounding, random, tally);
        }
    }
}

}  // namespace

void add_tree_laws(std::vector<Law>& laws) {
    laws.push_back(
        {"trees: rays and points agree (12 rays a tree)", 1200000, rays_and_points<any_tree>});
    laws.push_back(
        {"drilled: rays and points agree (12 rays a solid)", 400000, rays_and_points<drilled>});
    laws.push_back({"trees: rays from up to 1e12 away", 200000, from_far_away});
    laws.push_back({"packets: equal single rays bit for bit", 2000000, packets});
}

}  // namespace raymo::laws
