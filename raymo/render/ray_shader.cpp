#include "raymo/render/ray_shader.hpp"

#include <algorithm>
#include <cmath>

namespace raymo::render {
namespace {

using trace::Hit;
using trace::RayQuery;
using trace::SurfaceId;

/// Longest chain of reflections and refractions, and least weight, that options may ask for: a
/// picture is finished whatever they say. The weights of rays of one depth add up to at most 1, so
/// at most kMostDepth / kLeastWeight rays descend from one.
constexpr int kMostDepth = 64;
constexpr double kLeastWeight = 0x1p-16;

/// Light through less than this is no light.
constexpr double kDark = 0x1p-12;

std::uint32_t face_of(const Hit& hit) {
    std::uint64_t x =
        mix(hit.surface.leaf + (static_cast<std::uint64_t>(hit.surface.instance) << 32U));
    x = mix(x + hit.surface.face + (static_cast<std::uint64_t>(hit.part) << 20U) +
            (hit.entering ? 1ULL << 19U : 0U));
    return static_cast<std::uint32_t>(x) | 1U;
}

Signature signature_of(const Hit& hit) {
    const auto scaled = [](double x) { return static_cast<std::int8_t>(x * 127.0); };
    return {face_of(hit), {scaled(hit.normal.x), scaled(hit.normal.y), scaled(hit.normal.z)}};
}

RayQuery from_surface(const Hit& hit, Vec3 direction) {
    RayQuery query;
    query.ray = {hit.point, direction};
    query.start = hit.surface;
    query.start_error = hit.point_error;
    return query;
}

}  // namespace

Stage::Stage(const trace::CompiledScene& compiled, const Look& look, const Options& options)
    : scene(&compiled),
      lamps(prepared(look.lights, options.quality != Quality::final)),
      ambient(look.ambient),
      background(look.background),
      max_depth(options.quality == Quality::draft ? 0
                                                  : std::clamp(options.max_depth, 0, kMostDepth)),
      min_weight(std::max(options.min_weight, kLeastWeight)) {}

RayShader::RayShader(const Stage& stage) : stage_(&stage), tracer_(*stage.scene) {
    pending_.reserve(64);
}

trace::RayCounts RayShader::counts() const {
    trace::RayCounts counts = tracer_.counts();
    counts.primary = counts_.primary;
    counts.shadow = counts_.shadow;
    counts.secondary = counts_.secondary;
    return counts;
}

const Surface& RayShader::surface(csg::MaterialId id) {
    std::unique_ptr<const Surface>* slot = &unpainted_;
    if (id != csg::kNoMaterial) {
        if (id >= surfaces_.size()) surfaces_.resize(static_cast<std::size_t>(id) + 1);
        slot = &surfaces_[id];
    }
    if (!*slot) *slot = std::make_unique<const Surface>(stage_->scene->material(id));
    return **slot;
}

const Surface& RayShader::medium(csg::MaterialId id) {
    return id == Hit::kAir ? air_ : surface(id);
}

void RayShader::answer(std::span<const EyeRay> rays, Answer* answers) {
    eyes_ = rays;
    answers_ = answers;
    counts_.primary += rays.size();
    std::array<RayQuery, kPacket>& queries = queries_;
    std::array<Hit, kPacket>& hits = hits_;
    std::array<bool, kPacket> found{};
    std::array<Path, kPacket> paths;
    for (std::size_t i = 0; i < rays.size(); ++i) queries[i] = {rays[i].ray};
    tracer_.first_hits({queries.data(), rays.size()}, hits.data(), found.data());

    std::size_t count = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        events_[i] = 0;
        answers[i] = {};
        if (!found[i]) {
            answers[i].light = stage_->behind(rays[i].ray.direction);
            continue;
        }
        answers[i].signature = signature_of(hits[i]);
        if (count != i) {
            queries[count] = queries[i];
            hits[count] = hits[i];
        }
        paths[count] = {{1, 1, 1}, 0, i, events_[i]++};
        ++count;
    }
    if (count == 0) return;
    shade(count, queries.data(), hits.data(), paths.data());
    for (std::size_t k = 0; k < count; ++k) answers[paths[k].lane].light += brought_[k];

