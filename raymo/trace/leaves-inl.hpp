// Rays against leaves; included by walk.cpp once per instruction set, inside HWY_NAMESPACE.

using Ray8 = LocalRay<Lanes>;
HWY_INLINE void lane_spans(const solids::Block::Kernel&, const Ray8& ray,
                           LaneSpans<Lanes, Mask, 1>& out) {
    block_spans(ray, out);
}
HWY_INLINE void lane_spans(const solids::Sphere::Kernel&, const Ray8& ray,
                           LaneSpans<Lanes, Mask, 1>& out) {
    sphere_spans(ray, out);
}
HWY_INLINE void lane_spans(const solids::Cylinder::Kernel&, const Ray8& ray,
                           LaneSpans<Lanes, Mask, 1>& out) {
    cylinder_spans(ray, out);
}
HWY_INLINE void lane_spans(const solids::Cone::Kernel& k, const Ray8& ray,
                           LaneSpans<Lanes, Mask, 1>& out) {
    cone_spans(k.ratio(), ray, out);
}
HWY_INLINE void lane_spans(const solids::Torus::Kernel& k, const Ray8& ray,
                           LaneSpans<Lanes, Mask, 2>& out) {
    torus_spans(k.major_radius(), k.minor_radius(), ray, out);
}
HWY_INLINE void lane_spans(const solids::Halfspace::Kernel&, const Ray8& ray,
                           LaneSpans<Lanes, Mask, 1>& out) {
    halfspace_spans(ray, out);
}

/// From a place on face `face` to the normal there.
HWY_INLINE void lane_normal(const solids::Block::Kernel&, Lanes face, Lanes& x, Lanes& y,
                            Lanes& z) {
    block_normal(face, x, y, z);
}
HWY_INLINE void lane_normal(const solids::Sphere::Kernel&, Lanes, Lanes&, Lanes&, Lanes&) {}
HWY_INLINE void lane_normal(const solids::Cylinder::Kernel&, Lanes face, Lanes& x, Lanes& y,
                            Lanes& z) {
    cylinder_normal(face, x, y, z);
}
HWY_INLINE void lane_normal(const solids::Cone::Kernel& k, Lanes face, Lanes& x, Lanes& y,
                            Lanes& z) {
    cone_normal(k.ratio(), face, x, y, z);
}
HWY_INLINE void lane_normal(const solids::Torus::Kernel& k, Lanes, Lanes& x, Lanes& y, Lanes& z) {
    torus_normal(k.major_radius(), x, y, z);
}
HWY_INLINE void lane_normal(const solids::Halfspace::Kernel&, Lanes, Lanes& x, Lanes& y, Lanes& z) {
    halfspace_normal(x, y, z);
}

/// Of kernels by type: normals are told by the face alone, wherever on it.
inline constexpr auto kFlatFaces = [] {
    std::array<bool, solids::Inventory::kSize + 1> flat{};
    std::size_t type = 0;
    solids::Inventory::for_each([&]<class P>() {
        flat[type++] = std::is_same_v<P, solids::Block> || std::is_same_v<P, solids::Halfspace>;
    });
    return flat;
}();

/// Puts rays into a block, from number `first` on.
HWY_INLINE void store(const Ray8& ray, solids::RayBlock& out, int first) {
    store(ray.ox, out.o[0] + first);
    store(ray.oy, out.o[1] + first);
    store(ray.oz, out.o[2] + first);
    store(ray.dx, out.d[0] + first);
    store(ray.dy, out.d[1] + first);
    store(ray.dz, out.d[2] + first);
    store(ray.ex, out.e[0] + first);
    store(ray.ey, out.e[1] + first);
    store(ray.ez, out.e[2] + first);
    store(ray.dd, out.dd + first);
    store(ray.from, out.from + first);
}

/// Where in a leaf's frame a ray's past ends (LocalRay::from): some way before its start, further than errors reach.
template <class R>
HWY_INLINE R end_of_past(R start, R t0, const Local<R>& local) {
    const R size = R(1.0) + lane_abs(start) + lane_abs(t0) + lane_abs(local.shift);
    const R slack = R(0x1p-20) * size + R(16.0) * local.place_error;
    return (start - slack) - (t0 + local.shift);
}

/// What an end of a span becomes on the base ray. All sums are of the same few doubles in the same
/// order for single rays and packets.
struct Placing {
    double t0;     ///< of the context
    double shift;  ///< of the leaf
    /// Where the ray starts on a surface it may miss it by more than its own error: by 1 + `slack` times as much.
    double slack;
    std::uint32_t leaf;
    std::uint32_t context;
};

