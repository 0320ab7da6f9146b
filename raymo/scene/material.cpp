#include "raymo/scene/material.hpp"

#include <cmath>

namespace raymo::scene {
namespace {

/// The decoding of IEC 61966-2-1, continued below 0 by its straight part.
double decode(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }

}  // namespace

Colour from_srgb(Vec3 srgb) { return {decode(srgb.x), decode(srgb.y), decode(srgb.z)}; }

}  // namespace raymo::scene
