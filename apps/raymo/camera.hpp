// The camera that the command line asks for.
#pragma once

#include "apps/raymo/options.hpp"
#include "raymo/math/aabb.hpp"
#include "raymo/scene/scene.hpp"

namespace raymo::app {

/// The scene's camera of the wished name (its first one, or one fitted to `box`), changed as wished.
/// Trouble: no view of that name; a camera that looks nowhere.
[[nodiscard]] Attempt<scene::Camera> wished_camera(const scene::Scene& scene,
                                                   const CameraWish& wish, const Aabb& box,
                                                   double aspect);

}  // namespace raymo::app
