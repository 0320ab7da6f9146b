// One set of rays, and the two programs that answer them.
#pragma once

#include <embree3/rtcore.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "embree/shapes.hpp"
#include "raymo/trace/packet.hpp"

namespace raymo::bench {

/// CPU time of this process [s].
[[nodiscard]] double cpu_seconds();

/// The primary rays of a square picture, made once for both: in double precision in packets, 4 x 8 pixels, and rounded
/// to single precision in packets of sixteen, 4 x 4.
class Rays {
public:
    struct alignas(64) Sixteen {
        float d[3][16];
    };
    /// `side`: pixels each way, a multiple of 8.
    Rays(const scene::Camera& camera, int side);
    [[nodiscard]] std::size_t count() const { return packets.size() * trace::kRays; }

    std::vector<trace::RayPacket> packets;
    std::vector<Sixteen> sixteens;  ///< the same rays, two for each packet
    float eye[3];                   ///< where all begin
};

/// What RAYMO finds.
struct Answers {
    std::size_t hits = 0;
    std::vector<bool> is_hit;
    std::vector<Vec3> normals;  ///< where hit
};

class ExactScene {
public:
    [[nodiscard]] static Result<ExactScene> make(const Shape& shape);
    /// Both return the number of hits.
    [[nodiscard]] std::size_t trace_packets(const Rays& rays) const;
    [[nodiscard]] std::size_t trace_single(const Rays& rays) const;
    [[nodiscard]] Answers answers(const Rays& rays) const;
    [[nodiscard]] double seconds() const { return seconds_; }  ///< of CPU, that it took to make

private:
    explicit ExactScene(trace::CompiledScene scene) : scene_(std::move(scene)) {}
    trace::CompiledScene scene_;
    double seconds_ = 0.0;
};

/// Triangles as Embree likes them best: indexed, static, one thread, coherent packets, denormal numbers flushed to 0.
class EmbreeScene {
public:
    EmbreeScene(const Mesh& mesh, RTCBuildQuality quality);
    ~EmbreeScene();
    EmbreeScene(const EmbreeScene&) = delete;
    EmbreeScene& operator=(const EmbreeScene&) = delete;

    /// All return the number of hits.
    [[nodiscard]] std::size_t trace16(const Rays& rays) const;
    [[nodiscard]] std::size_t trace8(const Rays& rays) const;
    [[nodiscard]] std::size_t trace1(const Rays& rays) const;
    [[nodiscard]] RTCScene scene() const { return scene_; }

private:
    RTCScene scene_;
};

struct Errors {
    std::size_t wrong =
        0;               ///< rays that hit the solid and miss the triangles, or the other way round
    double angle = 0.0;  ///< of 99.9 % of the rest, the interpolated normal is this close [degrees]
};
[[nodiscard]] Errors compare(const Mesh& mesh, const EmbreeScene& scene, const Rays& rays,
                             const Answers& exact);

}  // namespace raymo::bench
