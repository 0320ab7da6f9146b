// The nearest surface of a simple solid for a packet of rays; included by walk.cpp once per instruction set, inside
// HWY_NAMESPACE.
//
// A solid is simple when every part is a union of units (units.hpp): leaves, and products of leaves (a & b - c - d). Seen from outside
// of all of them, the first change of any part is the nearest place where some unit is entered, which takes a minimum
// over units instead of events and counters. The answer is taken only where it is certain to be what the events would
// give (walker.hpp): nothing else may overlap it, the ray may not start inside a unit (but for one that is a whole part
// by itself, such as a glass ball), and no comparison may have been
// undecided. Other rays are left over (`Nearest::deferred`) and traced one by one.

/// Rays that go through more overlapping cutters of one product than this are traced one by one.
inline constexpr int kMostSearches = 32;

/// Span `k` of a leaf, for the rays `there`. Returns those that start inside it.
template <class Found>
HWY_INLINE std::uint32_t meet_span(Walker<kRays>& w, std::uint32_t index, int first, bool passable,
                                   Mask there, const Found& found, int k, NearestInLanes& nearest) {
    const EndInLanes enter = found.enter(k);
    if (passable) return pass_span(w, index, first, there, enter, found.exit(k), nearest);
    const Mask ahead = enter.near > nearest.start;
    const Lanes number(static_cast<double>(index));
    nearest.offer(lane_and(there, lane_and(ahead, enter.lo <= nearest.limit)), enter, number);
    const Mask begun = lane_and(there, lane_not(ahead));
    if (!lane_any(begun)) return 0;
    const EndInLanes exit = found.exit(k);
    const Mask about = lane_and(begun, exit.hi >= nearest.start);
    if (!lane_any(about)) return 0;
    const Mask left = exit.near <= nearest.start;
    nearest.pass(about, enter.hi);
    nearest.pass(lane_and(about, left), exit.hi);
    const std::uint32_t within = bits(lane_and(about, lane_not(left)));
    if (within != 0 && w.contexts[0].solid->leaves[index].alone) {
        // The part ends where its only leaf ends: that is another surface to be met.
        nearest.offer(lane_and(mask_of(within), exit.lo <= nearest.limit), exit,
                      number + Lanes(kLeaving));
    }
    return within;
}

/// A leaf by itself, for the rays from `first` on that are named. Returns the rays that start inside it; `changed`: something
/// was learnt.
HWY_INLINE std::uint32_t meet_leaf(Walker<kRays>& w, std::uint32_t index, int first,
                                   std::uint32_t lanes, bool& changed) {
    std::uint32_t inside = 0;
    const bool passable = w.mode == Mode::through && is_passable(w, index);
    ask_leaf(w, index, first, lanes, load(w.nearest.start + first),
             [&](const auto& found, Mask trouble, Lanes trouble_lo) RAYMO_INLINE_BODY {
                 // Most leaves that are asked are missed: what is nearest is not read before.
                 NearestInLanes nearest = load(w.nearest, first);
                 const Mask here = mask_of(lanes);
                 nearest.doubt(lane_and(here, trouble), trouble_lo);
                 for (int k = 0; k < found.count(); ++k) {
                     const Mask there = lane_and(here, found.valid(k));
                     if (lane_any(there))
                         inside |= meet_span(w, index, first, passable, there, found, k, nearest);
                 }
                 store(nearest, w.nearest, first);
                 changed = true;
             });
    return inside;
}

/// A product while it is met: inside all leaves of its core, and none of those that are taken away.
struct ProductInLanes {
    Mask alive;       ///< rays that may still meet it
    Mask doubtful;    ///< where something was undecided
    Mask from_start;  ///< `at` is the start of the ray
    Mask moved;       ///< `at` is where something that is taken away ends
    EndInLanes at;    ///< the first place that is not known to be taken away
    Lanes at_leaf;    ///< leaf whose surface is there
    // Where the first leaf of the core is left.
    Lanes exit_near, exit_lo, exit_hi;

