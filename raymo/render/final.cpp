// The final picture. Every pixel gets a ray through its middle. A pixel that differs from one of
// its four neighbours has an edge in it or beside it, and is drawn again with kEdgeSamples rays
// spread over it. So smooth areas cost one ray a pixel and edges are as good as if all had been
// drawn so. With Options::samples every pixel gets that many.
#include "raymo/render/tiles.hpp"

namespace raymo::render {
namespace {

constexpr int kTile = 32;
constexpr int kEdgeSamples = 16;
/// With an open lens no pixel is sharp, so all get as many.
constexpr int kLensSamples = 32;
constexpr int kMostSamples = 1 << 16;
/// The part of the work that is the first pass, for the progress bar: a guess.
constexpr double kFirstPass = 0.6;

using Signatures = std::vector<Signature, image::Zeroed<Signature>>;

/// Draws pixels of one tile with `samples` rays each: those for which wanted(x, y) holds.
template <class Wanted>
void draw_samples(const Sitting& s, const Rect& tile, std::uint32_t samples, RayShader& shader,
                  Wanted&& wanted) {
    std::array<Colour, kTile * kTile> sum{};
    Sampler sampler(
        s, shader, samples, false,
        [&](std::size_t pixel, const Colour& light, const Signature&) { sum[pixel] += light; });
    const auto slot = [&](int x, int y) {
        return static_cast<std::size_t>((y - tile.y0) * kTile + (x - tile.x0));
    };
    bool stopped = false;
    for_each_cell(tile, [&](int x, int y) {
        if (stopped || !wanted(x, y)) return;
        stopped = s.crew.cancelled();
        for (std::uint32_t k = 0; k < samples && !stopped; ++k) {
            sampler.add_sample(x, y, k, slot(x, y));
            if ((k & 255U) == 255U) stopped = s.crew.cancelled();
        }
    });
    sampler.flush();
    if (stopped) return;
    for_each_cell(tile, [&](int x, int y) {
        if (wanted(x, y)) s.film.set(x, y, sum[slot(x, y)] * (1.0 / samples));
    });
}

/// Marks the pixels of `tile` that differ from a neighbour.
void mark_edges(const image::Film& film, const Signatures& seen, const Rect& tile,
                std::vector<std::uint8_t>& edge) {
    const auto w = static_cast<std::size_t>(film.width);
    const auto at = [w](int x, int y) {
        return static_cast<std::size_t>(y) * w + static_cast<std::size_t>(x);
    };
    const auto own = [&](int x, int y) {
        return x >= tile.x0 && x < tile.x1 && y >= tile.y0 && y < tile.y1;
    };
    const auto compare = [&](int x, int y, int u, int v) {
        if (u < 0 || v < 0 || x >= film.width || y >= film.height) return;
        const std::size_t a = at(x, y);
        const std::size_t b = at(u, v);
        if (!differ(seen[a], &film.rgb[3 * a], seen[b], &film.rgb[3 * b])) return;
        if (own(x, y)) edge[a] = 1;
        if (own(u, v)) edge[b] = 1;
    };
    for (int y = tile.y0; y <= tile.y1; ++y) {
        for (int x = tile.x0; x <= tile.x1; ++x) {
            if (y < tile.y1) compare(x, y, x - 1, y);
            if (x < tile.x1) compare(x, y, x, y - 1);
        }
    }
}

bool draw_uniformly(const Sitting& s, const std::vector<Rect>& tiles, int samples) {
    return s.crew.run(tiles, 0.0, 1.0, [&](const Rect& tile, RayShader& shader) {
        draw_samples(s, tile, static_cast<std::uint32_t>(samples), shader,
                     [](int, int) { return true; });
    });
}

}  // namespace

bool draw_final(const Sitting& s) {
    const std::vector<Rect> tiles = tiles_of(s.film.width, s.film.height, kTile);
    if (s.options.samples > 1) {
        return draw_uniformly(s, tiles, std::min(s.options.samples, kMostSamples));
    }
    if (s.options.samples <= 0 && s.camera.aperture > 0.0) {
        return draw_uniformly(s, tiles, kLensSamples);
    }

    const bool once = s.options.samples == 1;
    const std::size_t pixels = s.film.rgb.size() / 3;
    Signatures seen(once ? 0 : pixels);
    const auto w = static_cast<std::size_t>(s.film.width);
    const auto draw_middles = [&](const Rect& tile, RayShader& shader) {
        Sampler sampler(s, shader, 1, !once,
                        [&](std::size_t pixel, const Colour& light, const Signature& signature) {
                            s.film.set(pixel, light);
                            if (!once) seen[pixel] = signature;
                        });
        const auto pixel = [w](int x, int y) {
            return static_cast<std::size_t>(y) * w + static_cast<std::size_t>(x);
        };
        for_each_block(
            tile, [&](int x, int y) { sampler.add_middles(x, y, pixel(x, y), w); },
            [&](int x, int y) { sampler.add_middle(x, y, pixel(x, y)); });
        sampler.flush();
    };
    if (!s.crew.run(tiles, 0.0, once ? 1.0 : kFirstPass, draw_middles)) return false;
    if (once) return true;

    // Marked before any pixel is drawn again, so that the order of tiles does not matter.
    std::vector<std::uint8_t> edge(pixels);
    if (!s.crew.run(tiles, kFirstPass, kFirstPass,
                    [&](const Rect& tile, RayShader&) { mark_edges(s.film, seen, tile, edge); })) {
        return false;
    }
    return s.crew.run(tiles, kFirstPass, 1.0, [&](const Rect& tile, RayShader& shader) {
        draw_samples(s, tile, kEdgeSamples, shader, [&](int x, int y) {
            return edge[static_cast<std::size_t>(y) * w + static_cast<std::size_t>(x)] != 0;
        });
    });
}

}  // namespace raymo::render
