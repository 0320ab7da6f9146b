// Draft and preview: stepwise refinement [Wijk86 2.4].
//
// The draft has one ray for each block of 4 x 4 pixels, spread over it.
// The preview starts with a ray for each 8 x 8 pixels. Where the four rays around such a square saw the same smooth
// surface in about the same light the pixels between are interpolated. Elsewhere it is cut into four blocks of 4 x 4,
// with a ray each, and blocks whose rays still differ are traced pixel by pixel: at each step the largest differences
// first, as far as an allowance of rays goes. So the cost of a preview is bounded, whatever is in the picture. Details
// between the samples may be missed, as in any preview.
#include <algorithm>
#include <cmath>

#include "raymo/render/tiles.hpp"

namespace raymo::render {
namespace {

constexpr int kBlock = 4;
/// Side of a tile in blocks.
constexpr int kTile = 8;
/// Rays that each step of the refinement may take, for each block of the picture.
constexpr double kAllowanceOfBlocks = 0.45;
constexpr double kAllowanceOfPixels = 0.2;
/// Rays that each step may take however small the picture is.
constexpr std::size_t kLeastAllowance = 8192;

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
    [[nodiscard]] Sample& at(int i, int j) {
        return samples[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) +
                       static_cast<std::size_t>(i)];
    }
    [[nodiscard]] const Sample& at(int i, int j) const {
        return samples[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) +
                       static_cast<std::size_t>(i)];
    }
};

/// For rays through points of the lattice.
auto lattice_sampler(const Sitting& s, Lattice& lattice, RayShader& shader) {
    return Sampler(s, shader, 1, true,
                   [&lattice](std::size_t index, const Colour& c, const Signature& signature) {
                       lattice.samples[index] = {{static_cast<float>(c.x), static_cast<float>(c.y),
                                                  static_cast<float>(c.z)},
                                                 signature};
                   });
}
template <class Rays>
void trace_point(const Lattice& lattice, int i, int j, Rays& rays) {
    rays.add_middle(kBlock * i, kBlock * j,
                    static_cast<std::size_t>(j) * static_cast<std::size_t>(lattice.columns) +
                        static_cast<std::size_t>(i));
}

/// Traces every `stride`-th point of the lattice, as the part 0..share of the work.
bool trace_lattice(const Sitting& s, Lattice& lattice, int stride, double share) {
    const auto count = [stride](int n) { return (n + stride - 1) / stride; };
    const auto tiles = tiles_of(count(lattice.columns), count(lattice.rows), 2 * kTile);
    return s.crew.run(tiles, 0.0, share, [&](const Rect& tile, RayShader& shader) {
        auto rays = lattice_sampler(s, lattice, shader);
        for_each_cell(tile,
                      [&](int i, int j) { trace_point(lattice, stride * i, stride * j, rays); });
        rays.flush();
    });
}

/// How urgently a square with these corners, in order around it, wants to be refined: 0 not at all .. 255.
std::uint8_t urgency(const std::array<const Sample*, 4>& corner) {
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
std::uint8_t urgency(const Lattice& lattice, int i, int j, int stride) {
    return urgency({&lattice.at(i, j), &lattice.at(i + stride, j),
                    &lattice.at(i + stride, j + stride), &lattice.at(i, j + stride)});
}

/// Turns urgencies into 1 for the `most` most urgent squares and 0 for the others.
void choose(std::vector<std::uint8_t>& wish, std::size_t most) {
    std::array<std::size_t, 256> count{};
    for (const std::uint8_t w : wish) ++count[w];
    std::size_t least = 256;
    while (least > 1 && count[least - 1] <= most) most -= count[--least];
    // Of the squares that are just as urgent as the first one left out, every so many-th.
    const std::size_t tied = least > 1 ? count[least - 1] : 0;
    std::size_t phase = 0;
    for (std::uint8_t& w : wish) {
        const bool marginal = w != 0 && w + std::size_t{1} == least;
        if (marginal) phase += most;
        const bool taken = w >= least || (marginal && phase >= tied);
        if (marginal && taken) phase -= tied;
        w = taken ? 1 : 0;
    }
}

std::size_t allowance(double rays_per_block, std::size_t blocks) {
    return std::max(static_cast<std::size_t>(rays_per_block * static_cast<double>(blocks)),
                    kLeastAllowance);
}

/// The squares of 8 x 8 pixels: 2 x 2 blocks.
struct Squares {
    int columns;
    int rows;
    std::vector<std::uint8_t> cut;  ///< 1: traced block by block

    Squares(int blocks_x, int blocks_y)
        : columns((blocks_x + 1) / 2),
          rows((blocks_y + 1) / 2),
          cut(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows)) {}
    [[nodiscard]] std::uint8_t& at(int p, int q) {
        return cut[static_cast<std::size_t>(q) * static_cast<std::size_t>(columns) +
                   static_cast<std::size_t>(p)];
    }
};