    /// As long as the place lies in a leaf that is taken away, it goes on to where that is left. Returns the rays for which it
    /// did.
    HWY_INLINE Mask leave(const SpanInLanes& span, Lanes leaf, Lanes start) {
        const Mask before =
            lane_or(span.enter.lo <= at.hi, lane_and(from_start, span.enter.near <= start));
        const Mask entered = lane_and(alive, lane_and(span.valid, before));
        const Mask left =
            lane_or(lane_and(from_start, span.exit.near <= start), span.exit.hi < at.lo);
        // Where a span that has been left ends, it is not met again.
        const Mask its_end = lane_and(moved, lane_and(at_leaf == leaf, at.t == span.exit.t));
        const Mask within = lane_and(entered, lane_not(lane_or(left, its_end)));
        const Mask goes_on = lane_and(within, span.exit.lo > at.hi);
        doubtful = lane_or(doubtful, lane_and(within, lane_not(span.exit.lo > at.hi)));
        at.t = lane_select(goes_on, span.exit.t, at.t);
        at.error = lane_select(goes_on, span.exit.error, at.error);
        at.face = lane_select(goes_on, span.exit.face, at.face);
        at.lo = lane_select(goes_on, span.exit.lo, at.lo);
        at.hi = lane_select(goes_on, span.exit.hi, at.hi);
        at_leaf = lane_select(goes_on, leaf, at_leaf);
        from_start = lane_and(from_start, lane_not(goes_on));
        moved = lane_or(moved, goes_on);
        return goes_on;
    }
};

/// Puts the children of a node of cutters that are met on the list. `beam`: of the rays, if it can be used.
HWY_INLINE void open_cutters(Walker<kRays>& w, const Beam* beam, const PacketInFloats& rays,
                             const CutterNode& at, const float* from, const float* to) {
    const Context<kRays>& c = w.contexts[0];
    const CompiledSolid& solid = *c.solid;
    const BvhNode& node = solid.nodes[at.ref];
    ++w.boxes;
    // Deep in the tree rays go their own ways: one of them is tested against all boxes at once.
    const bool single = (at.lanes & (at.lanes - 1)) == 0;
    std::uint32_t children = kAllChildren;
    if (single) {
        const int ray = __builtin_ctz(at.lanes);
        children = meet_node_alone(c, ray, from[ray], to[ray], node);
    } else if (beam != nullptr) {
        alignas(64) float near[8];
        children = meet_node(*beam, node, near);
    }
    for (; children != 0; children &= children - 1) {
        const int k = __builtin_ctz(children);
        if (!(node.lo[0][k] <= node.hi[0][k])) break;
        const std::uint32_t met = single ? at.lanes : lanes_in_box(rays, node, k) & at.lanes;
        if (met == 0) continue;
        w.cutter_nodes.push_back({node.ref[k], node.count[k], met});
        fetch_child(solid, node, k);
    }
}

