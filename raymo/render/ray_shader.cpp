#include "raymo/render/ray_shader.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace raymo::render {
namespace {

using trace::Hit;
using trace::HitPacket;
using trace::lowest_lane;
using trace::RayPacket;

/// Longest chain of reflections and refractions, and least weight, that options may ask for: a
/// picture is finished whatever they say. The weights of rays of one depth add up to at most 1, so
/// at most kMostDepth / kLeastWeight rays descend from one.
constexpr int kMostDepth = 64;
constexpr double kLeastWeight = 0x1p-16;

/// Light through less than this is no light.
constexpr double kDark = 0x1p-12;

/// Less than this part of min_weight can not be seen even in sums over a few lamps.
constexpr double kUnseen = 0.125;

Signature signature_of(const HitPacket& hits, int i) {
    std::uint64_t x = mix(hits.leaf[i] + (static_cast<std::uint64_t>(hits.instance[i]) << 32U));
    x = mix(x + hits.face[i] + (static_cast<std::uint64_t>(hits.part[i]) << 20U) +
            ((hits.entering >> i & 1U) != 0 ? 1ULL << 19U : 0U));
    const auto scaled = [](double c) { return static_cast<std::int8_t>(c * 127.0); };
    return {static_cast<std::uint32_t>(x) | 1U,
            {scaled(hits.normal[0][i]), scaled(hits.normal[1][i]), scaled(hits.normal[2][i])}};
}

Colour lane_of(const double (&colours)[3][kRays], int lane) {
    return {colours[0][lane], colours[1][lane], colours[2][lane]};
}
void set_lane(double (&colours)[3][kRays], int lane, Colour c) {
    for (int a = 0; a < 3; ++a) colours[a][lane] = c[a];
}

/// Gives the lanes named one value.
template <class T>
void fill(T (&row)[kRays], LaneBits lanes, T value) {
    if (lanes == trace::kAllLanes) {
        std::fill_n(row, kRays, value);
        return;
    }
    for (LaneBits rest = lanes; rest != 0; rest &= rest - 1) row[lowest_lane(rest)] = value;
}

}  // namespace

Stage::Stage(const trace::CompiledScene& compiled, const Look& look, const Options& options)
    : scene(&compiled),
      lamps(prepared(look.lights, options.quality != Quality::final)),
      around{look.ambient, look.background},
      max_depth(options.quality == Quality::draft ? 0
                                                  : std::clamp(options.max_depth, 0, kMostDepth)),
      min_weight(std::max(options.min_weight, kLeastWeight)),
      clear(compiled.has_transparency()),
      absorbs(compiled.has_absorption()),
      soft(std::any_of(lamps.begin(), lamps.end(), [](const Lamp& l) { return l.is_area(); })) {}

RayShader::RayShader(const Stage& stage)
    : stage_(&stage), tracer_(*stage.scene), surfaces_(*stage.scene) {}

trace::RayCounts RayShader::counts() const {
    trace::RayCounts counts = tracer_.counts();
    counts.primary = counts_.primary;
    counts.shadow = counts_.shadow;
    counts.secondary = counts_.secondary;
    return counts;
}

void RayShader::answer(const EyeBatch& eyes, Answers& answers) {
    eyes_ = &eyes;
    answers_ = &answers;
    counts_.primary += eyes.count;
    order_.clear();
    Paths paths;
    for (std::size_t first = 0; first < eyes.count; first += kRays) {
        const RayPacket& rays = eyes.rays[first / kRays];
        const LaneBits lanes = trace::first_lanes(std::min<std::size_t>(eyes.count - first, kRays));
        const HitPacket& hits = order_.next();
        const LaneBits found = tracer_.first_hits(rays, lanes, order_.next());
        if (found != lanes) shade_background(stage_->around, rays.d, spots_.light);
        for (LaneBits rest = lanes; rest != 0; rest &= rest - 1) {
            const int i = lowest_lane(rest);
            const std::size_t owner = first + static_cast<std::size_t>(i);
            const bool met = (found >> i & 1U) != 0;
            answers.light[owner] = met ? Colour{} : lane_of(spots_.light, i);
            if (eyes.signatures)
                answers.signature[owner] = met ? signature_of(hits, i) : Signature{};
        }
        if (found == 0 || order_.add(first / kRays, found)) continue;
        std::iota(paths.owner, paths.owner + kRays, static_cast<std::uint32_t>(first));
        shade_met(rays.d, hits, found, paths);
    }
    order_.sort();
    alignas(64) double view[3][kRays];
    for (std::size_t first = 0; first < order_.size(); first += kRays) {
        const LaneBits lanes = order_.take(first, eyes.rays.data(), own_hits_, view, paths.owner);
        shade_met(view, own_hits_, lanes, paths);
    }
    while (!views_.empty() || !images_.empty()) follow(views_.empty() ? images_ : views_);
}

