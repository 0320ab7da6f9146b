// The surfaces that blends join: planes, spheres, cylinders, cones and tori, each with a signed distance.
#pragma once

#include <cstdint>
#include <string_view>

#include "raymo/math/vec.hpp"

namespace raymo::blends {

enum class SurfaceKind : std::uint8_t { plane, sphere, cylinder, cone, torus };

/// "plane", "sphere", ...
[[nodiscard]] std::string_view kind_name(SurfaceKind kind);

/// One of the five surfaces. `distance` is negative on the inner side: below a plane's normal, within a sphere, a cylinder,
/// a cone's nappe or a torus' tube.
struct Surface {
    SurfaceKind kind = SurfaceKind::plane;
    Vec3
        point;  ///< of the plane, on the axis of the cylinder; centre of sphere and torus; apex of the cone
    Vec3 axis{0, 0,
              1};  ///< unit: the plane's normal, the axis of the others; the cone opens along it
    double radius = 0.0;  ///< of sphere and cylinder; from a torus' axis to the middle of its tube
    double tube = 0.0;    ///< radius of the torus' tube
    double sine = 0.0;    ///< of the cone's half angle
    double cosine = 1.0;

    /// Euclidean, and exact but for rounding; of a cone and behind its apex: to the cone run through without end.
    [[nodiscard]] double distance(Vec3 p) const;
    /// Unit; the direction in which the distance grows. On an axis any of the directions across.
    [[nodiscard]] Vec3 normal(Vec3 p) const;
};

}  // namespace raymo::blends