/// Looks among the cutters of a product, in the tree with root `root`, for those that the place p.at of the rays `lanes` lies
/// in. Returns the rays for which it went on.
HWY_INLINE std::uint32_t search_cutters(Walker<kRays>& w, const Beam& beam, std::uint32_t root,
                                        int first, std::uint32_t lanes, ProductInLanes& p,
                                        NearestInLanes& nearest) {
    const R f;
    const Context<kRays>& c = w.contexts[0];
    const Lanes start = nearest.start;
    // Boxes are met where the place may be; the rays that do not count, nowhere.
    alignas(64) float from[kRays];
    alignas(64) float to[kRays];
    for (int i = 0; i < kRays; ++i) {
        from[i] = std::numeric_limits<float>::infinity();
        to[i] = -from[i];
    }
    const Mask here = mask_of(lanes);
    const auto slack = [](Lanes t) { return Lanes(0x1p-20) * lane_abs(t); };
    store_floats(lane_select(here, p.at.lo - slack(p.at.lo), Lanes(kInfinity)), from + first);
    store_floats(lane_select(here, p.at.hi + slack(p.at.hi), Lanes(-kInfinity)), to + first);
    PacketInFloats rays;
    read_rays(c, lanes << first, rays);
    for (int v = 0; v < kParts; ++v) {
        rays.part[v].from = hn::Load(f, from + v * kRayFloats);
        rays.part[v].to = hn::Load(f, to + v * kRayFloats);
    }
    Beam near_by = beam;
    near_by.from = least_of(from, lanes << first);
    near_by.to = most_of(to, lanes << first);
    std::uint32_t moved = 0;
    // Level by level, so that what the rays need from memory is asked for before any of it is waited for.
    std::vector<CutterNode>& boxes = w.cutter_nodes;
    boxes.assign(1, {root, 0, lanes << first});
    for (std::size_t next = 0; next < boxes.size(); ++next) {
        const CutterNode box = boxes[next];
        if (box.count == 0) {
            open_cutters(w, beam.usable ? &near_by : nullptr, rays, box, from, to);
            continue;
        }
        w.leaves += box.count * static_cast<std::uint64_t>(lane_count(box.lanes));
        const Mask near = mask_of(box.lanes >> first);
        for (std::uint32_t leaf = box.ref; leaf < box.ref + box.count; ++leaf) {
            SpanInLanes spans[kMostSpansInLanes];
            Mask trouble;
            Lanes trouble_lo;
            const int count =
                spans_of(w, leaf, first, box.lanes >> first, start, spans, trouble, trouble_lo);
            nearest.doubt(lane_and(near, trouble), trouble_lo);
            for (int i = 0; i < count; ++i) {
                SpanInLanes& span = spans[i];
                span.valid = lane_and(span.valid, near);
                const Mask about = lane_and(span.valid, span.exit.hi >= start);
                nearest.pass(lane_and(about, span.enter.near <= start), span.enter.hi);
                nearest.pass(lane_and(about, span.exit.near <= start), span.exit.hi);
                moved |= bits(p.leave(span, Lanes(static_cast<double>(leaf)), start));
            }
        }
    }
    return moved;
}

/// The spans of one leaf.
struct LeafInLanes {
    SpanInLanes spans[kMostSpansInLanes];
    int count;
    Lanes number;  ///< of the leaf
};

/// The leaves of a product that stand together.
struct MembersInLanes {
    LeafInLanes core[kMostInUnit];  ///< all of which a place must be in
    int core_count = 0;
    LeafInLanes taken[kMostInUnit];  ///< and in none of these
    int taken_count = 0;
    int taken_spans = 0;  ///< of all of them
};

