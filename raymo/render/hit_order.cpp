// One text for all instruction sets: this file includes itself once for each (Highway's foreach_target).

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raymo/render/hit_order.cpp"
#include "raymo/render/hit_order.hpp"

#include "raymo/math/targets.hpp"
//
#include <hwy/foreach_target.h>  // must stand before highway.h
#include <hwy/highway.h>

#include <algorithm>

#include "raymo/math/lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace raymo::render {
namespace HWY_NAMESPACE {
#include "raymo/math/lanes-inl.hpp"
//
#include "raymo/render/lane_rows-inl.hpp"

LaneBits on_leaf_in_lanes(const trace::HitPacket& hits, int lane) {
    return equal_in_row(hits.leaf, lane);
}

/// Rows of `Packet`s that stand one after the other, read at places that are given in bytes from the first number of the row
/// in the first packet.
template <class T, class Tag>
HWY_INLINE void gather(const T (&row)[kRays], const hn::TFromD<hn::RebindToSigned<Tag>>* offset,
                       Tag tag, T (&out)[kRays]) {
    for (std::size_t i = 0; i < kRays; i += hn::Lanes(tag)) {
        hn::Store(hn::GatherOffset(tag, row, hn::Load(hn::RebindToSigned<Tag>(), offset + i)), tag,
                  out + i);
    }
}

void take_in_lanes(const std::uint16_t* place, const trace::HitPacket* met,
                   const std::uint32_t* packet, const trace::RayPacket* rays,
                   trace::HitPacket& hits, double (&view)[3][kRays]) {
    const D tag;
    const hn::CappedTag<std::uint32_t, kRays> whole;
    alignas(64) std::int64_t in_hits[kRays];
    alignas(64) std::int64_t in_rays[kRays];
    alignas(64) std::int32_t in_wholes[kRays];
    LaneBits entering = 0;
    for (int k = 0; k < kRays; ++k) {
        const std::uint32_t slot = place[k] / kRays;
        const std::uint32_t lane = place[k] % kRays;
        in_hits[k] = static_cast<std::int64_t>(slot * sizeof *met + lane * sizeof(double));
        in_rays[k] = static_cast<std::int64_t>(packet[slot] * sizeof *rays + lane * sizeof(double));
        in_wholes[k] = static_cast<std::int32_t>(slot * sizeof *met + lane * sizeof(std::uint32_t));
        entering |= (met[slot].entering >> lane & 1U) << k;
    }
    hits.entering = entering;
    gather(met->t, in_hits, tag, hits.t);
    gather(met->point_error, in_hits, tag, hits.point_error);
    for (int a = 0; a < 3; ++a) {
        gather(met->point[a], in_hits, tag, hits.point[a]);
        gather(met->normal[a], in_hits, tag, hits.normal[a]);
        gather(rays->d[a], in_rays, tag, view[a]);
    }
    gather(met->material, in_wholes, whole, hits.material);
    gather(met->medium_before, in_wholes, whole, hits.medium_before);
    gather(met->medium_after, in_wholes, whole, hits.medium_after);
    gather(met->leaf, in_wholes, whole, hits.leaf);
}

}  // namespace HWY_NAMESPACE
}  // namespace raymo::render
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace raymo::render {

HWY_EXPORT(on_leaf_in_lanes);
HWY_EXPORT(take_in_lanes);

bool HitOrder::add(std::size_t packet, LaneBits lanes) {
    const trace::HitPacket& hits = met_[packets_];
    const std::size_t before = groups_;
    for (LaneBits rest = lanes; rest != 0;) {
        const int lane = trace::lowest_lane(rest);
        const LaneBits alike = HWY_DYNAMIC_DISPATCH(on_leaf_in_lanes)(hits, lane) & rest;
        rest &= ~alike;
        group_[groups_++] = {hits.leaf[lane], static_cast<std::uint32_t>(packets_), alike};
    }
    if (groups_ - before <= kFew) {
        groups_ = before;
        return false;
    }
    packet_[packets_++] = static_cast<std::uint32_t>(packet);
    return true;
}

void HitOrder::sort() {
    std::sort(group_.begin(), group_.begin() + groups_, [](const Group& a, const Group& b) {
        return a.leaf != b.leaf ? a.leaf < b.leaf : a.slot < b.slot;
    });
    size_ = 0;
    for (std::size_t g = 0; g < groups_; ++g) {
        const Group& group = group_[g];
        for (LaneBits rest = group.lanes; rest != 0; rest &= rest - 1) {
            place_[size_++] = static_cast<std::uint16_t>(
                group.slot * kRays + static_cast<std::uint32_t>(trace::lowest_lane(rest)));
        }
    }
    // The last packet is filled up with the last hit.
    if (size_ > 0) std::fill_n(place_.begin() + size_, kRays, place_[size_ - 1]);
}

LaneBits HitOrder::take(std::size_t first, const trace::RayPacket* rays, trace::HitPacket& hits,
                        double (&view)[3][kRays], std::uint32_t (&owner)[kRays]) const {
    const std::uint16_t* const place = place_.data() + first;
    for (std::size_t k = 0; k < kRays; ++k)
        owner[k] = packet_[place[k] / kRays] * kRays + place[k] % kRays;
    HWY_DYNAMIC_DISPATCH(take_in_lanes)
    (place, met_.data(), packet_.data(), rays, hits, view);
    return trace::first_lanes(std::min<std::size_t>(size_ - first, kRays));
}

}  // namespace raymo::render
#endif
