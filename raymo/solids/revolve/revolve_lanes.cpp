// Rays side by side against a turned contour. This file includes itself once for each instruction set (Highway's
// foreach_target).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raymo/solids/revolve/revolve_lanes.cpp"
#include "raymo/math/targets.hpp"
//
#include <hwy/foreach_target.h>  // must stand before highway.h
#include <hwy/highway.h>

#include <limits>

#include "raymo/math/lanes.hpp"
#include "raymo/math/tolerance.hpp"
#include "raymo/solids/crossings.hpp"
#include "raymo/solids/ray_block.hpp"
#include "raymo/solids/revolve/profile_line.hpp"
#include "raymo/solids/revolve/revolve.hpp"

HWY_BEFORE_NAMESPACE();
namespace raymo::solids {
namespace HWY_NAMESPACE {
#include "raymo/math/lanes-inl.hpp"
#include "raymo/math/triple.inl"
#include "raymo/solids/ray_block-inl.hpp"
#include "raymo/solids/swept_kernels.inl"
//
#include "raymo/solids/revolve/kernel.inl"

void revolve_block(const Revolve::Kernel& k, const RayBlock& rays, std::uint32_t asked,
                   SpanBlock& out) {
    answer(rays, asked, out,
           [&](const LocalRay<Lanes>& ray, Mask here, auto& spans, Mask& left_over)
               RAYMO_INLINE_BODY {
                   return revolve_spans(k.region(), k.angle(), k.end_normal(), ray, here, spans,
                                        left_over);
               });
}

void revolve_places(const Revolve::Kernel& k, PlaceBlock& places, std::uint32_t asked) {
    turn_into_normals(
        places, asked,
        [&](Lanes face, Mask here, Triple<Lanes>& p) RAYMO_INLINE_BODY {
            return revolve_normals(k.region(), k.end_normal(), face, here, p);
        },
        [&](Vec3 p, std::uint16_t face) { return k.normal_in_full(p, face); });
}

}  // namespace HWY_NAMESPACE
}  // namespace raymo::solids
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace raymo::solids {

HWY_EXPORT(revolve_block);
HWY_EXPORT(revolve_places);

void Revolve::Kernel::spans(const RayBlock& rays, std::uint32_t asked, SpanBlock& out) const {
    HWY_DYNAMIC_DISPATCH(revolve_block)(*this, rays, asked, out);
}
void Revolve::Kernel::normals(PlaceBlock& places, std::uint32_t asked) const {
    HWY_DYNAMIC_DISPATCH(revolve_places)(*this, places, asked);
}

}  // namespace raymo::solids
#endif