/// A product, as far as it lies in one span of each leaf of its core, those with the numbers `choice`. Returns the rays
/// that start inside it.
HWY_INLINE std::uint32_t meet_core(Walker<kRays>& w, const Beam& beam, std::uint32_t cutters,
                                   int first, Mask here, const MembersInLanes& members,
                                   const int (&choice)[kMostInUnit], NearestInLanes& nearest) {
    const Lanes start = nearest.start;
    ProductInLanes p;
    p.alive = here;
    p.doubtful = p.moved = lane_and(here, lane_not(here));
    // Where all leaves of the core are entered, and where the first of them is left.
    EndInLanes enter;
    enter.t = enter.lo = enter.hi = enter.near = Lanes(-kInfinity);
    enter.error = enter.face = Lanes(0.0);
    p.at_leaf = Lanes(0.0);
    p.exit_near = p.exit_lo = p.exit_hi = Lanes(kInfinity);
    for (int i = 0; i < members.core_count; ++i) {
        const SpanInLanes& span = members.core[i].spans[choice[i]];
        p.alive = lane_and(p.alive, span.valid);
        if (!lane_any(p.alive)) return 0;
        const Mask later = span.enter.lo > enter.hi;
        const Mask earlier = span.enter.hi < enter.lo;
        const Mask matters = lane_max(span.enter.hi, enter.hi) > start;
        p.doubtful = lane_or(p.doubtful, lane_and(matters, lane_not(lane_or(later, earlier))));
        enter.t = lane_select(later, span.enter.t, enter.t);
        enter.error = lane_select(later, span.enter.error, enter.error);
        enter.face = lane_select(later, span.enter.face, enter.face);
        p.at_leaf = lane_select(later, members.core[i].number, p.at_leaf);
        enter.lo = lane_max(span.enter.lo, enter.lo);
        enter.hi = lane_max(span.enter.hi, enter.hi);
        enter.near = lane_max(span.enter.near, enter.near);
        p.exit_near = lane_min(span.exit.near, p.exit_near);
        p.exit_lo = lane_min(span.exit.lo, p.exit_lo);
        p.exit_hi = lane_min(span.exit.hi, p.exit_hi);
    }
    p.alive = lane_and(p.alive, lane_and(p.exit_hi >= start, lane_and(enter.lo <= nearest.limit,
                                                                      enter.lo <= p.exit_hi)));
    p.alive = lane_and(p.alive, p.exit_near > start);
    if (!lane_any(p.alive)) return 0;
    p.doubtful = lane_or(p.doubtful, enter.hi >= p.exit_lo);
    p.from_start = enter.near <= start;
    p.at = enter;
    p.at.lo = lane_select(p.from_start, start, enter.lo);
    p.at.hi = lane_select(p.from_start, start, enter.hi);

    // What is taken away and stands in the unit; returns the rays that went on. Each span is left once at most.
    const auto leave_members = [&] {
        Mask any = mask_of(0);
        for (int pass = 0; pass < members.taken_spans; ++pass) {
            Mask moved = mask_of(0);
            for (int j = 0; j < members.taken_count; ++j) {
                const LeafInLanes& leaf = members.taken[j];
                for (int k = 0; k < leaf.count; ++k)
                    moved = lane_or(moved, p.leave(leaf.spans[k], leaf.number, start));
            }
            if (!lane_any(moved)) break;
            any = lane_or(any, moved);
        }
        return any;
    };
    static_cast<void>(leave_members());
    if (cutters != kNone) {
        // Of rays that have found something nearer, or have left the core, nothing more needs to be known.
        const auto going = [&] {
            return lane_and(
                p.alive, lane_and(p.at.lo <= p.exit_hi,
                                  p.at.lo <= lane_min(nearest.t + nearest.error, nearest.limit)));
        };
        std::uint32_t searching = bits(going());
        for (int pass = 0; searching != 0; ++pass) {
            if (pass == kMostSearches) {
                p.doubtful = lane_or(p.doubtful, mask_of(searching));
                break;
            }
            searching = search_cutters(w, beam, cutters, first, searching, p, nearest);
            // Behind a cutter the place may lie in one of those of the unit, and the other way about.
            if (searching != 0) searching |= bits(leave_members());
            searching &= bits(going());
        }
    }
    p.alive = lane_and(p.alive, p.at.lo <= p.exit_hi);
    // Where what is taken away ends together with the core, the ray is outside before and behind.
    const Mask at_exit = p.at.hi >= p.exit_lo;
    p.alive =
        lane_and(p.alive, lane_not(lane_and(lane_and(at_exit, p.moved), lane_not(p.doubtful))));
    p.doubtful = lane_or(p.doubtful, at_exit);
    nearest.doubt(lane_and(p.alive, p.doubtful), lane_max(enter.lo, start));
    p.alive = lane_and(p.alive, lane_not(p.doubtful));
    nearest.offer(lane_and(p.alive, lane_and(lane_not(p.from_start), p.at.lo <= nearest.limit)),
                  p.at, p.at_leaf);
    return bits(lane_and(p.alive, p.from_start));
}

