#include "raymo/trace/tracer.hpp"

#include <algorithm>
#include <cmath>

#include "raymo/core/assert.hpp"
#include "raymo/math/lanes.hpp"
#include "raymo/math/tolerance.hpp"
#include "raymo/trace/data.hpp"
#include "raymo/trace/walk.hpp"

namespace raymo::trace {
namespace {

using solids::LocalRay;
#include "raymo/trace/localise.inl"

/// A ray in the frame of the base solid: x = (o + s d), and how s gives the user's t.
struct BaseRay {
    Vec3 o, d;
    double shift = 0.0;    ///< s = 0 stands at this parameter (in lengths of d) of the user's ray
    double t_per_s = 1.0;  ///< user's t = (s + shift) * t_per_s
    double error = 0.0;    ///< of o
    double step = 0.0;     ///< how far the ray was moved aside

    [[nodiscard]] double to_s(double t) const { return t / t_per_s - shift; }
    [[nodiscard]] double to_t(double s) const { return (s + shift) * t_per_s; }
};

/// a + b = sum + rest, exactly [Knuth].
struct Sum {
    double sum, rest;
};
Sum two_sum(double a, double b) {
    const double s = a + b;
    const double bb = s - a;
    return {s, (a - (s - bb)) + (b - bb)};
}

/// An origin far away is moved to the point of the line nearest to the solid, in doubled precision,
/// so that the distance costs no accuracy.
BaseRay base_ray(const CompiledSolid& solid, const RayQuery& query) {
    BaseRay out;
    const Vec3 direction = query.ray.direction;
    const int exponent = -std::ilogb(max_norm(direction));
    const double unit_scale = std::ldexp(1.0, exponent);
    out.t_per_s = unit_scale / solid.scale;
    Vec3 low;
    for (int a = 0; a < 3; ++a) {
        const Sum s = two_sum(query.ray.origin[a], -solid.centre[a]);
        out.o[a] = s.sum * solid.scale;
        low[a] = s.rest * solid.scale;
        out.d[a] = direction[a] * unit_scale;
    }
    const double far = max_norm(out.o);
    out.error = query.start_error * solid.scale + 4.0 * kUnitRoundoff * std::min(far, 4.0);
    if (far > 2.0) {
        out.shift = -dot(out.o, out.d) / dot(out.d, out.d);
        for (int a = 0; a < 3; ++a) {
            const double product = out.shift * out.d[a];
            const double rest = std::fma(out.shift, out.d[a], -product);
            const Sum s = two_sum(out.o[a], product);
            out.o[a] = s.sum + (s.rest + (rest + low[a]));
        }
        out.error += 8.0 * kUnitRoundoff * (max_norm(out.o) + kUnitRoundoff * far);
    }
    return out;
}

/// Moves the ray sideways, in a new generic direction at each attempt.
BaseRay moved_aside(BaseRay ray, double step, int attempt) {
    Vec3 s, t;
    make_frame(unit(ray.d), s, t);
    const double angle = 0.7390851332 + 2.39996322973 * attempt;
    const double length = step * static_cast<double>(1 << (2 * attempt));
    ray.o += s * (length * std::cos(angle)) + t * (length * std::sin(angle));
    ray.step = length;
    ray.error += length * 0x1p-20;
    return ray;
}

constexpr int kAttempts = 6;

}  // namespace

struct Tracer::State {
    const CompiledScene* scene;
    const CompiledScene::Data* data;
    Walker<1> one;
    Walker<8> eight;
    BaseRay rays[kPacket];
    RayCounts counts;

