// Rays to light: recursive ray tracing [Whitted80], [Wijk86 2.2], with shadows through transparent
// parts.
//
// At a surface the light towards the viewer is the sum of
//     body * ambient + facets * surroundings
//     power n.l (body + facets) for each lamp that is not hidden                  (light_model.hpp)
//     the mirror image and the refracted image                           (rays that are traced next)
// Rays to be traced next wait on stacks with the weight that they will have in the picture, so there is no recursion; they
// are traced in packets, as soon as there are enough of them.
// A ray that starts on a surface says so, and how exactly, instead of starting a little above it; together
// with exact normals this leaves neither acne nor light leaks. A lamp behind a surface does not
// light it.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "raymo/render/hit_order.hpp"
#include "raymo/render/ray_stack.hpp"
#include "raymo/render/render.hpp"
#include "raymo/render/shade.hpp"
#include "raymo/render/surface_table.hpp"

namespace raymo::render {

/// What all threads share.
struct Stage {
    const trace::CompiledScene* scene = nullptr;
    std::vector<Lamp> lamps;
    Surroundings around;
    int max_depth = 8;
    double min_weight = 1.0 / 512;
    bool clear = false;    ///< some part is transparent
    bool absorbs = false;  ///< and takes away light on the way through it
    bool soft = false;     ///< some lamp's light depends on the sample

    Stage(const trace::CompiledScene& scene, const Look& look, const Options& options);
};

/// Tells surfaces apart: equal for rays that saw the same face of the same leaf of the same part.
struct Signature {
    std::uint32_t face = 0;               ///< 0: nothing was seen
    std::array<std::int8_t, 3> normal{};  ///< times 127

    friend bool operator==(const Signature&, const Signature&) = default;
};

/// Rays from the eye, of unit direction.
struct EyeBatch {
    static constexpr std::size_t kMost = HitOrder::kPackets * kRays;
    std::size_t count = 0;
    std::array<trace::RayPacket, kMost / kRays> rays;
    /// Samples of one pixel share its seed; together they use each area light's samples once. Not read unless Stage::soft.
    std::array<std::uint64_t, kMost> seed;
    std::array<std::uint32_t, kMost> sample;  ///< number of the ray among those of its pixel
    std::uint32_t samples = 1;                ///< rays of each pixel
    bool signatures = true;                   ///< Answers::signature is wanted
};

/// What they bring.
struct Answers {
    std::array<Colour, EyeBatch::kMost> light;
    std::array<Signature, EyeBatch::kMost> signature;
};

/// Answers rays. Holds scratch memory, so one per thread.
class RayShader {
public:
    /// `stage` must outlive it.
    explicit RayShader(const Stage& stage);

    /// Light along all rays of a batch. An answer depends on which rays are asked together in the order of its sums only: by
    /// roundings.
    void answer(const EyeBatch& eyes, Answers& answers);

    [[nodiscard]] const Stage& stage() const { return *stage_; }
    [[nodiscard]] trace::RayCounts counts() const;

private:
    /// Adds the light of hits to the answers and puts the rays that go on from them on the stacks. `view`: directions of the
    /// rays that met them. spots_.weight is set.
    void shade(const double (&view)[3][kRays], const trace::HitPacket& hits, LaneBits lanes,
               const Paths& paths);
    /// The same for what rays from the eye met, of which `paths` has only the owners; then follows rays that wait, as long
    /// as they fill packets.
    void shade_met(const double (&view)[3][kRays], const trace::HitPacket& hits, LaneBits lanes,
                   Paths& paths);
    void follow(RayStack& stack);
    void look_up(LaneBits lanes);
    void go_on(const Onward& onward, const Paths& paths, std::uint32_t turn);
    void light_softly(const Lamp& lamp, const double (&view)[3][kRays], int lane,
                      std::uint32_t owner, std::uint32_t name);
    void dim(trace::RayPacket& shadows, int hit);
    void filter(trace::RayPacket& shadows, int hit);
    void absorb_gain(int lane, const Surface& medium, double length);
    [[nodiscard]] LaneBits cross(const trace::HitPacket& met, const double (&view)[3][kRays],
                                 double (&reached)[kRays], LaneBits lanes);

    const Stage* stage_;
    trace::Tracer tracer_;
    SurfaceTable surfaces_;
    HitOrder order_;  ///< of the batch in hand
    // Of the packet in hand.
    const trace::HitPacket* hits_ = nullptr;
    trace::HitPacket own_hits_{}, shadow_hits_{};
    Spots spots_;
    Onward reflected_, refracted_;
    Gains gains_;
    trace::RayPacket shadows_;
    trace::PassagePacket passages_;
    const Surface* around_[kRays];  ///< what each ray to a lamp is in
    double left_[kRays];            ///< of its light, behind the surfaces that it has passed
    // Images and what is seen through surfaces wait apart: rays of one kind are closer.
    RayStack images_, views_;
    const EyeBatch* eyes_ = nullptr;
    Answers* answers_ = nullptr;
    trace::RayCounts counts_;
};

}  // namespace raymo::render