/// A lattice point between traced ones: the light of both, the surface of the first.
Sample between(const Sample& a, const Sample& b) {
    Sample middle = a;
    for (std::size_t k = 0; k < 3; ++k) middle.light[k] = 0.5F * (a.light[k] + b.light[k]);
    return middle;
}

/// Gives all points of the lattice that are not at corners of squares a value: by rays in squares to be cut, else between
/// their neighbours. A square owns the points above and left of its middle, so edges on the right and below may be taken
/// from a neighbour that is not cut.
bool refine_lattice(const Sitting& s, Lattice& lattice, Squares& squares, double from, double to) {
    for (int j = 0; j < lattice.rows; j += 2) {
        for (int i = 1; i + 1 < lattice.columns; i += 2) {
            lattice.at(i, j) = between(lattice.at(i - 1, j), lattice.at(i + 1, j));
        }
    }
    for (int j = 1; j + 1 < lattice.rows; j += 2) {
        for (int i = 0; i < lattice.columns; ++i) {
            lattice.at(i, j) = between(lattice.at(i, j - 1), lattice.at(i, j + 1));
        }
    }
    const auto tiles = tiles_of(squares.columns, squares.rows, 2 * kTile);
    return s.crew.run(tiles, from, to, [&](const Rect& tile, RayShader& shader) {
        auto rays = lattice_sampler(s, lattice, shader);
        for_each_cell(tile, [&](int p, int q) {
            if (squares.at(p, q) == 0) return;
            trace_point(lattice, 2 * p + 1, 2 * q, rays);
            trace_point(lattice, 2 * p, 2 * q + 1, rays);
            trace_point(lattice, 2 * p + 1, 2 * q + 1, rays);
        });
        rays.flush();
    });
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
template <class Rays>
void refine(const Sitting& s, const Lattice& lattice, int i, int j, Rays& rays) {
    const int x0 = kBlock * i;
    const int y0 = kBlock * j;
    const Rect block{x0, y0, std::min(x0 + kBlock, s.film.width),
                     std::min(y0 + kBlock, s.film.height)};
    const std::array<float, 3>& c = lattice.at(i, j).light;
    s.film.set(x0, y0, {c[0], c[1], c[2]});
    for_each_cell(block, [&](int x, int y) {
        if (x == x0 && y == y0) return;
        rays.add_middle(x, y,
                        static_cast<std::size_t>(y) * static_cast<std::size_t>(s.film.width) +
                            static_cast<std::size_t>(x));
    });
}

int blocks_in(int pixels) { return (pixels + kBlock - 1) / kBlock; }

}  // namespace

bool draw_draft(const Sitting& s) {
    Lattice lattice(blocks_in(s.film.width), blocks_in(s.film.height));
    if (!trace_lattice(s, lattice, 1, 1.0)) return false;
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
    const std::size_t blocks =
        static_cast<std::size_t>(blocks_x) * static_cast<std::size_t>(blocks_y);
    Squares squares(blocks_x, blocks_y);
    Lattice lattice(2 * squares.columns, 2 * squares.rows);
    if (!trace_lattice(s, lattice, 2, 0.3)) return false;
    for (int q = 0; q < squares.rows; ++q) {
        for (int p = 0; p < squares.columns; ++p) {
            squares.at(p, q) = urgency(lattice, 2 * p, 2 * q, 2);
        }
    }
    choose(squares.cut, allowance(kAllowanceOfBlocks, blocks) / 3);
    if (!refine_lattice(s, lattice, squares, 0.3, 0.6)) return false;

    std::vector<std::uint8_t> wanted(blocks);
    std::size_t next = 0;
    for (int j = 0; j < blocks_y; ++j) {
        for (int i = 0; i < blocks_x; ++i, ++next) {
            if (squares.at(i / 2, j / 2) != 0) wanted[next] = urgency(lattice, i, j, 1);
        }
    }
    choose(wanted, allowance(kAllowanceOfPixels, blocks) / (kBlock * kBlock - 1));
    const auto tiles = tiles_of(blocks_x, blocks_y, kTile);
    return s.crew.run(tiles, 0.6, 1.0, [&](const Rect& tile, RayShader& shader) {
        Sampler rays(s, shader, 1, false,
                     [&](std::size_t pixel, const Colour& light, const Signature&) {
                         s.film.set(pixel, light);
                     });
        for (int j = tile.y0; j < tile.y1; ++j) {
            for (int i = tile.x0; i < tile.x1; ++i) {
                const bool refined =
                    wanted[static_cast<std::size_t>(j) * static_cast<std::size_t>(blocks_x) +
                           static_cast<std::size_t>(i)] != 0;
                if (refined) {
                    refine(s, lattice, i, j, rays);
                } else {
                    interpolate(lattice, i, j, s.film);
                }
            }
        }
        rays.flush();
    });
}

}  // namespace raymo::render
