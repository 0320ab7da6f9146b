#include "raymo/render/lamps.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "raymo/math/lanes.hpp"

namespace raymo::render {
namespace {

#include "raymo/render/light_model.inl"
//
#include "raymo/render/lamps.inl"

/// More shadow rays than this show no more shades in 8 bits.
constexpr int kMostSamples = 4096;

double cosine_of(double degrees) {
    return std::cos(std::clamp(degrees, 0.0, 180.0) * std::numbers::pi / 180.0);
}

}  // namespace

Lamp::Lamp(const scene::Light& light, bool at_once)
    : kind(light.kind),
      direction(light.direction == Vec3{} ? Vec3{0, 0, 1} : -unit(light.direction)),
      position(light.position),
      edge_u(light.edge_u),
      edge_v(light.edge_v),
      power(light.color * light.power),
      shadows(light.shadows) {
    if (kind == scene::LightKind::spot) {
        cosine_full = cosine_of(light.cone_angle);
        cosine_none = cosine_of(light.cone_angle + std::max(light.blur, 0.0));
    }
    if (kind == scene::LightKind::area && !at_once) {
        samples = std::clamp(light.samples, 1, kMostSamples);
    }
}

bool Lamp::arrive(Vec3 point, Point2 s, Arrival& out) const {
    bool there = true;
    const ArrivalOf<double> a =
        arrival<double, bool>(*this, {point.x, point.y, point.z}, s.u, s.v, there);
    out.direction = {a.direction.x, a.direction.y, a.direction.z};
    out.distance = a.distance;
    out.power = power * a.share;
    return there;
}

std::vector<Lamp> prepared(const std::vector<scene::Light>& lights, bool at_once) {
    std::vector<Lamp> lamps;
    for (const scene::Light& light : lights) {
        if (max_norm(light.color * light.power) > 0.0) lamps.emplace_back(light, at_once);
    }
    return lamps;
}

}  // namespace raymo::render
