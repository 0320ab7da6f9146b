#include "raymo/render/render.hpp"

#include <algorithm>

#include "raymo/render/tiles.hpp"

namespace raymo::render {
namespace {

/// 12 bytes a pixel: what still fits into the memory of the machines this is made for.
constexpr double kMostPixels = 1 << 28;

}  // namespace

Look look_of(const scene::Scene& scene, const Aabb& bounds, double aspect, std::size_t view) {
    Look look;
    look.camera = scene.cameras.empty()
                      ? scene::fitted_camera(bounds, aspect)
                      : scene.cameras[std::min(view, scene.cameras.size() - 1)].camera;
    look.lights = scene.lights.empty() ? scene::default_lights(bounds, look.camera) : scene.lights;
    look.ambient = scene.ambient.value_or(scene::default_ambient());
    look.background = scene.background.value_or(scene::default_background());
    return look;
}

Result<image::Film> render(const trace::CompiledScene& scene, const Look& look,
                           const Options& options, Executor& executor, Progress& progress,
                           Stats* stats) {
    if (options.width < 1 || options.height < 1) {
        return fail(ErrorCode::out_of_range, "picture: width and height must be at least 1");
    }
    if (static_cast<double>(options.width) * options.height > kMostPixels) {
        return fail(ErrorCode::limit, "picture: more than 268 million pixels",
                    "ask for a smaller --size");
    }
    const Stage stage(scene, look, options);
    const scene::View view(look.camera, options.width, options.height);
    Crew crew(stage, executor, progress);
    image::Film film(options.width, options.height,
                     is_uniform(options, look.camera) ? options.kept : image::Kept::light);
    const Sitting sitting{stage, view, look.camera, options, crew, film};
    bool done = false;
    if (options.samples > 0 || options.quality == Quality::final) {
        done = draw_final(sitting);
    } else if (options.quality == Quality::preview) {
        done = draw_preview(sitting);
    } else {
        done = draw_draft(sitting);
    }
    if (stats != nullptr) stats->rays = crew.counts();
    if (!done) return fail(ErrorCode::cancelled, "picture: stopped before it was finished");
    return film;
}

}  // namespace raymo::render
