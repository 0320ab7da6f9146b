// What a kernel of several rays needs to answer packets (ray_block.hpp); included once per instruction set, inside
// HWY_NAMESPACE, after math/lanes-inl.hpp.

HWY_INLINE LocalRay<Lanes> load(const RayBlock& rays, int first) {
    return {load(rays.o[0] + first), load(rays.o[1] + first), load(rays.o[2] + first),
            load(rays.d[0] + first), load(rays.d[1] + first), load(rays.d[2] + first),
            load(rays.e[0] + first), load(rays.e[1] + first), load(rays.e[2] + first),
            load(rays.dd + first),   load(rays.from + first)};
}

/// kernel(ray, asked, spans, left_over) returns how many spans there are at most.
template <class Kernel>
HWY_INLINE void answer(const RayBlock& rays, std::uint32_t asked, SpanBlock& out, Kernel&& kernel) {
    out.count = 0;
    out.left_over = 0;
    for (std::uint32_t& valid : out.valid) valid = 0;
    for (int first = 0; first < 8; first += kLanes) {
        const std::uint32_t here = (asked >> first) & ((1U << kLanes) - 1U);
        if (here == 0) continue;
        LaneSpans<Lanes, Mask, kSweptSpans> spans;
        Mask left_over = mask_of(0);
        const int count = kernel(load(rays, first), mask_of(here), spans, left_over);
        out.left_over |= bits(left_over) << first;
        for (int i = 0; i < count; ++i) {
            const std::uint32_t valid = bits(spans.valid[i]) & here;
            if (valid == 0) continue;
            out.count = i + 1 > out.count ? i + 1 : out.count;
            out.valid[i] |= valid << first;
            store(spans.enter[i], out.enter.s[i] + first);
            store(spans.enter_error[i], out.enter.error[i] + first);
            store(spans.enter_face[i], out.enter.face[i] + first);
            store(spans.exit[i], out.exit.s[i] + first);
            store(spans.exit_error[i], out.exit.error[i] + first);
            store(spans.exit_face[i], out.exit.face[i] + first);
        }
    }
}

/// kernel(face, asked, place) puts the normal in its place and returns for which rays it can not; full(place, face) does
/// these.
template <class Kernel, class Full>
HWY_INLINE void turn_into_normals(PlaceBlock& places, std::uint32_t asked, Kernel&& kernel,
                                  Full&& full) {
    for (int first = 0; first < 8; first += kLanes) {
        const std::uint32_t here = (asked >> first) & ((1U << kLanes) - 1U);
        if (here == 0) continue;
        Triple<Lanes> p{load(places.p[0] + first), load(places.p[1] + first),
                        load(places.p[2] + first)};
        std::uint32_t rest = bits(kernel(load(places.face + first), mask_of(here), p));
        alignas(64) double n[3][8];
        store(p.x, n[0]);
        store(p.y, n[1]);
        store(p.z, n[2]);
        for (; rest != 0; rest &= rest - 1) {
            const int i = __builtin_ctz(rest);
            const Vec3 found =
                full({places.p[0][first + i], places.p[1][first + i], places.p[2][first + i]},
                     static_cast<std::uint16_t>(places.face[first + i]));
            for (int a = 0; a < 3; ++a) n[a][i] = found[a];
        }
        for (int a = 0; a < 3; ++a) {
            for (int i = 0; i < kLanes; ++i) places.p[a][first + i] = n[a][i];
        }
    }
}
