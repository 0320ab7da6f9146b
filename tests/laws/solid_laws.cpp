// Laws of single solids: their kernels, and through the whole tracer under all kinds of maps.
#include <cmath>

#include "raymo/solids/conformance.hpp"
#include "tests/laws/contour.hpp"
#include "tests/laws/rays.hpp"
#include "tests/laws/shell.hpp"

namespace raymo::laws {
namespace {

template <class P>
void add_kernel_law(std::vector<Law>& laws) {
    laws.push_back({"kernel: " + std::string(P::schema().name), 1000000,
                    [](std::uint64_t rays, Random& random, Tally& tally) {
                        const auto found = solids::conformance::judge_primitive<P>(
                            rays, static_cast<std::uint64_t>(random.below(1 << 30)));
                        tally.rays = found.rays;
                        tally.samples = found.spans;
                        tally.exceptions = found.faults;
                        if (found.faults > 0) tally.reports.push_back(found.first_fault);
                    }});
}

/// One span or two with a smooth joint; sometimes straight, of one radius, thin, or with points that coincide.
ModelPtr any_sweep(Random& random) {
    const double radius = std::ldexp(random.uniform(0.5, 1), -random.below(5));
    const bool even = random.chance(0.4);
    const auto control = [&](Vec3 p, double r) { return std::array<double, 4>{p.x, p.y, p.z, r}; };
    std::vector<std::array<double, 4>> points;
    const int spans = 1 + random.below(2);
    for (int i = 0; i < 4; ++i)
        points.push_back(control(random.in_cube(4), even ? radius : radius * random.uniform(0, 2)));
    if (random.chance(0.2)) points[1] = points[0];
    if (random.chance(0.2)) points[2] = points[1];
    if (random.chance(0.2)) {
        for (std::size_t k = 0; k < 4; ++k) {
            points[1][k] = (2 * points[0][k] + points[3][k]) / 3;
            points[2][k] = (points[0][k] + 2 * points[3][k]) / 3;
        }
    }
    if (spans == 2) {
        std::array<double, 4> next{};
        for (std::size_t k = 0; k < 4; ++k) next[k] = 2 * points[3][k] - points[2][k];
        if (next[3] < 0) next[3] = 0;
        points.push_back(points[3]);
        points.push_back(next);
        points.push_back(control(random.in_cube(4), radius));
        points.push_back(control(random.in_cube(4), radius));
    }
    std::vector<double> numbers;
    for (const auto& p : points) numbers.insert(numbers.end(), p.begin(), p.end());
    return sweep(std::move(numbers));
}

ModelPtr solid(const std::string& name, Random& random) {
    const double r = random.uniform(0.5, 5), h = random.uniform(0.5, 5);
    if (name == "block") return block({r, h, random.uniform(0.5, 5)}, random.chance(0.5));
    if (name == "sphere") return sphere(r);
    if (name == "cylinder") return cylinder(r, h, random.chance(0.5));
    if (name == "cone") return cone(r, random.chance(0.3) ? 0.0 : random.uniform(0, 5), h);
    if (name == "torus") return torus(r, random.chance(0.2) ? r : h);
    if (name == "halfspace")
        return meet(block({8, 8, 8}, true), halfspace(random.direction(), r - 2));
    if (name == "prism") return prism(random_outline(random, false), h, random.chance(0.5));
    if (name == "conic") {
        const double top = random.chance(0.3) ? 0.0 : random.uniform(0, 2);
        return conic(random_outline(random, false), h, top);
    }
    if (name == "revolve") {
        return revolve(random_outline(random, true),
                       random.chance(0.5) ? 360.0 : random.uniform(1, 359));
    }
    if (name == "sweep") return any_sweep(random);
    if (name == "smooth") return smooth(random_mesh(random));
    if (name == "patches") return patches(random_nets(random));
    solids::Matrix4 m{};
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            m[4 * i + j] = m[4 * j + i] = random.chance(0.3) ? 0.0 : random.uniform(-1, 1);
        }
    }
    m[15] = -random.uniform(0.1, 2);  // so there is an inside
    return meet(block({8, 8, 8}, true), quadric(m));
}

/// Scale 2^-20 .. 2^20 or 1e-6 .. 1e6, mirror, skew and turns; the rays are made in the solid's frame and mapped.
void mapped_rays(const std::string& name, double far, std::uint64_t rays, Random& random,
                 Tally& tally) {
    constexpr std::uint64_t kRaysEach = 250;
    while (tally.rays < rays) {
        // At 1e8 the last bit is 1e-8, so there the solids are not made smaller.
        const double scale = std::pow(10.0, random.uniform(far > 0.0 ? 0 : -6, 6));
        const Affine map = translation(random.in_cube(far)) * scaling({scale, scale, scale}) *
                           random_map(random, 4);
        Traced traced(moved(solid(name, random), map));
        if (!traced.ok()) {
            tally.exception(traced.error() + ": " + text(*traced.model()));
            return;
        }
        const double size = max_norm(map.offset) + 40.0 * scale;
        for (std::uint64_t i = 0; i < kRaysEach; ++i) {
            const AimedRay aimed = any_ray(random, 6.0, 0.5);
            const Ray ray{map(aimed.ray.origin), map.linear * aimed.ray.direction};
            judge_ray(traced, *traced.model(), ray, size, aimed.rounding, random, tally);
        }
    }
}

}  // namespace

void add_solid_laws(std::vector<Law>& laws) {
    solids::Inventory::for_each([&]<class P>() { add_kernel_law<P>(laws); });
    for (const solids::Entry& entry : solids::inventory()) {
        const std::string name(entry.schema->name);
        laws.push_back({"mapped: " + name + ", scale 1e-6..1e6, mirror, skew", 1000000,
                        [name](std::uint64_t rays, Random& random, Tally& tally) {
                            mapped_rays(name, 0.0, rays, random, tally);
                        }});
        laws.push_back({"far: " + name + ", translated by 1e8", 200000,
                        [name](std::uint64_t rays, Random& random, Tally& tally) {
                            mapped_rays(name, 1e8, rays, random, tally);
                        }});
    }
}

}  // namespace raymo::laws
