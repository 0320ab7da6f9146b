// The hits of a batch, put side by side anew.
//
// Rays through neighbouring pixels meet surfaces that may be far apart, and of many materials. Hits on one leaf are close, so
// that their rays to a lamp meet the same boxes, and are shaded alike. So hits of packets that met more than a few leaves are
// sorted by leaf, in the order of the tree of boxes, in which neighbours are close too. Each is shaded as it would be where
// it stood: only the company changes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "raymo/render/shade.hpp"

namespace raymo::render {

class HitOrder {
public:
    /// Packets of a batch, at most.
    static constexpr std::size_t kPackets = 32;

    void clear() { groups_ = packets_ = 0; }
    /// Where the hits of the next packet are to be put, so that they can be added.
    [[nodiscard]] trace::HitPacket& next() { return met_[packets_]; }
    /// Takes what stands in next(): the hits in `lanes` of packet number `packet`. False: they are on so few leaves
    /// that moving them would not pay, and not taken.
    [[nodiscard]] bool add(std::size_t packet, LaneBits lanes);
    /// Brings what was taken into its new order.
    void sort();

    /// How many hits were sorted.
    [[nodiscard]] std::size_t size() const { return size_; }
    /// Those from number `first` on, as many as a packet holds; `rays` are those of all packets, in their order. Gives the
    /// lanes that hold one, the directions of the rays (`view` begins at a multiple of 64 bytes), and where each stood:
    /// packet * kRays + lane. The hits' error, part, instance and face are left out.
    LaneBits take(std::size_t first, const trace::RayPacket* rays, trace::HitPacket& hits,
                  double (&view)[3][kRays], std::uint32_t (&owner)[kRays]) const;

private:
    /// Leaves of a packet that are few. With one leaf less mixed scenes gain no more, and plates with holes lose 4 %.
    static constexpr std::size_t kFew = 2;

    /// Hits of one packet on one leaf.
    struct Group {
        std::uint32_t leaf;
        std::uint32_t slot;  ///< in met_
        LaneBits lanes;
    };
    std::size_t groups_ = 0, packets_ = 0, size_ = 0;
    std::array<trace::HitPacket, kPackets> met_;
    std::array<std::uint32_t, kPackets> packet_;  ///< number of each in met_
    std::array<Group, kPackets * kRays> group_;
    std::array<std::uint16_t, (kPackets + 1) * kRays> place_;  ///< slot * kRays + lane
};

}  // namespace raymo::render
