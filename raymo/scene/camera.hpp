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
    Vec3 up{0, 0, 1};     ///< must not be parallel to the line of sight
    double angle = 30.0;  ///< perspective: full angle of view over the picture's larger side
                          ///< [degrees], 0 < angle < 180
    Projection projection = Projection::perspective;
    double height = 100.0;  ///< parallel: extent of the picture's larger side [mm]
    double aperture = 0.0;  ///< diameter of the lens [mm]; 0: everything sharp
    double focus = 0.0;     ///< distance of the sharp plane; 0: look_at
    double shutter = 0.0;   ///< kept for animation

    friend bool operator==(const Camera&, const Camera&) = default;
};

/// Camera prepared for one picture size.
class View {
public:
    View(const Camera& camera, int width, int height);
    /// Ray through the picture at (x, y) in pixels, (0, 0) being the upper left corner of the
    /// picture. The direction has unit length.
    [[nodiscard]] Ray ray(double x, double y) const;
    /// The same through the point (lens_u, lens_v), both 0..1, of the lens; (0.5, 0.5) is its
    /// middle. All rays of one (x, y) meet in the sharp plane.
    [[nodiscard]] Ray ray(double x, double y, double lens_u, double lens_v) const;

    // ray(x, y) starts in eye() and goes along d = corner() + x step_x() + y step_y(), made unit; if parallel, it starts in
    // eye() + d and goes along forward(). For those who compute many at once.
    [[nodiscard]] Vec3 eye() const { return eye_; }
    [[nodiscard]] Vec3 corner() const { return corner_; }
    [[nodiscard]] Vec3 step_x() const { return step_x_; }
    [[nodiscard]] Vec3 step_y() const { return step_y_; }
    [[nodiscard]] Vec3 forward() const { return forward_; }
    [[nodiscard]] bool parallel() const { return parallel_; }

private:
    Vec3 eye_, corner_, step_x_, step_y_, forward_, lens_x_, lens_y_;
    double focus_;
    bool parallel_;
};

}  // namespace raymo::scene
