// A packet of rays brought into the frame of the base solid; included by walk.cpp once per instruction set, inside
// HWY_NAMESPACE. Does for eight rays what base_ray (base_ray.hpp) does for one, with equal bits.

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
    std::uint32_t far_rays = 0;
    const Lanes scale(base.scale);
    for (int first = 0; first < 8; first += kLanes) {
        const Lanes unit = load(unit_scale + first);
        Lanes far(0.0);
        for (int a = 0; a < 3; ++a) {
            const Lanes place = (load(o[a] + first) + Lanes(-base.centre[a])) * scale;
            far = lane_max(far, lane_abs(place));
            store(place, c.o[a] + first);
            store(load(d[a] + first) * unit, c.d[a] + first);
        }
        const Lanes t_per_s = unit / scale;
        store(t_per_s, n.t_per_s + first);
        store(Lanes(0.0), n.shift + first);
        store(Lanes(0.0), n.start + first);
        store(load(t_max + first) / t_per_s, n.limit + first);
        store(Lanes(4.0 * kUnitRoundoff) * lane_min(far, Lanes(kFarOrigin)), c.error + first);
        store(load(start_error + first) * scale, c.start_error + first);
        store(Lanes(0.0), c.t0 + first);
        far_rays |= bits(far > Lanes(kFarOrigin)) << first;
    }
    for (; far_rays != 0; far_rays &= far_rays - 1) {
        const int i = __builtin_ctz(far_rays);
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
