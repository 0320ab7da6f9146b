// Draft and preview: stepwise refinement [Wijk86 2.4].
//
// One ray for each block of 4 x 4 pixels. The draft spreads each over its block. The preview looks
// at the four samples around a block: where they saw the same smooth surface in about the same
// light the pixels between are interpolated, and elsewhere they are traced, the largest steps
// first, as far as an allowance of rays goes. So the cost of a preview is bounded, whatever is in
// the picture; small details between samples may be missed, as in any preview.
#include <algorithm>
#include <cmath>

#include "raymo/render/tiles.hpp"

namespace raymo::render {
namespace {

constexpr int kBlock = 4;
/// Side of a tile in blocks.
constexpr int kTile = 8;
/// Rays for refinement, for each block of the picture.
constexpr double kAllowance = 1.0;

struct Sample {
    std::array<float, 3> light{};
    Signature signature;
};

/// The samples at the upper left pixels of all blocks, and of those that would follow on the right
/// and below.
struct Lattice {
    int columns;
    int rows;
    std::vector<Sample> samples;

    Lattice(int blocks_x, int blocks_y)
        : columns(blocks_x + 1),
          rows(blocks_y + 1),
          samples(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {}
    [[nodiscard]] const Sample& at(int i, int j) const {
        return samples[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) +
                       static_cast<std::size_t>(i)];
    }
};

bool trace_lattice(const Sitting& s, Lattice& lattice, double share) {
    const auto tiles = tiles_of(lattice.columns, lattice.rows, 2 * kTile);
    const auto columns = static_cast<std::size_t>(lattice.columns);
    return s.crew.run(tiles, 0.0, share, [&](const Rect& tile, RayShader& shader) {
        Packet packet(shader, [&](std::size_t index, const Answer& answer) {
            const Colour c = answer.light;
            lattice.samples[index] = {
                {static_cast<float>(c.x), static_cast<float>(c.y), static_cast<float>(c.z)},
                answer.signature};
        });
        for_each_cell(tile, [&](int i, int j) {
            const int x = kBlock * i;
            const int y = kBlock * j;
            packet.add({s.view.ray(x + 0.5, y + 0.5), pixel_seed(s.options.seed, x, y), 0, 1},
                       static_cast<std::size_t>(j) * columns + static_cast<std::size_t>(i));
        });
        packet.flush();
    });
}

/// How urgently a block wants to be refined: 0 not at all .. 255.
std::uint8_t urgency(const Lattice& lattice, int i, int j) {
    const std::array<const Sample*, 4> corner{&lattice.at(i, j), &lattice.at(i + 1, j),
                                              &lattice.at(i + 1, j + 1), &lattice.at(i, j + 1)};
    bool any = false;
    bool outline = false;
    float step = 0.0F;
    for (std::size_t k = 0; k < 4; ++k) {
        const Sample& a = *corner[k];
        const Sample& b = *corner[(k + 1) % 4];
        if (!differ(a.signature, a.light.data(), b.signature, b.light.data())) continue;
        any = true;
        outline = outline || (a.signature.face == 0) != (b.signature.face == 0);
        step = std::max(step, step_between(a.light.data(), b.light.data()));
    }
    if (!any) return 0;
    return static_cast<std::uint8_t>(1.0F + 190.0F * std::min(step, 1.0F) +
                                     (outline ? 64.0F : 0.0F));
}

/// Chooses the blocks to be refined within the allowance.
std::vector<std::uint8_t> choose(const Lattice& lattice, int blocks_x, int blocks_y) {
    const std::size_t blocks =
        static_cast<std::size_t>(blocks_x) * static_cast<std::size_t>(blocks_y);
    std::vector<std::uint8_t> wish(blocks);
    std::array<std::size_t, 256> count{};
    std::size_t next = 0;
    for (int j = 0; j < blocks_y; ++j) {
        for (int i = 0; i < blocks_x; ++i) ++count[wish[next++] = urgency(lattice, i, j)];
    }
    std::size_t left =
        static_cast<std::size_t>(kAllowance * static_cast<double>(blocks)) / (kBlock * kBlock - 1);
    // Small pictures are refined as far as they like.
    left = std::max<std::size_t>(left, 1024);
    std::size_t least = 256;
    while (least > 1 && count[least - 1] <= left) left -= count[--least];
    // Of the blocks that are just as urgent as the first one left out, every so many-th.
    const std::size_t tied = least > 1 ? count[least - 1] : 0;
    std::size_t phase = 0;
    for (std::uint8_t& w : wish) {
        if (w >= least) {
            w = 1;
        } else if (w != 0 && w + std::size_t{1} == least) {
            phase += left;
            const bool taken = phase >= tied;
            if (taken) phase -= tied;
            w = taken ? 1 : 0;
        } else {
            w = 0;
        }
    }
    return wish;
}

void interpolate(const Lattice& lattice, int i, int j, image::Film& film) {
    const Sample& a = lattice.at(i, j);
    const Sample& b = lattice.at(i + 1, j);
    const Sample& c = lattice.at(i, j + 1);
    const Sample& d = lattice.at(i + 1, j + 1);
    const int x1 = std::min(kBlock, film.width - kBlock * i);
    const int y1 = std::min(kBlock, film.height - kBlock * j);
    for (int y = 0; y < y1; ++y) {
        const float v = static_cast<float>(y) / kBlock;
        float* out = &film.rgb[3 * (static_cast<std::size_t>(kBlock * j + y) *
                                        static_cast<std::size_t>(film.width) +
                                    static_cast<std::size_t>(kBlock * i))];
        std::array<float, 3> left;
        std::array<float, 3> step;
        for (std::size_t k = 0; k < 3; ++k) {
            left[k] = a.light[k] + (c.light[k] - a.light[k]) * v;
            step[k] = (b.light[k] + (d.light[k] - b.light[k]) * v - left[k]) * (1.0F / kBlock);
        }
        for (int x = 0; x < x1; ++x) {
            for (std::size_t k = 0; k < 3; ++k) {
                out[3 * static_cast<std::size_t>(x) + k] =
                    left[k] + step[k] * static_cast<float>(x);
            }
        }
    }
}

/// Traces the other pixels of a block.
void refine(const Sitting& s, const Lattice& lattice, int i, int j, Packet& packet) {
    const int x0 = kBlock * i;
    const int y0 = kBlock * j;
    const Rect block{x0, y0, std::min(x0 + kBlock, s.film.width),
                     std::min(y0 + kBlock, s.film.height)};
    const std::array<float, 3>& c = lattice.at(i, j).light;
    s.film.set(x0, y0, {c[0], c[1], c[2]});
    for_each_cell(block, [&](int x, int y) {
        if (x == x0 && y == y0) return;
        packet.add({s.view.ray(x + 0.5, y + 0.5), pixel_seed(s.options.seed, x, y), 0, 1},
                   static_cast<std::size_t>(y) * static_cast<std::size_t>(s.film.width) +
                       static_cast<std::size_t>(x));
    });
}

int blocks_in(int pixels) { return (pixels + kBlock - 1) / kBlock; }

}  // namespace

bool draw_draft(const Sitting& s) {
    Lattice lattice(blocks_in(s.film.width), blocks_in(s.film.height));
    if (!trace_lattice(s, lattice, 1.0)) return false;
    for (int y = 0; y < s.film.height; ++y) {
        for (int x = 0; x < s.film.width; ++x) {
            const std::array<float, 3>& c = lattice.at(x / kBlock, y / kBlock).light;
            s.film.set(x, y, {c[0], c[1], c[2]});
        }
    }
    return true;
}

bool draw_preview(const Sitting& s) {
    const int blocks_x = blocks_in(s.film.width);
    const int blocks_y = blocks_in(s.film.height);
    Lattice lattice(blocks_x, blocks_y);
    if (!trace_lattice(s, lattice, 0.5)) return false;
    const std::vector<std::uint8_t> wanted = choose(lattice, blocks_x, blocks_y);
    const auto w = static_cast<std::size_t>(s.film.width);
    const auto tiles = tiles_of(blocks_x, blocks_y, kTile);
    return s.crew.run(tiles, 0.5, 1.0, [&](const Rect& tile, RayShader& shader) {
        Packet packet(shader, [&](std::size_t pixel, const Answer& answer) {
            s.film.set(static_cast<int>(pixel % w), static_cast<int>(pixel / w), answer.light);
        });
        for (int j = tile.y0; j < tile.y1; ++j) {
            for (int i = tile.x0; i < tile.x1; ++i) {
                const bool refined =
                    wanted[static_cast<std::size_t>(j) * static_cast<std::size_t>(blocks_x) +
                           static_cast<std::size_t>(i)] != 0;
                if (refined) {
                    refine(s, lattice, i, j, packet);
                } else {
                    interpolate(lattice, i, j, s.film);
                }
            }
        }
        packet.flush();
    });
}

}  // namespace raymo::render
