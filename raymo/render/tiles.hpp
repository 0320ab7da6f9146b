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

/// Gathers rays into packets. Pixels are numbers that the taker understands.
class Packet {
public:
    Packet(RayShader& shader, std::function<void(std::size_t pixel, const Answer&)> take)
        : shader_(&shader), take_(std::move(take)) {}

    void add(const EyeRay& ray, std::size_t pixel) {
        rays_[count_] = ray;
        pixels_[count_] = pixel;
        if (++count_ == rays_.size()) flush();
    }
    /// Must be called after the last ray.
    void flush() {
        if (count_ == 0) return;
        shader_->answer({rays_.data(), count_}, answers_.data());
        for (std::size_t i = 0; i < count_; ++i) take_(pixels_[i], answers_[i]);
        count_ = 0;
    }

private:
    RayShader* shader_;
    std::function<void(std::size_t, const Answer&)> take_;
    std::array<EyeRay, RayShader::kPacket> rays_;
    std::array<std::size_t, RayShader::kPacket> pixels_{};
    std::array<Answer, RayShader::kPacket> answers_;
    std::size_t count_ = 0;
};

/// Calls f(x, y) for all cells of a tile, by blocks of 4 x 2, the shape of a packet of eight
/// coherent rays.
template <class F>
void for_each_cell(const Rect& tile, F&& f) {
    for (int y = tile.y0; y < tile.y1; y += 2) {
        for (int x = tile.x0; x < tile.x1; x += 4) {
            for (int v = y; v < std::min(y + 2, tile.y1); ++v) {
                for (int u = x; u < std::min(x + 4, tile.x1); ++u) f(u, v);
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

/// Every pixel once, then edges again; or all pixels with equally many samples. False: cancelled.
[[nodiscard]] bool draw_final(const Sitting& sitting);
/// Every fourth pixel of every fourth row, spread out; or interpolated, and refined where
/// neighbours differ. False: cancelled.
[[nodiscard]] bool draw_draft(const Sitting& sitting);
[[nodiscard]] bool draw_preview(const Sitting& sitting);

}  // namespace raymo::render
