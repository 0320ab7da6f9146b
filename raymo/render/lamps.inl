// What arrives from a lamp, at one point or several (see math/lanes.hpp). Included once per instruction set, after
// light_model.inl.

template <class R>
struct ArrivalOf {
    Triple<R> direction;  // to the lamp, unit
    R distance;
    R share;  // of the lamp's power
};

template <class R>
RAYMO_INLINE Triple<R> everywhere(Vec3 v) {
    return {R(v.x), R(v.y), R(v.z)};
}

// `there` is narrowed to the points that anything arrives at. (u, v): the place on an area lamp.
template <class R, class M>
RAYMO_INLINE ArrivalOf<R> arrival(const Lamp& lamp, Triple<R> point, R u, R v, M& there) {
    ArrivalOf<R> out;
    out.share = R(1.0);
    if (lamp.kind == scene::LightKind::directional) {
        out.direction = everywhere<R>(lamp.direction);
        out.distance = R(std::numeric_limits<double>::infinity());
        return out;
    }
    Triple<R> place = everywhere<R>(lamp.position);
    if (lamp.kind == scene::LightKind::area) {
        place = place + everywhere<R>(lamp.edge_u) * u + everywhere<R>(lamp.edge_v) * v;
    }
    const Triple<R> way = place - point;
    const R squared = dot(way, way);
    there = lane_and(there, squared > R(0.0));
    out.distance = lane_sqrt(squared);
    out.direction = way * (R(1.0) / lane_max(out.distance, R(0x1p-500)));
    if (lamp.kind == scene::LightKind::spot) {
        const R cosine = dot(out.direction, everywhere<R>(lamp.direction));
        there = lane_and(there, cosine >= R(lamp.cosine_none));
        const double fade = lamp.cosine_full - lamp.cosine_none;
        const R x = (cosine - R(lamp.cosine_none)) * R(fade > 0.0 ? 1.0 / fade : 0.0);
        out.share =
            lane_select(cosine < R(lamp.cosine_full), x * x * (R(3.0) - R(2.0) * x), out.share);
    }
    return out;
}
