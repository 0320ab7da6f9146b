// Rays in, surfaces and spans out.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "raymo/math/ray.hpp"
#include "raymo/trace/compiled_scene.hpp"

namespace raymo::trace {

/// A face of a leaf.
struct SurfaceId {
    static constexpr std::uint32_t kNone = 0xffffffffU;
    std::uint32_t leaf = kNone;  ///< stored leaf
    std::uint32_t instance = 0;  ///< which instance of it; 0 when the leaf is not instanced
    std::uint16_t face = 0;

    friend bool operator==(const SurfaceId&, const SurfaceId&) = default;
};

/// A question to the tracer. A ray that starts on a surface needs no offset: crossings that can not be told from the start
/// are passed.
struct RayQuery {
    Ray ray;
    double t_max = std::numeric_limits<double>::infinity();
    bool on_surface = false;   ///< the ray starts on a surface, which it has met before
    double start_error = 0.0;  ///< bound of the distance of ray.origin from that surface
};

/// A crossing of a part's boundary.
struct Hit {
    double t = 0.0;      ///< along the ray, in lengths of its direction
    double error = 0.0;  ///< |t - true t| <= error
    Vec3 point;
    double point_error = 0.0;  ///< distance of `point` from the surface, at most
    Vec3 normal;               ///< unit, out of the part
    bool entering = true;
    std::uint32_t part = 0;
    csg::MaterialId material = csg::kNoMaterial;  ///< of the surface
    /// Material of what the ray is in just before and just behind the surface; kAir when outside of
    /// everything.
    static constexpr std::uint32_t kAir = 0xfffffffeU;
    csg::MaterialId medium_before = kAir;
    csg::MaterialId medium_after = kAir;
    SurfaceId surface;
};

/// A span of one part along a ray; ends at infinity have t = +-inf and no surface.
struct PartSpan {
    Hit enter;
    Hit exit;
};

struct RayCounts {
    std::uint64_t primary = 0, shadow = 0, secondary = 0;
    std::uint64_t boxes = 0, leaves = 0;
};

struct RayPacket;
struct HitPacket;
struct PassagePacket;

/// Answers rays. Holds scratch memory, so one per thread; the scene must outlive it.
class Tracer {
public:
    explicit Tracer(const CompiledScene& scene);
    ~Tracer();
    Tracer(Tracer&&) noexcept;

    /// First crossing of any part's boundary with 0 < t < t_max. False: none.
    [[nodiscard]] bool first_hit(const RayQuery& query, Hit& hit);
    /// True when a crossing of an opaque part's boundary lies within (0, t_max), or the ray starts
    /// inside one.
    [[nodiscard]] bool occluded(const RayQuery& query);

    /// The same answers, bit for bit, for the rays of a packet that `lanes` (not 0) names, one bit each; faster when they
    /// are close. (Only where a ray runs in the boundary of a leaf that has no part in the answer may the two differ, by less
    /// than their errors: a single ray is moved aside there, a packet may not have looked at the leaf. What the ray only grazes
    /// may then be met by one and missed by the other.) The other lanes may hold anything. first_hits: returns the rays whose lane of `hits` is set.
    std::uint32_t first_hits(const RayPacket& rays, std::uint32_t lanes, HitPacket& hits);
    /// Returns the rays that are occluded.
    std::uint32_t occluded(const RayPacket& rays, std::uint32_t lanes);

    /// What light passes on the way of rays of a packet, where the surfaces that are met one after the other all belong to
    /// transparent parts; `blocked` are the rays that meet something opaque. Those of `lanes` that are returned are left
    /// over: of them nothing is told, and first_hits, from surface to surface, tells it.
    std::uint32_t passages(const RayPacket& rays, std::uint32_t lanes, PassagePacket& out,
                           std::uint32_t& blocked);

    /// All spans of every part along the whole line, from -infinity to +infinity, by part and then
    /// by t.
    void spans(const Ray& ray, std::vector<std::vector<PartSpan>>& by_part);

    [[nodiscard]] LeafInfo leaf_info(SurfaceId id) const;
    [[nodiscard]] std::string_view face_name(SurfaceId id) const;

    [[nodiscard]] const RayCounts& counts() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace raymo::trace
