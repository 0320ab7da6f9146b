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

/// A light with all that does not depend on the point worked out.
struct Lamp {
    /// `at_once`: area lights are asked for one sample only, in their middle.
    Lamp(const scene::Light& light, bool at_once);

    /// True for lamps whose light depends on the sample.
    [[nodiscard]] bool is_area() const { return kind == scene::LightKind::area && samples > 1; }
    /// What arrives at `point`; of area lights from their place `s`, which gives their whole power.
    /// False: nothing.
    [[nodiscard]] bool arrive(Vec3 point, Point2 s, Arrival& out) const;

    scene::LightKind kind;
    Vec3 direction;  ///< towards the light, unit
    Vec3 position;
    Vec3 edge_u;
    Vec3 edge_v;
    scene::Colour power;
    double cosine_full = -1.0;  ///< spot: full light within this angle
    double cosine_none = -1.0;  ///< and none outside of this
    int samples = 1;            ///< of one hit that share the lamp's power; 1 but for area lights
    bool shadows;
};

/// The lamps that shine at all.
[[nodiscard]] std::vector<Lamp> prepared(const std::vector<scene::Light>& lights, bool at_once);

}  // namespace raymo::render
