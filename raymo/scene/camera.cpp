#include "raymo/scene/camera.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace raymo::scene {
namespace {

/// Unit vector along `v`, or `fallback` when v has no direction.
Vec3 direction_or(Vec3 v, Vec3 fallback) {
    return is_finite(v) && max_norm(v) > 0.0 ? unit(v) : fallback;
}

/// Unit vector to the right of the line of sight. Where `up` lies along that line another one
/// stands in for it.
Vec3 right_of(Vec3 forward, Vec3 up) {
    for (const Vec3 candidate : {direction_or(up, {0, 0, 1}), Vec3{0, 1, 0}, Vec3{1, 0, 0}}) {
        const Vec3 right = cross(forward, candidate);
        if (max_norm(right) > 1e-9) return unit(right);
    }
    return {1, 0, 0};
}

/// Point of the unit disc for a point of the unit square, area to area, so that stratified points
/// stay stratified. Source: [ShirleyChiu97].
void to_disc(double u, double v, double& x, double& y) {
    const double a = 2.0 * u - 1.0;
    const double b = 2.0 * v - 1.0;
    if (a == 0.0 && b == 0.0) {
        x = y = 0.0;
        return;
    }
    const bool wide = std::fabs(a) > std::fabs(b);
    const double r = wide ? a : b;
    const double angle = wide ? std::numbers::pi / 4.0 * (b / a)
                              : std::numbers::pi / 2.0 - std::numbers::pi / 4.0 * (a / b);
    x = r * std::cos(angle);
    y = r * std::sin(angle);
}

}  // namespace

View::View(const Camera& camera, int width, int height)
    : eye_(camera.eye), parallel_(camera.projection == Projection::parallel) {
    const double w = std::max(width, 1);
    const double h = std::max(height, 1);
    const double larger = std::max(w, h);
    forward_ = direction_or(camera.look_at - camera.eye, {0, 0, -1});
    const Vec3 right = right_of(forward_, camera.up);
    const Vec3 up = cross(right, forward_);
    const double extent =
        parallel_ ? camera.height : 2.0 * std::tan(0.5 * camera.angle * std::numbers::pi / 180.0);
    const double pixel = extent / larger;
    step_x_ = right * pixel;
    step_y_ = up * -pixel;
    corner_ = step_x_ * (-0.5 * w) + step_y_ * (-0.5 * h);
    if (!parallel_) corner_ += forward_;
    const double radius = 0.5 * camera.aperture;
    lens_x_ = right * radius;
    lens_y_ = up * radius;
    focus_ = camera.focus > 0.0 ? camera.focus : norm(camera.look_at - camera.eye);
}

Ray View::ray(double x, double y) const {
    const Vec3 d = corner_ + step_x_ * x + step_y_ * y;
    if (parallel_) return {eye_ + d, forward_};
    return {eye_, d * (1.0 / std::sqrt(dot(d, d)))};
}

Ray View::ray(double x, double y, double lens_u, double lens_v) const {
    const Vec3 d = corner_ + step_x_ * x + step_y_ * y;
    double u;
    double v;
    to_disc(lens_u, lens_v, u, v);
    const Vec3 offset = lens_x_ * u + lens_y_ * v;
    const Vec3 origin = (parallel_ ? eye_ + d : eye_) + offset;
    // The point of the sharp plane that the middle of the lens sees, from where the ray now starts.
    const Vec3 aim = (parallel_ ? forward_ : d) * focus_ - offset;
    return {origin, unit(aim)};
}

}  // namespace raymo::scene
