#include "apps/raymo/camera.hpp"

#include <cmath>
#include <numbers>

#include "apps/raymo/text.hpp"

namespace raymo::app {
namespace {

double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

Attempt<scene::Camera> chosen(const scene::Scene& scene, const CameraWish& wish, const Aabb& box,
                              double aspect) {
    if (!wish.view.empty()) {
        std::vector<std::string> known;
        for (const scene::NamedCamera& c : scene.cameras) {
            if (c.name == wish.view) return c.camera;
            known.push_back(c.name);
        }
        std::string hint = did_you_mean(wish.view, known);
        if (hint.empty())
            hint = known.empty() ? "the model has no views"
                                 : "its first view is " + in_quotes(known[0]);
        return trouble(kCommandWrong, "the model has no view " + in_quotes(wish.view), hint);
    }
    if (!wish.fit && !scene.cameras.empty()) return scene.cameras[0].camera;
    scene::Camera camera = scene::fitted_camera(box, aspect);
    if (wish.azimuth || wish.elevation) {
        constexpr double kAzimuth = -60.0;
        constexpr double kElevation = 28.0;
        camera = scene::fitted_camera(box, aspect, wish.azimuth.value_or(kAzimuth),
                                      wish.elevation.value_or(kElevation));
    }
    return camera;
}

}  // namespace

Attempt<scene::Camera> wished_camera(const scene::Scene& scene, const CameraWish& wish,
                                     const Aabb& box, double aspect) {
    Attempt<scene::Camera> camera = chosen(scene, wish, box, aspect);
    if (!camera) return camera;
    scene::Camera& c = *camera;
    const bool fitted = wish.fit || (scene.cameras.empty() && wish.view.empty());
    if (wish.angle) {
        // A fitted camera steps back or forward, so that a ball around the model fills the same part of the picture.
        if (fitted && !wish.eye) {
            const double ratio =
                std::sin(radians(c.angle) / 2) / std::sin(radians(*wish.angle) / 2);
            c.eye = c.look_at + (c.eye - c.look_at) * ratio;
        }
        c.angle = *wish.angle;
    }
    if (wish.eye) c.eye = *wish.eye;
    if (wish.look_at) c.look_at = *wish.look_at;
    if (wish.projection && *wish.projection != c.projection) {
        if (*wish.projection == scene::Projection::parallel) {
            // What is looked at keeps its size in the picture.
            c.height = 2.0 * norm(c.look_at - c.eye) * std::tan(radians(c.angle) / 2);
        }
        c.projection = *wish.projection;
    }
    const Vec3 sight = c.look_at - c.eye;
    if (!(max_norm(sight) > 0.0) || !is_finite(sight)) {
        return trouble(kCommandWrong, "the camera stands where it looks at: " + json_vector(c.eye),
                       "give --eye and --look-at two different points");
    }
    const auto along_sight = [&](Vec3 up) {
        return !(max_norm(up) > 0.0) || norm(cross(unit(up), unit(sight))) < 1e-9;
    };
    if (wish.up) {
        c.up = *wish.up;
        if (along_sight(c.up)) {
            return trouble(kCommandWrong,
                           "--up: " + json_vector(c.up) + " points along the line of sight",
                           "give a direction across the line of sight");
        }
    } else if (along_sight(c.up)) {
        c.up = {0, 1, 0};  // seen from straight above or below
        if (along_sight(c.up)) c.up = {0, 0, 1};
    }
    return camera;
}

}  // namespace raymo::app