    // Wave by wave: all rays that are one reflection or refraction further, in packets.
    while (!pending_.empty()) {
        wave_.swap(pending_);
        pending_.clear();
        for (std::size_t first = 0; first < wave_.size(); first += kPacket) {
            follow({wave_.data() + first, std::min(kPacket, wave_.size() - first)});
        }
    }
}

void RayShader::follow(std::span<const Pending> rays) {
    std::array<RayQuery, kPacket>& queries = queries_;
    std::array<Hit, kPacket>& hits = hits_;
    std::array<bool, kPacket> found{};
    std::array<Path, kPacket> paths;
    for (std::size_t i = 0; i < rays.size(); ++i) queries[i] = rays[i].query;
    counts_.secondary += rays.size();
    tracer_.first_hits({queries.data(), rays.size()}, hits.data(), found.data());

    std::array<Colour, kPacket> brought{};
    std::array<std::size_t, kPacket> which{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!found[i]) {
            brought[i] = rays[i].path.weight * stage_->behind(rays[i].query.ray.direction);
            continue;
        }
        queries[count] = queries[i];
        hits[count] = hits[i];
        paths[count] = rays[i].path;
        paths[count].event = events_[rays[i].path.lane]++;
        which[count++] = i;
    }
    if (count > 0) shade(count, queries.data(), hits.data(), paths.data());
    for (std::size_t k = 0; k < count; ++k) brought[which[k]] = brought_[k];
    // In the order of the rays, so that a sum does not depend on what else is in the packet.
    for (std::size_t i = 0; i < rays.size(); ++i) answers_[rays[i].path.lane].light += brought[i];
}