/// A product, in its unit's place. Returns the rays that start inside it.
HWY_INLINE std::uint32_t meet_product(Walker<kRays>& w, const Beam& beam, std::uint32_t index,
                                      int size, int first, std::uint32_t lanes,
                                      NearestInLanes& nearest) {
    const CompiledSolid& solid = *w.contexts[0].solid;
    const Lanes start = nearest.start;
    Mask here = mask_of(lanes);
    MembersInLanes members;
    Lanes past = start;  // where the core is entered, at the earliest
    for (int i = 0; i < size; ++i) {
        const std::uint32_t number = index + static_cast<std::uint32_t>(i);
        const bool cuts = w.data->looks[solid.leaves[number].look].cuts;
        LeafInLanes& leaf =
            cuts ? members.taken[members.taken_count++] : members.core[members.core_count++];
        leaf.number = Lanes(static_cast<double>(number));
        Mask trouble;
        Lanes trouble_lo;
        leaf.count = spans_of(w, number, first, lanes, past, leaf.spans, trouble, trouble_lo);
        nearest.doubt(lane_and(here, trouble), trouble_lo);
        Mask met = mask_of(0);
        Lanes entered(kInfinity);
        for (int k = 0; k < leaf.count; ++k) {
            const SpanInLanes& span = leaf.spans[k];
            const Mask about = lane_and(lane_and(here, span.valid), span.exit.hi >= start);
            nearest.pass(lane_and(about, span.enter.near <= start), span.enter.hi);
            nearest.pass(lane_and(about, span.exit.near <= start), span.exit.hi);
            met = lane_or(met, about);
            entered = lane_select(about, lane_min(entered, span.enter.lo), entered);
        }
        if (cuts) {
            members.taken_spans += leaf.count;
            continue;
        }
        // Of rays that miss the core, or have found something before it, nothing more needs to be known.
        past = lane_max(past, entered);
        here = lane_and(lane_and(here, met),
                        past <= lane_min(nearest.t + nearest.error, nearest.limit));
        lanes = bits(here);
        if (lanes == 0) return 0;
    }
    // All ways to choose a span of each leaf of the core.
    const std::uint32_t cutters = solid.leaves[index].cutters;
    int choice[kMostInUnit] = {};
    std::uint32_t inside = 0;
    for (;;) {
        inside |= meet_core(w, beam, cutters, first, here, members, choice, nearest);
        int i = 0;
        while (i < members.core_count && ++choice[i] == members.core[i].count) choice[i++] = 0;
        if (i == members.core_count) return inside;
    }
}

