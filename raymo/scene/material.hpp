// How a surface looks: data only; the light model is in render/.
#pragma once

#include <cstdint>
#include <string>

#include "raymo/math/vec.hpp"

namespace raymo::scene {

/// Linear light, Rec. 709 primaries, 0 = black, 1 = white; may exceed 1.
using Colour = Vec3;

/// sRGB components 0..1 to linear light.
[[nodiscard]] Colour from_srgb(Vec3 srgb);

/// Distribution of facet slopes in the Torrance-Sparrow model [Blinn77].
enum class Facets : std::uint8_t { trowbridge_reitz, gaussian, phong };

/// Torrance-Sparrow surface with mirror reflection and transmission [Wijk86 2.2, 2.6]. All factors 0..1.
struct Material {
    Colour color{0.8, 0.8, 0.8};  ///< of diffuse reflection
    double diffuse = 0.9;         ///< part of light reflected diffusely
    double specular = 0.05;       ///< part that facets reflect at normal incidence: the highlight
    double roughness = 0.25;  ///< 0 sharp .. 1 dull: half-power angle of the facets in 45 degrees
    double metal = 0.0;       ///< 1: highlights and mirror images take the surface's colour
    double mirror = 0.0;      ///< weight of mirror reflection at normal incidence
    double transmission =
        0.0;  ///< part of light that passes (refraction); > 0 makes the material transparent
    double ior = 1.5;  ///< index of refraction, >= 1
    Vec3 absorption{
        0, 0, 0};  ///< per mm of path inside, per colour: light falls by exp(-absorption * length)
    Facets facets = Facets::trowbridge_reitz;
    std::string name;  ///< preset or colour the user asked for; shown by `rays --json`

    friend bool operator==(const Material&, const Material&) = default;
};

}  // namespace raymo::scene
