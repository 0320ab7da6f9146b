// Rays against boxes; included by walk.cpp once per instruction set, inside HWY_NAMESPACE.
//
// Slab test in floats. Boxes carry a margin that covers the rounding (flatten.cpp), so a box that a ray meets is never
// missed; a box that is met in vain costs time, not correctness. Used children of a node stand before unused ones.

/// Of children of a node, and of rays of a packet.
using F = hn::CappedTag<float, BvhNode::kWidth>;
using R = hn::CappedTag<float, kRays>;
inline constexpr int kFloats = static_cast<int>(HWY_MIN(BvhNode::kWidth, HWY_LANES(float)));
inline constexpr int kRayFloats = static_cast<int>(HWY_MIN(kRays, HWY_LANES(float)));
using Floats = hn::Vec<F>;
using RayFloats = hn::Vec<R>;
/// Children of a node, one bit each.
inline constexpr std::uint32_t kAllChildren = (1U << BvhNode::kWidth) - 1U;

/// One bit a lane, and back.
template <class Tag>
HWY_INLINE std::uint32_t float_bits(Tag tag, hn::Mask<Tag> mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(tag, mask, bytes);
    return static_cast<std::uint32_t>(bytes[0]) | static_cast<std::uint32_t>(bytes[1]) << 8;
}
template <class Tag>
HWY_INLINE hn::Mask<Tag> float_mask(Tag tag, std::uint32_t lanes) {
    const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(lanes),
                                   static_cast<std::uint8_t>(lanes >> 8)};
    return hn::LoadMaskBits(tag, bytes);
}

/// Rays of a packet, as many as fit a vector.
struct RaysInFloats {
    RayFloats ox, oy, oz, ix, iy, iz, from, to;
};
inline constexpr int kParts = kRays / kRayFloats;
/// All of them. How many vectors there are is known to the compiler, so they stay in registers; those without a ray that
/// counts are passed over.
struct PacketInFloats {
    RaysInFloats part[kParts];
    bool used[kParts];
};
HWY_INLINE void read_rays(const Context<kRays>& c, std::uint32_t lanes, PacketInFloats& out) {
    const R f;
    for (int v = 0; v < kParts; ++v) {
        const int first = v * kRayFloats;
        out.used[v] = (lanes >> first & first_lanes(kRayFloats)) != 0;
        out.part[v] = {hn::Load(f, c.fo[0] + first),      hn::Load(f, c.fo[1] + first),
                       hn::Load(f, c.fo[2] + first),      hn::Load(f, c.inverse[0] + first),
                       hn::Load(f, c.inverse[1] + first), hn::Load(f, c.inverse[2] + first),
                       hn::Load(f, c.from + first),       hn::Load(f, c.to + first)};
    }
}

/// Narrows [enter, leave] to the slab lo <= o + t / inverse <= hi.
template <class V>
HWY_INLINE void clip(V lo, V hi, V o, V inverse, V& enter, V& leave) {
    const V p = hn::Mul(hn::Sub(lo, o), inverse);
    const V q = hn::Mul(hn::Sub(hi, o), inverse);
    enter = hn::Max(enter, hn::Min(p, q));
    leave = hn::Min(leave, hn::Max(p, q));
}

/// Which rays of a packet meet child `k` of a node.
HWY_INLINE std::uint32_t lanes_in_box(const PacketInFloats& rays, const BvhNode& node, int k) {
    const R f;
    std::uint32_t lanes = 0;
    for (int v = 0; v < kParts; ++v) {
        if (!rays.used[v]) continue;
        const RaysInFloats& r = rays.part[v];
        RayFloats enter = r.from;
        RayFloats leave = r.to;
        clip(hn::Set(f, node.lo[0][k]), hn::Set(f, node.hi[0][k]), r.ox, r.ix, enter, leave);
        clip(hn::Set(f, node.lo[1][k]), hn::Set(f, node.hi[1][k]), r.oy, r.iy, enter, leave);
        clip(hn::Set(f, node.lo[2][k]), hn::Set(f, node.hi[2][k]), r.oz, r.iz, enter, leave);
        lanes |= float_bits(f, hn::Le(enter, leave)) << (v * kRayFloats);
    }
    return lanes;
}

