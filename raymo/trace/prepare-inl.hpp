// A packet of rays brought into the frame of the base solid; included by walk.cpp once per instruction set, inside
// HWY_NAMESPACE. Does for eight rays what base_ray (base_ray.hpp) does for one, with equal bits.

struct SumInLanes {
    Lanes sum, rest;
};
/// a + b = sum + rest, exactly [Knuth97 4.2.2].
HWY_INLINE SumInLanes two_sum(Lanes a, Lanes b) {
    const Lanes s = a + b;
    const Lanes bb = s - a;
    return {s, (a - (s - bb)) + (b - bb)};
}
/// a * b = sum + rest, exactly [Dekker71], while nothing overflows: what a fused multiplication gives, where there is none.
HWY_INLINE SumInLanes two_product(Lanes a, Lanes b) {
    const Lanes splitter(134217729.0);  // 2^27 + 1
    const Lanes ca = splitter * a;
    const Lanes cb = splitter * b;
    const Lanes a1 = ca - (ca - a);
    const Lanes b1 = cb - (cb - b);
    const Lanes a2 = a - a1;
    const Lanes b2 = b - b1;
    const Lanes p = a * b;
    return {p, ((a1 * b1 - p) + a1 * b2 + a2 * b1) + a2 * b2};
}

/// Rays from further away than Dekker's product can bear are left to base_ray.
HWY_INLINE void prepare_packet(Walker<8>& w, const RayQuery* queries, int count) {
    Context<8>& c = w.contexts[0];
    const CompiledSolid& base = *c.solid;
    Nearest& n = w.nearest;
    alignas(64) double o[3][8], d[3][8], unit_scale[8], start_error[8], t_max[8];
    for (int i = 0; i < 8; ++i) {
        const RayQuery& q = queries[i < count ? i : count - 1];
        const Vec3 direction = q.ray.direction;
        for (int a = 0; a < 3; ++a) o[a][i] = q.ray.origin[a];
        for (int a = 0; a < 3; ++a) d[a][i] = direction[a];
        unit_scale[i] = binary_inverse(max_norm(direction));
        start_error[i] = q.start_error;
        t_max[i] = q.t_max;
    }
    std::uint32_t very_far = 0;
    const Lanes scale(base.scale);
    for (int first = 0; first < 8; first += kLanes) {
        const Lanes unit = load(unit_scale + first);
        Lanes far(0.0);
        Lanes place[3], low[3], along[3];
        for (int a = 0; a < 3; ++a) {
            const SumInLanes sum = two_sum(load(o[a] + first), Lanes(-base.centre[a]));
            place[a] = sum.sum * scale;
            low[a] = sum.rest * scale;
            along[a] = load(d[a] + first) * unit;
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
        for (int a = 0; a < 3; ++a) {
            store(place[a], c.o[a] + first);
            store(along[a], c.d[a] + first);
        }
        const Lanes t_per_s = unit / scale;
        store(t_per_s, n.t_per_s + first);
        store(shift, n.shift + first);
        store(Lanes(0.0) - shift, n.start + first);
        store(load(t_max + first) / t_per_s - shift, n.limit + first);
        store(error, c.error + first);
        store(load(start_error + first) * scale, c.start_error + first);
        store(Lanes(0.0), c.t0 + first);
        very_far |= bits(lane_not(far <= Lanes(0x1p+400))) << first;
    }
    for (; very_far != 0; very_far &= very_far - 1) {
        const int i = __builtin_ctz(very_far);
        const RayQuery& q = queries[i < count ? i : count - 1];
        const BaseRay ray = base_ray(base, q);
        for (int a = 0; a < 3; ++a) c.o[a][i] = ray.o[a];
        c.error[i] = ray.error;
        n.shift[i] = ray.shift;
        n.start[i] = ray.to_s(0.0);
        n.limit[i] = ray.to_s(q.t_max);
    }
    for (int i = 0; i < 8; ++i) {
        const double from = n.start[i];
        const double to = n.limit[i];
        c.from[i] = static_cast<float>(from - 0x1p-20 * (from < 0.0 ? -from : from));
        c.to[i] = static_cast<float>(to + 0x1p-20 * (to < 0.0 ? -to : to));
    }
    for (int a = 0; a < 3; ++a) {
        for (int i = 0; i < 8; ++i) {
            constexpr float kTilt = 1e-20F;
            const auto x = static_cast<float>(c.d[a][i]);
            const float size = x < 0.0F ? -x : x;
            const float tilted = size < kTilt ? kTilt : size;
            c.fo[a][i] = static_cast<float>(c.o[a][i]);
            c.inverse[a][i] = (x < 0.0F ? -1.0F : 1.0F) / tilted;
        }
    }
}

/// Nothing found yet.
HWY_INLINE void reset_nearest(Nearest& n) {
    for (int i = 0; i < 8; ++i) {
        n.lo[i] = n.t[i] = n.hi[i] = n.second_lo[i] = n.trouble_lo[i] = kInfinity;
        n.start_hi[i] = -kInfinity;
        n.error[i] = n.face[i] = 0.0;
        n.leaf[i] = n.inside[i] = -1.0;
        n.found[i] = false;
    }
    n.deferred = 0;
}
