// Rays against boxes; included by walk.cpp once per instruction set, inside HWY_NAMESPACE.
//
// Slab test in floats. Boxes carry a margin that covers the rounding (flatten.cpp), so a box that a
// ray meets is never missed; a box that is met in vain costs time, not correctness.

using F = hn::CappedTag<float, 8>;
inline constexpr int kFloats = static_cast<int>(HWY_MIN(8, HWY_LANES(float)));

/// A packet of rays against one box after the other.
HWY_INLINE void open_node(Walker<8>& w, const Unopened& box, std::uint32_t lanes) {
    const F f;
    const Context<8>& c = w.contexts[box.context];
    const BvhNode& node = c.solid->nodes[box.ref];
    ++w.boxes;
    for (int k = 0; k < BvhNode::kWidth; ++k) {
        if (node.lo[0][k] > node.hi[0][k]) continue;
        std::uint32_t met = 0;
        alignas(64) float near[8];
        for (int i = 0; i < 8; i += kFloats) {
            auto enter = hn::LoadU(f, c.from + i);
            auto leave = hn::LoadU(f, c.to + i);
            for (int a = 0; a < 3; ++a) {
                const auto o = hn::LoadU(f, c.fo[a] + i);
                const auto inverse = hn::LoadU(f, c.inverse[a] + i);
                const auto p = hn::Mul(hn::Sub(hn::Set(f, node.lo[a][k]), o), inverse);
                const auto q = hn::Mul(hn::Sub(hn::Set(f, node.hi[a][k]), o), inverse);
                enter = hn::Max(enter, hn::Min(p, q));
                leave = hn::Min(leave, hn::Max(p, q));
            }
            hn::StoreU(enter, f, near + i);
            std::uint8_t bytes[8] = {};
            hn::StoreMaskBits(f, hn::Le(enter, leave), bytes);
            met |= static_cast<std::uint32_t>(bytes[0]) << i;
        }
        met &= lanes;
        if (met == 0) continue;
        double t = kInfinity;
        for (std::uint32_t rest = met; rest != 0; rest &= rest - 1) {
            const int i = __builtin_ctz(rest);
            const double entry = base_t(c.t0[i], near[i]);
            t = entry < t ? entry : t;
        }
        w.push({t, node.ref[k], box.context, node.count[k], static_cast<std::uint8_t>(met)});
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
        auto enter = hn::Set(f, c.from[0]);
        auto leave = hn::Set(f, c.to[0]);
        for (int a = 0; a < 3; ++a) {
            const auto o = hn::Set(f, c.fo[a][0]);
            const auto inverse = hn::Set(f, c.inverse[a][0]);
            const auto p = hn::Mul(hn::Sub(hn::LoadU(f, node.lo[a] + i), o), inverse);
            const auto q = hn::Mul(hn::Sub(hn::LoadU(f, node.hi[a] + i), o), inverse);
            enter = hn::Max(enter, hn::Min(p, q));
            leave = hn::Min(leave, hn::Max(p, q));
        }
        hn::StoreU(enter, f, near + i);
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(f, hn::Le(enter, leave), bytes);
        met |= static_cast<std::uint32_t>(bytes[0]) << i;
    }
    for (; met != 0; met &= met - 1) {
        const int k = __builtin_ctz(met);
        if (node.lo[0][k] > node.hi[0][k]) continue;
        w.push({base_t(c.t0[0], near[k]), node.ref[k], box.context, node.count[k], 1});
    }
}
