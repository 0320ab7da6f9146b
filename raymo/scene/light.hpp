// Lights: data only.
#pragma once

#include <cstdint>

#include "raymo/scene/material.hpp"

namespace raymo::scene {

enum class LightKind : std::uint8_t {
    point,        ///< shines from `position` in all directions, without falling off with distance
    directional,  ///< shines along `direction` from infinitely far away
    spot,         ///< like point, within a cone about `direction`
    area,         ///< a parallelogram: position + u*edge_u + v*edge_v, u, v in 0..1
};

struct Light {
    LightKind kind = LightKind::point;
    Vec3 position;
    Vec3 direction{0, 0, -1};  ///< the way the light goes; unit length
    double power = 1.0;  ///< radiance reflected by a white diffuse surface that faces the light
    Colour color{1, 1, 1};
    double cone_angle = 30.0;  ///< spot: half angle of full light [degrees]
    double blur = 5.0;         ///< spot: further degrees over which it fades to nothing
    Vec3 edge_u, edge_v;       ///< area
    int samples = 16;          ///< area: shadow rays per hit
    bool shadows = true;

    friend bool operator==(const Light&, const Light&) = default;
};

}  // namespace raymo::scene