/// The same, and where the first of them does.
struct Met {
    std::uint32_t lanes;
    float near;
};
HWY_INLINE Met meet_box(const PacketInFloats& rays, const BvhNode& node, int k) {
    const R f;
    Met out{0, 0.0F};
    RayFloats least = hn::Set(f, std::numeric_limits<float>::infinity());
    for (int v = 0; v < kParts; ++v) {
        if (!rays.used[v]) continue;
        const RaysInFloats& r = rays.part[v];
        RayFloats enter = r.from;
        RayFloats leave = r.to;
        clip(hn::Set(f, node.lo[0][k]), hn::Set(f, node.hi[0][k]), r.ox, r.ix, enter, leave);
        clip(hn::Set(f, node.lo[1][k]), hn::Set(f, node.hi[1][k]), r.oy, r.iy, enter, leave);
        clip(hn::Set(f, node.lo[2][k]), hn::Set(f, node.hi[2][k]), r.oz, r.iz, enter, leave);
        const auto hit = hn::Le(enter, leave);
        least = hn::Min(least, hn::IfThenElse(hit, enter, least));
        out.lanes |= float_bits(f, hit) << (v * kRayFloats);
    }
    out.near = hn::GetLane(hn::MinOfLanes(f, least));
    return out;
}

/// All rays of a packet together: a box that the beam misses is missed by every ray. Only where they all point into one
/// octant.
struct Beam {
    bool usable;
    bool forward[3];          ///< towards larger coordinates
    float nearest[3];         ///< coordinate of the origins that is nearest to what lies ahead
    float furthest[3];        ///< and furthest from it
    float least[3], most[3];  ///< of the inverse directions
    float from, to;
};
HWY_INLINE float least_of(const float* values, std::uint32_t lanes) {
    const R f;
    RayFloats least = hn::Set(f, std::numeric_limits<float>::infinity());
    for (int v = 0; v < kRays; v += kRayFloats) {
        const RayFloats x = hn::Load(f, values + v);
        least = hn::Min(least, hn::IfThenElse(float_mask(f, lanes >> v), x, least));
    }
    return hn::GetLane(hn::MinOfLanes(f, least));
}
HWY_INLINE float most_of(const float* values, std::uint32_t lanes) {
    const R f;
    RayFloats most = hn::Set(f, -std::numeric_limits<float>::infinity());
    for (int v = 0; v < kRays; v += kRayFloats) {
        const RayFloats x = hn::Load(f, values + v);
        most = hn::Max(most, hn::IfThenElse(float_mask(f, lanes >> v), x, most));
    }
    return hn::GetLane(hn::MaxOfLanes(f, most));
}
/// The least (or the most) of each of eight lists of floats, over the lanes that count.
template <bool kMost>
HWY_INLINE void ends_of(const float* const (&lists)[8], std::uint32_t lanes, float (&out)[8]) {
#if HWY_TARGET <= HWY_AVX2
    const F f;
    const hn::Repartition<double, F> pairs;
    const auto other = hn::Set(f, kMost ? -std::numeric_limits<float>::infinity()
                                        : std::numeric_limits<float>::infinity());
    const auto better = [](Floats a, Floats b) { return kMost ? hn::Max(a, b) : hn::Min(a, b); };
    const auto read = [&](int i) {
        const auto part = [&](int v) {
            return hn::IfThenElse(float_mask(f, lanes >> v), hn::Load(f, lists[i] + v), other);
        };
        const int begin = begin_of(lanes);
        Floats best = part(begin);
        for (int v = begin + kFloats; v < end_of(lanes); v += kFloats) best = better(best, part(v));
        return best;
    };
    // Two lists side by side in each block, then four, then all: every step halves what is left of each.
    const auto two = [&](int i) {
        const Floats x = read(i);
        const Floats y = read(i + 1);
        return better(hn::InterleaveLower(f, x, y), hn::InterleaveUpper(f, x, y));
    };
    const auto four = [&](int i) {
        const auto x = hn::BitCast(pairs, two(i));
        const auto y = hn::BitCast(pairs, two(i + 2));
        return better(hn::BitCast(f, hn::InterleaveLower(pairs, x, y)),
                      hn::BitCast(f, hn::InterleaveUpper(pairs, x, y)));
    };
    const Floats x = four(0);
    const Floats y = four(4);
    hn::StoreU(better(hn::ConcatLowerLower(f, y, x), hn::ConcatUpperUpper(f, y, x)), f, out);
#else
    for (int i = 0; i < 8; ++i)
        out[i] = kMost ? most_of(lists[i], lanes) : least_of(lists[i], lanes);
#endif
}
HWY_INLINE Beam beam_of(const Context<kRays>& c, std::uint32_t lanes) {
    Beam beam{};
    const float* const lists[8] = {c.inverse[0], c.inverse[1], c.inverse[2], c.fo[0],
                                   c.fo[1],      c.fo[2],      c.from,       c.to};
    float least[8];
    float most[8];
    ends_of<false>(lists, lanes, least);
    ends_of<true>(lists, lanes, most);
    for (int a = 0; a < 3; ++a) {
        beam.least[a] = least[a];
        beam.most[a] = most[a];
        if (beam.least[a] < 0.0F && beam.most[a] > 0.0F) return beam;
        beam.forward[a] = beam.least[a] > 0.0F;
        beam.nearest[a] = beam.forward[a] ? most[3 + a] : least[3 + a];
        beam.furthest[a] = beam.forward[a] ? least[3 + a] : most[3 + a];
    }
    beam.from = least[6];
    beam.to = most[7];
    beam.usable = true;
    return beam;
}
/// The children of a node that there are, one bit each.
HWY_INLINE std::uint32_t used_children(const BvhNode& node) {
    const F f;
    std::uint32_t used = 0;
    for (int v = 0; v < BvhNode::kWidth; v += kFloats) {
        used |= float_bits(f, hn::Le(hn::Load(f, node.lo[0] + v), hn::Load(f, node.hi[0] + v)))
                << v;
    }
    return used;
}
/// The children of a node that the beam may meet, one bit each.
HWY_INLINE std::uint32_t meet_node(const Beam& beam, const BvhNode& node, float* near) {
    const F f;
    std::uint32_t met = 0;
    for (int v = 0; v < BvhNode::kWidth; v += kFloats) {
        Floats enter = hn::Set(f, beam.from);
        Floats leave = hn::Set(f, beam.to);
        for (int a = 0; a < 3; ++a) {
            const Floats least = hn::Set(f, beam.least[a]);
            const Floats most = hn::Set(f, beam.most[a]);
            const Floats front =
                hn::Sub(hn::Load(f, (beam.forward[a] ? node.lo[a] : node.hi[a]) + v),
                        hn::Set(f, beam.nearest[a]));
            const Floats back =
                hn::Sub(hn::Load(f, (beam.forward[a] ? node.hi[a] : node.lo[a]) + v),
                        hn::Set(f, beam.furthest[a]));
            enter = hn::Max(enter, hn::Min(hn::Mul(front, least), hn::Mul(front, most)));
            leave = hn::Min(leave, hn::Max(hn::Mul(back, least), hn::Mul(back, most)));
        }
        hn::Store(enter, f, near + v);
        met |= float_bits(f, hn::Le(enter, leave)) << v;
    }
    return met;
}