/// How much further than its own error a ray's start may lie from its surface, in that error.
template <class R>
HWY_INLINE R start_slack(R start_error, R place_error) {
    return start_error / lane_max(place_error, R(1e-300));
}

HWY_INLINE Event event_at(const Placing& at, double s, double error, std::uint16_t face,
                          bool enter) {
    const double t = at.t0 + (at.shift + s);
    const double rounding =
        2.0 * kUnitRoundoff * (std::fabs(at.t0) + std::fabs(at.shift) + std::fabs(s));
    const double total = std::isfinite(s) ? error + rounding : 0.0;
    return {t - total, t,     total, t - (total + at.slack * total), at.leaf, at.context, face,
            enter,     false, false};
}

template <int L>
HWY_INLINE void add_span(const Walker<L>& w, Lane& lane, const Event& enter, const Event& exit) {
    if (w.mode != Mode::all && (exit.hi() < lane.start || enter.lo > lane.limit)) return;
    lane.insert(enter);
    if (exit.lo < kInfinity) lane.insert(exit);
}

/// Marks that the leaf may be touched between two places, without being entered for certain.
template <int L>
HWY_INLINE void add_touch(const Walker<L>& w, Lane& lane, const Placing& at, double from,
                          double to) {
    const double middle = 0.5 * (from + to);
    Event event = event_at(at, middle, 0.5 * (to - from), 0, true);
    event.near = kInfinity;
    event.idle = true;
    if (w.mode != Mode::all && (event.hi() < lane.start || event.lo > lane.limit)) return;
    lane.insert(event);
}

/// How far to step aside: clear of the boundary over the whole leaf, but little compared to the leaf.
HWY_INLINE double sidestep(const Frame& frame, double place_error) {
    const double size = 1.0 / max_norm(frame.row_length);
    const double clear = kSidestep * place_error;
    const double most = 0x1p-8 * (size < 1.0 ? size : 1.0);
    return clear < most ? clear : most;
}

/// Marks that the ray runs in the boundary of the leaf, from `enter` on; `step`: how far it should be moved aside.
template <int L>
HWY_INLINE void add_uncertain(const Walker<L>& w, Lane& lane, Event enter, double exit_hi,
                              double step) {
    if (w.mode != Mode::all && (exit_hi < lane.start || enter.lo > lane.limit)) return;
    enter.t = enter.lo;
    enter.error = step;
    enter.uncertain = true;
    lane.insert(enter);
}

/// Makes the rays' context inside an instance and puts its tree on the list. `place_error` is in
/// the parent's frame.
template <int L>
void open_instance(Walker<L>& w, std::uint32_t parent, std::uint32_t leaf_index, const Frame& frame,
                   std::uint32_t lanes, const Local<double>* locals) {
    const auto index = static_cast<std::uint32_t>(w.contexts.size());
    w.contexts.emplace_back();
    const Context<L>& from = w.contexts[parent];
    Context<L>& to = w.contexts[index];
    const Leaf& leaf = from.solid->leaves[leaf_index];
    const Look& look = w.data->looks[leaf.look];
    to.solid = &w.data->solids[frame.index];
    to.parent = parent;
    to.leaf = leaf_index;
    to.path = (from.path * 0x01000193U) ^ (from.solid->first_leaf + leaf_index + 1);
    to.cuts = from.cuts != look.cuts;
    to.material = look.material != csg::kNoMaterial ? look.material : from.material;
    const double stretch = frame.stretch * max_norm(frame.row_length) * (1.0 + 0x1p-30);
    to.size = from.size / max_norm(frame.row_length);
    double nearest = kInfinity;
    for (int i = 0; i < L; ++i) {
        const Local<double>& l = locals[i];
        const LocalRay<double>& r = l.ray;
        const double o[3] = {r.ox, r.oy, r.oz};
        const double d[3] = {r.dx, r.dy, r.dz};
        to.t0[i] = from.t0[i] + l.shift;
        to.start_error[i] = from.start_error[i] * stretch;
        to.error[i] = stretch * l.place_error + norm(frame.error);
        for (int a = 0; a < 3; ++a) {
            to.o[a][i] = o[a];
            to.d[a][i] = d[a];
        }
        set_box_ray(to, i, w.lanes[i].start, w.lanes[i].limit, w.mode == Mode::all);
        if ((lanes >> i & 1U) != 0) {
            // The solid lies within the unit ball about its centre, so it is not met earlier than
            // this.
            const double reach = 1.5 / std::sqrt(r.dd);
            const double t = base_t(to.t0[i], -reach);
            nearest = t < nearest ? t : nearest;
        }
    }
    w.unopened.make_room(1);
    w.unopened.put({nearest, 0, index, 0, lanes});
}