void RayShader::shade_met(const double (&view)[3][kRays], const HitPacket& hits, LaneBits lanes,
                          Paths& paths) {
    std::fill_n(paths.name, kRays, 1U);
    std::fill_n(paths.depth, kRays, 0U);
    std::fill_n(&spots_.weight[0][0], 3 * kRays, 1.0);
    shade(view, hits, lanes, paths);
    while (views_.size() >= kRays) follow(views_);
    while (images_.size() >= kRays) {
        follow(images_);
        while (views_.size() >= kRays) follow(views_);
    }
}

void RayShader::follow(RayStack& stack) {
    RayPacket rays;
    Paths paths;
    const LaneBits lanes = stack.pop(rays, spots_.weight, paths);
    counts_.secondary += static_cast<std::uint64_t>(trace::lane_count(lanes));
    const LaneBits found = tracer_.first_hits(rays, lanes, own_hits_);
    if (found != lanes) {
        shade_background(stage_->around, rays.d, spots_.light);
        for (LaneBits rest = lanes & ~found; rest != 0; rest &= rest - 1) {
            const int i = lowest_lane(rest);
            answers_->light[paths.owner[i]] += lane_of(spots_.weight, i) * lane_of(spots_.light, i);
        }
    }
    if (found != 0) shade(rays.d, own_hits_, found, paths);
}

/// The surfaces that were met.
void RayShader::look_up(LaneBits lanes) {
    const int some = lowest_lane(lanes);
    spots_.same = true;
    spots_.tinted = spots_.transparent = spots_.mirrors = spots_.slow = spots_.dark = 0;
    LaneBits absorbed = 0;
    std::fill_n(spots_.index, kRays, 1.0);
    for (LaneBits rest = lanes; rest != 0;) {
        // All that met one material between the same media.
        const int i = lowest_lane(rest);
        LaneBits alike = met_alike(*hits_, i) & rest;
        rest &= ~alike;
        if (alike == lanes) alike = trace::kAllLanes;
        const Surface* material = &surfaces_[hits_->material[i]];
        const Surface& before = surfaces_[hits_->medium_before[i]];
        if (before.absorbs) absorbed |= alike;
        if (material->transparent) {
            const Surface& after = surfaces_[hits_->medium_after[i]];
            // Where something opaque starts right behind a transparent surface, that is what is
            // seen.
            if (hits_->medium_after[i] != Hit::kAir && !after.transparent) {
                material = &after;
            } else {
                fill(spots_.index, alike, after.index / before.index);
                spots_.transparent |= alike;
            }
        }
        fill(spots_.surface, alike, material);
        spots_.same = spots_.same && material == spots_.surface[some];
        if (material->tinted) spots_.tinted |= alike;
        if (material->specular.none() && max_norm(material->body) == 0.0) spots_.dark |= alike;
        if (!material->transparent && !material->mirror.none()) spots_.mirrors |= alike;
        if (material->facets.kind != scene::Facets::trowbridge_reitz) spots_.slow |= alike;
    }
    fill(spots_.surface, ~lanes & trace::kAllLanes, spots_.surface[some]);
    for (LaneBits rest = absorbed & lanes; rest != 0; rest &= rest - 1) {
        // What the way to the hit has taken.
        const int i = lowest_lane(rest);
        set_lane(spots_.weight, i,
                 lane_of(spots_.weight, i) *
                     transmittance(surfaces_[hits_->medium_before[i]], hits_->t[i]));
    }
}

