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

/// The number of a pixel in its tile.
std::size_t slot_of(const Rect& tile, int x, int y) {
    return static_cast<std::size_t>((y - tile.y0) * kTile + (x - tile.x0));
}

/// Light of a whole tile, on its way to a film of either kind.
class TileLight {
public:
    void set(std::size_t slot, const Colour& light) {
        float* p = &rgb_[3 * slot];
        for (int a = 0; a < 3; ++a) p[a] = static_cast<float>(light[a]);
    }
    void put(const Rect& tile, image::Film& film) const {
        for (int y = tile.y0; y < tile.y1; ++y) {
            film.put(tile.x0, y, &rgb_[3 * slot_of(tile, tile.x0, y)],
                     static_cast<std::size_t>(tile.x1 - tile.x0));
        }
    }

private:
    std::array<float, 3 * std::size_t{kTile} * kTile> rgb_;
};

/// Draws pixels of one tile with `samples` rays each, those for which wanted(x, y) holds, and gives take(x, y, light) what
/// they show. False: cancelled, nothing was given.
template <class Wanted, class Take>
bool draw_samples(const Sitting& s, const Rect& tile, std::uint32_t samples, RayShader& shader,
                  Wanted&& wanted, Take&& take) {
    std::array<Colour, kTile * kTile> sum{};
    Sampler sampler(
        s, shader, samples, false,
        [&](std::size_t slot, const Colour& light, const Signature&) { sum[slot] += light; });
    bool stopped = false;
    for_each_cell(tile, [&](int x, int y) {
        if (stopped || !wanted(x, y)) return;
        stopped = s.crew.cancelled();
        for (std::uint32_t k = 0; k < samples && !stopped; ++k) {
            sampler.add_sample(x, y, k, slot_of(tile, x, y));
            if ((k & 255U) == 255U) stopped = s.crew.cancelled();
        }
    });
    sampler.flush();
    if (stopped) return false;
    for_each_cell(tile, [&](int x, int y) {
        if (wanted(x, y)) take(x, y, sum[slot_of(tile, x, y)] * (1.0 / samples));
    });
    return true;
}

/// Draws the pixels of one tile by rays through their middles: take(slot, light, signature).
template <class Take>
void draw_middles(const Sitting& s, const Rect& tile, bool signatures, RayShader& shader,
                  Take&& take) {
    Sampler sampler(s, shader, 1, signatures, take);
    for_each_block(
        tile, [&](int x, int y) { sampler.add_middles(x, y, slot_of(tile, x, y), kTile); },
        [&](int x, int y) { sampler.add_middle(x, y, slot_of(tile, x, y)); });
    sampler.flush();
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
        TileLight light;
        const bool done = draw_samples(
            s, tile, static_cast<std::uint32_t>(samples), shader, [](int, int) { return true; },
            [&](int x, int y, const Colour& c) { light.set(slot_of(tile, x, y), c); });
        if (done) light.put(tile, s.film);
    });
}

bool draw_once(const Sitting& s, const std::vector<Rect>& tiles) {
    return s.crew.run(tiles, 0.0, 1.0, [&](const Rect& tile, RayShader& shader) {
        TileLight light;
        draw_middles(
            s, tile, false, shader,
            [&](std::size_t slot, const Colour& c, const Signature&) { light.set(slot, c); });
        light.put(tile, s.film);
    });
}

bool draw_with_sharp_edges(const Sitting& s, const std::vector<Rect>& tiles) {
    const std::size_t pixels = s.film.components() / 3;
    Signatures seen(pixels);
    const auto w = static_cast<std::size_t>(s.film.width);
    const auto number_of = [w](int x, int y) {
        return static_cast<std::size_t>(y) * w + static_cast<std::size_t>(x);
    };
    const auto draw = [&](const Rect& tile, RayShader& shader) {
        const std::size_t first = number_of(tile.x0, tile.y0);
        draw_middles(s, tile, true, shader,
                     [&](std::size_t slot, const Colour& light, const Signature& signature) {
                         const std::size_t pixel = first + slot / kTile * w + slot % kTile;
                         s.film.set(pixel, light);
                         seen[pixel] = signature;
                     });
    };
    if (!s.crew.run(tiles, 0.0, kFirstPass, draw)) return false;

    // Marked before any pixel is drawn again, so that the order of tiles does not matter.
    std::vector<std::uint8_t> edge(pixels);
    if (!s.crew.run(tiles, kFirstPass, kFirstPass,
                    [&](const Rect& tile, RayShader&) { mark_edges(s.film, seen, tile, edge); })) {
        return false;
    }
    return s.crew.run(tiles, kFirstPass, 1.0, [&](const Rect& tile, RayShader& shader) {
        static_cast<void>(draw_samples(
            s, tile, kEdgeSamples, shader, [&](int x, int y) { return edge[number_of(x, y)] != 0; },
            [&](int x, int y, const Colour& light) { s.film.set(x, y, light); }));
    });
}

}  // namespace

bool is_uniform(const Options& options, const scene::Camera& camera) {
    return options.samples > 0 || (options.quality == Quality::final && camera.aperture > 0.0);
}

bool draw_final(const Sitting& s) {
    const std::vector<Rect> tiles = tiles_of(s.film.width, s.film.height, kTile);
    if (!is_uniform(s.options, s.camera)) return draw_with_sharp_edges(s, tiles);
    if (s.options.samples == 1) return draw_once(s, tiles);
    return draw_uniformly(
        s, tiles, s.options.samples > 0 ? std::min(s.options.samples, kMostSamples) : kLensSamples);
}

}  // namespace raymo::render
