// Rays side by side against a sweep. This file includes itself once for each instruction set (Highway's foreach_target).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raymo/solids/sweep/sweep_lanes.cpp"
#include "raymo/math/targets.hpp"
//
#include <hwy/foreach_target.h>  // must stand before highway.h
#include <hwy/highway.h>

#include <limits>

#include "raymo/math/lanes.hpp"
#include "raymo/math/tolerance.hpp"
#include "raymo/solids/ray_block.hpp"
#include "raymo/solids/sweep/slabs.hpp"
#include "raymo/solids/sweep/sweep.hpp"

HWY_BEFORE_NAMESPACE();
namespace raymo::solids {
namespace HWY_NAMESPACE {
#include "raymo/math/lanes-inl.hpp"
#include "raymo/math/triple.inl"
#include "raymo/solids/interval.inl"
//
#include "raymo/solids/ray_block-inl.hpp"
#include "raymo/solids/slabs-inl.hpp"
#include "raymo/solids/sweep/kernel.inl"

HWY_INLINE int sweep_spans(const SweptSpheres& spheres, const LocalRay<Lanes>& ray, Mask asked,
                           LaneSpans<Lanes, Mask, kSweptSpans>& out, Mask& left_over) {
    LaneChords<Lanes, Mask> found(mask_of(0));
    SweepLines<Lanes, Mask> lines = sweep_lines<Lanes, Mask>(ray, found);
    SlabLanes slabs{};  // vectors may hold fewer lines than eight
    set_slabs(lines.o, lines.along, lines.error, lines.past, 0, slabs);
    struct Todo {
        std::uint32_t level, node, lanes;
    };
    std::array<Todo, kMostWaiting> open;
    std::size_t count = 0;
    open[count++] = {static_cast<std::uint32_t>(spheres.levels.size() - 1), 0, bits(asked)};
    while (count > 0) {
        const Todo at = open[--count];
        const std::uint32_t here = at.lanes & ~bits(found.rest);
        const SweptNode& node = spheres.levels[at.level][at.node];
        for (std::uint32_t c = 0; c < SweptNode::kWidth; ++c) {
            const std::uint32_t there = here & met(slabs, node, c);
            if (there == 0) continue;
            const auto child = static_cast<std::uint32_t>(at.node * SweptNode::kWidth + c);
            if (at.level > 0) {
                open[count++] = {at.level - 1, child, there};
            } else {
                lines.meet(spheres.pieces[child], lane_and(mask_of(there), lane_not(found.rest)));
            }
        }
    }
    const Mask plain = lane_and(asked, lane_not(found.rest));
    const int spans = found.spans(plain, lane_sqrt(ray.dd), sweep_limit(ray), out);
    left_over = lane_and(asked, found.rest);
    return spans;
}

void sweep_block(const SweptSpheres& spheres, const RayBlock& rays, std::uint32_t asked,
                 SpanBlock& out) {
    answer(rays, asked, out,
           [&](const LocalRay<Lanes>& ray, Mask here, auto& spans, Mask& left_over)
               RAYMO_INLINE_BODY { return sweep_spans(spheres, ray, here, spans, left_over); });
}

}  // namespace HWY_NAMESPACE
}  // namespace raymo::solids
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace raymo::solids {

HWY_EXPORT(sweep_block);

void Sweep::Kernel::spans(const RayBlock& rays, std::uint32_t asked, SpanBlock& out) const {
    HWY_DYNAMIC_DISPATCH(sweep_block)(*spheres_, rays, asked, out);
}

}  // namespace raymo::solids
#endif
