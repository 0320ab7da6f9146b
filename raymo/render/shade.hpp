// Shading of the hits of a packet side by side, compiled for each instruction set and chosen at run time. The formulas are those of
// light_model.hpp and lamps.hpp; what belongs to single rays, and the order of things, is in ray_shader.cpp.
#pragma once

#include <cstdint>

#include "raymo/render/lamps.hpp"
#include "raymo/render/light_model.hpp"
#include "raymo/scene/camera.hpp"
#include "raymo/scene/scene.hpp"
#include "raymo/trace/packet.hpp"

namespace raymo::render {

using trace::kRays;
using trace::LaneBits;

/// Rays through the points (x, y) of the picture, as View::ray gives them.
void eye_rays(const scene::View& view, const double (&x)[kRays], const double (&y)[kRays],
              trace::RayPacket& rays);

/// What lies around the model.
struct Surroundings {
    Colour ambient;
    scene::Background background;
};
/// What is seen in the unit directions `view` where nothing is.
void shade_background(const Surroundings& around, const double (&view)[3][kRays],
                      double (&light)[3][kRays]);

/// Which rays of a packet met the same material between the same media as ray `lane` did.
[[nodiscard]] LaneBits met_alike(const trace::HitPacket& hits, int lane);

/// Hits while they are shaded. Lanes beside those in use hold anything.
struct alignas(64) Spots {
    // What shade_surroundings() wants.
    const Surface* surface[kRays];
    double index[kRays];      ///< of refraction: behind over before; 1 where nothing is refracted
    double weight[3][kRays];  ///< of the light in the picture
    LaneBits tinted;          ///< surfaces that are
    LaneBits transparent;
    LaneBits mirrors;  ///< opaque ones that reflect images
    LaneBits dark;     ///< reflect no lamp's light
    LaneBits slow;     ///< facets of another distribution than Trowbridge and Reitz's
    bool same;         ///< all lanes have one surface
    // What it gives.
    double normal[3][kRays];  ///< on the viewer's side
    double nv[kRays];         ///< cosine of the angle of view
    double body[3][kRays];    ///< with what the interface took away
    double light[3][kRays];   ///< so far: ambient
    LaneBits lit;             ///< lamps count
};

/// Rays that go on from hits, by reflection or by refraction.
struct alignas(64) Onward {
    double d[3][kRays];
    double weight[3][kRays];
    LaneBits lanes;
};

/// All of a hit that does not depend on lamps. `view`: directions of the rays that met the surfaces.
void shade_surroundings(const Surroundings& around, const double (&view)[3][kRays],
                        const trace::HitPacket& hits, LaneBits lanes, Spots& spots,
                        Onward& reflected, Onward& refracted);

/// Which of the rays are worth tracing, of those in onward.lanes: their weight is at least `least`.
[[nodiscard]] LaneBits worth_tracing(const Onward& onward, double least);

/// What transparent surfaces that are met at `hits` leave of light that goes straight on along `view`: multiplies `left` by
/// transmission * (1 - fresnel(the cosine, ratio)) in the lanes named. `ratio` >= 1.
void shade_passage(const trace::HitPacket& hits, const double (&view)[3][kRays], LaneBits lanes,
                   const double (&transmission)[kRays], const double (&ratio)[kRays],
                   double (&left)[kRays]);

/// What hits get from a lamp that nothing hides.
struct alignas(64) Gains {
    double light[3][kRays];
    LaneBits lanes;  ///< that get anything that counts
};
/// One place of the lamp for all hits in `lanes`, in `places` for area lamps. Light whose weight is at most `least` does not
/// count. `shadows`: rays to the lamp.
void shade_by_lamp(const Lamp& lamp, const double (&view)[3][kRays], const trace::HitPacket& hits,
                   LaneBits lanes, const Spots& spots, double least, Gains& gains,
                   trace::RayPacket& shadows);
/// Adds to each hit the light of its own lane, of the lanes that get anything.
void add_gains(const Gains& gains, Spots& spots);
/// One hit, lane `hit`, and the places (u[i], v[i]) of the lamp for i in `lanes`.
void shade_by_lamp_places(const Lamp& lamp, const double (&view)[3][kRays],
                          const trace::HitPacket& hits, int hit, LaneBits lanes,
                          const double (&u)[kRays], const double (&v)[kRays], const Spots& spots,
                          double least, Gains& gains, trace::RayPacket& shadows);

}  // namespace raymo::render
