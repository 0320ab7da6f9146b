// Rays that wait to be traced, last come first served: so there are never many, and those taken together are close.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
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
};

class RayStack {
public:
    [[nodiscard]] std::size_t size() const { return paths_.size(); }
    [[nodiscard]] bool empty() const { return paths_.empty(); }

    void push(const trace::HitPacket& hits, const Onward& onward, int lane, const Path& path) {
        Ray& ray = rays_.emplace_back();
        for (std::size_t a = 0; a < 3; ++a) {
            ray.o[a] = hits.point[a][lane];
            ray.d[a] = onward.d[a][lane];
            ray.weight[a] = onward.weight[a][lane];
        }
        ray.start_error = hits.point_error[lane];
        paths_.push_back(path);
    }
    /// Takes up to eight rays off the stack; returns how many.
    std::size_t pop(trace::RayPacket& rays, double (&weight)[3][8], std::array<Path, 8>& paths) {
        const std::size_t count = std::min<std::size_t>(size(), 8);
        const std::size_t first = size() - count;
        for (std::size_t i = 0; i < count; ++i) {
            const Ray& ray = rays_[first + i];
            for (std::size_t a = 0; a < 3; ++a) {
                rays.o[a][i] = ray.o[a];
                rays.d[a][i] = ray.d[a];
                weight[a][i] = ray.weight[a];
            }
            rays.start_error[i] = ray.start_error;
            rays.t_max[i] = std::numeric_limits<double>::infinity();
            paths[i] = paths_[first + i];
        }
        rays.on_surface = trace::kAllLanes;
        rays_.resize(first);
        paths_.resize(first);
        return count;
    }

private:
    struct Ray {
        double o[3];
        double d[3];
        double weight[3];
        double start_error;
    };
    std::vector<Ray> rays_;
    std::vector<Path> paths_;
};

}  // namespace raymo::render
