// The spans of one leaf for several rays at once, and the nearest surface so far; included by walk.cpp once per instruction
// set, inside HWY_NAMESPACE.

/// The ends of one span of a leaf as events of the base ray. `lo` and `hi` are their earliest and latest places.
struct EndInLanes {
    Lanes t, error, lo, hi, face;
    Lanes near;  ///< lo, as far as the start of a ray on a surface is concerned
};
struct SpanInLanes {
    Mask valid;
    EndInLanes enter, exit;
};

HWY_INLINE EndInLanes end_at(Lanes shift, Lanes slack, Lanes s, Lanes error, Lanes face) {
    EndInLanes out;
    out.t = shift + s;
    const Lanes rounding = Lanes(2.0 * kUnitRoundoff) * (lane_abs(shift) + lane_abs(s));
    out.error = lane_select(lane_abs(s) < Lanes(kInfinity), error + rounding, Lanes(0.0));
    out.lo = out.t - out.error;
    out.hi = out.t + out.error;
    out.near = out.t - (out.error + slack * out.error);
    out.face = face;
    return out;
}

/// Spans that a kernel gave for some lanes. Their ends on the rays are worked out when they are asked for.
template <int N>
struct SpansFound {
    const LaneSpans<Lanes, Mask, N>& spans;
    Lanes shift, slack;

    [[nodiscard]] HWY_INLINE int count() const { return N; }
    [[nodiscard]] HWY_INLINE Mask valid(int k) const { return spans.valid[k]; }
    [[nodiscard]] HWY_INLINE EndInLanes enter(int k) const {
        return end_at(shift, slack, spans.enter[k], spans.enter_error[k], spans.enter_face[k]);
    }
    [[nodiscard]] HWY_INLINE EndInLanes exit(int k) const {
        return end_at(shift, slack, spans.exit[k], spans.exit_error[k], spans.exit_face[k]);
    }
};
/// The same of a kernel that answers blocks.
struct SpansInBlock {
    const solids::SpanBlock& spans;
    Lanes shift, slack;

    [[nodiscard]] HWY_INLINE int count() const { return spans.count; }
    [[nodiscard]] HWY_INLINE Mask valid(int k) const { return mask_of(spans.valid[k]); }
    [[nodiscard]] HWY_INLINE EndInLanes enter(int k) const { return end(spans.enter, k); }
    [[nodiscard]] HWY_INLINE EndInLanes exit(int k) const { return end(spans.exit, k); }

private:
    [[nodiscard]] HWY_INLINE EndInLanes end(const solids::SpanBlock::End& e, int k) const {
        return end_at(shift, slack, load(e.s[k]), load(e.error[k]), load(e.face[k]));
    }
};

/// Asks a leaf for its spans of the rays from `first` on that are `asked`. Calls use(spans, trouble, trouble_lo) if there are any,
/// or where there is trouble: the ray runs in the boundary, or was left over. What is told of other rays has no meaning.
/// `past`: what lies before does not count; a span that begins there begins anywhere in it (LocalRay::from).
template <class Use>
HWY_INLINE void ask_leaf(const Walker<kRays>& w, std::uint32_t index, int first,
                         std::uint32_t asked, Lanes past, Use&& use) {
    const Context<kRays>& c = w.contexts[0];
    const Leaf& leaf = c.solid->leaves[index];
    const Frame& frame = w.data->frames[leaf.frame];
    Local<Lanes> local = localise<Lanes>(
        frame, leaf, load(c.o[0] + first), load(c.o[1] + first), load(c.o[2] + first),
        load(c.d[0] + first), load(c.d[1] + first), load(c.d[2] + first), load(c.error + first));
    const Lanes slack = w.nearest.on_surface
                            ? start_slack(load(c.start_error + first), local.place_error)
                            : Lanes(0.0);
    const auto left_over_from = [&]() RAYMO_INLINE_BODY {
        return local.shift - Lanes(frame.reach) / lane_sqrt(local.ray.dd);
    };
    if (frame.in_blocks) {
        local.ray.from = end_of_past(past, Lanes(0.0), local);
        solids::RayBlock block;
        store(local.ray, block, 0);
        solids::SpanBlock found;
        block_spans(w.data->kernels, frame, block, asked, found);
        if (found.count == 0 && found.left_over == 0) return;
        const Mask trouble = mask_of(found.left_over);
        use(SpansInBlock{found, local.shift, slack}, trouble,
            lane_any(trouble) ? left_over_from() : Lanes(kInfinity));
        return;
    }
    const Mask here = mask_of(asked);
    visit_kernel(w, frame, [&]<class K>(const K& kernel) RAYMO_INLINE_BODY {
        constexpr int kSpans = kSpansInLanes<K>;
        if constexpr (kSpans > 0 && !BlockKernel<K>) {
            LaneSpans<Lanes, Mask, kSpans> found;
            lane_spans(kernel, local.ray, found);
            Mask trouble = lane_or(found.degenerate, found.touched);
            Mask any = trouble;
            for (int k = 0; k < kSpans; ++k) any = lane_or(any, found.valid[k]);
            if (!lane_any(lane_and(here, any))) return;
            Lanes trouble_lo(kInfinity);
            if (lane_any(lane_and(here, trouble))) {
                if (lane_any(found.degenerate)) trouble_lo = left_over_from();
                const Lanes touch_lo = local.shift + found.touch_lo;
                trouble_lo = lane_select(
                    found.touched,
                    lane_min(trouble_lo, touch_lo - lane_abs(touch_lo) * Lanes(0x1p-50)),
                    trouble_lo);
            }
            use(SpansFound<kSpans>{found, local.shift, slack}, trouble, trouble_lo);
        }
    });
}