template <int L, class Visit>
HWY_INLINE void visit_kernel(const Walker<L>& w, const Frame& frame, Visit&& visit) {
    const auto& tables = w.data->kernels;
    switch (frame.type) {
#define RAYMO_KERNEL(n)                                                                     \
    case n:                                                                                 \
        if constexpr (n < solids::Inventory::kSize)                                         \
            visit(std::get < n < solids::Inventory::kSize ? n : 0 > (tables)[frame.index]); \
        break;
        RAYMO_KERNEL(0)
        RAYMO_KERNEL(1)
        RAYMO_KERNEL(2)
        RAYMO_KERNEL(3)
        RAYMO_KERNEL(4)
        RAYMO_KERNEL(5)
        RAYMO_KERNEL(6)
        RAYMO_KERNEL(7)
        RAYMO_KERNEL(8)
        RAYMO_KERNEL(9)
        RAYMO_KERNEL(10)
        RAYMO_KERNEL(11)
        RAYMO_KERNEL(12)
        RAYMO_KERNEL(13)
        RAYMO_KERNEL(14)
        RAYMO_KERNEL(15)
#undef RAYMO_KERNEL
        default:
            break;
    }
    static_assert(solids::Inventory::kSize <= 16);
}

template <int L>
HWY_INLINE void add_spans(const Walker<L>& w, Lane& lane, const Frame& frame,
                          const solids::SpanList& spans, const Local<double>& local,
                          const Placing& at) {
    if (spans.degenerate()) {
        // Where in the leaf is not known: anywhere the ray comes near it.
        const double reach = frame.reach / std::sqrt(local.ray.dd);
        add_uncertain(w, lane, event_at(at, -reach, 0.0, 0, true), at.t0 + (at.shift + reach),
                      sidestep(frame, local.place_error) * w.contexts[at.context].size);
    }
    if (spans.touched()) add_touch(w, lane, at, spans.touch_lo(), spans.touch_hi());
    for (std::size_t i = 0; i < spans.size(); ++i) {
        const solids::Span& span = spans[i];
        add_span(w, lane, event_at(at, span.enter.s, span.enter.error, span.enter.face, true),
                 event_at(at, span.exit.s, span.exit.error, span.exit.face, false));
    }
}

/// Whether a span of a leaf may begin elsewhere (LocalRay::from).
HWY_INLINE bool holds_end_of_past(double enter, double exit, double from) {
    return enter < from && exit >= from;
}

/// Where, of all spans of a leaf, the one begins that holds the end of a ray's past: in which order a ray has come into parts
/// that overlap tells which of their media it is in.
HWY_INLINE solids::SpanEnd beginning(const solids::SpanList& all, double from,
                                     const solids::SpanEnd& otherwise) {
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i].exit.s >= from) return all[i].enter.s < from ? all[i].enter : otherwise;
    }
    return otherwise;
}

HWY_INLINE void open_leaf(Walker<1>& w, std::uint32_t context, std::uint32_t index,
                          std::uint32_t lanes) {
    const Context<1>& c = w.contexts[context];
    const Leaf& leaf = c.solid->leaves[index];
    const Frame& frame = w.data->frames[leaf.frame];
    ++w.leaves;
    Local<double> local = localise<double>(frame, leaf, c.o[0][0], c.o[1][0], c.o[2][0], c.d[0][0],
                                           c.d[1][0], c.d[2][0], c.error[0]);
    if (w.mode != Mode::all) local.ray.from = end_of_past(w.lanes[0].start, c.t0[0], local);
    if (frame.type == kInstanceType) {
        open_instance(w, context, index, frame, lanes, &local);
        return;
    }
    const Placing at{c.t0[0], local.shift, start_slack(c.start_error[0], local.place_error), index,
                     context};
    visit_kernel(w, frame, [&]<class K>(const K& kernel) {
        solids::SpanList spans;
        kernel.spans(local.ray, spans);
        if constexpr (BlockKernel<K>) {
            for (std::size_t i = 0; i < spans.size(); ++i) {
                if (!holds_end_of_past(spans[i].enter.s, spans[i].exit.s, local.ray.from)) continue;
                LocalRay<double> whole = local.ray;
                whole.from = solids::kFromTheBeginning;
                solids::SpanList all;
                kernel.spans(whole, all);
                spans.begin(i, beginning(all, local.ray.from, spans[i].enter));
            }
        }
        add_spans(w, w.lanes[0], frame, spans, local, at);
    });
}

