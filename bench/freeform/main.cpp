// raymo_freeform: one ray after another against solids of patches and against a torus of the same shape.
//
//     raymo_freeform [RAYS]        262144 if not given
//
// Prints, for a torus as a B-spline of n x n patches, what a ray costs in CPU time, the best of five rounds in turn, and the
// ratio; and for bundles of eight rays beside each other, as pixels send them, what a ray costs alone and in packets. The gate:
// the torus has the same length inside, to within what the B-spline is smaller by, and packets have it to the last bit.
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
#include "raymo/solids/ray_block.hpp"
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

/// The same, eight together; those that are left over alone.
void shoot_packets(const solids::Freeform& kernel, const std::vector<solids::RayBlock>& blocks,
                   double unit, Seen& out) {
    out.spans = 0;
    out.inside = 0.0;
    const double begin = cpu_seconds();
    for (const solids::RayBlock& block : blocks) {
        solids::SpanBlock found;
        kernel.spans(block, 0xff, found);
        for (std::size_t i = 0; i < 8; ++i) {
            if ((found.left_over >> i & 1U) != 0) {
                solids::SpanList spans;
                kernel.spans_in_full({block.o[0][i], block.o[1][i], block.o[2][i], block.d[0][i],
                                      block.d[1][i], block.d[2][i], block.e[0][i], block.e[1][i],
                                      block.e[2][i], block.dd[i], block.from[i]},
                                     spans);
                out.spans += spans.size();
                for (std::size_t k = 0; k < spans.size(); ++k)
                    out.inside += (spans[k].exit.s - spans[k].enter.s) * unit;
                continue;
            }
            for (std::size_t k = 0; k < static_cast<std::size_t>(found.count); ++k) {
                if ((found.valid[k] >> i & 1U) == 0) continue;
                ++out.spans;
                out.inside += (found.exit.s[k][i] - found.enter.s[k][i]) * unit;
            }
        }
    }
    out.seconds = std::min(out.seconds, cpu_seconds() - begin);
}

/// Four rays beside each other, twice, a five-hundredth apart, about each of an eighth of the rays.
std::vector<solids::LocalRay<double>> bundles(const std::vector<solids::LocalRay<double>>& rays) {
    std::vector<solids::LocalRay<double>> out;
    for (std::size_t n = 0; n < rays.size() / 8; ++n) {
        const auto& ray = rays[n];
        Vec3 s, t;
        make_frame({ray.dx, ray.dy, ray.dz}, s, t);
        for (int i = 0; i < 8; ++i) {
            const Vec3 o =
                Vec3{ray.ox, ray.oy, ray.oz} + s * (0.002 * (i % 4)) + t * (0.002 * (i / 4));
            out.push_back(
                {o.x, o.y, o.z, ray.dx, ray.dy, ray.dz, ray.ex, ray.ey, ray.ez, ray.dd, ray.from});
        }
    }
    return out;
}

std::vector<solids::RayBlock> blocks_of(const std::vector<solids::LocalRay<double>>& rays) {
    std::vector<solids::RayBlock> out(rays.size() / 8);
    for (std::size_t n = 0; n < rays.size(); ++n) {
        const auto& ray = rays[n];
        solids::RayBlock& block = out[n / 8];
        const std::size_t i = n % 8;
        block.o[0][i] = ray.ox, block.o[1][i] = ray.oy, block.o[2][i] = ray.oz;
        block.d[0][i] = ray.dx, block.d[1][i] = ray.dy, block.d[2][i] = ray.dz;
        block.e[0][i] = ray.ex, block.e[1][i] = ray.ey, block.e[2][i] = ray.ez;
        block.dd[i] = ray.dd;
        block.from[i] = ray.from;
    }
    return out;
}

}  // namespace

int main(int argc, char** argv) {
    const long count = argc > 1 ? std::strtol(argv[1], nullptr, 10) : 262144;
    if (count < 8) {
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
            out.push_back(
                {o.x, o.y, o.z, d.x, d.y, d.z, e, e, e, dot(d, d), solids::kFromTheBeginning});
        }
        return out;
    };
    const solids::Torus::Kernel torus(0.75, 0.25);
    const auto torus_rays = rays_at(1.0);
    std::printf("patches  ns a ray  torus  ratio  bundles alone  in packets  times\n");
    bool agree = true;
    for (const int n : {4, 6, 10, 20, 40}) {
        const auto placed = solids::frame_shell(meshes::smooth(ring(n)).value()).value();
        const double size = placed.to_object.linear.row[0].x;
        const auto rays = rays_at(size);
        const auto bundled = bundles(rays);
        const auto blocks = blocks_of(bundled);
        Seen patches, round, alone, packets;
        for (int i = 0; i < 5; ++i) {
            shoot(placed.kernel, rays, size, patches);
            shoot(torus, torus_rays, 1.0, round);
            shoot(placed.kernel, bundled, size, alone);
            shoot_packets(placed.kernel, blocks, size, packets);
        }
        const auto rays_count = static_cast<double>(count);
        const auto bundled_count = static_cast<double>(bundled.size());
        std::printf("%7d  %8.0f  %5.0f  %5.2f  %13.0f  %10.0f  %5.2f\n", n * n,
                    patches.seconds / rays_count * 1e9, round.seconds / rays_count * 1e9,
                    patches.seconds / round.seconds, alone.seconds / bundled_count * 1e9,
                    packets.seconds / bundled_count * 1e9, alone.seconds / packets.seconds);
        const double off = std::fabs(patches.inside / round.inside - 1.0);
        agree = agree && off < 4.0 / (n * n) && alone.inside == packets.inside;
    }
    if (!agree) std::printf("the lengths inside do not agree\n");
    return agree ? 0 : 1;
}
