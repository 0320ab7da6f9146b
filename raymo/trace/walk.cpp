// One text for all instruction sets: this file includes itself once for each (Highway's
// foreach_target).
//
// A single ray is tested against the eight boxes of a node at once, and so is a packet as a whole (a beam); the rays of a
// packet are then tested against one box at a time. Leaves compute the rays of a packet side by side where their kernel can
// (solids/kernels.inl), with the same operations in the same order as for a single ray, so that
// both give equal bits. Boxes only choose what is looked at; they have no part in the result.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raymo/trace/walk.cpp"
#include "raymo/trace/walk.hpp"

#include "raymo/math/targets.hpp"
//
#include <hwy/foreach_target.h>  // must stand before highway.h
#include <hwy/highway.h>

#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

#include "raymo/math/lanes.hpp"
#include "raymo/math/tolerance.hpp"
#include "raymo/solids/ray_block.hpp"
#include "raymo/trace/base_ray.hpp"
#include "raymo/trace/blocks.hpp"
#include "raymo/trace/lane_kinds.hpp"
#include "raymo/trace/packet.hpp"

HWY_BEFORE_NAMESPACE();
namespace raymo::trace {
namespace HWY_NAMESPACE {
#include "raymo/math/lanes-inl.hpp"
using solids::BlockKernel;
using solids::LaneSpans;
using solids::LocalRay;
#include "raymo/math/triple.inl"
#include "raymo/solids/kernels.inl"
#include "raymo/trace/localise.inl"
//
#include "raymo/trace/boxes-inl.hpp"
#include "raymo/trace/leaves-inl.hpp"
#include "raymo/trace/surface.inl"
//
#include "raymo/trace/spans-inl.hpp"
//
#include "raymo/trace/finish-inl.hpp"
#include "raymo/trace/passages-inl.hpp"
//
#include "raymo/trace/nearest-inl.hpp"
#include "raymo/trace/prepare-inl.hpp"

/// Opens what lies nearest until every ray has its answer.
template <int L>
HWY_INLINE void walk_all(Walker<L>& w) {
    w.unopened.count = 0;
    w.unopened.put({-kInfinity, 0, 0, 0, w.active});
    while (w.unopened.count > 0) {
        const Unopened box = w.unopened.last();
        for (std::uint32_t rest = w.active; rest != 0; rest &= rest - 1) {
            const int i = __builtin_ctz(rest);
            Lane& lane = w.lanes[i];
            // What lies before the start is in order only when all boxes are open that it may lie in.
            const bool in_order = w.mode == Mode::all || box.t > lane.start;
            if (in_order && lane.head < lane.events.size() && lane.events[lane.head].lo < box.t)
                w.advance(i, box.t);
            if (lane.done) w.active &= ~(1U << i);
        }
        if (w.active == 0) return;
        --w.unopened.count;
        const std::uint32_t lanes = box.lanes & w.active;
        if (lanes == 0) continue;
        if (box.count == 0) {
            open_node(w, box, lanes);
        } else {
            for (std::uint32_t k = 0; k < box.count; ++k)
                open_leaf(w, box.context, box.ref + k, lanes);
        }
    }
    for (std::uint32_t rest = w.active; rest != 0; rest &= rest - 1) {
        const int i = __builtin_ctz(rest);
        w.advance(i, kInfinity);
        w.finish(i);
    }
}

void walk_ray(Walker<1>& w) { walk_all(w); }
void walk_packet(Walker<kRays>& w) { walk_all(w); }
/// In mode through `passed` is what the rays pass; otherwise `hits`, unless null, what they meet.
void walk_simple_packet(Walker<kRays>& w, const RayPacket& rays, HitPacket* hits,
                        PassagePacket* passed) {
    const CompiledSolid& solid = *w.contexts[0].solid;
    constexpr float kBefore = -std::numeric_limits<float>::infinity();
    NearBox root(kBefore, solid.units, 0, w.active);
    const bool is_within =
        hits != nullptr && rays.within < solid.leaves.size() && solid.leaves[rays.within].apart;
    if (is_within) root = {kBefore, rays.within, 1, w.active};
    for (;;) {
        prepare_packet(w, rays);
        reset_nearest(w.nearest, w.active);
        if (passed != nullptr) reset_passages(w.passages);
        walk_nearest(w, root);
        settle_nearest(w);
        if (root.count() == 0 || all_leave(w, rays.within)) break;
        root = {kBefore, solid.units, 0, w.active};
    }
    if (passed != nullptr) {
        settle_passages(w, *passed);
        for (int k = 0; k < passed->count; ++k) {
            if (passed->lanes[k] == 0) continue;
            show_passage(w, k);
            finish_surfaces(w, passed->lanes[k], passed->hits[k]);
        }
    } else if (hits != nullptr) {
        finish_surfaces(w, w.nearest.found & ~w.nearest.deferred, *hits);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace raymo::trace
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace raymo::trace {

HWY_EXPORT(walk_ray);
HWY_EXPORT(walk_packet);
HWY_EXPORT(walk_simple_packet);

void walk(Walker<1>& walker) { HWY_DYNAMIC_DISPATCH(walk_ray)(walker); }
void walk(Walker<kRays>& walker) { HWY_DYNAMIC_DISPATCH(walk_packet)(walker); }
void walk_simple(Walker<kRays>& walker, const RayPacket& rays, HitPacket* hits) {
    HWY_DYNAMIC_DISPATCH(walk_simple_packet)(walker, rays, hits, nullptr);
}
void walk_through(Walker<kRays>& walker, const RayPacket& rays, PassagePacket& out) {
    HWY_DYNAMIC_DISPATCH(walk_simple_packet)(walker, rays, nullptr, &out);
}

}  // namespace raymo::trace
#endif