/// A leaf whose kernel answers blocks; the rays from `first` on, as many as a vector holds, of which those in `lanes` count.
HWY_INLINE void open_block_leaf(Walker<kRays>& w, std::uint32_t context, std::uint32_t index,
                                const Frame& frame, int first, std::uint32_t lanes) {
    const Context<kRays>& c = w.contexts[context];
    const Leaf& leaf = c.solid->leaves[index];
    solids::RayBlock block;
    alignas(64) double shift[8];
    alignas(64) double slack[8];
    Local<Lanes> local = localise<Lanes>(
        frame, leaf, load(c.o[0] + first), load(c.o[1] + first), load(c.o[2] + first),
        load(c.d[0] + first), load(c.d[1] + first), load(c.d[2] + first), load(c.error + first));
    if (w.mode != Mode::all) {
        alignas(64) double start[8];
        for (int i = 0; i < kLanes; ++i) start[i] = w.lanes[first + i].start;
        local.ray.from = end_of_past(load(start), load(c.t0 + first), local);
    }
    store(local.ray, block, 0);
    store(local.shift, shift);
    store(start_slack(load(c.start_error + first), local.place_error), slack);
    const auto alone = [&](int ray) {
        return localise<double>(frame, leaf, c.o[0][ray], c.o[1][ray], c.o[2][ray], c.d[0][ray],
                                c.d[1][ray], c.d[2][ray], c.error[ray]);
    };
    solids::SpanBlock spans;
    block_spans(w.data->kernels, frame, block, lanes, spans);
    for (int k = 0; k < spans.count; ++k) {
        for (std::uint32_t rest = spans.valid[k]; rest != 0; rest &= rest - 1) {
            const int i = __builtin_ctz(rest);
            const Placing at{c.t0[first + i], shift[i], slack[i], index, context};
            const auto end = [&](const solids::SpanBlock::End& e) -> solids::SpanEnd {
                return {e.s[k][i], e.error[k][i], static_cast<std::uint16_t>(e.face[k][i])};
            };
            solids::SpanEnd enter = end(spans.enter);
            const solids::SpanEnd exit = end(spans.exit);
            if (holds_end_of_past(enter.s, exit.s, block.from[i])) {
                solids::SpanList all;
                spans_in_full(w.data->kernels, frame, alone(first + i).ray, all);
                enter = beginning(all, block.from[i], enter);
            }
            add_span(w, w.lanes[first + i], event_at(at, enter.s, enter.error, enter.face, true),
                     event_at(at, exit.s, exit.error, exit.face, false));
        }
    }
    for (std::uint32_t rest = spans.left_over; rest != 0; rest &= rest - 1) {
        const int i = __builtin_ctz(rest);
        const auto ray = alone(first + i);
        solids::SpanList list;
        spans_in_full(w.data->kernels, frame, ray.ray, list);
        add_spans(w, w.lanes[first + i], frame, list, ray,
                  {c.t0[first + i], shift[i], slack[i], index, context});
    }
}

