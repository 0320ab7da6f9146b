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

/// What a ray is part of.
struct Path {
    std::uint32_t owner = 0;  ///< the eye ray that it descends from
    std::uint32_t name =
        1;          ///< tells the hits of one eye ray apart: the turns taken at each surface
    int depth = 0;  ///< reflections and refractions so far
    std::uint32_t within = trace::SurfaceId::kNone;  ///< leaf that the ray has entered and not left
};

class RayStack {
public:
    [[nodiscard]] std::size_t size() const { return paths_.size(); }
    [[nodiscard]] bool empty() const { return paths_.empty(); }

    /// Puts the rays of `onward` that `lanes` names on the stack; `paths` are those of the hits.
    void push(const trace::HitPacket& hits, const Onward& onward, LaneBits lanes,
              const std::array<Path, 8>& paths, std::uint32_t turn) {
        const std::size_t first = size();
        for (LaneBits rest = lanes; rest != 0; rest &= rest - 1) {
            const int i = trace::lowest_lane(rest);
            const Path& path = paths[static_cast<std::size_t>(i)];
            const bool is_within = (hits.entering >> i & 1U) == turn;
            paths_.push_back({path.owner, 2 * path.name + turn, path.depth + 1,
                              is_within ? hits.leaf[i] : trace::SurfaceId::kNone});
        }
        if (first + 8 > columns_[0].size()) {
            for (auto& column : columns_) column.resize(2 * first + 64);
        }
        // Eight are written in any case: what lies beyond the last is overwritten by the next.
        std::array<std::size_t, 8> from{};
        std::size_t count = 0;
        for (LaneBits rest = lanes; rest != 0; rest &= rest - 1)
            from[count++] = static_cast<std::size_t>(trace::lowest_lane(rest));
        std::size_t c = 0;
        const auto pack = [&](const double(&values)[8]) {
            double* out = columns_[c++].data() + first;
            if (lanes == trace::kAllLanes) {
                std::memcpy(out, values, sizeof values);
            } else {
                for (std::size_t k = 0; k < 8; ++k) out[k] = values[from[k]];
            }
        };
        for (const auto& values : hits.point) pack(values);
        for (const auto& values : onward.d) pack(values);
        for (const auto& values : onward.weight) pack(values);
        pack(hits.point_error);
    }
    /// Takes up to eight rays off the stack, and returns their lanes. The lanes beyond them hold anything.
    LaneBits pop(trace::RayPacket& rays, double (&weight)[3][8], std::array<Path, 8>& paths) {
        const std::size_t count = std::min<std::size_t>(size(), 8);
        const std::size_t first = size() - count;
        const auto column = [&](std::size_t c, double(&out)[8]) {
            std::memcpy(out, columns_[c].data() + first, sizeof out);
        };
        for (std::size_t a = 0; a < 3; ++a) {
            column(a, rays.o[a]);
            column(3 + a, rays.d[a]);
            column(6 + a, weight[a]);
        }
        column(9, rays.start_error);
        std::fill_n(rays.t_max, 8, std::numeric_limits<double>::infinity());
        rays.on_surface = trace::kAllLanes;
        std::copy_n(paths_.data() + first, count, paths.data());
        paths_.resize(first);
        rays.within = paths[0].within;
        for (std::size_t k = 1; k < count; ++k) {
            if (paths[k].within != rays.within) rays.within = trace::SurfaceId::kNone;
        }
        return trace::first_lanes(count);
    }

private:
    static constexpr std::size_t kColumns = 10;  ///< place, direction, weight, error of the place
    std::array<std::vector<double>, kColumns> columns_;
    std::vector<Path> paths_;
};

}  // namespace raymo::render
