// What a model gets that says nothing about its look: the light of a small photo studio.
//
// Fitting a perspective camera. In axes along the view (x right, y up, z forward) a corner c is in
// a picture of half widths tx, ty (tangents) seen from e when  |c.x - e.x| <= tx (c.z - e.z)  and
// the same in y. With
//     A = max(c.x - tx c.z),  B = max(-c.x - tx c.z)  over the corners
// the two conditions in x say  A <= e.x - tx e.z  and  B <= -e.x - tx e.z,  hence the nearest eye
// that holds them has
//     e.x = (A - B) / 2,   e.z = -(A + B) / (2 tx).
// The same for y; the farther of both e.z fits all eight corners, and touches the picture's margin
// on two sides.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "raymo/scene/scene.hpp"

namespace raymo::scene {
namespace {

constexpr double kFieldOfView = 30.0;  ///< [degrees] a short telephoto lens: little distortion
constexpr double kMargin = 0.88;       ///< part of the picture that the box may fill

std::array<Vec3, 8> corners(const Aabb& box) {
    std::array<Vec3, 8> all;
    for (std::size_t i = 0; i < 8; ++i) {
        all[i] = {(i & 1) != 0 ? box.hi.x : box.lo.x, (i & 2) != 0 ? box.hi.y : box.lo.y,
                  (i & 4) != 0 ? box.hi.z : box.lo.z};
    }
    return all;
}

/// Eye coordinate across, and along the view, that just fit the corners in one direction of the
/// picture.
struct Fit {
    double across;
    double along;
};
Fit fit(const std::array<Vec3, 8>& points, Vec3 centre, Vec3 axis, Vec3 forward, double tangent) {
    double a = -Aabb::kInf;
    double b = -Aabb::kInf;
    for (const Vec3 p : points) {
        const double x = dot(p - centre, axis);
        const double z = dot(p - centre, forward);
        a = std::max(a, x - tangent * z);
        b = std::max(b, -x - tangent * z);
    }
    return {0.5 * (a - b), -0.5 * (a + b) / tangent};
}

/// Half the diagonal of the box; 1 for a box that has none.
double radius_of(const Aabb& box) {
    if (box.empty() || !box.bounded()) return 1.0;
    const double r = 0.5 * norm(box.size());
    return r > 0.0 ? r : 1.0;
}

Vec3 centre_of(const Aabb& box) { return box.empty() || !box.bounded() ? Vec3{} : box.centre(); }

}  // namespace

const Material& default_material() {
    static const Material kMaterial{.color = {0.66, 0.66, 0.67},
                                    .diffuse = 0.9,
                                    .specular = 0.05,
                                    .roughness = 0.25,
                                    .absorption = {},
                                    .name = "default"};
    return kMaterial;
}

Camera fitted_camera(const Aabb& box, double aspect, double azimuth, double elevation) {
    const SinCos az = sin_cos_degrees(azimuth);
    const SinCos el = sin_cos_degrees(elevation);
    const Vec3 forward{-el.cos * az.cos, -el.cos * az.sin, -el.sin};
    const Vec3 up{-el.sin * az.cos, -el.sin * az.sin, el.cos};
    const Vec3 right = cross(forward, up);

    Camera camera;
    camera.angle = kFieldOfView;
    // Straight from above or below the vertical is no upward direction; else it is the better one
    // to show and to edit.
    camera.up = std::fabs(el.cos) > 1e-3 ? Vec3{0, 0, std::copysign(1.0, el.cos)} : up;

    const Vec3 centre = centre_of(box);
    const double radius = radius_of(box);
    Aabb shown{centre, centre};
    if (!box.empty() && box.bounded() && norm(box.size()) > 0.0) shown = box;
    if (shown.lo == shown.hi) shown = grown(shown, radius);

    const double tangent = kMargin * std::tan(0.5 * kFieldOfView * std::numbers::pi / 180.0);
    const double ratio = aspect > 0.0 && std::isfinite(aspect) ? aspect : 1.0;
    const std::array<Vec3, 8> points = corners(shown);
    const Fit x = fit(points, centre, right, forward, ratio >= 1.0 ? tangent : tangent * ratio);
    const Fit y = fit(points, centre, up, forward, ratio >= 1.0 ? tangent / ratio : tangent);
    const double along = std::min(x.along, y.along);
    const Vec3 axis = centre + right * x.across + up * y.across;
    camera.eye = axis + forward * along;
    camera.look_at = axis;
    camera.height = 2.0 * radius / kMargin;
    return camera;
}

std::vector<Light> default_lights(const Aabb& box, const Camera& camera) {
    const Vec3 centre = centre_of(box);
    const double radius = radius_of(box);
    Vec3 forward = camera.look_at - camera.eye;
    forward = max_norm(forward) > 0.0 ? unit(forward) : Vec3{0, 0, -1};
    Vec3 right = cross(forward, camera.up);
    if (!(max_norm(right) > 1e-9 * max_norm(camera.up))) {
        Vec3 unused;
        make_frame(forward, right, unused);
    }
    right = unit(right);
    const Vec3 up = cross(right, forward);
    /// From the model to the light, in the camera's axes: right, up, towards the eye.
    const auto towards = [&](double x, double y, double z) {
        return unit(right * x + up * y - forward * z);
    };

    // A large soft key from the upper left, a wide fill beside the lens on the other side, and a
    // rim from behind.
    const Vec3 key = towards(-0.8, 0.8, 0.75);
    Vec3 s;
    Vec3 t;
    make_frame(key, s, t);
    const double side = 1.8 * radius;
    const Vec3 middle = centre + key * (6.0 * radius);
    return {Light{.kind = LightKind::area,
                  .position = middle - (s + t) * (0.5 * side),
                  .direction = -key,
                  .power = 1.2,
                  .color = {1.0, 0.97, 0.93},
                  .edge_u = s * side,
                  .edge_v = t * side,
                  .samples = 16},
            Light{.kind = LightKind::directional,
                  .position = {},
                  .direction = -towards(0.9, 0.1, 1.0),
                  .power = 0.22,
                  .color = {0.93, 0.96, 1.0},
                  .edge_u = {},
                  .edge_v = {},
                  .shadows = false},
            Light{.kind = LightKind::directional,
                  .position = {},
                  .direction = -towards(0.55, 0.6, -0.85),
                  .power = 0.35,
                  .color = {0.96, 0.98, 1.0},
                  .edge_u = {},
                  .edge_v = {}}};
}

Colour default_ambient() { return {0.12, 0.13, 0.145}; }

Background default_background() { return {{0.56, 0.58, 0.61}, {1.15, 1.15, 1.15}}; }

}  // namespace raymo::scene
