#include "raymo/trace/tracer.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "raymo/core/assert.hpp"
#include "raymo/math/lanes.hpp"
#include "raymo/math/tolerance.hpp"
#include "raymo/trace/base_ray.hpp"
#include "raymo/trace/data.hpp"
#include "raymo/trace/packet.hpp"
#include "raymo/trace/walk.hpp"

namespace raymo::trace {
namespace {

using solids::LocalRay;
#include "raymo/math/triple.inl"
#include "raymo/trace/localise.inl"
//
#include "raymo/trace/surface.inl"

/// After so many steps aside crossings are taken as they are.
constexpr int kAttempts = 6;
/// The same of steps out of what a glance blurs: then the ray is asked that was blurred first.
constexpr int kBlurredAttempts = 3;

}  // namespace

struct Tracer::State {
    const CompiledScene* scene;
    const CompiledScene::Data* data;
    Walker<1> one;
    Walker<kRays> many;
    BaseRay rays[kRays];
    bool simple = false;  ///< the latest packet was answered by walk_simple
    RayCounts counts;

    template <int L>
    void place(Walker<L>& w, int i, const BaseRay& ray, const RayQuery& query) {
        Context<L>& c = w.contexts[0];
        for (int a = 0; a < 3; ++a) {
            c.o[a][i] = ray.o[a];
            c.d[a][i] = ray.d[a];
        }
        c.t0[i] = 0.0;
        c.error[i] = ray.error;
        c.start_error[i] = ray.start_error;
        w.lanes[i].reset(ray.to_s(0.0), ray.to_s(query.t_max));
        set_box_ray(c, i, w.lanes[i].start, w.lanes[i].limit, w.mode == Mode::all);
    }
    template <int L>
    void start(Walker<L>& w, Mode mode) {
        w.data = data;
        w.mode = mode;
        w.ignore_uncertain = w.ignore_blur = false;
        w.contexts.resize(1);
        Context<L>& c = w.contexts[0];
        c.solid = &data->solids.front();
        c.parent = c.leaf = kNone;
        c.path = 0;
        c.cuts = false;
        c.size = 1.0;
        c.material = csg::kNoMaterial;
        w.counters.reset();
        w.boxes = w.leaves = 0;
    }
    /// Traces a packet in `many`. Returns the rays that must be traced alone, one bit each. Where the solid is simple, which
    /// rays met anything is in many.nearest, and what they met in `hits` (unless that is null).
    LaneBits trace_packet(const RayPacket& packet, LaneBits lanes, Mode mode, HitPacket* hits) {
        RAYMO_ASSERT(lanes != 0);
        const CompiledSolid& base = data->solids.front();
        // Shadows of transparent parts need the materials on the way, which only events give.
        simple = base.simple && (mode == Mode::first || !data->has_transparency);
        start(many, mode);
        many.active = lanes;
        LaneBits deferred = 0;
        if (simple) {
            walk_simple(many, packet, hits);
            deferred = many.nearest.deferred;
        } else {
            const int some = lowest_lane(lanes);
            for (int i = begin_of(lanes); i < (end_of(lanes) + kGroup - 1) / kGroup * kGroup; ++i) {
                const RayQuery query = packet.query((lanes >> i & 1U) != 0 ? i : some);
                rays[i] = base_ray(base, query);
                place(many, i, rays[i], query);
            }
            walk(many);
            for (LaneBits rest = lanes; rest != 0; rest &= rest - 1) {
                const int i = lowest_lane(rest);
                deferred |= (many.lanes[i].stepped_aside ? 1U : 0U) << i;
            }
        }
        counts.boxes += many.boxes;
        counts.leaves += many.leaves;
        return deferred;
    }
    /// Traces one ray in `one`; the ray as traced (perhaps moved aside) is returned.
    BaseRay trace_one(const RayQuery& query, Mode mode) {
        const BaseRay straight = base_ray(data->solids.front(), query);
        BaseRay ray = straight;
        BaseRay first = straight;  // that was found to be blurred
        double step = 0.0;
        int attempts = 0;
        int blurs = 0;
        for (;;) {
            start(one, mode);
            one.ignore_uncertain = attempts == kAttempts;
            one.ignore_blur = blurs > kBlurredAttempts;
            one.active = 1;
            place(one, 0, ray, query);
            walk(one);
            counts.boxes += one.boxes;
            counts.leaves += one.leaves;
            const Lane& lane = one.lanes[0];
            if (!lane.stepped_aside) return ray;
            if (lane.is_blurred) {
                if (blurs == 0) first = ray;
                ray = blurs == kBlurredAttempts
                          ? first
                          : moved_aside(first, lane.step, blurs, query.on_surface);
                ++blurs;
            } else {
                // As a last resort the ray that was moved least: longer steps may lead into another place.
                step = std::max(step, lane.step);
                const int which = attempts + 1 == kAttempts ? 0 : attempts;
                ray = moved_aside(straight, step, which, query.on_surface);
                ++attempts;
            }
        }
    }
    template <int L>
    Hit hit_of(const Walker<L>& w, int i, const BaseRay& ray, const Crossing& crossing) const;
};

/// Fills in what only the surface that is seen needs.
template <int L>
Hit Tracer::State::hit_of(const Walker<L>& w, int i, const BaseRay& ray,
                          const Crossing& crossing) const {
    const Event& event = crossing.event;
    const Context<L>* c = &w.contexts[event.context];
    const Leaf& leaf = c->solid->leaves[event.leaf];
    const Frame& frame = data->frames[leaf.frame];
    const Local<double> local = localise<double>(frame, leaf, c->o[0][i], c->o[1][i], c->o[2][i],
                                                 c->d[0][i], c->d[1][i], c->d[2][i], c->error[i]);
    const Triple<double> place = place_in_leaf(local, event.t - c->t0[i]);
    const Vec3 p{place.x, place.y, place.z};
    Vec3 normal;
    const auto ask = [&]<std::size_t I>(std::integral_constant<std::size_t, I>) {
        if (frame.type == I) normal = std::get<I>(data->kernels)[frame.index].normal(p, event.face);
    };
    [&]<std::size_t... I>(std::index_sequence<I...>) {
        (ask(std::integral_constant<std::size_t, I>{}), ...);
    }
    (std::make_index_sequence<solids::Inventory::kSize>{});
    Triple<double> n = normal_outside(frame, Triple<double>{normal.x, normal.y, normal.z});
    const bool cuts = data->looks[leaf.look].cuts != c->cuts;
    for (; c->parent != kNone; c = &w.contexts[c->parent]) {
        const Leaf& instance = w.contexts[c->parent].solid->leaves[c->leaf];
        n = normal_outside(data->frames[instance.frame], n);
    }
    const double sign = cuts ? -1.0 : 1.0;
    n = {sign * n.x, sign * n.y, sign * n.z};
    // The place is told on the ray as it was given, also when it was moved aside to be traced.
    const Vec3 given = ray.o - ray.moved;
    const Surface<double> surface =
        surface_at(data->solids.front(), Triple<double>{given.x, given.y, given.z},
                   Triple<double>{ray.d.x, ray.d.y, ray.d.z}, n, event.t, event.error, ray.shift,
                   ray.t_per_s, &ray.step);
    Hit hit;
    hit.t = surface.t;
    hit.error = surface.error;
    hit.point = {surface.x, surface.y, surface.z};
    hit.point_error = surface.point_error;
    hit.normal = {n.x, n.y, n.z};
    hit.entering = crossing.entering;
    hit.part = crossing.part;
    hit.material = crossing.material;
    hit.medium_before = crossing.before;
    hit.medium_after = crossing.after;
    const Context<L>& at = w.contexts[event.context];
    hit.surface = {at.solid->first_leaf + event.leaf, at.path, event.face};
    return hit;
}

Tracer::Tracer(const CompiledScene& scene) : state_(std::make_unique<State>()) {
    state_->scene = &scene;
    state_->data = &scene.data();
}
Tracer::~Tracer() = default;
Tracer::Tracer(Tracer&&) noexcept = default;

bool Tracer::first_hit(const RayQuery& query, Hit& hit) {
    State& s = *state_;
    ++s.counts.secondary;
    const BaseRay ray = s.trace_one(query, Mode::first);
    const Lane& lane = s.one.lanes[0];
    if (lane.crossings.empty()) return false;
    hit = s.hit_of(s.one, 0, ray, lane.crossings.front());
    return true;
}

bool Tracer::occluded(const RayQuery& query) {
    State& s = *state_;
    ++s.counts.shadow;
    s.trace_one(query, Mode::any);
    return s.one.lanes[0].blocked;
}

LaneBits Tracer::first_hits(const RayPacket& rays, LaneBits lanes, HitPacket& hits) {
    State& s = *state_;
    s.counts.primary += static_cast<std::uint64_t>(lane_count(lanes));
    const LaneBits deferred = s.trace_packet(rays, lanes, Mode::first, &hits);
    LaneBits found = s.simple ? s.many.nearest.found & ~deferred : 0;
    if (!s.simple) {
        for (LaneBits rest = lanes & ~deferred; rest != 0; rest &= rest - 1) {
            const int i = lowest_lane(rest);
            const Lane& lane = s.many.lanes[i];
            if (lane.crossings.empty()) continue;
            found |= 1U << i;
            hits.set(i, s.hit_of(s.many, i, s.rays[i], lane.crossings.front()));
        }
    }
    for (LaneBits rest = deferred; rest != 0; rest &= rest - 1) {
        const int i = lowest_lane(rest);
        const BaseRay ray = s.trace_one(rays.query(i), Mode::first);
        const Lane& lane = s.one.lanes[0];
        if (lane.crossings.empty()) continue;
        found |= 1U << i;
        hits.set(i, s.hit_of(s.one, 0, ray, lane.crossings.front()));
    }
    return found;
}

LaneBits Tracer::occluded(const RayPacket& rays, LaneBits lanes) {
    State& s = *state_;
    s.counts.shadow += static_cast<std::uint64_t>(lane_count(lanes));
    const LaneBits deferred = s.trace_packet(rays, lanes, Mode::any, nullptr);
    LaneBits blocked = s.simple ? s.many.nearest.found & ~deferred : 0;
    for (LaneBits rest = lanes; rest != 0; rest &= rest - 1) {
        const int i = lowest_lane(rest);
        if ((deferred >> i & 1U) != 0) {
            s.trace_one(rays.query(i), Mode::any);
            blocked |= (s.one.lanes[0].blocked ? 1U : 0U) << i;
        } else if (!s.simple) {
            blocked |= (s.many.lanes[i].blocked ? 1U : 0U) << i;
        }
    }
    return blocked;
}

LaneBits Tracer::passages(const RayPacket& rays, LaneBits lanes, PassagePacket& out,
                          LaneBits& blocked) {
    State& s = *state_;
    RAYMO_ASSERT(lanes != 0);
    blocked = 0;
    out.count = 0;
    if (!s.data->solids.front().simple) return lanes;
    s.start(s.many, Mode::through);
    s.many.active = lanes;
    walk_through(s.many, rays, out);
    s.counts.shadow += static_cast<std::uint64_t>(lane_count(lanes));
    s.counts.boxes += s.many.boxes;
    s.counts.leaves += s.many.leaves;
    blocked = s.many.nearest.found;
    return s.many.nearest.deferred;
}

void Tracer::spans(const Ray& ray, std::vector<std::vector<PartSpan>>& by_part) {
    State& s = *state_;
    ++s.counts.secondary;
    RayQuery query;
    query.ray = ray;
    const BaseRay base = s.trace_one(query, Mode::all);
    by_part.resize(s.scene->part_count());
    for (auto& list : by_part) list.clear();
    for (const Crossing& crossing : s.one.lanes[0].crossings) {
        std::vector<PartSpan>& list = by_part[crossing.part];
        const Hit hit = s.hit_of(s.one, 0, base, crossing);
        if (crossing.entering) {
            list.emplace_back();
            list.back().enter = hit;
            list.back().exit.t = kInfinity;
        } else if (!list.empty()) {
            list.back().exit = hit;
        }
    }
}

LeafInfo Tracer::leaf_info(SurfaceId id) const {
    const CompiledScene::Data& data = *state_->data;
    for (const CompiledSolid& solid : data.solids) {
        if (id.leaf < solid.first_leaf || id.leaf - solid.first_leaf >= solid.leaves.size())
            continue;
        const Look& look = data.looks[solid.leaves[id.leaf - solid.first_leaf].look];
        return {solids::inventory()[look.primitive].schema->name, look.span};
    }
    return {};
}

std::string_view Tracer::face_name(SurfaceId id) const {
    const CompiledScene::Data& data = *state_->data;
    std::string_view name;
    for (const CompiledSolid& solid : data.solids) {
        if (id.leaf < solid.first_leaf || id.leaf - solid.first_leaf >= solid.leaves.size())
            continue;
        const Frame& frame = data.frames[solid.leaves[id.leaf - solid.first_leaf].frame];
        const auto ask = [&]<std::size_t I>(std::integral_constant<std::size_t, I>) {
            if (frame.type != I) return;
            const auto faces = std::get<I>(data.kernels)[frame.index].faces();
            if (!faces.empty()) name = faces[std::min<std::size_t>(id.face, faces.size() - 1)];
        };
        [&]<std::size_t... I>(std::index_sequence<I...>) {
            (ask(std::integral_constant<std::size_t, I>{}), ...);
        }
        (std::make_index_sequence<solids::Inventory::kSize>{});
    }
    return name;
}

const RayCounts& Tracer::counts() const { return state_->counts; }

}  // namespace raymo::trace
