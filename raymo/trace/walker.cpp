#include "raymo/trace/walker.hpp"

#include <algorithm>
#include <cmath>

#include "raymo/math/affine.hpp"
#include "raymo/math/tolerance.hpp"

namespace raymo::trace {
namespace {

using solids::LocalRay;
#include "raymo/trace/localise.inl"

}  // namespace

/// A ray may glance off a face so that where it crosses it is hardly known, and cross others there that are. What comes first
/// may be told a little aside, where it crosses that face elsewhere. Faces that coincide glance alike, and are left to cancel.
/// Returns how far aside; 0 where there is no such face.
template <int L>
double Walker<L>::blurred(int index, std::size_t end) const {
    const Lane& lane = lanes[index];
    const auto place_error = [&](const Event& event) {
        const Context<L>& c = contexts[event.context];
        const Leaf& leaf = leaf_of(event);
        const auto local = localise<double>(data->frames[leaf.frame], leaf, c.o[0][index],
                                            c.o[1][index], c.o[2][index], c.d[0][index],
                                            c.d[1][index], c.d[2][index], c.error[index]);
        return local.place_error * c.size;
    };
    const auto counts = [](const Event& event) {
        return !event.uncertain && !event.idle && event.error > 0.0 && event.error < kInfinity;
    };
    double worst = 0.0;
    for (std::size_t i = lane.head; i < end; ++i) {
        if (counts(lane.events[i])) worst = std::max(worst, lane.events[i].error);
    }
    if (worst < kBlurred) return 0.0;
    double steepest = 0.0;
    double least = kInfinity;
    double step = 0.0;
    for (std::size_t i = lane.head; i < end; ++i) {
        const Event& event = lane.events[i];
        if (!counts(event)) continue;
        const double place = place_error(event);
        const double climb = place / event.error;
        steepest = std::max(steepest, climb);
        if (event.error < kBlurred || climb >= least) continue;
        least = climb;
        step = kBlurredStep * place;
    }
    return steepest > kBlurredClimb * least ? step : 0.0;
}

template <int L>
void Walker<L>::flip(int lane, const Event& event) {
    std::uint32_t context = event.context;
    const Leaf& leaf = leaf_of(event);
    std::uint32_t group = leaf.parent;
    bool literal = event.enter != data->looks[leaf.look].literal_negated;
    while (true) {
        const CompiledSolid& solid = *contexts[context].solid;
        const Group& g = solid.groups[group];
        std::int32_t& count = counters.find(context, group, g.initial)[lane];
        const bool before = count > 0;
        count += literal ? 1 : -1;
        const bool after = count > 0;
        if (before == after) return;
        const auto known_group = [&](const Turned& t) {
            return t.group == group && t.context == context;
        };
        if (std::find_if(turned_.begin(), turned_.end(), known_group) == turned_.end()) {
            turned_.push_back({context, group, before});
        }
        if (g.parent != kNone) {
            literal = after != g.negated;
            group = g.parent;
        } else if (context != 0) {
            const Leaf& instance =
                contexts[contexts[context].parent].solid->leaves[contexts[context].leaf];
            literal = after != data->looks[instance.look].literal_negated;
            group = instance.parent;
            context = contexts[context].parent;
        } else {
            const auto same = [&](const Change& c) { return c.part == group; };
            const auto known = std::find_if(changes_.begin(), changes_.end(), same);
            if (known != changes_.end()) {
                changes_.erase(known);  // there and back
            } else {
                changes_.push_back({group, after});
            }
            return;
        }
    }
}

template <int L>
void Walker<L>::advance(int index, double horizon) {
    Lane& lane = lanes[index];
    while (!lane.done && lane.head < lane.events.size() && lane.events[lane.head].lo < horizon) {
        double hi = lane.events[lane.head].hi();
        std::size_t end = lane.head + 1;
        while (end < lane.events.size() && lane.events[end].lo <= hi) {
            hi = std::max(hi, lane.events[end].hi());
            ++end;
        }
        if (!(hi < horizon)) return;
        if (mode != Mode::all && lane.events[lane.head].lo > lane.limit) {
            finish(index);
            return;
        }
        settle(index, end);
    }
}

template <int L>
void Walker<L>::finish(int index) {
    Lane& lane = lanes[index];
    if (lane.done) return;
    lane.done = true;
    if (mode != Mode::any) return;
    for (const Medium& medium : lane.inside) {
        lane.blocked = lane.blocked || is_opaque(medium.material);
    }
}

template <int L>
bool Walker<L>::climb(std::uint32_t& context, std::uint32_t& group) const {
    const Group& g = contexts[context].solid->groups[group];
    if (g.parent != kNone) {
        group = g.parent;
        return true;
    }
    if (context == 0) return false;
    const Context<L>& c = contexts[context];
    group = contexts[c.parent].solid->leaves[c.leaf].parent;
    context = c.parent;
    return true;
}

template <int L>
std::uint32_t Walker<L>::part_of(const Event& event) const {
    std::uint32_t context = event.context;
    std::uint32_t group = leaf_of(event).parent;
    while (climb(context, group)) {
    }
    return group;
}

/// Whether the event's leaf stands below a group.
template <int L>
bool Walker<L>::below(const Event& event, std::uint32_t context, std::uint32_t group) const {
    std::uint32_t c = event.context;
    std::uint32_t g = leaf_of(event).parent;
    do {
        if (c == context && g == group) return true;
    } while (climb(c, g));
    return false;
}

/// Whether all groups above the event's leaf have another value after the cluster than before, so that the leaf had a
/// part in the change.
template <int L>
bool Walker<L>::turned(int lane, const Event& event) {
    std::uint32_t context = event.context;
    std::uint32_t group = leaf_of(event).parent;
    do {
        const auto same = [&](const Turned& t) { return t.group == group && t.context == context; };
        const auto known = std::find_if(turned_.begin(), turned_.end(), same);
        if (known == turned_.end()) return false;
        const Group& g = contexts[context].solid->groups[group];
        const bool now = counters.find(context, group, g.initial)[lane] > 0;
        if (now == known->before) return false;
    } while (climb(context, group));
    return true;
}

/// Whether a's leaf stands left of b's in the model: by the places of leaf and instances where their paths part.
template <int L>
bool Walker<L>::left_of(const Event& a, const Event& b) const {
    const auto depth = [&](std::uint32_t context) {
        int d = 0;
        for (; context != 0; context = contexts[context].parent) ++d;
        return d;
    };
    std::uint32_t ca = a.context;
    std::uint32_t cb = b.context;
    std::uint32_t oa = leaf_of(a).order;
    std::uint32_t ob = leaf_of(b).order;
    const auto up = [&](std::uint32_t& context, std::uint32_t& order) {
        const Context<L>& c = contexts[context];
        order = contexts[c.parent].solid->leaves[c.leaf].order;
        context = c.parent;
    };
    int da = depth(ca);
    int db = depth(cb);
    for (; da > db; --da) up(ca, oa);
    for (; db > da; --db) up(cb, ob);
    while (ca != cb) {
        up(ca, oa);
        up(cb, ob);
    }
    return oa < ob;
}

/// Of the events of the cluster that have made the change, the one that stands leftmost in the model.
template <int L>
const Event& Walker<L>::shown_by(int index, std::size_t end, const Change& change) {
    const Lane& lane = lanes[index];
    const Event* best = nullptr;
    const Event* any = nullptr;
    for (std::size_t i = lane.head; i < end; ++i) {
        const Event& event = lane.events[i];
        if (event.uncertain || event.idle) continue;
        if (any == nullptr) any = &event;
        const bool cuts = data->looks[leaf_of(event).look].cuts != contexts[event.context].cuts;
        if ((event.enter != cuts) != change.inside) continue;
        if (changes_.size() > 1 && part_of(event) != change.part) continue;
        if (end - lane.head > 1 && !turned(index, event)) continue;
        if (best == nullptr || left_of(event, *best)) best = &event;
    }
    return best != nullptr ? *best : *any;
}

/// A leaf's own material, else that of its instance; a cutter without one shows what it cuts.
template <int L>
csg::MaterialId Walker<L>::material_of(const Lane& lane, const Event& event,
                                       std::size_t end) const {
    const Look& look = data->looks[leaf_of(event).look];
    if (look.material != csg::kNoMaterial) return look.material;
    if (contexts[event.context].material != csg::kNoMaterial)
        return contexts[event.context].material;
    if (look.cuts == contexts[event.context].cuts) return csg::kNoMaterial;
    // The group that the cutter is taken from: the nearest above it that turns things inside out.
    std::uint32_t context = event.context;
    std::uint32_t group = leaf_of(event).parent;
    while (contexts[context].solid->groups[group].taken_away == contexts[context].cuts) {
        if (!climb(context, group)) return csg::kNoMaterial;
    }
    // Of what is left of it, the leftmost leaf that the ray is in here, and that has a material.
    const Event* best = nullptr;
    csg::MaterialId found = csg::kNoMaterial;
    for (std::size_t i = 0; i < end; ++i) {
        const Event& e = lane.events[i];
        if (e.uncertain || e.idle || !e.enter) continue;
        const Look& other = data->looks[leaf_of(e).look];
        const csg::MaterialId material =
            other.material != csg::kNoMaterial ? other.material : contexts[e.context].material;
        if (material == csg::kNoMaterial || other.cuts != contexts[e.context].cuts ||
            !below(e, context, group) || (best != nullptr && !left_of(e, *best))) {
            continue;
        }
        // Left again before this place?
        bool left = false;
        for (std::size_t k = i + 1; k < end && !left; ++k) {
            const Event& later = lane.events[k];
            left = !later.enter && later.leaf == e.leaf && later.context == e.context &&
                   (k < lane.head || event.enter);
        }
        if (left) continue;
        best = &e;
        found = material;
    }
    return found;
}

template <int L>
void Walker<L>::settle(int index, std::size_t end) {
    Lane& lane = lanes[index];
    bool at_start = false;
    changes_.clear();
    turned_.clear();
    for (std::size_t i = lane.head; i < end; ++i) {
        const Event& event = lane.events[i];
        if (event.uncertain) {
            if (ignore_uncertain) continue;
            lane.step = std::max(lane.step, event.error);
            lane.stepped_aside = true;
            continue;
        }
        if (event.idle) continue;
        at_start = at_start || event.near <= lane.start;
        flip(index, event);
    }
    if (end - lane.head > 1 && !lane.stepped_aside && !ignore_blur) {
        lane.step = blurred(index, end);
        lane.stepped_aside = lane.is_blurred = lane.step > 0.0;
    }
    if (lane.stepped_aside) {
        lane.done = true;
        return;
    }
    if (changes_.empty()) {
        lane.head = end;
        return;
    }

    const csg::MaterialId before = lane.inside.empty() ? Hit::kAir : lane.inside.back().material;
    // What is left, then what is entered; of several changes the leftmost that enters shows, else
    // one that leaves.
    const std::size_t first = lane.crossings.size();
    std::size_t shown = first;
    for (const bool entering : {false, true}) {
        for (const Change& change : changes_) {
            if (change.inside != entering) continue;
            const Event& by = shown_by(index, end, change);
            const Crossing crossing{by,     change.part, entering, material_of(lane, by, end),
                                    before, before};
            if (lane.crossings.size() > first) {
                const Crossing& best = lane.crossings[shown];
                if (entering > best.entering ||
                    (entering == best.entering && left_of(by, best.event))) {
                    shown = lane.crossings.size();
                }
            }
            lane.crossings.push_back(crossing);
            if (entering) {
                lane.inside.push_back({change.part, crossing.material});
            } else {
                std::erase_if(lane.inside, [&](const Medium& m) { return m.part == change.part; });
            }
        }
    }
    const csg::MaterialId after = lane.inside.empty() ? Hit::kAir : lane.inside.back().material;
    lane.head = end;
    for (std::size_t i = first; i < lane.crossings.size(); ++i) lane.crossings[i].after = after;
    if (mode == Mode::all) return;

    const Crossing crossing = lane.crossings[shown];
    lane.crossings.clear();
    if (at_start) return;  // behind the start, or the surface that the ray starts on
    if (!(crossing.event.t < lane.limit)) {
        finish(index);
    } else if (mode == Mode::first) {
        lane.crossings.push_back(crossing);
        lane.done = true;
    } else if (is_opaque(crossing.material)) {
        lane.blocked = true;
        lane.done = true;
    }
}

template struct Walker<1>;
template struct Walker<kRays>;

}  // namespace raymo::trace