void RayShader::shade(const double (&view)[3][kRays], const HitPacket& hits, LaneBits lanes,
                      const Paths& paths) {
    hits_ = &hits;
    look_up(lanes);
    shade_surroundings(stage_->around, view, hits, lanes, spots_, reflected_, refracted_);
    go_on(reflected_, paths, 0);
    go_on(refracted_, paths, 1);
    const double least = kUnseen * stage_->min_weight;
    for (const Lamp& lamp : stage_->lamps) {
        if (spots_.lit == 0) break;
        if (lamp.is_area()) {
            for (LaneBits rest = spots_.lit; rest != 0; rest &= rest - 1) {
                const int i = lowest_lane(rest);
                light_softly(lamp, view, i, paths.owner[i], paths.name[i]);
            }
            continue;
        }
        shade_by_lamp(lamp, view, hits, spots_.lit, spots_, least, gains_, shadows_);
        if (gains_.lanes == 0) continue;
        if (lamp.shadows) dim(shadows_, -1);
        add_gains(gains_, spots_);
    }
    for (LaneBits rest = lanes & ~spots_.dark; rest != 0; rest &= rest - 1) {
        const int i = lowest_lane(rest);
        answers_->light[paths.owner[i]] += lane_of(spots_.weight, i) * lane_of(spots_.light, i);
    }
}

/// Lets rays go on, or puts ambient light in the place of what they would bring. `turn`: 1 where they are refracted.
void RayShader::go_on(const Onward& onward, const Paths& paths, std::uint32_t turn) {
    if (onward.lanes == 0) return;
    LaneBits going = worth_tracing(onward, stage_->min_weight);
    const auto most = static_cast<std::uint32_t>(stage_->max_depth);
    std::uint32_t left = 0;  // negative where one is too deep
    for (const std::uint32_t depth : paths.depth) left |= most - 1 - depth;
    if (static_cast<std::int32_t>(left) < 0) {
        for (LaneBits rest = going; rest != 0; rest &= rest - 1) {
            const int i = lowest_lane(rest);
            if (paths.depth[i] >= most) going &= ~(1U << i);
        }
    }
    for (LaneBits rest = onward.lanes & ~going; rest != 0; rest &= rest - 1) {
        const int i = lowest_lane(rest);
        answers_->light[paths.owner[i]] += lane_of(onward.weight, i) * stage_->around.ambient;
    }
    if (going != 0) (turn == 0 ? images_ : views_).push(*hits_, onward, going, paths, turn);
}

/// The lamp's light by several samples of its area; the fewer, the less the hit counts in the picture.
void RayShader::light_softly(const Lamp& lamp, const double (&view)[3][kRays], int lane,
                             std::uint32_t owner, std::uint32_t name) {
    const double share = std::min(max_norm(lane_of(spots_.weight, lane)), 1.0) / eyes_->samples;
    const auto samples = static_cast<std::uint32_t>(std::max(std::ceil(lamp.samples * share), 1.0));
    const double part = 1.0 / samples;
    // Every hit and lamp has its own set of points, of which the pixel's samples take their turns.
    const std::uint64_t set = mix(eyes_->seed[owner] + (static_cast<std::uint64_t>(name) << 32U) +
                                  static_cast<std::uint64_t>(&lamp - stage_->lamps.data()) + 1);
    alignas(64) double u[kRays] = {};
    alignas(64) double v[kRays] = {};
    const double least = kUnseen * stage_->min_weight;
    for (std::uint32_t first = 0; first < samples; first += kRays) {
        const std::uint32_t count = std::min(samples - first, static_cast<std::uint32_t>(kRays));
        for (std::uint32_t k = 0; k < count; ++k) {
            const Point2 place = sample_point(eyes_->sample[owner] * samples + first + k, set);
            u[k] = place.u;
            v[k] = place.v;
        }
        shade_by_lamp_places(lamp, view, *hits_, lane, trace::first_lanes(count), u, v, spots_,
                             least, gains_, shadows_);
        if (gains_.lanes == 0) continue;
        if (lamp.shadows) dim(shadows_, lane);
        for (LaneBits rest = gains_.lanes; rest != 0; rest &= rest - 1) {
            const int i = lowest_lane(rest);
            for (int a = 0; a < 3; ++a) spots_.light[a][lane] += gains_.light[a][i] * part;
        }
    }
}

/// Takes from the gains what does not arrive. Ray i of `shadows` starts at hit `hit`, or at hit i if that is -1.
void RayShader::dim(RayPacket& shadows, int hit) {
    counts_.shadow += static_cast<std::uint64_t>(trace::lane_count(gains_.lanes));
    if (stage_->clear) {
        filter(shadows, hit);
    } else {
        gains_.lanes &= ~tracer_.occluded(shadows, gains_.lanes);
    }
}

