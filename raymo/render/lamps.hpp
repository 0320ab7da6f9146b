// Lights with all that does not depend on the surface worked out.
#pragma once

#include <limits>
#include <vector>

#include "raymo/render/sampling.hpp"
#include "raymo/scene/light.hpp"

namespace raymo::render {

/// Light that arrives at a point from one place.
struct Arrival {
    Vec3 direction;  ///< from the point to the light, unit
    double distance = std::numeric_limits<double>::infinity();
    scene::Colour power;  ///< radiance of a white diffuse surface that faces it
};

class Lamp {
public:
    /// `at_once`: area lights are asked for one sample only, in their middle.
    Lamp(const scene::Light& light, bool at_once);

    [[nodiscard]] bool shadows() const { return shadows_; }
    /// Samples of one hit that share the lamp's power; 1 but for area lights.
    [[nodiscard]] int samples() const { return samples_; }
    /// True for lamps whose light depends on the sample.
    [[nodiscard]] bool is_area() const { return kind_ == scene::LightKind::area && samples_ > 1; }
    /// What arrives at `point`; of area lights from their place `s`, which gives their whole power.
    /// False: nothing.
    [[nodiscard]] bool arrive(Vec3 point, Point2 s, Arrival& out) const {
        if (kind_ == scene::LightKind::directional) {
            out.direction = direction_;
            out.distance = std::numeric_limits<double>::infinity();
            out.power = power_;
            return true;
        }
        return arrive_from_place(point, s, out);
    }

private:
    [[nodiscard]] bool arrive_from_place(Vec3 point, Point2 s, Arrival& out) const;

    scene::LightKind kind_;
    Vec3 direction_;  ///< towards the light
    Vec3 position_;
    Vec3 edge_u_;
    Vec3 edge_v_;
    scene::Colour power_;
    double cosine_full_ = -1.0;  ///< spot: full light within this angle
    double cosine_none_ = -1.0;  ///< and none outside of this
    int samples_ = 1;
    bool shadows_;
};

/// The lamps that shine at all.
[[nodiscard]] std::vector<Lamp> prepared(const std::vector<scene::Light>& lights, bool at_once);

}  // namespace raymo::render