/// Walks the tree below `root`, or to one leaf that stands apart, for all active rays; the answers are in w.nearest.
HWY_INLINE void walk_together(Walker<kRays>& w, const NearBox& root, Beam beam) {
    Nearest& n = w.nearest;
    Context<kRays>& c = w.contexts[0];
    const int begin = begin_of(w.active);
    const int end = end_of(w.active);
    w.near_boxes.count = 0;
    w.near_boxes.put(root);
    while (w.near_boxes.count > 0) {
        const NearBox box = w.near_boxes.last();
        --w.near_boxes.count;
        std::uint32_t open = 0;  // rays that may still find something nearer
        const Lanes near(static_cast<double>(box.t()));
        for (int i = 0; i < kRays; i += kLanes) open |= bits(load(n.hi + i) >= near) << i;
        open &= w.active & ~n.deferred;
        // Boxes further up the list may be nearer: they are not sorted as a whole.
        if (open == 0) continue;
        const std::uint32_t lanes = box.lanes() & open;
        if (lanes == 0) continue;
        const std::uint32_t count = box.count();
        if (count == 0) {
            open_node(w, box.ref(), lanes, beam);
            continue;
        }
        bool changed = false;
        for (int first = 0; first < kRays; first += kLanes) {
            const std::uint32_t here = (lanes >> first) & ((1U << kLanes) - 1U);
            if (here == 0) continue;
            for (std::uint32_t k = 0; k < count;) {
                const std::uint32_t leaf = box.ref() + k;
                const int size = c.solid->leaves[leaf].unit;
                const bool is_leaf = size == 1 && c.solid->leaves[leaf].cutters == kNone;
                std::uint32_t inside = 0;
                if (is_leaf) {
                    inside = meet_leaf(w, leaf, first, here, changed);
                } else {
                    NearestInLanes nearest = load(n, first);
                    inside = meet_product(w, beam, leaf, size, first, here, nearest);
                    store(nearest, n, first);
                    changed = true;
                }
                for (std::uint32_t rest = inside << first; rest != 0; rest &= rest - 1) {
                    // Inside one part that is a single leaf is simple enough.
                    const int i = __builtin_ctz(rest);
                    const bool known = n.inside[i] < 0.0 && c.solid->leaves[leaf].alone &&
                                       (w.mode == Mode::first ||
                                        (w.mode == Mode::through && is_passable(w, leaf)));
                    n.inside[i] = static_cast<double>(leaf);
                    if (!known) n.deferred |= 1U << i;
                }
                k += static_cast<std::uint32_t>(size);
            }
        }
        w.leaves += count * static_cast<std::uint64_t>(lane_count(lanes));
        if (!changed || w.near_boxes.count == 0) continue;
        for (int i = begin; i < end; i += kLanes) {
            const Lanes hi = lane_min(load(n.hi + i), load(n.limit + i));
            store_floats(hi + Lanes(0x1p-20) * lane_abs(hi), c.to + i);
        }
        const std::uint32_t searching = w.active & ~n.deferred;
        if (searching == 0) return;
        beam.to = most_of(c.to, searching);
    }
}

/// The same; rays that point into different octants have no beam, and go group by group, as far apart as they may be.
HWY_INLINE void walk_nearest(Walker<kRays>& w, const NearBox& root) {
    const Context<kRays>& c = w.contexts[0];
    const std::uint32_t active = w.active;
    Beam beam{};
    if (root.count() == 0) beam = beam_of(c, active);
    const bool together = root.count() != 0 || beam.usable;
    // walk_together stands here once only, as its text is copied to where it stands.
    for (std::uint32_t rest = active; rest != 0; rest &= ~w.active) {
        if (!together) {
            w.active = rest & first_lanes(kGroup) << begin_of(rest);
            beam = beam_of(c, w.active);
        }
        walk_together(w, root, beam);
    }
    w.active = active;
}

/// Whether all active rays are known to start in leaf `index`, and to leave it.
HWY_INLINE bool all_leave(const Walker<kRays>& w, std::uint32_t index) {
    const Nearest& n = w.nearest;
    const Lanes leaf(static_cast<double>(index));
    std::uint32_t leave = 0;
    for (int i = begin_of(w.active); i < end_of(w.active); i += kLanes) {
        const Mask out = load(n.leaf + i) == leaf + Lanes(kLeaving);
        leave |= bits(lane_and(out, load(n.inside + i) == leaf)) << i;
    }
    return (w.active & ~(leave & n.found & ~n.deferred)) == 0;
}

/// Decides for which rays the answer is certain.
HWY_INLINE void settle_nearest(Walker<kRays>& w) {
    Nearest& n = w.nearest;
    for (int i = begin_of(w.active); i < end_of(w.active); i += kLanes) {
        const Lanes lo = load(n.lo + i);
        const Lanes hi = load(n.hi + i);
        const Lanes trouble = load(n.trouble_lo + i);
        const Lanes never(kInfinity);
        const Mask found = lo < never;
        const Mask clear =
            lane_and(trouble > hi, lane_and(load(n.second_lo + i) > hi, load(n.start_hi + i) < lo));
        const Mask certain =
            lane_or(lane_and(found, clear), lane_and(lane_not(found), trouble == never));
        const Mask within = load(n.t + i) < load(n.limit + i);
        n.deferred |= (bits(lane_not(certain)) << i) & w.active;
        n.found |= (bits(lane_and(lane_and(found, certain), within)) << i) & w.active;
    }
}
