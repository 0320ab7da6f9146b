// raymo_freeform: one ray after another against solids of patches and against a torus of the same shape.
//
//     raymo_freeform [RAYS]        262144 if not given
//
// Prints, for a torus as a B-spline of n x n patches, what a ray costs in CPU time, the best of five rounds in turn, and the
// ratio. The gate: both see as many spans and the same length inside, to within what the B-spline is smaller by.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numbers>
#include <random>

#include "raymo/meshes/build.hpp"
#include "raymo/meshes/smooth.hpp"
#include "raymo/solids/freeform/freeform.hpp"
#include "raymo/solids/torus/torus.hpp"

namespace {

using namespace raymo;

double cpu_seconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// A ring whose B-spline runs about where the torus of radii 0.75 and 0.25 does.
meshes::Mesh ring(int n) {
    // A B-spline of n points on a circle of radius 1 has about the radius (2 + cos(2 pi / n)) / 3.
    const double grow = 3.0 / (2.0 + std::cos(2.0 * std::numbers::pi / n));
    std::vector<std::vector<Vec3>> rows;
    for (int i = 0; i < n; ++i) {
        std::vector<Vec3> row;
        for (int j = 0; j < n; ++j) {
            const double a = 2.0 * std::numbers::pi * i / n;
            const double b = 2.0 * std::numbers::pi * j / n;
            const double q = grow * (0.75 + grow * 0.25 * std::cos(b));
            row.push_back({q * std::cos(a), q * std::sin(a), grow * 0.25 * std::sin(b)});
        }
        rows.push_back(std::move(row));
    }
    return meshes::grid_mesh(rows, meshes::Closing::both).value();
}

struct Seen {
    std::size_t spans = 0;
    double inside = 0.0;
    double seconds = 1e300;
};

template <class Kernel>
void shoot(const Kernel& kernel, const std::vector<solids::LocalRay<double>>& rays, double unit,
           Seen& out) {
    out.spans = 0;
    out.inside = 0.0;
    const double begin = cpu_seconds();
    for (const auto& ray : rays) {
        solids::SpanList spans;
        kernel.spans(ray, spans);
        out.spans += spans.size();
        for (std::size_t i = 0; i < spans.size(); ++i)
            out.inside += (spans[i].exit.s - spans[i].enter.s) * unit;
    }
    out.seconds = std::min(out.seconds, cpu_seconds() - begin);
}

}  // namespace

int main(int argc, char** argv) {
    const long count = argc > 1 ? std::strtol(argv[1], nullptr, 10) : 262144;
    if (count < 1) {
        std::fprintf(stderr, "usage: raymo_freeform [RAYS]\n");
        return 2;
    }
    std::mt19937_64 engine(1);
    const auto uniform = [&](double lo, double hi) {
        return lo + (hi - lo) * static_cast<double>(engine() >> 11) * 0x1p-53;
    };
    // Lines through places in the torus' box.
    std::vector<Vec3> origins, directions;
    for (long i = 0; i < count; ++i) {
        Vec3 d;
        do {
            d = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
        } while (!(norm(d) > 0.1 && norm(d) < 1.0));
        directions.push_back(unit(d));
        origins.push_back({uniform(-1, 1), uniform(-1, 1), uniform(-0.25, 0.25)});
    }
    const auto rays_at = [&](double unit_length) {
        std::vector<solids::LocalRay<double>> out;
        for (std::size_t i = 0; i < origins.size(); ++i) {
            const Vec3 d = directions[i];
            Vec3 o = origins[i] / unit_length;
            o -= d * dot(o, d);
            const double e = 0x1p-48;
            out.push_back({o.x, o.y, o.z, d.x, d.y, d.z, e, e, e, dot(d, d)});
        }
        return out;
    };
    const solids::Torus::Kernel torus(0.75, 0.25);
    const auto torus_rays = rays_at(1.0);
    std::printf("patches  ns a ray  torus  ratio\n");
    bool agree = true;
    for (const int n : {4, 6, 10, 20, 40}) {
        const auto placed = solids::frame_shell(meshes::smooth(ring(n)).value()).value();
        const double size = placed.to_object.linear.row[0].x;
        const auto rays = rays_at(size);
        Seen patches, round;
        for (int i = 0; i < 5; ++i) {
            shoot(placed.kernel, rays, size, patches);
            shoot(torus, torus_rays, 1.0, round);
        }
        const auto rays_count = static_cast<double>(count);
        std::printf("%7d  %8.0f  %5.0f  %5.2f\n", n * n, patches.seconds / rays_count * 1e9,
                    round.seconds / rays_count * 1e9, patches.seconds / round.seconds);
        const double off = std::fabs(patches.inside / round.inside - 1.0);
        agree = agree && off < 4.0 / (n * n);
    }
    if (!agree) std::printf("the lengths inside do not agree\n");
    return agree ? 0 : 1;
}