HWY_INLINE void open_leaf(Walker<kRays>& w, std::uint32_t context, std::uint32_t index,
                          std::uint32_t lanes) {
    const Context<kRays>& c = w.contexts[context];
    const Leaf& leaf = c.solid->leaves[index];
    const Frame& frame = w.data->frames[leaf.frame];
    w.leaves += static_cast<std::uint64_t>(lane_count(lanes));
    if (frame.type == kInstanceType) {
        Local<double> locals[kRays];
        for (int i = 0; i < kRays; ++i) {
            locals[i] = localise<double>(frame, leaf, c.o[0][i], c.o[1][i], c.o[2][i], c.d[0][i],
                                         c.d[1][i], c.d[2][i], c.error[i]);
        }
        open_instance(w, context, index, frame, lanes, locals);
        return;
    }
    if (frame.in_blocks) {
        for (int first = 0; first < kRays; first += kLanes) {
            const std::uint32_t here = (lanes >> first) & ((1U << kLanes) - 1U);
            if (here != 0) open_block_leaf(w, context, index, frame, first, here);
        }
        return;
    }
    visit_kernel(w, frame, [&]<class K>(const K& kernel) {
        constexpr int kSpans = kSpansInLanes<K>;
        if constexpr (BlockKernel<K>) {
            return;
        } else if constexpr (kSpans == 0) {
            for (std::uint32_t rest = lanes; rest != 0; rest &= rest - 1) {
                const int i = __builtin_ctz(rest);
                const auto local = localise<double>(frame, leaf, c.o[0][i], c.o[1][i], c.o[2][i],
                                                    c.d[0][i], c.d[1][i], c.d[2][i], c.error[i]);
                solids::SpanList spans;
                kernel.spans(local.ray, spans);
                add_spans(w, w.lanes[i], frame, spans, local,
                          {c.t0[i], local.shift, start_slack(c.start_error[i], local.place_error),
                           index, context});
            }
        } else {
            for (int first = 0; first < kRays; first += kLanes) {
                const std::uint32_t here = (lanes >> first) & ((1U << kLanes) - 1U);
                if (here == 0) continue;
                const Local<Lanes> local = localise<Lanes>(
                    frame, leaf, load(c.o[0] + first), load(c.o[1] + first), load(c.o[2] + first),
                    load(c.d[0] + first), load(c.d[1] + first), load(c.d[2] + first),
                    load(c.error + first));
                LaneSpans<Lanes, Mask, kSpans> spans;
                lane_spans(kernel, local.ray, spans);
                const std::uint32_t uncertain = bits(spans.degenerate) & here;
                std::uint32_t valid[kSpans];
                const std::uint32_t touched = bits(spans.touched) & here;
                std::uint32_t any = uncertain | touched;
                for (int k = 0; k < kSpans; ++k) any |= valid[k] = bits(spans.valid[k]) & here;
                if (any == 0) continue;
                alignas(64) double shift[8];
                alignas(64) double slack[8];
                store(local.shift, shift);
                store(start_slack(load(c.start_error + first), local.place_error), slack);
                if (uncertain != 0) {
                    alignas(64) double dd[8];
                    alignas(64) double place[8];
                    store(local.ray.dd, dd);
                    store(local.place_error, place);
                    for (std::uint32_t rest = uncertain; rest != 0; rest &= rest - 1) {
                        const int i = __builtin_ctz(rest);
                        const Placing at{c.t0[first + i], shift[i], slack[i], index, context};
                        const double reach = frame.reach / std::sqrt(dd[i]);
                        add_uncertain(w, w.lanes[first + i], event_at(at, -reach, 0.0, 0, true),
                                      at.t0 + (at.shift + reach),
                                      sidestep(frame, place[i]) * c.size);
                    }
                }
                if (touched != 0) {
                    alignas(64) double from[8];
                    alignas(64) double to[8];
                    store(spans.touch_lo, from);
                    store(spans.touch_hi, to);
                    for (std::uint32_t rest = touched; rest != 0; rest &= rest - 1) {
                        const int i = __builtin_ctz(rest);
                        add_touch(w, w.lanes[first + i],
                                  {c.t0[first + i], shift[i], slack[i], index, context}, from[i],
                                  to[i]);
                    }
                }
                for (int k = 0; k < kSpans; ++k) {
                    if (valid[k] == 0) continue;
                    alignas(64) double enter[8], exit[8], enter_error[8], exit_error[8],
                        enter_face[8], exit_face[8];
                    store(spans.enter[k], enter);
                    store(spans.exit[k], exit);
                    store(spans.enter_error[k], enter_error);
                    store(spans.exit_error[k], exit_error);
                    store(spans.enter_face[k], enter_face);
                    store(spans.exit_face[k], exit_face);
                    for (std::uint32_t rest = valid[k]; rest != 0; rest &= rest - 1) {
                        const int i = __builtin_ctz(rest);
                        const Placing at{c.t0[first + i], shift[i], slack[i], index, context};
                        add_span(w, w.lanes[first + i],
                                 event_at(at, enter[i], enter_error[i],
                                          static_cast<std::uint16_t>(enter_face[i]), true),
                                 event_at(at, exit[i], exit_error[i],
                                          static_cast<std::uint16_t>(exit_face[i]), false));
                    }
                }
            }
        }
    });
}
