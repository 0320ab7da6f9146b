// A picture cut into tiles for any number of workers.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <vector>

#include "raymo/render/ray_shader.hpp"

namespace raymo::render {

/// Pixels (or other cells of a grid): x0 <= x < x1, y0 <= y < y1.
struct Rect {
    int x0, y0, x1, y1;
};

/// The squares of `size` cells that cover width x height cells, in Morton order, so that neighbours
/// in the picture are neighbours in time and find the same parts of the model in the caches.
[[nodiscard]] std::vector<Rect> tiles_of(int width, int height, int size);

/// Runs tiles on the executor, with one RayShader a worker, and tells how far they are.
class Crew {
public:
    Crew(const Stage& stage, Executor& executor, Progress& progress)
        : stage_(&stage),
          executor_(&executor),
          progress_(&progress),
          shaders_(executor.workers()) {}

    /// Calls work(tile, shader) for every tile. The pass is the part from..to of all the work.
    /// False: cancelled.
    [[nodiscard]] bool run(const std::vector<Rect>& tiles, double from, double to,
                           const std::function<void(const Rect&, RayShader&)>& work);
    /// Polled within tiles that take long.
    [[nodiscard]] bool cancelled() const { return progress_->cancelled(); }
    [[nodiscard]] trace::RayCounts counts() const;

private:
    void report(std::size_t total, double from, double to);