/// The children of a node that ray `i` of a packet meets between two places, one bit each.
HWY_INLINE std::uint32_t meet_node_alone(const Context<kRays>& c, int i, float from, float to,
                                         const BvhNode& node) {
    const F f;
    std::uint32_t met = 0;
    for (int v = 0; v < BvhNode::kWidth; v += kFloats) {
        Floats enter = hn::Set(f, from);
        Floats leave = hn::Set(f, to);
        for (int a = 0; a < 3; ++a) {
            clip(hn::Load(f, node.lo[a] + v), hn::Load(f, node.hi[a] + v), hn::Set(f, c.fo[a][i]),
                 hn::Set(f, c.inverse[a][i]), enter, leave);
        }
        met |= float_bits(f, hn::Le(enter, leave)) << v;
    }
    return met;
}

/// Asks for what a child of a node holds, before it is waited for.
HWY_INLINE void fetch_child(const CompiledSolid& solid, const BvhNode& node, int k) {
    if (node.count[k] != 0) {
        __builtin_prefetch(&solid.leaves[node.ref[k]]);
    } else {
        const auto* lines = reinterpret_cast<const char*>(&solid.nodes[node.ref[k]]);
        for (std::size_t i = 0; i < sizeof(BvhNode); i += 64) __builtin_prefetch(lines + i);
    }
}

