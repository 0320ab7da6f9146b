// From a compiled scene to a picture.
#pragma once

#include <cstdint>

#include "raymo/core/executor.hpp"
#include "raymo/core/progress.hpp"
#include "raymo/core/result.hpp"
#include "raymo/image/film.hpp"
#include "raymo/scene/scene.hpp"
#include "raymo/trace/tracer.hpp"

namespace raymo::render {

enum class Quality : std::uint8_t {
    draft,    ///< one ray for each 4 x 4 block of pixels; no reflection
    preview,  ///< one ray for each 8 x 8 block, refined in steps where neighbours differ, within a bounded number of
              ///< rays; soft lights from their middles; no anti-aliasing
    final,    ///< every pixel, edges anti-aliased
};

struct Options {
    int width = 800;
    int height = 600;
    Quality quality = Quality::final;
    int samples =
        0;  ///< uniform anti-aliasing with this many samples a pixel; 0: what the quality asks for
    int max_depth = 8;              ///< longest chain of reflections and refractions
    double min_weight = 1.0 / 512;  ///< a ray that contributes less is not traced
    std::uint64_t seed = 1;
    /// What the film needs to keep. Light is kept all the same where neighbours are compared on the way.
    image::Kept kept = image::Kept::light;
};

/// Everything a picture needs besides the solids: one camera, the lights that shine, ambient and
/// background.
struct Look {
    scene::Camera camera;
    std::vector<scene::Light> lights;
    scene::Colour ambient;
    scene::Background background;
};

/// The scene's own camera `view` (by index), lights and background, or the defaults where it has
/// none.
[[nodiscard]] Look look_of(const scene::Scene& scene, const Aabb& bounds, double aspect,
                           std::size_t view = 0);

struct Stats {
    trace::RayCounts rays;
};

/// Same picture, bit for bit, for any executor and any instruction set. Error: cancelled.
[[nodiscard]] Result<image::Film> render(const trace::CompiledScene& scene, const Look& look,
                                         const Options& options, Executor& executor,
                                         Progress& progress, Stats* stats = nullptr);

}  // namespace raymo::render
