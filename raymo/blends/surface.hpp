// The surfaces that blends join, each with a signed distance: planes, spheres, cylinders, cones and tori, and the walls that a
// free-form curve sweeps along a line, about an axis or towards a point.
//
// A leaning wall is swept towards its apex. With the apex in the origin and the curve P(u) in the plane z = h, the foot of a
// point d lies on the ruling D(u) = (P, h) that is seen from the apex at the least angle from d: where d.D / |D| is largest,
//     (d.D') (D.D) = (d.D) (D.D').
// There d - D (d.D) / (D.D) stands on D and D', so that the distance is (d - D).n along the normal n across both.
#pragma once

#include <cstdint>
#include <string_view>

#include "raymo/blends/profile.hpp"
#include "raymo/math/vec.hpp"

namespace raymo::blends {

enum class SurfaceKind : std::uint8_t {
    plane,
    sphere,
    cylinder,
    cone,
    torus,
    wall,
    turned,
    leaning
};

/// "plane", "sphere", ...
[[nodiscard]] std::string_view kind_name(SurfaceKind kind);

/// One of these surfaces. `distance` is negative on the inner side: below a plane's normal, within a sphere, a cylinder,
/// a cone's nappe or a torus' tube, and to the left of a curve.
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
    RunPtr
        run;  ///< of walls, in (across, up) from `point`; of what is turned, in (radius, height above `point`)
    Vec3 across, up{};    ///< of walls: unit
    double height = 0.0;  ///< of a leaning wall: from its apex, along the axis, to `point`

    /// Euclidean, and exact but for rounding; of a cone and behind its apex: to the cone run through without end.
    [[nodiscard]] double distance(Vec3 p) const;
    /// What it takes to tell a distance or a normal, in units of some 100 ns.
    [[nodiscard]] double work() const { return is_free() ? 25.0 : 0.3; }
    /// Whether it is made of a free-form curve.
    [[nodiscard]] bool is_free() const { return run != nullptr; }
    /// Unit; the direction in which the distance grows. On an axis any of the directions across.
    [[nodiscard]] Vec3 normal(Vec3 p) const;
    /// No principal radius of curvature of the surface's parallel through p is smaller [mm]; 0 where none is known.
    [[nodiscard]] double least_round(Vec3 p) const;
    /// A point of the plane of a wall's run.
    [[nodiscard]] Vec3 place(Vec2 q) const { return point + across * q.x + up * q.y; }
    /// The apex of a leaning wall.
    [[nodiscard]] Vec3 apex() const { return point - axis * height; }
};

}  // namespace raymo::blends
