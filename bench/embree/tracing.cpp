#include "embree/tracing.hpp"

#include <immintrin.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <ctime>
#include <limits>
#include <numbers>

#include "raymo/scene/camera.hpp"

namespace raymo::bench {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

/// As Embree advises; put back afterwards, for RAYMO does without.
class FlushDenormals {
public:
    FlushDenormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040U); }
    ~FlushDenormals() { _mm_setcsr(before_); }
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

private:
    unsigned before_;
};

RTCDevice device() {
    static const RTCDevice only = rtcNewDevice("threads=1");
    return only;
}

RTCIntersectContext coherent() {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    return context;
}

/// N rays from one point. They start with the first of `from`.
template <class Packet, std::size_t N>
void fill(Packet& packet, const Rays& rays, const Rays::Sixteen& from, std::size_t first) {
    for (std::size_t i = 0; i < N; ++i) {
        packet.ray.org_x[i] = rays.eye[0];
        packet.ray.org_y[i] = rays.eye[1];
        packet.ray.org_z[i] = rays.eye[2];
        packet.ray.dir_x[i] = from.d[0][first + i];
        packet.ray.dir_y[i] = from.d[1][first + i];
        packet.ray.dir_z[i] = from.d[2][first + i];
        packet.ray.tnear[i] = 0.0F;
        packet.ray.time[i] = 0.0F;
        packet.ray.tfar[i] = kFar;
        packet.ray.mask[i] = 0xffffffffU;
        packet.ray.flags[i] = 0;
        packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
}

template <class Packet, std::size_t N>
std::size_t hits_of(const Packet& packet) {
    std::size_t hits = 0;
    for (std::size_t i = 0; i < N; ++i)
        hits += packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID ? 1 : 0;
    return hits;
}

alignas(64) constexpr int kAll[16] = {-1, -1, -1, -1, -1, -1, -1, -1,
                                      -1, -1, -1, -1, -1, -1, -1, -1};

}  // namespace

double cpu_seconds() {
    std::timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Rays::Rays(const scene::Camera& camera, int side) {
    const scene::View view(camera, side, side);
    for (int a = 0; a < 3; ++a) eye[a] = static_cast<float>(camera.eye[a]);
    for (int y = 0; y < side; y += trace::kRays / 4) {
        for (int x = 0; x < side; x += 4) {
            trace::RayPacket packet;
            for (int i = 0; i < trace::kRays; ++i) {
                trace::RayQuery query;
                query.ray = view.ray(x + i % 4 + 0.5, y + i / 4 + 0.5);
                packet.set(i, query);
                if (i % 16 == 0) sixteens.emplace_back();
                for (int a = 0; a < 3; ++a)
                    sixteens.back().d[a][i % 16] = static_cast<float>(query.ray.direction[a]);
            }
            packets.push_back(packet);
        }
    }
}

Result<ExactScene> ExactScene::make(const Shape& shape) {
    const double start = cpu_seconds();
    auto solid = shape.exact();
    if (!solid) return fail(std::move(solid).error());
    scene::Scene scene;
    scene.parts.push_back({std::string(shape.name), *std::move(solid), {}});
    auto compiled = trace::compile(scene);
    if (!compiled) return fail(std::move(compiled).error());
    ExactScene made(*std::move(compiled));
    made.seconds_ = cpu_seconds() - start;
    return made;
}

std::size_t ExactScene::trace_packets(const Rays& rays) const {
    trace::Tracer tracer(scene_);
    trace::HitPacket hits;
    std::size_t count = 0;
    for (const trace::RayPacket& packet : rays.packets)
        count += static_cast<std::size_t>(
            trace::lane_count(tracer.first_hits(packet, trace::kAllLanes, hits)));
    return count;
}

std::size_t ExactScene::trace_single(const Rays& rays) const {
    trace::Tracer tracer(scene_);
    trace::Hit hit;
    std::size_t count = 0;
    for (const trace::RayPacket& packet : rays.packets) {
        for (int i = 0; i < trace::kRays; ++i)
            count += tracer.first_hit(packet.query(i), hit) ? 1 : 0;
    }
    return count;
}

Answers ExactScene::answers(const Rays& rays) const {
    trace::Tracer tracer(scene_);
    trace::HitPacket hits;
    Answers out;
    for (const trace::RayPacket& packet : rays.packets) {
        const trace::LaneBits met = tracer.first_hits(packet, trace::kAllLanes, hits);
        out.hits += static_cast<std::size_t>(trace::lane_count(met));
        for (int i = 0; i < trace::kRays; ++i) {
            const bool is_hit = (met >> i & 1U) != 0;
            out.is_hit.push_back(is_hit);
            out.normals.push_back(is_hit ? hits.hit(i).normal : Vec3{});
        }
    }
    return out;
}

EmbreeScene::EmbreeScene(const Mesh& mesh, RTCBuildQuality quality)
    : scene_(rtcNewScene(device())) {
    const RTCGeometry geometry = rtcNewGeometry(device(), RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry, quality);
    const std::size_t vertex = sizeof(Mesh::Vertex), triangle = sizeof(mesh.triangles[0]);
    std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                        vertex, mesh.places.size()),
                mesh.places.data(), vertex * mesh.places.size());
    std::memcpy(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                        triangle, mesh.triangles.size()),
                mesh.triangles.data(), triangle * mesh.triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneBuildQuality(scene_, quality);
    rtcCommitScene(scene_);
}

