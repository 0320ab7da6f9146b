// Rays that start on a surface: the surface itself is not met again, and what comes next is right.
#include <cstdio>

#include "tests/laws/rays.hpp"

namespace raymo::laws {
namespace {

/// Bounces through a model: a ray hits, and the next starts there, outwards or inwards.
void bounces(std::uint64_t rays, Random& random, Tally& tally,
             const std::function<ModelPtr(Random&)>& make) {
    while (tally.rays < rays) {
        Traced traced(make(random));
        if (!traced.ok()) {
            tally.exception(traced.error() + ": " + text(*traced.model()));
            continue;
        }
        for (int path = 0; path < 10; ++path) {
            trace::RayQuery query;
            query.ray = any_ray(random, kGridSize, 0.5).ray;
            trace::Hit hit;
            if (!traced.tracer().first_hit(query, hit)) {
                ++tally.rays;
                continue;
            }
            for (int bounce = 0; bounce < 8; ++bounce) {
                const bool outwards = random.chance(0.5);
                Vec3 d = random.direction();
                if ((dot(d, hit.normal) > 0.0) != outwards) d = -d;
                // Sometimes nearly along the surface.
                if (random.chance(0.2))
                    d = unit(cross(hit.normal, d) + hit.normal * dot(d, hit.normal) * 1e-3);
                const bool inside = dot(d, hit.normal) < 0.0;
                trace::RayQuery next;
                next.ray = {hit.point, d};
                next.on_surface = true;
                next.start_error = hit.point_error;
                trace::Hit met;
                const bool found = traced.tracer().first_hit(next, met);
                ++tally.rays;
                const auto fault = [&](const char* what) {
                    char start[100];
                    std::snprintf(start, sizeof start,
                                  ", from leaf %u face %d, start error %g: ", hit.surface.leaf,
                                  static_cast<int>(hit.surface.face), next.start_error);
                    tally.exception(std::string(what) + start +
                                    describe(*traced.model(), next.ray));
                };
                ++tally.samples;
                if (found && !(met.t >= 0.0)) fault("hit behind the start");
                if (!found && inside) {
                    // Certain only where points just ahead are clearly inside.
                    const RealPoint ahead{hit.point.x + 1e-6L * d.x, hit.point.y + 1e-6L * d.y,
                                          hit.point.z + 1e-6L * d.z};
                    if (classify(*traced.model(), ahead, 1e-10L) == Side::in) fault("no way out");
                }
                // Between the start and the hit nothing changes.
                const double reach = found ? met.t : 2.0 * kGridSize;
                for (const double w : {1e-4, 0.03, 0.37, 0.81, 1.0 - 1e-4}) {
                    const double t = w * reach;
                    const RealPoint p{hit.point.x + static_cast<Real>(t) * d.x,
                                      hit.point.y + static_cast<Real>(t) * d.y,
                                      hit.point.z + static_cast<Real>(t) * d.z};
                    const Side truth = classify(*traced.model(), p, 1e-9L);
                    ++tally.samples;
                    const bool said_inside = found ? !met.entering : false;
                    if (truth == Side::in && !said_inside)
                        fault("lost hit, or hit from within called entering");
                    if (truth == Side::out && said_inside)
                        fault("lost hit, or phantom hit from outside");
                }
                if (!found) break;
                hit = met;
            }
        }
    }
}

/// A convex solid's own surface is never in its own way.
void convex(std::uint64_t rays, Random& random, Tally& tally) {
    while (tally.rays < rays) {
        ModelPtr solid;
        switch (random.below(4)) {
            case 0:
                solid = sphere(random.uniform(0.5, 4));
                break;
            case 1:
                solid = block(Vec3{1, 1, 1} + random.in_cube(0.9));
                break;
            case 2:
                solid = cylinder(random.uniform(0.5, 4), random.uniform(0.5, 4));
                break;
            default:
                solid = cone(random.uniform(0.5, 4), random.uniform(0, 4), random.uniform(0.5, 4));
        }
        Traced traced(moved(solid, random_map(random, 4)));
        for (int i = 0; i < 50; ++i) {
            trace::RayQuery query;
            query.ray = general_ray(random, 8.0).ray;
            trace::Hit hit;
            ++tally.rays;
            if (!traced.tracer().first_hit(query, hit)) continue;
            Vec3 d = random.direction();
            if (dot(d, hit.normal) < 0.0) d = -d;
            trace::RayQuery next;
            next.ray = {hit.point, d};
            next.on_surface = true;
            next.start_error = hit.point_error;
            trace::Hit again;
            ++tally.samples;
            if (traced.tracer().first_hit(next, again) || traced.tracer().occluded(next)) {
                tally.exception("a convex solid shades itself: " +
                                describe(*traced.model(), next.ray));
            }
        }
    }
}

}  // namespace

void add_start_laws(std::vector<Law>& laws) {
    laws.push_back({"starts: bounces through random trees", 1000000,
                    [](std::uint64_t rays, Random& random, Tally& tally) {
                        bounces(rays, random, tally,
                                [](Random& r) { return grid_tree(r, 1 + r.below(3)); });
                    }});
    laws.push_back({"starts: bounces through single solids, mapped", 1000000,
                    [](std::uint64_t rays, Random& random, Tally& tally) {
                        bounces(rays, random, tally,
                                [](Random& r) { return moved(grid_leaf(r), random_map(r, 2)); });
                    }});
    laws.push_back({"starts: convex solids do not shade themselves", 500000, convex});
}

}  // namespace raymo::laws