    const Stage* stage_;
    Executor* executor_;
    Progress* progress_;
    std::vector<std::unique_ptr<RayShader>> shaders_;
    std::atomic<std::size_t> done_{0};
    std::atomic_flag reporting_;
};

/// The blocks of pixels whose rays make a packet.
inline constexpr int kAcross = 4;
inline constexpr int kDown = trace::kRays / kAcross;

/// Calls f(x, y) for all cells of a tile, block by block, so that those that follow each other are close.
template <class F>
void for_each_cell(const Rect& tile, F&& f) {
    for (int y = tile.y0; y < tile.y1; y += kDown) {
        for (int x = tile.x0; x < tile.x1; x += kAcross) {
            for (int v = y; v < std::min(y + kDown, tile.y1); ++v) {
                for (int u = x; u < std::min(x + kAcross, tile.x1); ++u) f(u, v);
            }
        }
    }
}

/// Calls block(x, y) for the blocks that lie within a tile and whose corners those are, and pixel(x, y) for what is left of
/// it beside them; in the same order.
template <class Block, class Pixel>
void for_each_block(const Rect& tile, Block&& block, Pixel&& pixel) {
    for (int y = tile.y0; y < tile.y1; y += kDown) {
        for (int x = tile.x0; x < tile.x1; x += kAcross) {
            const Rect part{x, y, std::min(x + kAcross, tile.x1), std::min(y + kDown, tile.y1)};
            if (part.x1 - x == kAcross && part.y1 - y == kDown) {
                block(x, y);
            } else {
                for_each_cell(part, pixel);
            }
        }
    }
}

/// Where two neighbouring answers differ so much that the line between them shows: another surface,
/// a bend of more than about 45 degrees, or a step of about 1/16 in brightness as a screen shows
/// it.
[[nodiscard]] bool differ(const Signature& a, const float* light_a, const Signature& b,
                          const float* light_b);

/// Largest step in a colour component between the two, about as a screen shows it: 0 .. about 1.
[[nodiscard]] float step_between(const float* light_a, const float* light_b);

/// Names the random numbers of one pixel.
[[nodiscard]] inline std::uint64_t pixel_seed(std::uint64_t seed, int x, int y) {
    return mix(mix(seed) + (static_cast<std::uint64_t>(static_cast<std::uint32_t>(y)) << 32U) +
               static_cast<std::uint32_t>(x));
}

/// One picture in the making.
struct Sitting {
    const Stage& stage;
    const scene::View& view;
    const scene::Camera& camera;
    const Options& options;
    Crew& crew;
    image::Film& film;
};

/// Gathers rays of one tile into batches. take(pixel, light, signature) gets what they bring, in their order; pixels are
/// numbers that it understands.
template <class Take>
class Sampler {
public:
    /// `samples`: rays of each pixel. `signatures`: they are wanted.
    Sampler(const Sitting& sitting, RayShader& shader, std::uint32_t samples, bool signatures,
            Take take)
        : s_(&sitting), shader_(&shader), take_(std::move(take)) {
        batch_.samples = samples;
        batch_.signatures = signatures;
    }
    /// A ray through the middle of pixel (x, y).
    void add_middle(int x, int y, std::size_t pixel) {
        if (shader_->stage().soft) seed(x, y);
        add(x + 0.5, y + 0.5, 0, pixel);
    }
    /// The same for the pixels of a block with the corner (x, y); `pixel` is that of the corner, rows are `stride` apart.
    void add_middles(int x, int y, std::size_t pixel, std::size_t stride) {
        if (shader_->stage().soft || batch_.count % trace::kRays != 0) {
            for (int v = 0; v < kDown; ++v) {
                const std::size_t row = pixel + static_cast<std::size_t>(v) * stride;
                for (int u = 0; u < kAcross; ++u)
                    add_middle(x + u, y + v, row + static_cast<std::size_t>(u));
            }
            return;
        }
        const std::size_t first = batch_.count;
        Row& xs = x_[first / trace::kRays];
        Row& ys = y_[first / trace::kRays];
        for (std::size_t k = 0; k < trace::kRays; ++k) {
            const std::size_t u = k % kAcross;
            const std::size_t v = k / kAcross;
            xs.at[k] = x + (static_cast<double>(u) + 0.5);
            ys.at[k] = y + (static_cast<double>(v) + 0.5);
            pixel_[first + k] = pixel + u + v * stride;
        }
        std::fill_n(batch_.sample.begin() + first, trace::kRays, 0U);
        batch_.count += trace::kRays;
        if (batch_.count == EyeBatch::kMost) flush();
    }
    /// Ray number `k` of a pixel.
    void add_sample(int x, int y, std::uint32_t k, std::size_t pixel) {
        const std::uint64_t set = seed(x, y);
        const Point2 p = sample_point(k, set);
        if (s_->camera.aperture > 0.0) lens_[batch_.count] = sample_point(k, set + 1);
        add(x + p.u, y + p.v, k, pixel);
    }
    /// Must be called after the last ray.
    void flush() {
        if (batch_.count == 0) return;
        const std::size_t packets = (batch_.count + trace::kRays - 1) / trace::kRays;
        for (std::size_t i = 0; i < packets; ++i) {
            if (i + 1 == packets) fill_up();
            eye_rays(s_->view, x_[i].at, y_[i].at, batch_.rays[i]);
        }
        if (s_->camera.aperture > 0.0 && batch_.samples > 1) open_lens();
        shader_->answer(batch_, answers_);
        for (std::size_t i = 0; i < batch_.count; ++i)
            take_(pixel_[i], answers_.light[i], answers_.signature[i]);
        batch_.count = 0;
    }

private:
    std::uint64_t seed(int x, int y) {
        return batch_.seed[batch_.count] = pixel_seed(s_->options.seed, x, y);
    }
    void add(double x, double y, std::uint32_t sample, std::size_t pixel) {
        const std::size_t i = batch_.count++;
        number(x_, i) = x;
        number(y_, i) = y;
        batch_.sample[i] = sample;
        pixel_[i] = pixel;
        if (batch_.count == EyeBatch::kMost) flush();
    }
    /// The lanes of the last packet that no ray is in get the last ray.
    void fill_up() {
        const std::size_t last = batch_.count - 1;
        for (std::size_t i = batch_.count; i % trace::kRays != 0; ++i) {
            number(x_, i) = number(x_, last);
            number(y_, i) = number(y_, last);
        }
    }
    void open_lens() {
        for (std::size_t i = 0; i < batch_.count; ++i) {
            trace::RayQuery query;
            query.ray = s_->view.ray(number(x_, i), number(y_, i), lens_[i].u, lens_[i].v);
            batch_.rays[i / trace::kRays].set(static_cast<int>(i % trace::kRays), query);
        }
    }

    /// A number for each ray, packet by packet.
    struct alignas(64) Row {
        double at[trace::kRays];
    };
    using Rows = std::array<Row, EyeBatch::kMost / trace::kRays>;
    static double& number(Rows& rows, std::size_t i) {
        return rows[i / trace::kRays].at[i % trace::kRays];
    }
    const Sitting* s_;
    RayShader* shader_;
    Take take_;
    EyeBatch batch_;
    Answers answers_;
    Rows x_, y_;  ///< in the picture
    std::array<Point2, EyeBatch::kMost> lens_;
    std::array<std::size_t, EyeBatch::kMost> pixel_;
};

/// Whether all pixels get equally many rays, so that none is compared with its neighbours.
[[nodiscard]] bool is_uniform(const Options& options, const scene::Camera& camera);

/// Every pixel once, then edges again; or all pixels with equally many samples. False: cancelled.
[[nodiscard]] bool draw_final(const Sitting& sitting);
/// Every fourth pixel of every fourth row, spread out; or interpolated, and refined where
/// neighbours differ. False: cancelled.
[[nodiscard]] bool draw_draft(const Sitting& sitting);
[[nodiscard]] bool draw_preview(const Sitting& sitting);

}  // namespace raymo::render