void RayShader::shade(std::size_t count, const RayQuery* queries, const Hit* hits,
                      const Path* paths) {
    std::array<Spot, kPacket> spots;
    std::array<Path, kPacket> arrived;
    for (std::size_t i = 0; i < count; ++i) {
        arrived[i] = paths[i];
        brought_[i] = {};
        spots[i] = approach(queries[i], hits[i], arrived[i], brought_[i]);
    }
    for (const Lamp& lamp : stage_->lamps) {
        if (!lamp.is_area()) {
            light_directly(lamp, count, queries, hits, arrived.data(), spots.data());
            continue;
        }
        for (std::size_t i = 0; i < count; ++i) {
            if (spots[i].lit) light_softly(lamp, queries[i], hits[i], arrived[i], spots[i]);
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        brought_[i] += arrived[i].weight * spots[i].light;
    }
}

/// All of a hit but the lamps: absorption on the way, ambient light, and the rays that go on from
/// here.
RayShader::Spot RayShader::approach(const RayQuery& query, const Hit& hit, Path& path,
                                    Colour& brought) {
    const Surface* material = &surface(hit.material);
    double index = 1.0;
    if (stage_->scene->has_transparency()) {
        const Surface& before = medium(hit.medium_before);
        if (before.absorbs) path.weight = path.weight * transmittance(before, hit.t);
        if (material->transparent) {
            const Surface& after = medium(hit.medium_after);
            // Where something opaque starts right behind a transparent surface, that is what is
            // seen.
            if (hit.medium_after != Hit::kAir && !after.transparent) {
                material = &after;
            } else {
                index = after.index / before.index;
            }
        }
    }

    Spot spot;
    spot.surface = material;
    spot.normal = hit.entering ? hit.normal : -hit.normal;
    // Rounding may put a surface seen edge-on on the wrong side.
    spot.nv = std::max(-dot(spot.normal, query.ray.direction), 1e-9);
    const double facets = material->specular(spot.nv);
    const double mirror =
        material->transparent
            ? std::max(fresnel(spot.nv, index), index == 1.0 ? 0.0 : material->least_mirror)
            : material->mirror(spot.nv);
    spot.body = material->body * ((1.0 - facets) * (1.0 - mirror));
    spot.light = spot.body * stage_->ambient;
    if (facets > mirror) {
        const double rest = (facets - mirror) * material->opaque_part;
        const Vec3 image = reflected_direction(query.ray.direction, spot.normal);
        spot.light += stage_->surroundings(image, material->metal) *
                      material->reflected(facets, material->specular.value()) * (rest / facets);
    }
    spot.lit = !material->transparent || hit.entering;

    if (mirror > 0.0) {
        const double normal_value =
            material->transparent ? fresnel(1.0, index) : material->mirror.value();
        const Colour part = mirror >= 1.0
                                ? (material->transparent ? Colour{1, 1, 1} : material->tint)
                                : material->reflected(mirror, normal_value);
        spawn(hit, reflected_direction(query.ray.direction, spot.normal), path, part, brought);
    }
    if (material->transparent && mirror < 1.0) {
        Vec3 direction;
        if (refracted_direction(query.ray.direction, spot.normal, index, direction)) {
            const double part = material->transmission * (1.0 - mirror);
            spawn(hit, direction, path, {part, part, part}, brought);
        }
    }
    return spot;
}

/// Lets a ray go on, or puts ambient light in the place of what it would bring.
void RayShader::spawn(const Hit& hit, Vec3 direction, const Path& path, Colour weight,
                      Colour& brought) {
    const Colour total = path.weight * weight;
    if (path.depth >= stage_->max_depth || max_norm(total) < stage_->min_weight) {
        brought += total * stage_->ambient;
        return;
    }
    pending_.push_back({from_surface(hit, direction), {total, path.depth + 1, path.lane, 0}});
}

void RayShader::light_directly(const Lamp& lamp, std::size_t count, const RayQuery* queries,
                               const Hit* hits, const Path* paths, Spot* spots) {
    std::array<RayQuery, kPacket>& shadows = shadows_;
    std::array<Colour, kPacket> gains;
    std::array<std::size_t, kPacket> which;
    std::array<csg::MaterialId, kPacket> media;
    std::size_t rays = 0;
    Arrival arrival;
    for (std::size_t i = 0; i < count; ++i) {
        if (!spots[i].lit || !lamp.arrive(hits[i].point, {0.5, 0.5}, arrival)) continue;
        const double nl = dot(spots[i].normal, arrival.direction);
        if (nl <= 0.0) continue;
        gains[rays] = gain(queries[i], arrival, nl, spots[i]);
        if (!matters(gains[rays], paths[i])) continue;
        shadows[rays] = from_surface(hits[i], arrival.direction);
        shadows[rays].t_max = arrival.distance;
        media[rays] = hits[i].medium_before;
        which[rays++] = i;
    }
    if (rays == 0) return;
    if (lamp.shadows()) dim({shadows.data(), rays}, media.data(), gains.data());
    for (std::size_t r = 0; r < rays; ++r) spots[which[r]].light += gains[r];
}

/// The lamp's light by several samples of its area; the fewer, the less the hit counts in the picture.
void RayShader::light_softly(const Lamp& lamp, const RayQuery& query, const Hit& hit,
                             const Path& path, Spot& spot) {
    const EyeRay& eye = eyes_[path.lane];
    const double share = std::min(max_norm(path.weight), 1.0) / eye.samples;
    const auto samples =
        static_cast<std::uint32_t>(std::max(std::ceil(lamp.samples() * share), 1.0));
    const double part = 1.0 / samples;
    // Every hit and lamp has its own set of points, of which the pixel's samples take their turns.
    const std::uint64_t set =
        mix(eye.seed + (static_cast<std::uint64_t>(path.event) << 40U) +
            (static_cast<std::uint64_t>(&lamp - stage_->lamps.data()) << 32U) + 1);

    Arrival arrival;
    for (std::uint32_t first = 0; first < samples; first += kPacket) {
        const std::uint32_t last = std::min<std::uint32_t>(first + kPacket, samples);
        std::array<RayQuery, kPacket>& shadows = shadows_;
        std::array<Colour, kPacket> gains;
        std::array<csg::MaterialId, kPacket> media;
        std::size_t rays = 0;
        for (std::uint32_t k = first; k < last; ++k) {
            const Point2 place = sample_point(eye.sample * samples + k, set);
            if (!lamp.arrive(hit.point, place, arrival)) continue;
            const double nl = dot(spot.normal, arrival.direction);
            if (nl <= 0.0) continue;
            gains[rays] = gain(query, arrival, nl, spot);
            if (!matters(gains[rays], path)) continue;
            shadows[rays] = from_surface(hit, arrival.direction);
            shadows[rays].t_max = arrival.distance;
            media[rays++] = hit.medium_before;
        }
        if (rays == 0) continue;
        if (lamp.shadows()) dim({shadows.data(), rays}, media.data(), gains.data());
        for (std::size_t r = 0; r < rays; ++r) spot.light += gains[r] * part;
    }
}

/// Radiance towards the viewer for a lamp that nothing hides.
Colour RayShader::gain(const RayQuery& query, const Arrival& arrival, double nl,
                       const Spot& spot) const {
    const Colour power = arrival.power * nl;
    const Surface& material = *spot.surface;
    if (material.specular.none()) return power * spot.body;
    const double vl = -dot(query.ray.direction, arrival.direction);
    return power *
           (spot.body * (1.0 - material.specular(nl)) + facet_term(material, spot.nv, nl, vl));
}

/// Takes from the gains of a packet of shadow rays what does not arrive. `media`: in which each ray starts.
void RayShader::dim(std::span<const RayQuery> shadows, const csg::MaterialId* media,
                    Colour* gains) {
    counts_.shadow += shadows.size();
    std::array<bool, kPacket> met{};
    if (!stage_->scene->has_transparency()) {
        tracer_.occluded(shadows, met.data());
        for (std::size_t r = 0; r < shadows.size(); ++r) {
            if (met[r]) gains[r] = {};
        }
        return;
    }
    std::array<Hit, kPacket>& hits = shadow_hits_;
    tracer_.first_hits(shadows, hits.data(), met.data());
    for (std::size_t r = 0; r < shadows.size(); ++r) {
        if (!met[r]) {
            const Surface& around = medium(media[r]);
            if (around.absorbs) gains[r] = gains[r] * transmittance(around, shadows[r].t_max);
        } else {
            gains[r] = gains[r] * filtered(shadows[r], hits[r]);
        }
    }
}

/// What transparent parts on the way to a lamp leave of its light, from the first surface `hit` on. It goes straight on,
/// as bending would leave the lamp aside [Whitted80].
Colour RayShader::filtered(RayQuery shadow, Hit hit) {
    Colour left{1, 1, 1};
    for (;;) {
        left = left * transmittance(medium(hit.medium_before), hit.t);
        const Surface& material = surface(hit.material);
        if (!material.transparent) return {};
        const double ratio = medium(hit.medium_after).index / medium(hit.medium_before).index;
        const double cosine = std::fabs(dot(hit.normal, shadow.ray.direction));
        left *= material.transmission * (1.0 - fresnel(cosine, std::max(ratio, 1.0 / ratio)));
        if (max_norm(left) < kDark) return {};
        const double rest = shadow.t_max - hit.t;
        const Surface& behind = medium(hit.medium_after);
        shadow = from_surface(hit, shadow.ray.direction);
        shadow.t_max = rest;
        ++counts_.shadow;
        if (!tracer_.first_hit(shadow, hit)) {
            return behind.absorbs ? left * transmittance(behind, rest) : left;
        }
    }
}

}  // namespace raymo::render
