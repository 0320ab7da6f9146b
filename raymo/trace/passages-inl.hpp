// The transparent parts on the way of a packet of rays through a simple solid (nearest-inl.hpp); included by walk.cpp once
// per instruction set, inside HWY_NAMESPACE.
//
// On the way to a lamp an opaque surface ends a ray, wherever it is met; of what is transparent every surface counts, in their
// order. So where a part is one leaf and lets light through, its spans are kept on a list instead of being offered as what is
// nearest: one walk tells of all surfaces what otherwise a walk from each surface to the next would. The list is taken only
// where it is certain to be what those walks would give: each leaf is left before the next is entered, and no place on the
// list may be mistaken for the next one, or for the start. Other rays are left over.

/// Whether a leaf is a part by itself that lets light through.
HWY_INLINE bool is_passable(const Walker<kRays>& w, std::uint32_t index) {
    const Leaf& leaf = w.contexts[0].solid->leaves[index];
    return leaf.alone && !w.is_opaque(w.data->looks[leaf.look].material);
}

HWY_INLINE void reset_passages(Passages& p) {
    p.count = 0;
    p.overflown = 0;
}

/// A place on the list for a span of `leaf` of the rays `lanes`: behind all that these rays enter earlier than `lo`. Null:
/// there is none left.
HWY_INLINE Passages::Span* place_on_list(Passages& p, std::uint32_t leaf, std::uint32_t lanes,
                                         Lanes lo, int first) {
    // Rays of other vectors of the packet may have made one.
    for (int k = 0; k < p.count; ++k) {
        Passages::Span& span = p.spans[k];
        if (span.leaf == leaf && ((span.enter.lanes | span.exit.lanes) >> first) == 0) return &span;
    }
    if (p.count == Passages::kMost) {
        p.overflown |= lanes;
        return nullptr;
    }
    int at = p.count++;
    for (; at > 0; --at) {
        const Passages::Span& before = p.spans[at - 1];
        const std::uint32_t later = bits(load(before.exit.lo + first) > lo) << first;
        if ((later & before.exit.lanes & lanes) == 0) break;
        p.spans[at] = before;
    }
    Passages::Span& span = p.spans[at];
    span.leaf = leaf;
    span.enter.lanes = span.exit.lanes = 0;
    return &span;
}

HWY_INLINE void put_on_list(const EndInLanes& end, std::uint32_t lanes, int first,
                            Passages::End& out) {
    store(end.lo, out.lo + first);
    store(end.hi, out.hi + first);
    store(end.t, out.t + first);
    store(end.error, out.error + first);
    store(end.face, out.face + first);
    out.lanes |= lanes;
}

/// A span of a leaf that can be passed, for the rays `there`. Returns those that start inside it.
HWY_INLINE std::uint32_t pass_span(Walker<kRays>& w, std::uint32_t index, int first, Mask there,
                                   const EndInLanes& enter, const EndInLanes& exit,
                                   NearestInLanes& nearest) {
    const Mask about =
        lane_and(there, lane_and(exit.hi >= nearest.start, enter.lo <= nearest.limit));
    const Mask ahead = lane_and(about, enter.near > nearest.start);
    const Mask begun = lane_and(about, lane_not(ahead));
    const Mask left = lane_and(begun, exit.near <= nearest.start);
    nearest.pass(begun, enter.hi);
    nearest.pass(left, exit.hi);
    const Mask leaves = lane_and(about, lane_not(left));
    const std::uint32_t exits = bits(leaves) << first;
    if (exits == 0) return 0;
    const Lanes lo = lane_select(ahead, enter.lo, nearest.start);
    if (Passages::Span* span = place_on_list(w.passages, index, exits, lo, first)) {
        put_on_list(enter, bits(ahead) << first, first, span->enter);
        put_on_list(exit, exits, first, span->exit);
    }
    return bits(lane_and(begun, leaves));
}

/// Decides for which rays the list is certain, after settle_nearest; the others are left over.
HWY_INLINE void settle_passages(Walker<kRays>& w, PassagePacket& out) {
    Nearest& n = w.nearest;
    const Passages& p = w.passages;
    // Of what is no part by itself it matters what it shows.
    for (std::uint32_t rest = n.found & ~n.deferred; rest != 0; rest &= rest - 1) {
        const int i = __builtin_ctz(rest);
        if (!w.is_opaque(material_shown(w, static_cast<std::uint32_t>(n.leaf[i]))))
            n.deferred |= 1U << i;
    }
    n.found &= ~n.deferred;
    n.deferred |= p.overflown & ~n.found;
    out.count = 2 * p.count;
    for (int k = 0; k < out.count; ++k) out.lanes[k] = 0;
    for (int first = 0; first < kRays; first += kLanes) {
        const Lanes none(-1.0);
        const Lanes limit = load(n.limit + first);
        Lanes before = load(n.start_hi + first);
        Lanes inside = load(n.inside + first);
        Mask wrong = mask_of(0);
        for (int k = 0; k < p.count; ++k) {
            const Passages::Span& span = p.spans[k];
            const Lanes leaf(static_cast<double>(span.leaf));
            const auto cross = [&](const Passages::End& end, Lanes from, Lanes to, int row) {
                const Mask here = mask_of(end.lanes >> first);
                const Mask right = lane_and(before < load(end.lo + first), inside == from);
                wrong = lane_or(wrong, lane_and(here, lane_not(right)));
                before = lane_select(here, load(end.hi + first), before);
                inside = lane_select(here, to, inside);
                out.lanes[row] |= bits(lane_and(here, load(end.t + first) < limit)) << first;
            };
            cross(span.enter, none, leaf, 2 * k);
            cross(span.exit, leaf, none, 2 * k + 1);
        }
        n.deferred |= (bits(wrong) << first) & w.active & ~n.found;
    }
    const std::uint32_t certain = w.active & ~(n.found | n.deferred);
    for (int k = 0; k < out.count; ++k) out.lanes[k] &= certain;
}

/// Puts row `k` of what is passed in the place of what is nearest.
HWY_INLINE void show_passage(Walker<kRays>& w, int k) {
    Nearest& n = w.nearest;
    const Passages::Span& span = w.passages.spans[k / 2];
    const bool enters = k % 2 == 0;
    const Passages::End& end = enters ? span.enter : span.exit;
    const auto leaf = static_cast<double>(span.leaf);
    for (int i = 0; i < kRays; i += kLanes) {
        store(load(end.t + i), n.t + i);
        store(load(end.error + i), n.error + i);
        store(load(end.face + i), n.face + i);
        store(Lanes(enters ? leaf : leaf + kLeaving), n.leaf + i);
        store(Lanes(enters ? -1.0 : leaf), n.inside + i);
    }
}