/// The same with transparent parts on the way to a lamp. Light goes straight on through them, as bending would leave the
/// lamp aside [Whitted80].
void RayShader::filter(RayPacket& shadows, int hit) {
    std::fill_n(left_, kRays, 1.0);
    csg::MaterialId medium = Hit::kAir;
    const Surface* around = &surfaces_[medium];
    // Without media that absorb, nobody asks what a ray is in.
    const LaneBits dimmed = stage_->absorbs ? trace::kAllLanes : 0;
    for (LaneBits rest = gains_.lanes & dimmed; rest != 0; rest &= rest - 1) {
        const int i = lowest_lane(rest);
        const csg::MaterialId id = hits_->medium_before[hit < 0 ? i : hit];
        if (id != medium) around = &surfaces_[medium = id];
        around_[i] = around;
    }
    LaneBits blocked = 0;
    LaneBits by_steps = tracer_.passages(shadows, gains_.lanes, passages_, blocked);
    LaneBits arriving = gains_.lanes & ~(blocked | by_steps);
    alignas(64) double reached[kRays] = {};
    for (int k = 0; k < passages_.count && arriving != 0; ++k) {
        const HitPacket& met = passages_.hits[k];
        const LaneBits crossing = arriving & passages_.lanes[k];
        if (crossing != 0) arriving &= ~crossing | cross(met, shadows.d, reached, crossing);
    }
    for (LaneBits rest = arriving & dimmed; rest != 0; rest &= rest - 1) {
        const int i = lowest_lane(rest);
        absorb_gain(i, *around_[i], shadows.t_max[i] - reached[i]);
    }
    // The others go from surface to surface.
    while (by_steps != 0) {
        const LaneBits found = tracer_.first_hits(shadows, by_steps, shadow_hits_);
        for (LaneBits rest = by_steps & ~found & dimmed; rest != 0; rest &= rest - 1) {
            const int i = lowest_lane(rest);
            absorb_gain(i, *around_[i], shadows.t_max[i]);
        }
        arriving |= by_steps & ~found;
        std::fill_n(reached, kRays, 0.0);
        by_steps = found == 0 ? 0 : cross(shadow_hits_, shadows.d, reached, found);
        if (by_steps == 0) break;
        shadows.go_on_from(shadow_hits_, by_steps);
        counts_.shadow += static_cast<std::uint64_t>(trace::lane_count(by_steps));
    }
    gains_.lanes = arriving;
    for (auto& row : gains_.light) {
        for (int i = 0; i < kRays; ++i) row[i] *= left_[i];
    }
}

void RayShader::absorb_gain(int lane, const Surface& medium, double length) {
    if (!medium.absorbs) return;
    set_lane(gains_.light, lane, lane_of(gains_.light, lane) * transmittance(medium, length));
}

/// Takes rays to a lamp along `view` across the surfaces that they meet, and `reached` to there. Returns those of `lanes` that
/// still bring light.
LaneBits RayShader::cross(const HitPacket& met, const double (&view)[3][kRays],
                          double (&reached)[kRays], LaneBits lanes) {
    alignas(64) double transmission[kRays] = {};
    alignas(64) double ratio[kRays] = {};
    std::fill_n(ratio, kRays, 1.0);
    LaneBits going = lanes;
    for (LaneBits rest = lanes; rest != 0;) {
        const int first = lowest_lane(rest);
        const LaneBits alike = met_alike(met, first) & rest;
        rest &= ~alike;
        const Surface& material = surfaces_[met.material[first]];
        if (!material.transparent) {
            going &= ~alike;
            continue;
        }
        const Surface& before = surfaces_[met.medium_before[first]];
        const Surface& after = surfaces_[met.medium_after[first]];
        fill(transmission, alike, material.transmission);
        fill(ratio, alike,
             std::max(after.index, before.index) / std::min(after.index, before.index));
        fill(around_, alike, &after);
        for (LaneBits each = stage_->absorbs ? alike : 0; each != 0; each &= each - 1) {
            const int i = lowest_lane(each);
            absorb_gain(i, before, met.t[i] - reached[i]);
            reached[i] = met.t[i];
        }
    }
    if (going == 0) return 0;
    shade_passage(met, view, going, transmission, ratio, left_);
    for (LaneBits rest = going; rest != 0; rest &= rest - 1) {
        const int i = lowest_lane(rest);
        if (left_[i] < kDark) going &= ~(1U << i);
    }
    return going;
}

}  // namespace raymo::render
