// Models whose number of leaves can be chosen, for measuring how the cost of a ray grows with it.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "raymo/scene/scene.hpp"

namespace raymo::bench {

/// One family of models. All members look alike from afar: same overall size, same camera, more and
/// smaller leaves.
struct Family {
    std::string_view name;
    std::string_view what;
    /// The model with about `leaves` leaves.
    Result<csg::Solid> (*build)(std::size_t leaves);
    scene::Camera camera;
    std::span<const std::size_t> sizes;
    int coarser =
        1;  ///< the picture has so many times fewer pixels each way, where rays are expensive
};

[[nodiscard]] std::span<const Family> families();

}  // namespace raymo::bench
