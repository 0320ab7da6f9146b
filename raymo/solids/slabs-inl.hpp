// Lines side by side against boxes (slabs.hpp); included once per instruction set, inside HWY_NAMESPACE, after
// math/lanes-inl.hpp and math/triple.inl.

/// As Slabs() for each line, with the same numbers: the lines from number `first` of eight on, as many as a vector holds.
HWY_INLINE void set_slabs(const Triple<Lanes>& origin, const Triple<Lanes>& along, Lanes error,
                          Lanes past, int first, SlabLanes& out) {
    const hn::Rebind<float, D> tag;
    const auto floats = [&](Lanes x) RAYMO_INLINE_BODY { return hn::DemoteTo(tag, x.v); };
    const auto margin = floats(error * Lanes(1.0 + 0x1p-20));
    const auto set = [&](std::size_t a, Lanes o, Lanes d) RAYMO_INLINE_BODY {
        const auto place = floats(o);
        const auto way = floats(d);
        const auto steep = hn::CopySign(hn::Max(hn::Abs(way), hn::Set(tag, 1e-15F)), way);
        const auto aside = hn::CopySign(margin, way);
        hn::StoreU(hn::Div(hn::Set(tag, 1.0F), steep), tag, out.inverse[a] + first);
        hn::StoreU(hn::Add(place, aside), tag, out.from_first[a] + first);
        hn::StoreU(hn::Sub(place, aside), tag, out.from_last[a] + first);
    };
    set(0, origin.x, along.x);
    set(1, origin.y, along.y);
    set(2, origin.z, along.z);
    store_floats(past - Lanes(0x1p-20) * (Lanes(1.0) + lane_abs(past)), out.past + first);
}

/// Slabs::met(), of box k: the lines that may meet it, one bit each.
HWY_INLINE std::uint32_t met(const SlabLanes& slabs, const EightBoxes& boxes, std::size_t k) {
    const hn::CappedTag<float, 8> tag;
    constexpr std::size_t kFloats = HWY_MIN(8, HWY_LANES(float));
    std::uint32_t out = 0;
    for (std::size_t first = 0; first < 8; first += kFloats) {
        auto enter = hn::Zero(tag);
        auto exit = hn::Zero(tag);
        for (std::size_t a = 0; a < 3; ++a) {
            const auto inverse = hn::LoadU(tag, slabs.inverse[a] + first);
            const auto forwards = hn::Gt(inverse, hn::Zero(tag));
            const auto lo = hn::Set(tag, boxes.lo[a][k]);
            const auto hi = hn::Set(tag, boxes.hi[a][k]);
            const auto near = hn::Mul(hn::Sub(hn::IfThenElse(forwards, lo, hi),
                                              hn::LoadU(tag, slabs.from_first[a] + first)),
                                      inverse);
            const auto far = hn::Mul(hn::Sub(hn::IfThenElse(forwards, hi, lo),
                                             hn::LoadU(tag, slabs.from_last[a] + first)),
                                     inverse);
            enter = a == 0 ? near : hn::IfThenElse(hn::Gt(near, enter), near, enter);
            exit = a == 0 ? far : hn::IfThenElse(hn::Lt(far, exit), far, exit);
        }
        const auto ahead = hn::Ge(exit, hn::LoadU(tag, slabs.past + first));
        std::uint8_t bytes[8] = {};
        hn::StoreMaskBits(tag, hn::And(hn::Le(enter, exit), ahead), bytes);
        out |= std::uint32_t{bytes[0]} << first;
    }
    return out;
}
