// raymo_embree: exact solids against triangles that Embree traces, at equal error. The same rays, one thread, CPU time, in
// turns, medians. Exit status 1 when a gate fails or a promise is missed, 2 when something can not be built.

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "embree/tracing.hpp"

namespace {

using namespace raymo::bench;

struct Options {
    int side = 1024;
    int runs = 5;
    std::string shape;  ///< empty: all
};

/// A share of wrong pixels, in millionths, and how many times faster RAYMO promises to be there, build included.
struct Level {
    double wrong;
    double promised;
};
constexpr std::array<Level, 2> kLevels{Level{150.0, 2.0}, Level{20.0, 8.0}};
constexpr double kGrowth = 1.25;  ///< of the number of triangles, from one trial to the next
constexpr double kMostTriangles = 2e7;

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// The coarsest mesh that errs in no more than the given share of pixels.
bool find_mesh(const Shape& shape, const Rays& rays, const Answers& exact, double wrong,
               double& triangles, Mesh& mesh, Errors& errors) {
    for (; triangles < kMostTriangles; triangles *= kGrowth) {
        mesh = shape.tessellate(triangles);
        const EmbreeScene scene(mesh, RTC_BUILD_QUALITY_MEDIUM);
        errors = compare(mesh, scene, rays, exact);
        if (1e6 * static_cast<double>(errors.wrong) / static_cast<double>(rays.count()) <= wrong)
            return true;
    }
    return false;
}

struct Timing {
    std::vector<double> compile, packets, single;                         // RAYMO
    std::vector<double> generate, medium, low, packets16, packets8, one;  // Embree
    std::vector<double> low16;
};

/// All of it once, RAYMO and Embree in turns. False: the number of hits is not what it was.
bool time_once(const Shape& shape, double triangles, const Rays& rays, const Answers& exact,
               const Errors& errors, Timing& out) {
    double seconds = cpu_seconds();
    const auto lap = [&](std::vector<double>& into) {
        const double now = cpu_seconds();
        into.push_back(now - seconds);
        seconds = now;
    };
    const auto solid = ExactScene::make(shape);
    if (!solid) return false;
    lap(out.compile);
    bool same = solid->trace_packets(rays) == exact.hits;
    lap(out.packets);
    same &= solid->trace_single(rays) == exact.hits;
    lap(out.single);
    const Mesh mesh = shape.tessellate(triangles);
    lap(out.generate);
    const EmbreeScene scene(mesh, RTC_BUILD_QUALITY_MEDIUM);
    lap(out.medium);
    const auto is_near = [&](std::size_t hits) {
        const std::size_t apart = hits > exact.hits ? hits - exact.hits : exact.hits - hits;
        return apart <= errors.wrong;
    };
    same &= is_near(scene.trace16(rays));
    lap(out.packets16);
    same &= is_near(scene.trace8(rays));
    lap(out.packets8);
    same &= is_near(scene.trace1(rays));
    lap(out.one);
    const EmbreeScene quick(mesh, RTC_BUILD_QUALITY_LOW);
    lap(out.low);
    same &= is_near(quick.trace16(rays));
    lap(out.low16);
    return same;
}

/// Prints one line, and says whether the promises are kept.
bool print(const Shape& shape, const Rays& rays, const Errors& errors, std::size_t triangles,
           const Timing& time, const Level& level) {
    const auto count = static_cast<double>(rays.count());
    const double ray = 1e9 / count;
    const double ours = median(time.packets), compile = median(time.compile);
    const double packets = std::min(median(time.packets16), median(time.packets8));
    const double generate = median(time.generate);
    // A quicker build makes slower trees: what is faster in sum counts.
    const double medium = generate + median(time.medium);
    const double low = generate + median(time.low);
    const double theirs = std::min(medium + packets, low + median(time.low16));
    const double with_build = theirs / (compile + ours);
    const double without = packets / ours;
    std::printf(
        "%-11s %5.0f %9zu %6.1f %7.3f | %7.1f %7.1f | %7.1f %7.1f %6.1f %6.1f %6.1f | %6.2f %6.2f "
        "%6.2f  %g: %s\n",
        std::string(shape.name).c_str(), level.wrong, triangles,
        1e6 * static_cast<double>(errors.wrong) / count, errors.angle, ours * ray,
        median(time.single) * ray, 1e3 * medium, 1e3 * low, median(time.packets16) * ray,
        median(time.packets8) * ray, median(time.one) * ray, with_build,
        (medium + median(time.one)) / (compile + median(time.single)), without, level.promised,
        with_build >= level.promised && without >= 1.0 ? "kept" : "MISSED");
    return with_build >= level.promised && without >= 1.0;
}

/// 0, 1 or 2, as the program's exit status.
int measure(const Shape& shape, const Options& options) {
    const Rays rays(shape.camera, options.side);
    const auto solid = ExactScene::make(shape);
    if (!solid) {
        std::fprintf(stderr, "raymo_embree: %s: %s\n", std::string(shape.name).c_str(),
                     solid.error().message.c_str());
        return 2;
    }
    const Answers exact = solid->answers(rays);
    int status = 0;
    double triangles = 500.0;
    for (const Level& level : kLevels) {
        Mesh mesh;
        Errors errors;
        if (!find_mesh(shape, rays, exact, level.wrong, triangles, mesh, errors)) {
            std::printf(
                "%-11s %5.0f: %zu of the rays still differ with %zu triangles: gate failed\n",
                std::string(shape.name).c_str(), level.wrong, errors.wrong, mesh.triangles.size());
            return 1;
        }
        Timing time;
        for (int run = 0; run < options.runs; ++run) {
            if (!time_once(shape, triangles, rays, exact, errors, time)) {
                std::printf("%-11s the number of hits is another: gate failed\n",
                            std::string(shape.name).c_str());
                return 1;
            }
        }
        if (!print(shape, rays, errors, mesh.triangles.size(), time, level)) status = 1;
        std::fflush(stdout);
    }
    std::printf("%-11s hits %zu of %zu rays; RAYMO's scene is made in %.3f ms\n\n", "", exact.hits,
                rays.count(), 1e3 * solid->seconds());
    return status;
}

bool read_options(int count, char** words, Options& options) {
    for (int i = 1; i < count; i += 2) {
        const std::string name = words[i];
        if (i + 1 >= count) return false;
        const char* text = words[i + 1];
        const char* end = text + std::strlen(text);
        if (name == "--shape") {
            options.shape = text;
            continue;
        }
        int value = 0;
        const auto [stop, error] = std::from_chars(text, end, value);
        if (error != std::errc() || stop != end) return false;
        if (name == "--side" && value >= 64 && value <= 8192 && value % 8 == 0) {
            options.side = value;
        } else if (name == "--runs" && value >= 1 && value <= 1000) {
            options.runs = value;
        } else {
            return false;
        }
    }
    return true;
}

}  // namespace

