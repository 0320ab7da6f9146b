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
#include "raymo/solids/sweep/kernel.inl"

/// Slabs of the lines that are `asked`.
HWY_INLINE void slabs_of(const SweepLines<Lanes, Mask>& lines, std::uint32_t asked,
                         Slabs (&out)[8]) {
    alignas(64) double o[3][8], along[3][8], error[8], past[8];
    store(lines.o.x, o[0]);
    store(lines.o.y, o[1]);
    store(lines.o.z, o[2]);
    store(lines.along.x, along[0]);
    store(lines.along.y, along[1]);
    store(lines.along.z, along[2]);
    store(lines.error, error);
    store(lines.past, past);
    for (; asked != 0; asked &= asked - 1) {
        const int i = __builtin_ctz(asked);
        out[i] = Slabs({o[0][i], o[1][i], o[2][i]}, {along[0][i], along[1][i], along[2][i]},
                       error[i], past[i]);
    }
}

HWY_INLINE int sweep_spans(const SweptSpheres& spheres, const LocalRay<Lanes>& ray, Mask asked,
                           LaneSpans<Lanes, Mask, kSweptSpans>& out, Mask& left_over) {
    LaneChords<Lanes, Mask> found(mask_of(0));
    SweepLines<Lanes, Mask> lines = sweep_lines<Lanes, Mask>(ray, found);
    Slabs slabs[8];
    slabs_of(lines, bits(asked), slabs);
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
        std::uint32_t met[SweptNode::kWidth] = {};
        std::uint32_t any = 0;
        for (std::uint32_t rest = here; rest != 0; rest &= rest - 1) {
            const int i = __builtin_ctz(rest);
            std::uint32_t children = slabs[i].met(node);
            any |= children;
            for (; children != 0; children &= children - 1) met[__builtin_ctz(children)] |= 1U << i;
        }
        for (; any != 0; any &= any - 1) {
            const auto c = static_cast<std::uint32_t>(__builtin_ctz(any));
            const auto child = static_cast<std::uint32_t>(at.node * SweptNode::kWidth + c);
            if (at.level > 0) {
                open[count++] = {at.level - 1, child, met[c]};
            } else {
                lines.meet(spheres.pieces[child], lane_and(mask_of(met[c]), lane_not(found.rest)));
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