/// A packet of rays against the children of a node, for the walk of a simple solid.
HWY_INLINE void open_node(Walker<kRays>& w, std::uint32_t ref, std::uint32_t lanes,
                          const Beam& beam) {
    const Context<kRays>& c = w.contexts[0];
    const BvhNode& node = c.solid->nodes[ref];
    PacketInFloats rays;
    read_rays(c, lanes, rays);
    ++w.boxes;
    w.near_boxes.make_room(BvhNode::kWidth);
    // Children are sorted among themselves only: that opens no more nodes, and costs less, than a list that is sorted as a whole.
    const std::size_t base = w.near_boxes.count;
    alignas(64) float near[8];
    std::uint32_t met = beam.usable ? meet_node(beam, node, near) : used_children(node);
    for (; met != 0; met &= met - 1) {
        const int k = __builtin_ctz(met);
        // Rays that do not count may be nearer, and a beam is nearer than its rays: that opens a box too early, never too late.
        Met by{lanes, near[k]};
        if (!beam.usable) {
            by = meet_box(rays, node, k);
        } else if (w.nearest.on_surface || node.count[k] != 0) {
            by.lanes = lanes_in_box(rays, node, k);
        }
        by.lanes &= lanes;
        if (by.lanes == 0) continue;
        fetch_child(*c.solid, node, k);
        w.near_boxes.put({by.near, node.ref[k], node.count[k], by.lanes}, base);
    }
}

/// A packet of rays against one box after the other.
HWY_INLINE void open_node(Walker<kRays>& w, const Unopened& box, std::uint32_t lanes) {
    const Context<kRays>& c = w.contexts[box.context];
    const BvhNode& node = c.solid->nodes[box.ref];
    PacketInFloats rays;
    read_rays(c, lanes, rays);
    ++w.boxes;
    w.unopened.make_room(BvhNode::kWidth);
    for (int k = 0; k < BvhNode::kWidth; ++k) {
        if (node.lo[0][k] > node.hi[0][k]) break;
        Met by = meet_box(rays, node, k);
        by.lanes &= lanes;
        if (by.lanes == 0) continue;
        double t = by.near;
        if (box.context != 0) {
            // The rays' own starts differ: each entry is bounded by the nearest of all.
            t = kInfinity;
            for (std::uint32_t rest = by.lanes; rest != 0; rest &= rest - 1) {
                const double entry = base_t(c.t0[__builtin_ctz(rest)], by.near);
                t = entry < t ? entry : t;
            }
        }
        w.unopened.put({t, node.ref[k], box.context, node.count[k], by.lanes});
    }
}

/// One ray against all boxes of a node.
HWY_INLINE void open_node(Walker<1>& w, const Unopened& box, std::uint32_t) {
    const F f;
    const Context<1>& c = w.contexts[box.context];
    const BvhNode& node = c.solid->nodes[box.ref];
    ++w.boxes;
    std::uint32_t met = 0;
    w.unopened.make_room(BvhNode::kWidth);
    alignas(64) float near[8];
    for (int i = 0; i < BvhNode::kWidth; i += kFloats) {
        Floats enter = hn::Set(f, c.from[0]);
        Floats leave = hn::Set(f, c.to[0]);
        for (int a = 0; a < 3; ++a) {
            clip(hn::Load(f, node.lo[a] + i), hn::Load(f, node.hi[a] + i), hn::Set(f, c.fo[a][0]),
                 hn::Set(f, c.inverse[a][0]), enter, leave);
        }
        hn::Store(enter, f, near + i);
        met |= float_bits(f, hn::Le(enter, leave)) << i;
    }
    for (; met != 0; met &= met - 1) {
        const int k = __builtin_ctz(met);
        if (node.lo[0][k] > node.hi[0][k]) break;
        w.unopened.put({base_t(c.t0[0], near[k]), node.ref[k], box.context, node.count[k], 1});
    }
}
