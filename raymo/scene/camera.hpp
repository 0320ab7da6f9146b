// Where a picture is taken from: data and the rays that follow from it.
#pragma once

#include <cstdint>

#include "raymo/math/ray.hpp"
#include "raymo/math/vec.hpp"

namespace raymo::scene {

enum class Projection : std::uint8_t { perspective, parallel };

struct Camera {
    Vec3 eye{100, -150, 100};
    Vec3 look_at;
    Vec3 up{0, 0, 1};           ///< must not be parallel to the line of sight
    double angle = 30.0;        ///< perspective: full angle of view over the picture's larger side [degrees], 0 < angle < 180
    Projection projection = Projection::perspective;
    double height = 100.0;      ///< parallel: extent of the picture's larger side [mm]
    double aperture = 0.0;      ///< diameter of the lens [mm]; 0: everything sharp
    double focus = 0.0;         ///< distance of the sharp plane; 0: look_at
    double shutter = 0.0;       ///< kept for animation

    friend bool operator==(const Camera&, const Camera&) = default;
};

/// Camera prepared for one picture size.
class View {
public:
    View(const Camera& camera, int width, int height);
    /// Ray through the picture at (x, y) in pixels, (0, 0) being the upper left corner of the picture.
    [[nodiscard]] Ray ray(double x, double y) const;

private:
    Vec3 eye_, corner_, step_x_, step_y_, forward_;
    bool parallel_;
};

}  // namespace raymo::scene
