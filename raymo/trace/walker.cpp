#include "raymo/trace/walker.hpp"

#include <algorithm>

namespace raymo::trace {

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
std::uint32_t Walker<L>::part_of(const Event& event) const {
    std::uint32_t context = event.context;
    std::uint32_t group = leaf_of(event).parent;
    while (true) {
        const Group& g = contexts[context].solid->groups[group];
        if (g.parent != kNone) {
            group = g.parent;
        } else if (context != 0) {
            const Context<L>& c = contexts[context];
            group = contexts[c.parent].solid->leaves[c.leaf].parent;
            context = c.parent;
        } else {
            return group;
        }
    }
}

/// Of the events of the cluster that can have made the change, the one that stands leftmost in the
/// model.
template <int L>
const Event& Walker<L>::shown_by(const Lane& lane, std::size_t end, const Change& change) const {
    const Event* best = nullptr;
    std::uint64_t best_order = 0;
    for (std::size_t i = lane.head; i < end; ++i) {
        const Event& event = lane.events[i];
        if (event.uncertain) continue;
        const Leaf& leaf = leaf_of(event);
        const bool cuts = data->looks[leaf.look].cuts != contexts[event.context].cuts;
        if ((event.enter != cuts) != change.inside) continue;
        if (changes_.size() > 1 && part_of(event) != change.part) continue;
        std::uint64_t order = leaf.order;
        for (std::uint32_t c = event.context; c != 0; c = contexts[c].parent) {
            order =
                (order & 0xffffffU) |
                (std::uint64_t{contexts[contexts[c].parent].solid->leaves[contexts[c].leaf].order}
                 << 24);
        }
        if (best == nullptr || order < best_order) {
            best = &event;
            best_order = order;
        }
    }
    return best != nullptr ? *best : lane.events[lane.head];
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
    // The leftmost leaf of the same part that the ray is in here, and that has a material.
    const std::uint32_t part = part_of(event);
    csg::MaterialId best = csg::kNoMaterial;
    std::uint32_t best_order = kNone;
    for (std::size_t i = 0; i < end; ++i) {
        const Event& e = lane.events[i];
        if (e.uncertain || !e.enter) continue;
        const Leaf& leaf = leaf_of(e);
        const Look& other = data->looks[leaf.look];
        const csg::MaterialId material =
            other.material != csg::kNoMaterial ? other.material : contexts[e.context].material;
        if (material == csg::kNoMaterial || other.cuts != contexts[e.context].cuts ||
            leaf.order >= best_order || part_of(e) != part) {
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
        best = material;
        best_order = leaf.order;
    }
    return best;
}

template <int L>
void Walker<L>::settle(int index, std::size_t end) {
    Lane& lane = lanes[index];
    bool at_start = false;
    changes_.clear();
    for (std::size_t i = lane.head; i < end; ++i) {
        const Event& event = lane.events[i];
        if (event.uncertain) {
            if (ignore_uncertain) continue;
            lane.step = std::max(lane.step, event.error);
            lane.stepped_aside = true;
            continue;
        }
        at_start = at_start || event.near <= lane.start;
        flip(index, event);
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
            const Event& by = shown_by(lane, end, change);
            const Crossing crossing{by,     change.part, entering, material_of(lane, by, end),
                                    before, before};
            if (lane.crossings.size() > first) {
                const Crossing& best = lane.crossings[shown];
                if (entering > best.entering ||
                    (entering == best.entering && leaf_of(by).order < leaf_of(best.event).order)) {
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
template struct Walker<8>;

}  // namespace raymo::trace
