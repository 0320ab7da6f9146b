// Rays to light: recursive ray tracing [Whitted80], [Wijk86 2.2], with shadows through transparent
// parts.
//
// At a surface the light towards the viewer is the sum of
//     body * ambient + facets * surroundings
//     power n.l (body + facets) for each lamp that is not hidden                  (light_model.hpp)
//     the mirror image and the refracted image                           (rays that are traced next)
// Rays to be traced next wait in a list with the weight that they will have in the picture, so
// there is no recursion; they are traced in packets, one wave a bounce.
// A ray that starts on a surface names that surface instead of starting a little above it; together
// with exact normals this leaves neither acne nor light leaks. A lamp behind a surface does not
// light it.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "raymo/render/lamps.hpp"
#include "raymo/render/light_model.hpp"
#include "raymo/render/render.hpp"
#include "raymo/trace/tracer.hpp"

namespace raymo::render {

/// What all threads share.
struct Stage {
    const trace::CompiledScene* scene = nullptr;
    std::vector<Lamp> lamps;
    Colour ambient;
    scene::Background background;
    int max_depth = 8;
    double min_weight = 1.0 / 512;

    Stage(const trace::CompiledScene& scene, const Look& look, const Options& options);

    /// What is seen in unit direction `d` where nothing is.
    [[nodiscard]] Colour behind(Vec3 d) const {
        const double up = 0.5 + 0.5 * d.z;
        return background.bottom * (1.0 - up) + background.top * up;
    }
    /// What facets that are not traced reflect from direction `d`. Mostly that is other parts, in ambient light; but a
    /// metal shows little else than what is around it, so half of that is taken from the backdrop.
    [[nodiscard]] Colour surroundings(Vec3 d, double metal) const {
        return ambient + (behind(d) - ambient) * (0.5 * metal);
    }
};

/// A ray from the eye. Samples of one pixel share its `seed`; together they use each area light's
/// samples once.
struct EyeRay {
    Ray ray;  ///< unit direction
    std::uint64_t seed = 0;
    std::uint32_t sample = 0;
    std::uint32_t samples = 1;
};

/// Tells surfaces apart: equal for rays that saw the same face of the same leaf of the same part.
struct Signature {
    std::uint32_t face = 0;               ///< 0: nothing was seen
    std::array<std::int8_t, 3> normal{};  ///< times 127

    friend bool operator==(const Signature&, const Signature&) = default;
};

struct Answer {
    Colour light;
    Signature signature;
};

/// Answers rays. Holds scratch memory, so one per thread.
class RayShader {
public:
    static constexpr std::size_t kPacket = trace::Tracer::kPacket;

    /// `stage` must outlive it.
    explicit RayShader(const Stage& stage);

    /// Light along up to kPacket rays; answers do not depend on which rays are asked together.
    void answer(std::span<const EyeRay> rays, Answer* answers);

    [[nodiscard]] trace::RayCounts counts() const;

private:
    /// A ray whose hit is to be shaded.
    struct Path {
        Colour weight;
        int depth = 0;
        std::size_t lane = 0;     ///< of the eye ray it descends from
        std::uint32_t event = 0;  ///< number of the hit among those of its eye ray
    };
    struct Pending {
        trace::RayQuery query;
        Path path;
    };
    /// A hit while lamps are summed up.
    struct Spot {
        const Surface* surface;
        Vec3 normal;  ///< on the viewer's side
        double nv;
        Colour body;   ///< with what the interface took away
        Colour light;  ///< so far
        bool lit;      ///< lamps count
    };

    /// Sums up the light of hits into brought_ and puts the rays that go on from them on the list.
    void shade(std::size_t count, const trace::RayQuery* queries, const trace::Hit* hits,
               const Path* paths);
    void follow(std::span<const Pending> rays);
    [[nodiscard]] Spot approach(const trace::RayQuery& query, const trace::Hit& hit, Path& path,
                                Colour& brought);
    void light_directly(const Lamp& lamp, std::size_t count, const trace::RayQuery* queries,
                        const trace::Hit* hits, const Path* paths, Spot* spots);
    void light_softly(const Lamp& lamp, const trace::RayQuery& query, const trace::Hit& hit,
                      const Path& path, Spot& spot);
    [[nodiscard]] Colour gain(const trace::RayQuery& query, const Arrival& arrival, double nl,
                              const Spot& spot) const;
    [[nodiscard]] bool matters(Colour gain, const Path& path) const {
        // Less than this can not be seen even in sums over a few lamps.
        return max_norm(gain * path.weight) > 0.125 * stage_->min_weight;
    }
    void spawn(const trace::Hit& hit, Vec3 direction, const Path& path, Colour weight,
               Colour& brought);
    void dim(std::span<const trace::RayQuery> shadows, const csg::MaterialId* media, Colour* gains);
    [[nodiscard]] Colour filtered(trace::RayQuery shadow, trace::Hit hit);
    [[nodiscard]] const Surface& surface(csg::MaterialId id);
    [[nodiscard]] const Surface& medium(csg::MaterialId id);

    const Stage* stage_;
    trace::Tracer tracer_;
    std::vector<std::unique_ptr<const Surface>> surfaces_;  ///< by material, made when first seen
    std::unique_ptr<const Surface> unpainted_;
    Surface air_;
    // Of the packet in hand, kept from one to the next: they are large.
    std::array<trace::RayQuery, kPacket> queries_, shadows_;
    std::array<trace::Hit, kPacket> hits_, shadow_hits_;
    std::vector<Pending> pending_;  ///< rays of the next wave
    std::vector<Pending> wave_;
    std::array<Colour, kPacket> brought_{};  ///< by shade(), for each of its hits
    std::span<const EyeRay> eyes_;
    Answer* answers_ = nullptr;
    std::array<std::uint32_t, kPacket> events_{};  ///< hits shaded so far, by lane
    trace::RayCounts counts_;
};

}  // namespace raymo::render
