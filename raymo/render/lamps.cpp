#include "raymo/render/lamps.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace raymo::render {
namespace {

/// More shadow rays than this show no more shades in 8 bits.
constexpr int kMostSamples = 4096;

double cosine_of(double degrees) {
    return std::cos(std::clamp(degrees, 0.0, 180.0) * std::numbers::pi / 180.0);
}

}  // namespace

Lamp::Lamp(const scene::Light& light, bool at_once)
    : kind_(light.kind),
      direction_(light.direction == Vec3{} ? Vec3{0, 0, 1} : -unit(light.direction)),
      position_(light.position),
      edge_u_(light.edge_u),
      edge_v_(light.edge_v),
      power_(light.color * light.power),
      shadows_(light.shadows) {
    if (kind_ == scene::LightKind::spot) {
        cosine_full_ = cosine_of(light.cone_angle);
        cosine_none_ = cosine_of(light.cone_angle + std::max(light.blur, 0.0));
    }
    if (kind_ == scene::LightKind::area && !at_once) {
        samples_ = std::clamp(light.samples, 1, kMostSamples);
    }
}

bool Lamp::arrive_from_place(Vec3 point, Point2 s, Arrival& out) const {
    Vec3 place = position_;
    if (kind_ == scene::LightKind::area) place += edge_u_ * s.u + edge_v_ * s.v;
    const Vec3 way = place - point;
    const double squared = dot(way, way);
    if (!(squared > 0.0)) return false;
    out.distance = std::sqrt(squared);
    out.direction = way * (1.0 / out.distance);
    out.power = power_;
    if (kind_ == scene::LightKind::spot) {
        const double cosine = dot(out.direction, direction_);
        if (cosine < cosine_none_) return false;
        if (cosine < cosine_full_) {
            const double x = (cosine - cosine_none_) / (cosine_full_ - cosine_none_);
            out.power *= x * x * (3.0 - 2.0 * x);
        }
    }
    return true;
}

std::vector<Lamp> prepared(const std::vector<scene::Light>& lights, bool at_once) {
    std::vector<Lamp> lamps;
    for (const scene::Light& light : lights) {
        if (max_norm(light.color * light.power) > 0.0) lamps.emplace_back(light, at_once);
    }
    return lamps;
}

}  // namespace raymo::render