EmbreeScene::~EmbreeScene() { rtcReleaseScene(scene_); }

std::size_t EmbreeScene::trace16(const Rays& rays) const {
    const FlushDenormals flush;
    RTCIntersectContext context = coherent();
    std::size_t hits = 0;
    for (const Rays::Sixteen& sixteen : rays.sixteens) {
        RTCRayHit16 packet;
        fill<RTCRayHit16, 16>(packet, rays, sixteen, 0);
        rtcIntersect16(kAll, scene_, &context, &packet);
        hits += hits_of<RTCRayHit16, 16>(packet);
    }
    return hits;
}

std::size_t EmbreeScene::trace8(const Rays& rays) const {
    const FlushDenormals flush;
    RTCIntersectContext context = coherent();
    std::size_t hits = 0;
    for (const Rays::Sixteen& sixteen : rays.sixteens) {
        for (std::size_t half = 0; half < 2; ++half) {
            RTCRayHit8 packet;
            fill<RTCRayHit8, 8>(packet, rays, sixteen, 8 * half);
            rtcIntersect8(kAll, scene_, &context, &packet);
            hits += hits_of<RTCRayHit8, 8>(packet);
        }
    }
    return hits;
}

namespace {

RTCRayHit single(const Rays& rays, const Rays::Sixteen& from, std::size_t i) {
    RTCRayHit one;
    one.ray = {
        rays.eye[0], rays.eye[1], rays.eye[2], 0.0F, from.d[0][i], from.d[1][i], from.d[2][i], 0.0F,
        kFar,        0xffffffffU, 0,           0};
    one.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    one.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    return one;
}

}  // namespace

std::size_t EmbreeScene::trace1(const Rays& rays) const {
    const FlushDenormals flush;
    RTCIntersectContext context = coherent();
    std::size_t hits = 0;
    for (const Rays::Sixteen& sixteen : rays.sixteens) {
        for (std::size_t i = 0; i < 16; ++i) {
            RTCRayHit one = single(rays, sixteen, i);
            rtcIntersect1(scene_, &context, &one);
            hits += one.hit.geomID != RTC_INVALID_GEOMETRY_ID ? 1 : 0;
        }
    }
    return hits;
}

Errors compare(const Mesh& mesh, const EmbreeScene& scene, const Rays& rays, const Answers& exact) {
    const FlushDenormals flush;
    RTCIntersectContext context = coherent();
    Errors out;
    std::vector<double> angles;
    for (std::size_t k = 0; k < rays.count(); ++k) {
        RTCRayHit one = single(rays, rays.sixteens[k / 16], k % 16);
        rtcIntersect1(scene.scene(), &context, &one);
        const bool is_hit = one.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        if (is_hit != exact.is_hit[k]) ++out.wrong;
        if (!is_hit || !exact.is_hit[k]) continue;
        const auto normal = [&](std::size_t corner) {
            const Mesh::Vertex& n = mesh.normals[mesh.triangles[one.hit.primID][corner]];
            return Vec3{n.x, n.y, n.z};
        };
        const double u = one.hit.u, v = one.hit.v;
        const Vec3 smooth = unit(normal(0) * (1.0 - u - v) + normal(1) * u + normal(2) * v);
        angles.push_back(
            std::atan2(norm(cross(smooth, exact.normals[k])), dot(smooth, exact.normals[k])));
    }
    if (!angles.empty()) {
        const auto rank = static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(angles.size()));
        std::nth_element(angles.begin(), angles.begin() + rank, angles.end());
        out.angle = angles[static_cast<std::size_t>(rank)] * 180.0 / std::numbers::pi;
    }
    return out;
}

}  // namespace raymo::bench