int main(int count, char** words) {
    Options options;
    if (!read_options(count, words, options)) {
        std::fprintf(stderr,
                     "usage: raymo_embree [--side PIXELS] [--runs N] [--shape NAME]\n"
                     "PIXELS: a multiple of 8; NAME: torus, revolution, prism or sweep\n");
        return 2;
    }
    std::printf(
        "%-11s %5s %9s %6s %7s | %15s | %38s | times as fast\n"
        "%-11s %5s %9s %6s %7s | %7s %7s | %7s %7s %6s %6s %6s | %6s %6s %6s\n"
        "%-11s %5s %9s %6s %7s | %7s %7s | %7s %7s %6s %6s %6s | %6s %6s %6s\n",
        "", "", "", "", "normal", "RAYMO, ns/ray", "Embree: made, ms; ns/ray", "shape", "level",
        "triangles", "wrong", "99.9 %", "packets", "single", "medium", "low", "of 16", "of 8",
        "single", "with", "single", "trace", "", "", "", "/1e6", "degrees", "", "", "", "", "", "",
        "", "build", "with", "only");
    int status = 0;
    bool any = false;
    for (const Shape& shape : shapes()) {
        if (!options.shape.empty() && options.shape != shape.name) continue;
        any = true;
        status = std::max(status, measure(shape, options));
        if (status == 2) return status;
    }
    if (!any) {
        std::fprintf(stderr, "raymo_embree: no shape of that name\n");
        return 2;
    }
    return status;
}
