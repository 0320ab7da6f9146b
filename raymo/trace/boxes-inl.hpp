// Rays against boxes; included by walk.cpp once per instruction set, inside HWY_NAMESPACE.
//
// Slab test in floats. Boxes carry a margin that covers the rounding (flatten.cpp), so a box that a ray meets is never
// missed; a box that is met in vain costs time, not correctness. Used children of a node stand before unused ones.

using F = hn::CappedTag<float, 8>;
inline constexpr int kFloats = static_cast<int>(HWY_MIN(8, HWY_LANES(float)));
using Floats = hn::Vec<F>;

/// Rays of a packet, as many as fit a vector.
struct RaysInFloats {
    Floats ox, oy, oz, ix, iy, iz, from, to;
};
HWY_INLINE RaysInFloats rays_in_floats(const Context<8>& c, int first) {
    const F f;
    return {hn::Load(f, c.fo[0] + first),      hn::Load(f, c.fo[1] + first),
            hn::Load(f, c.fo[2] + first),      hn::Load(f, c.inverse[0] + first),
            hn::Load(f, c.inverse[1] + first), hn::Load(f, c.inverse[2] + first),
            hn::Load(f, c.from + first),       hn::Load(f, c.to + first)};
}

/// Narrows [enter, leave] to the slab lo <= o + t / inverse <= hi.
HWY_INLINE void clip(Floats lo, Floats hi, Floats o, Floats inverse, Floats& enter, Floats& leave) {
    const Floats p = hn::Mul(hn::Sub(lo, o), inverse);
    const Floats q = hn::Mul(hn::Sub(hi, o), inverse);
    enter = hn::Max(enter, hn::Min(p, q));
    leave = hn::Min(leave, hn::Max(p, q));
}

/// Puts a box on the list, which is sorted with the nearest last.
template <int L>
HWY_INLINE void put_off(Walker<L>& w, const Unopened& box) {
    std::size_t i = w.unopened.size();
    w.unopened.push_back(box);
    Unopened* list = w.unopened.data();
    while (i > 0 && list[i - 1].t < box.t) {
        list[i] = list[i - 1];
        --i;
    }
    list[i] = box;
}

/// A packet of rays against one box after the other.
HWY_INLINE void open_node(Walker<8>& w, const Unopened& box, std::uint32_t lanes) {
    const F f;
    const Context<8>& c = w.contexts[box.context];
    const BvhNode& node = c.solid->nodes[box.ref];
    RaysInFloats rays[8 / kFloats];
    for (int v = 0; v < 8 / kFloats; ++v) rays[v] = rays_in_floats(c, v * kFloats);
    ++w.boxes;
    for (int k = 0; k < BvhNode::kWidth; ++k) {
        if (node.lo[0][k] > node.hi[0][k]) break;
        std::uint32_t met = 0;
        alignas(64) float near[8];
        for (int v = 0; v < 8 / kFloats; ++v) {
            const RaysInFloats& r = rays[v];
            Floats enter = r.from;
            Floats leave = r.to;
            clip(hn::Set(f, node.lo[0][k]), hn::Set(f, node.hi[0][k]), r.ox, r.ix, enter, leave);
            clip(hn::Set(f, node.lo[1][k]), hn::Set(f, node.hi[1][k]), r.oy, r.iy, enter, leave);
            clip(hn::Set(f, node.lo[2][k]), hn::Set(f, node.hi[2][k]), r.oz, r.iz, enter, leave);
            const auto hit = hn::Le(enter, leave);
            hn::Store(
                hn::IfThenElse(hit, enter, hn::Set(f, std::numeric_limits<float>::infinity())), f,
                near + v * kFloats);
            std::uint8_t bytes[8] = {};
            hn::StoreMaskBits(f, hit, bytes);
            met |= static_cast<std::uint32_t>(bytes[0]) << (v * kFloats);
        }
        met &= lanes;
        if (met == 0) continue;
        double t = kInfinity;
        if (box.context == 0) {
            // Rays that do not count may be nearer: that opens the box too early, never too late.
            float least = near[0];
            for (int i = 1; i < 8; ++i) least = near[i] < least ? near[i] : least;
            t = least;
        } else {
            for (std::uint32_t rest = met; rest != 0; rest &= rest - 1) {
                const int i = __builtin_ctz(rest);
                const double entry = base_t(c.t0[i], near[i]);
                t = entry < t ? entry : t;
            }
        }
        put_off(w, {t, node.ref[k], box.context, node.count[k], static_cast<std::uint8_t>(met)});
    }
}

/// One ray against all boxes of a node.
HWY_INLINE void open_node(Walker<1>& w, const Unopened& box, std::uint32_t) {
    const F f;
    const Context<1>& c = w.contexts[box.context];
    const BvhNode& node = c.solid->nodes[box.ref];
    ++w.boxes;
    std::uint32_t met = 0;
    alignas(64) float near[8];
    for (int i = 0; i < 8; i += kFloats) {
        Floats enter = hn::Set(f, c.from[0]);
        Floats leave = hn::Set(f, c.to[0]);
        for (int a = 0; a < 3; ++a) {
            clip(hn::Load(f, node.lo[a] + i), hn::Load(f, node.hi[a] + i), hn::Set(f, c.fo[a][0]),
                 hn::Set(f, c.inverse[a][0]), enter, leave);
        }
        hn::Store(enter, f, near + i);
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(f, hn::Le(enter, leave), bytes);
        met |= static_cast<std::uint32_t>(bytes[0]) << i;
    }
    for (; met != 0; met &= met - 1) {
        const int k = __builtin_ctz(met);
        if (node.lo[0][k] > node.hi[0][k]) break;
        put_off(w, {base_t(c.t0[0], near[k]), node.ref[k], box.context, node.count[k], 1});
    }
}