    template <int L>
    void place(Walker<L>& w, int i, const BaseRay& ray, const RayQuery& query) {
        Context<L>& c = w.contexts[0];
        for (int a = 0; a < 3; ++a) {
            c.o[a][i] = ray.o[a];
            c.d[a][i] = ray.d[a];
        }
        c.t0[i] = 0.0;
        // A ray that was moved aside starts beside its surface, by as much.
        c.error[i] = ray.error;
        w.lanes[i].reset(ray.to_s(0.0), ray.to_s(query.t_max));
        set_box_ray(c, i, w.lanes[i].start, w.lanes[i].limit, w.mode == Mode::all);
    }
    template <int L>
    void start(Walker<L>& w, Mode mode) {
        w.data = data;
        w.mode = mode;
        w.ignore_uncertain = false;
        w.contexts.resize(1);
        Context<L>& c = w.contexts[0];
        c.solid = &data->solids.front();
        c.parent = c.leaf = kNone;
        c.path = 0;
        c.cuts = false;
        c.material = csg::kNoMaterial;
        w.counters.reset();
        w.boxes = w.leaves = 0;
    }
    /// Traces one ray in `one`; the ray as traced (perhaps moved aside) is returned.
    BaseRay trace_one(const RayQuery& query, Mode mode) {
        const BaseRay straight = base_ray(data->solids.front(), query);
        BaseRay ray = straight;
        double step = 0.0;
        for (int attempt = 0;; ++attempt) {
            start(one, mode);
            one.ignore_uncertain = attempt == kAttempts;
            one.active = 1;
            place(one, 0, ray, query);
            walk(one);
            counts.boxes += one.boxes;
            counts.leaves += one.leaves;
            if (!one.lanes[0].stepped_aside) return ray;
            step = std::max(step, kSidestep * one.lanes[0].step);
            ray = moved_aside(straight, step, attempt);
        }
    }
    template <int L>
    Hit hit_of(const Walker<L>& w, int i, const BaseRay& ray, const Crossing& crossing,
               const RayQuery& query) const;
};

/// Fills in what only the surface that is seen needs.
template <int L>
Hit Tracer::State::hit_of(const Walker<L>& w, int i, const BaseRay& ray, const Crossing& crossing,
                          const RayQuery& query) const {
    const Event& event = crossing.event;
    const Context<L>* c = &w.contexts[event.context];
    const Leaf& leaf = c->solid->leaves[event.leaf];
    const Frame& frame = data->frames[leaf.frame];
    const Local<double> local = localise<double>(frame, leaf, c->o[0][i], c->o[1][i], c->o[2][i],
                                                 c->d[0][i], c->d[1][i], c->d[2][i], c->error[i]);
    const double s = (event.t - c->t0[i]) - local.shift;
    const Vec3 p{local.ray.ox + s * local.ray.dx, local.ray.oy + s * local.ray.dy,
                 local.ray.oz + s * local.ray.dz};
    Vec3 normal;
    const auto ask = [&]<std::size_t I>(std::integral_constant<std::size_t, I>) {
        if (frame.type == I) normal = std::get<I>(data->kernels)[frame.index].normal(p, event.face);
    };
    [&]<std::size_t... I>(std::index_sequence<I...>) {
        (ask(std::integral_constant<std::size_t, I>{}), ...);
    }
    (std::make_index_sequence<solids::Inventory::kSize>{});
    normal = unit(transposed_times(frame.to_local, normal));
    bool cuts = data->looks[leaf.look].cuts != c->cuts;
    for (; c->parent != kNone; c = &w.contexts[c->parent]) {
        const Leaf& instance = w.contexts[c->parent].solid->leaves[c->leaf];
        normal = unit(transposed_times(data->frames[instance.frame].to_local, normal));
    }
    if (cuts) normal = -normal;

    Hit hit;
    const CompiledSolid& base = data->solids.front();
    const Vec3 place = ray.o + ray.d * event.t;
    const double facing = std::fabs(dot(normal, ray.d));
    const double aside = ray.step > 0.0 ? std::min(ray.step / std::max(facing, 1e-300), 2.0) : 0.0;
    hit.t = ray.to_t(event.t);
    hit.error = (event.error + aside + 2.0 * kUnitRoundoff * std::fabs(ray.shift)) * ray.t_per_s +
                2.0 * kUnitRoundoff * std::fabs(hit.t);
    hit.point = base.centre + place / base.scale;
    hit.point_error =
        (event.error * facing + 4.0 * kUnitRoundoff * (max_norm(ray.o) + std::fabs(event.t))) /
            base.scale +
        2.0 * kUnitRoundoff * (max_norm(hit.point) + max_norm(base.centre));
    hit.normal = normal;
    hit.entering = crossing.entering;
    hit.part = crossing.part;
    hit.material = crossing.material;
    hit.medium_before = crossing.before;
    hit.medium_after = crossing.after;
    const Context<L>& at = w.contexts[event.context];
    hit.surface = {at.solid->first_leaf + event.leaf, at.path, event.face};
    static_cast<void>(query);
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
    hit = s.hit_of(s.one, 0, ray, lane.crossings.front(), query);
    return true;
}

bool Tracer::occluded(const RayQuery& query) {
    State& s = *state_;
    ++s.counts.shadow;
    s.trace_one(query, Mode::any);
    return s.one.lanes[0].blocked;
}

void Tracer::first_hits(std::span<const RayQuery> queries, Hit* hits, bool* found) {
    State& s = *state_;
    RAYMO_ASSERT(queries.size() <= kPacket);
    s.counts.primary += queries.size();
    s.start(s.eight, Mode::first);
    s.eight.active = (1U << queries.size()) - 1U;
    for (std::size_t i = 0; i < kPacket; ++i) {
        const RayQuery& query = queries[std::min(i, queries.size() - 1)];
        s.rays[i] = base_ray(s.data->solids.front(), query);
        s.place(s.eight, static_cast<int>(i), s.rays[i], query);
    }
    walk(s.eight);
    s.counts.boxes += s.eight.boxes;
    s.counts.leaves += s.eight.leaves;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const Lane& lane = s.eight.lanes[i];
        if (lane.stepped_aside) {
            const BaseRay ray = s.trace_one(queries[i], Mode::first);
            const Lane& again = s.one.lanes[0];
            found[i] = !again.crossings.empty();
            if (found[i]) hits[i] = s.hit_of(s.one, 0, ray, again.crossings.front(), queries[i]);
            continue;
        }
        found[i] = !lane.crossings.empty();
        if (found[i]) {
            hits[i] = s.hit_of(s.eight, static_cast<int>(i), s.rays[i], lane.crossings.front(),
                               queries[i]);
        }
    }
}

void Tracer::occluded(std::span<const RayQuery> queries, bool* blocked) {
    State& s = *state_;
    RAYMO_ASSERT(queries.size() <= kPacket);
    s.counts.shadow += queries.size();
    s.start(s.eight, Mode::any);
    s.eight.active = (1U << queries.size()) - 1U;
    for (std::size_t i = 0; i < kPacket; ++i) {
        const RayQuery& query = queries[std::min(i, queries.size() - 1)];
        s.rays[i] = base_ray(s.data->solids.front(), query);
        s.place(s.eight, static_cast<int>(i), s.rays[i], query);
    }
    walk(s.eight);
    s.counts.boxes += s.eight.boxes;
    s.counts.leaves += s.eight.leaves;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const Lane& lane = s.eight.lanes[i];
        blocked[i] = lane.blocked;
        if (lane.stepped_aside) {
            s.trace_one(queries[i], Mode::any);
            blocked[i] = s.one.lanes[0].blocked;
        }
    }
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
        const Hit hit = s.hit_of(s.one, 0, base, crossing, query);
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
            if (id.face < faces.size()) name = faces[id.face];
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
