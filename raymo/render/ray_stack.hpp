// Rays that wait to be traced, last come first served: so there are never many, and those taken together are close.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "raymo/render/shade.hpp"

namespace raymo::render {

/// What the rays of a packet are part of.
struct alignas(64) Paths {
    std::uint32_t owner[kRays];   ///< the eye ray that each descends from
    std::uint32_t name[kRays];    ///< of its hits: 1, and the turns taken at each surface
    std::uint32_t depth[kRays];   ///< reflections and refractions so far
    std::uint32_t within[kRays];  ///< leaf that the ray has entered and not left
};

class RayStack {
public:
    [[nodiscard]] std::size_t size() const { return size_; }
    [[nodiscard]] bool empty() const { return size_ == 0; }

    /// Puts the rays of `onward` that `lanes` names on the stack; `paths` are those of the hits.
    void push(const trace::HitPacket& hits, const Onward& onward, LaneBits lanes,
              const Paths& paths, std::uint32_t turn) {
        make_room();
        const bool all = lanes == trace::kAllLanes;
        const auto count = static_cast<std::size_t>(trace::lane_count(lanes));
        // A packet is written in any case: what lies beyond the last is overwritten by the next.
        std::uint8_t from[kRays] = {};
        if (!all) {
            std::size_t k = 0;
            for (LaneBits rest = lanes; rest != 0; rest &= rest - 1)
                from[k++] = static_cast<std::uint8_t>(trace::lowest_lane(rest));
        }
        const auto pack = [&]<class T>(const T(&values)[kRays], std::vector<T>& column) {
            T* out = column.data() + size_;
            if (all) {
                std::memcpy(out, values, sizeof values);
            } else {
                for (std::size_t k = 0; k < kRays; ++k) out[k] = values[from[k]];
            }
        };
        for (std::size_t a = 0; a < 3; ++a) {
            pack(hits.point[a], places_[a]);
            pack(onward.d[a], directions_[a]);
            pack(onward.weight[a], weights_[a]);
        }
        pack(hits.point_error, errors_);
        // What is entered and refracted into, or left and reflected back into, the ray is within.
        const LaneBits within = lanes & (turn != 0 ? hits.entering : ~hits.entering);
        Paths next;
        for (std::size_t k = 0; k < kRays; ++k) {
            next.name[k] = 2 * paths.name[k] + turn;
            next.depth[k] = paths.depth[k] + 1;
            next.within[k] = hits.leaf[k];
        }
        if (within == 0) {
            std::fill_n(next.within, kRays, trace::SurfaceId::kNone);
        } else {
            for (LaneBits rest = lanes & ~within; rest != 0; rest &= rest - 1)
                next.within[trace::lowest_lane(rest)] = trace::SurfaceId::kNone;
        }
        pack(paths.owner, owners_);
        pack(next.name, names_);
        pack(next.depth, depths_);
        pack(next.within, within_);
        size_ += count;
    }
    /// Takes as many rays off the stack as a packet holds, and returns their lanes. The lanes beyond them hold anything.
    LaneBits pop(trace::RayPacket& rays, double (&weight)[3][kRays], Paths& paths) {
        const std::size_t count = std::min<std::size_t>(size_, kRays);
        size_ -= count;
        const auto unpack = [&]<class T>(const std::vector<T>& column, T(&out)[kRays]) {
            std::memcpy(out, column.data() + size_, sizeof out);
        };
        for (std::size_t a = 0; a < 3; ++a) {
            unpack(places_[a], rays.o[a]);
            unpack(directions_[a], rays.d[a]);
            unpack(weights_[a], weight[a]);
        }
        unpack(errors_, rays.start_error);
        std::fill_n(rays.t_max, kRays, std::numeric_limits<double>::infinity());
        rays.on_surface = trace::kAllLanes;
        unpack(owners_, paths.owner);
        unpack(names_, paths.name);
        unpack(depths_, paths.depth);
        unpack(within_, paths.within);
        std::uint32_t differ = 0;
        for (std::size_t k = 1; k < count; ++k) differ |= paths.within[k] ^ paths.within[0];
        rays.within = differ == 0 ? paths.within[0] : trace::SurfaceId::kNone;
        return trace::first_lanes(count);
    }

private:
    void make_room() {
        if (size_ + kRays <= errors_.size()) return;
        const std::size_t room = 2 * size_ + 4 * kRays;
        for (auto* columns : {&places_, &directions_, &weights_}) {
            for (auto& column : *columns) column.resize(room);
        }
        errors_.resize(room);
        for (auto* column : {&owners_, &names_, &depths_, &within_}) column->resize(room);
    }

    using Columns = std::array<std::vector<double>, 3>;
    Columns places_, directions_, weights_;
    std::vector<double> errors_;  ///< of the places
    std::vector<std::uint32_t> owners_, names_, depths_, within_;
    std::size_t size_ = 0;
};

}  // namespace raymo::render
