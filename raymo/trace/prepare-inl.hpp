// A packet of rays brought into the frame of the base solid; included by walk.cpp once per instruction set, inside
// HWY_NAMESPACE. Does for many rays what base_ray (base_ray.hpp) does for one, with equal bits.

struct SumInLanes {
    Lanes sum, rest;
};
/// a + b = sum + rest, exactly [Knuth97 4.2.2].
HWY_INLINE SumInLanes two_sum(Lanes a, Lanes b) {
    const Lanes s = a + b;
    const Lanes bb = s - a;
    return {s, (a - (s - bb)) + (b - bb)};
}
/// a * b = sum + rest, exactly, while nothing overflows: by a fused multiplication, or where there is none by [Dekker71].
HWY_INLINE SumInLanes two_product(Lanes a, Lanes b) {
#if HWY_NATIVE_FMA
    const Lanes product = a * b;
    return {product, lane_fma(a, b, Lanes(0.0) - product)};
#else
    const Lanes splitter(134217729.0);  // 2^27 + 1
    const Lanes ca = splitter * a;
    const Lanes cb = splitter * b;
    const Lanes a1 = ca - (ca - a);
    const Lanes b1 = cb - (cb - b);
    const Lanes a2 = a - a1;
    const Lanes b2 = b - b1;
    const Lanes p = a * b;
    return {p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2};
#endif
}

/// binary_inverse() of each lane.
HWY_INLINE Lanes binary_inverses(Lanes size) {
    const hn::RebindToUnsigned<D> integer;
    const auto exponent = hn::And(hn::BitCast(integer, size.v), hn::Set(integer, 0x7ffULL << 52));
    const Lanes quick(hn::BitCast(D(), hn::Sub(hn::Set(integer, 2046ULL << 52), exponent)));
    const Mask usual = lane_and(size >= Lanes(0x1p-1022), size < Lanes(0x1p+1023));
    if (!lane_any(lane_not(usual))) return quick;
    alignas(64) double inverse[8];
    store(size, inverse);
    for (int i = 0; i < kLanes; ++i) inverse[i] = binary_inverse(inverse[i]);
    return load(inverse);
}

/// Rays from further away than Dekker's product can bear are left to base_ray.
HWY_INLINE void prepare_packet(Walker<kRays>& w, const RayPacket& rays) {
    Context<kRays>& c = w.contexts[0];
    const CompiledSolid& base = *c.solid;
    Nearest& n = w.nearest;
    std::uint32_t very_far = 0;
    n.on_surface = false;
    const Lanes scale(base.scale);
    const int some = __builtin_ctz(w.active);
    for (int first = begin_of(w.active); first < end_of(w.active); first += kLanes) {
        // Lanes that are not in use do as one that is.
        const Mask used = mask_of(w.active >> first);
        const auto read = [&](const double(&row)[kRays]) {
            return lane_select(used, load(row + first), Lanes(row[some]));
        };
        const Lanes given[3] = {read(rays.d[0]), read(rays.d[1]), read(rays.d[2])};
        const Lanes unit = binary_inverses(
            lane_max(lane_abs(given[0]), lane_max(lane_abs(given[1]), lane_abs(given[2]))));
        Lanes far(0.0);
        Lanes place[3], low[3], along[3];
        for (int a = 0; a < 3; ++a) {
            const SumInLanes sum = two_sum(read(rays.o[a]), Lanes(-base.centre[a]));
            place[a] = sum.sum * scale;
            low[a] = sum.rest * scale;
            along[a] = given[a] * unit;
            far = lane_max(far, lane_abs(place[a]));
        }
        Lanes error = Lanes(4.0 * kUnitRoundoff) * lane_min(far, Lanes(kFarOrigin));
        Lanes shift(0.0);
        const Mask moves = far > Lanes(kFarOrigin);
        if (lane_any(moves)) {
            const auto dot = [](const Lanes* u, const Lanes* v) {
                return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
            };
            shift = lane_select(moves, (Lanes(0.0) - dot(place, along)) / dot(along, along), shift);
            Lanes size(0.0);
            for (int a = 0; a < 3; ++a) {
                const SumInLanes product = two_product(shift, along[a]);
                const SumInLanes sum = two_sum(place[a], product.sum);
                const Lanes moved = sum.sum + (sum.rest + (product.rest + low[a]));
                place[a] = lane_select(moves, moved, place[a]);
                size = lane_max(size, lane_abs(place[a]));
            }
            const Lanes more = Lanes(8.0 * kUnitRoundoff) * (size + Lanes(kUnitRoundoff) * far);
            error = lane_select(moves, error + more, error);
        }
        const Lanes t_per_s = unit * Lanes(1.0 / base.scale);  // powers of two
        const Lanes from = Lanes(0.0) - shift;
        const Lanes t_max = read(rays.t_max);
        const bool endless = !lane_any(t_max < Lanes(kInfinity));
        const Lanes to = (endless ? t_max : t_max / t_per_s) - shift;
        for (int a = 0; a < 3; ++a) {
            constexpr double kTilt = 1e-20;
            store(place[a], c.o[a] + first);
            store(along[a], c.d[a] + first);
            store_floats(place[a], c.fo[a] + first);
            const Lanes tilted =
                lane_copysign(lane_max(lane_abs(along[a]), Lanes(kTilt)), along[a]);
            store_floats(Lanes(1.0) / tilted, c.inverse[a] + first);
        }
        store(t_per_s, n.t_per_s + first);
        store(shift, n.shift + first);
        store(from, n.start + first);
        store(to, n.limit + first);
        store_floats(from - Lanes(0x1p-20) * lane_abs(from), c.from + first);
        store_floats(to + Lanes(0x1p-20) * lane_abs(to), c.to + first);
        store(error, c.error + first);
        const Lanes start_error = read(rays.start_error) * scale;
        n.on_surface |= lane_any(start_error > Lanes(0.0));
        store(start_error, c.start_error + first);
        store(Lanes(0.0), c.t0 + first);
        very_far |= bits(lane_not(far <= Lanes(0x1p+400))) << first;
    }
    for (; very_far != 0; very_far &= very_far - 1) {
        const int i = __builtin_ctz(very_far);
        const RayQuery q = rays.query((w.active >> i & 1U) != 0 ? i : some);
        const BaseRay ray = base_ray(base, q);
        for (int a = 0; a < 3; ++a) {
            c.o[a][i] = ray.o[a];
            c.fo[a][i] = static_cast<float>(ray.o[a]);
        }
        c.error[i] = ray.error;
        n.shift[i] = ray.shift;
        n.start[i] = ray.to_s(0.0);
        n.limit[i] = ray.to_s(q.t_max);
        c.from[i] = static_cast<float>(n.start[i] - 0x1p-20 * std::fabs(n.start[i]));
        c.to[i] = static_cast<float>(n.limit[i] + 0x1p-20 * std::fabs(n.limit[i]));
    }
}

/// Nothing found yet by the rays `lanes`.
HWY_INLINE void reset_nearest(Nearest& n, std::uint32_t lanes) {
    const Lanes none(kInfinity);
    for (int i = begin_of(lanes); i < end_of(lanes); i += kLanes) {
        for (double* p : {n.lo, n.t, n.hi, n.second_lo, n.trouble_lo}) store(none, p + i);
        store(Lanes(-kInfinity), n.start_hi + i);
        for (double* p : {n.error, n.face}) store(Lanes(0.0), p + i);
        for (double* p : {n.leaf, n.inside}) store(Lanes(-1.0), p + i);
    }
    n.found = n.deferred = 0;
}
