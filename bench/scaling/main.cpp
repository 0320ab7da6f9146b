// raymo_scaling: what a ray costs as the number of leaves grows. One thread, CPU time, every model
// of a family measured in turns, medians printed. Exit status 1 when the promise for the plate is
// not kept, 2 when a model can not be built.

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

#include "raymo/scene/camera.hpp"
#include "raymo/trace/packet.hpp"
#include "scaling/models.hpp"

namespace {

using raymo::trace::CompiledScene;
using raymo::trace::HitPacket;
using raymo::trace::RayPacket;
using raymo::trace::RayQuery;
using raymo::trace::Tracer;

constexpr double kPromisedGrowth = 8.0;  ///< time per ray at 10^6 holes over that at 10

struct Options {
    int side = 1024;  ///< rays are those of a picture of this many pixels each way
    int runs = 5;
    std::size_t most = 1'000'000;  ///< leaves
    std::string family;            ///< empty: all
};

double cpu_seconds() {
    std::timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t half = values.size() / 2;
    return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

struct Measured {
    std::size_t hits = 0;
    double seconds = 0.0;
};

/// One picture's primary rays, in blocks of 4 x 8.
Measured trace_picture(const CompiledScene& scene, const raymo::scene::View& view, int side) {
    Tracer tracer(scene);
    RayPacket rays;
    HitPacket hits;
    Measured result;
    const double start = cpu_seconds();
    for (int y = 0; y < side; y += raymo::trace::kRays / 4) {
        for (int x = 0; x < side; x += 4) {
            for (int i = 0; i < raymo::trace::kRays; ++i) {
                RayQuery query;
                query.ray = view.ray(x + i % 4 + 0.5, y + i / 4 + 0.5);
                rays.set(i, query);
            }
            result.hits += static_cast<std::size_t>(
                raymo::trace::lane_count(tracer.first_hits(rays, raymo::trace::kAllLanes, hits)));
        }
    }
    result.seconds = cpu_seconds() - start;
    return result;
}

struct Row {
    std::size_t leaves;
    CompiledScene scene;
    double compile_seconds;
    std::size_t hits = 0;
    std::vector<double> seconds = {};
};

/// Median nanoseconds per ray of each size, printed as a table; empty when a model can not be
/// built.
std::vector<double> measure(const raymo::bench::Family& family, const Options& options) {
    std::printf("%.*s: %.*s\n", static_cast<int>(family.name.size()), family.name.data(),
                static_cast<int>(family.what.size()), family.what.data());
    std::vector<Row> rows;
    for (const std::size_t leaves : family.sizes) {
        if (leaves > options.most) continue;
        auto solid = family.build(leaves);
        if (!solid) {
            std::fprintf(stderr, "raymo_scaling: %s\n", solid.error().message.c_str());
            return {};
        }
        raymo::scene::Scene scene;
        scene.parts.push_back({std::string(family.name), *std::move(solid), {}});
        const double start = cpu_seconds();
        auto compiled = raymo::trace::compile(scene);
        if (!compiled) {
            std::fprintf(stderr, "raymo_scaling: %s\n", compiled.error().message.c_str());
            return {};
        }
        rows.push_back({leaves, *std::move(compiled), cpu_seconds() - start});
    }
    const int side = std::max(options.side / family.coarser / 4 * 4, 4);
    const raymo::scene::View view(family.camera, side, side);
    for (int run = 0; run < options.runs; ++run) {
        for (Row& row : rows) {
            const Measured measured = trace_picture(row.scene, view, side);
            row.hits = measured.hits;
            row.seconds.push_back(measured.seconds);
        }
    }
    const double rays = static_cast<double>(side) * side;
    std::printf("  %9s %9s %8s %9s %9s %11s %9s\n", "leaves", "ns/ray", "(min)", "growth", "hits",
                "compile ms", "MiB");
    std::vector<double> medians;
    for (const Row& row : rows) {
        medians.push_back(1e9 * median(row.seconds) / rays);
        std::printf("  %9zu %9.1f %8.1f %9.2f %8.1f%% %11.1f %9.1f\n", row.leaves, medians.back(),
                    1e9 * *std::min_element(row.seconds.begin(), row.seconds.end()) / rays,
                    medians.back() / medians.front(), 100.0 * static_cast<double>(row.hits) / rays,
                    1e3 * row.compile_seconds, static_cast<double>(row.scene.bytes()) / (1 << 20));
    }
    std::printf("\n");
    return medians;
}

bool read_number(const char* text, long low, long high, long& value) {
    const char* end = text + std::strlen(text);
    const auto [stop, error] = std::from_chars(text, end, value);
    return error == std::errc() && stop == end && value >= low && value <= high;
}

bool read_options(int count, char** words, Options& options) {
    for (int i = 1; i < count; i += 2) {
        const std::string name = words[i];
        if (i + 1 >= count) return false;
        const char* text = words[i + 1];
        long value = 0;
        if (name == "--side" && read_number(text, 8, 16384, value) && value % 4 == 0) {
            options.side = static_cast<int>(value);
        } else if (name == "--runs" && read_number(text, 1, 1000, value)) {
            options.runs = static_cast<int>(value);
        } else if (name == "--most" && read_number(text, 10, 100'000'000, value)) {
            options.most = static_cast<std::size_t>(value);
        } else if (name == "--family") {
            options.family = text;
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
        std::fprintf(
            stderr,
            "usage: raymo_scaling [--side PIXELS] [--runs N] [--most LEAVES] [--family NAME]\n"
            "PIXELS: a multiple of 4; NAME: plate, chain, rings, hedgehog or needles\n");
        return 2;
    }
    bool kept = true;
    bool any = false;
    for (const raymo::bench::Family& family : raymo::bench::families()) {
        if (!options.family.empty() && options.family != family.name) continue;
        any = true;
        const std::vector<double> medians = measure(family, options);
        if (medians.empty()) return 2;
        if (family.name == "plate" && options.most >= family.sizes.back()) {
            const double growth = medians.back() / medians.front();
            std::printf(
                "plate, time per ray at %zu holes over that at %zu: %.2f (promised: at most %g): "
                "%s\n\n",
                family.sizes.back(), family.sizes.front(), growth, kPromisedGrowth,
                growth <= kPromisedGrowth ? "kept" : "MISSED");
            kept = growth <= kPromisedGrowth;
        }
    }
    if (!any) {
        std::fprintf(stderr, "raymo_scaling: no family of that name\n");
        return 2;
    }
    return kept ? 0 : 1;
}