/// The same, kept. Returns how many spans a ray has at most.
HWY_INLINE int spans_of(const Walker<kRays>& w, std::uint32_t index, int first, std::uint32_t asked,
                        Lanes past, SpanInLanes (&spans)[kMostSpansInLanes], Mask& trouble,
                        Lanes& trouble_lo) {
    int count = 0;
    trouble = mask_of(0);
    trouble_lo = Lanes(kInfinity);
    ask_leaf(w, index, first, asked, past,
             [&](const auto& found, Mask where, Lanes from) RAYMO_INLINE_BODY {
                 count = found.count();
                 for (int k = 0; k < count; ++k)
                     spans[k] = {found.valid(k), found.enter(k), found.exit(k)};
                 trouble = where;
                 trouble_lo = from;
             });
    return count;
}

/// The running minimum of a packet's half, in registers.
struct NearestInLanes {
    Lanes lo, t, error, face, leaf, second_lo, start_hi, trouble_lo;
    Lanes start, limit;

    HWY_INLINE void offer(Mask there, const EndInLanes& end, Lanes by) {
        // Cores that overlap show the same face of a cutter that they share.
        there = lane_and(there, lane_not(lane_and(leaf == by, lo == end.lo)));
        const Mask closer = lane_and(there, end.lo < lo);
        const Lanes loser = lane_select(closer, lo, end.lo);
        second_lo = lane_select(there, lane_min(second_lo, loser), second_lo);
        lo = lane_select(closer, end.lo, lo);
        t = lane_select(closer, end.t, t);
        error = lane_select(closer, end.error, error);
        face = lane_select(closer, end.face, face);
        leaf = lane_select(closer, by, leaf);
    }
    /// Events up to the start, or about it, have been passed; nothing else may lie within their uncertainty.
    HWY_INLINE void pass(Mask there, Lanes hi) {
        start_hi = lane_select(there, lane_max(start_hi, hi), start_hi);
    }
    HWY_INLINE void doubt(Mask there, Lanes from) {
        trouble_lo = lane_select(there, lane_min(trouble_lo, from), trouble_lo);
    }
};

HWY_INLINE NearestInLanes load(const Nearest& n, int first) {
    NearestInLanes out;
    out.lo = load(n.lo + first);
    out.t = load(n.t + first);
    out.error = load(n.error + first);
    out.face = load(n.face + first);
    out.leaf = load(n.leaf + first);
    out.second_lo = load(n.second_lo + first);
    out.start_hi = load(n.start_hi + first);
    out.trouble_lo = load(n.trouble_lo + first);
    out.start = load(n.start + first);
    out.limit = load(n.limit + first);
    return out;
}
HWY_INLINE void store(const NearestInLanes& l, Nearest& n, int first) {
    store(l.lo, n.lo + first);
    store(l.t, n.t + first);
    store(l.error, n.error + first);
    store(l.face, n.face + first);
    store(l.leaf, n.leaf + first);
    store(l.second_lo, n.second_lo + first);
    store(l.start_hi, n.start_hi + first);
    store(l.trouble_lo, n.trouble_lo + first);
    store(l.t + l.error, n.hi + first);
}

/// Added to the number of a leaf that is left instead of entered.
inline constexpr double kLeaving = 0.5;
