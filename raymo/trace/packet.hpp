// Rays side by side, and what they meet: the form in which the walk and the shading compute.
#pragma once

#include <cstdint>

#include "raymo/trace/lane_bits.hpp"
#include "raymo/trace/tracer.hpp"

namespace raymo::trace {

/// Answers, as in Hit.
struct alignas(64) HitPacket {
    double t[kRays], error[kRays];
    double point[3][kRays], point_error[kRays];
    double normal[3][kRays];
    std::uint32_t part[kRays];
    csg::MaterialId material[kRays], medium_before[kRays], medium_after[kRays];
    std::uint32_t leaf[kRays], instance[kRays], face[kRays];
    LaneBits entering = 0;

    void set(int lane, const Hit& hit) {
        t[lane] = hit.t;
        error[lane] = hit.error;
        for (int a = 0; a < 3; ++a) {
            point[a][lane] = hit.point[a];
            normal[a][lane] = hit.normal[a];
        }
        point_error[lane] = hit.point_error;
        part[lane] = hit.part;
        material[lane] = hit.material;
        medium_before[lane] = hit.medium_before;
        medium_after[lane] = hit.medium_after;
        leaf[lane] = hit.surface.leaf;
        instance[lane] = hit.surface.instance;
        face[lane] = hit.surface.face;
        entering = (entering & ~(1U << lane)) | (hit.entering ? 1U : 0U) << lane;
    }
    [[nodiscard]] Hit hit(int lane) const {
        Hit out;
        out.t = t[lane];
        out.error = error[lane];
        out.point = {point[0][lane], point[1][lane], point[2][lane]};
        out.point_error = point_error[lane];
        out.normal = {normal[0][lane], normal[1][lane], normal[2][lane]};
        out.entering = (entering >> lane & 1U) != 0;
        out.part = part[lane];
        out.material = material[lane];
        out.medium_before = medium_before[lane];
        out.medium_after = medium_after[lane];
        out.surface = {leaf[lane], instance[lane], static_cast<std::uint16_t>(face[lane])};
        return out;
    }
};

/// The surfaces of transparent parts that the rays of a packet cross: each ray those of which `lanes` has its bit, one after
/// the other.
struct PassagePacket {
    static constexpr int kMost = 16;
    HitPacket hits[kMost];
    LaneBits lanes[kMost];
    int count = 0;
};

/// Questions, as in RayQuery.
struct alignas(64) RayPacket {
    double o[3][kRays];
    double d[3][kRays];
    double t_max[kRays];
    double start_error[kRays];
    LaneBits on_surface = 0;
    /// A leaf that all rays in use start in, as far as their past tells (SurfaceId::leaf); a hint, which saves time.
    std::uint32_t within = SurfaceId::kNone;

    void set(int lane, const RayQuery& query) {
        for (int a = 0; a < 3; ++a) {
            o[a][lane] = query.ray.origin[a];
            d[a][lane] = query.ray.direction[a];
        }
        t_max[lane] = query.t_max;
        start_error[lane] = query.start_error;
        on_surface = (on_surface & ~(1U << lane)) | (query.on_surface ? 1U : 0U) << lane;
    }
    [[nodiscard]] RayQuery query(int lane) const {
        RayQuery q;
        q.ray = {{o[0][lane], o[1][lane], o[2][lane]}, {d[0][lane], d[1][lane], d[2][lane]}};
        q.t_max = t_max[lane];
        q.start_error = start_error[lane];
        q.on_surface = (on_surface >> lane & 1U) != 0;
        return q;
    }
    /// Lets the rays in `lanes` start anew where they met a surface.
    void go_on_from(const HitPacket& hits, LaneBits lanes) {
        for (LaneBits rest = lanes; rest != 0; rest &= rest - 1) {
            const int i = lowest_lane(rest);
            for (int a = 0; a < 3; ++a) o[a][i] = hits.point[a][i];
            start_error[i] = hits.point_error[i];
            t_max[i] -= hits.t[i];
        }
        on_surface |= lanes;
    }
};

}  // namespace raymo::trace
