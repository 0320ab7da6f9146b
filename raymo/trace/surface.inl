// What is told of the surface that a ray meets, for one ray or several (see math/lanes.hpp). Included once per
// instruction set, after localise.inl and math/triple.inl.

/// a / |a|, scaled first so that squares neither overflow nor underflow.
template <class R>
RAYMO_INLINE Triple<R> unit_of(Triple<R> a) {
    const R size = lane_max(lane_abs(a.x), lane_max(lane_abs(a.y), lane_abs(a.z)));
    const R scale = R(1.0) / lane_max(size, R(0x1p-1022));
    const Triple<R> b{a.x * scale, a.y * scale, a.z * scale};
    const R inverse = R(1.0) / lane_sqrt(b.x * b.x + b.y * b.y + b.z * b.z);
    return {b.x * inverse, b.y * inverse, b.z * inverse};
}

/// A normal in the frame of a leaf, seen from the frame outside: the transposed map, made unit.
template <class R>
RAYMO_INLINE Triple<R> normal_outside(const Frame& frame, Triple<R> n) {
    const Mat3& m = frame.to_local;
    if (frame.diagonal) {
        return unit_of(Triple<R>{R(m.row[0].x) * n.x, R(m.row[1].y) * n.y, R(m.row[2].z) * n.z});
    }
    const auto column = [&](int j) {
        return R(m.row[0][j]) * n.x + R(m.row[1][j]) * n.y + R(m.row[2][j]) * n.z;
    };
    return unit_of(Triple<R>{column(0), column(1), column(2)});
}

/// The place in the leaf's frame where the ray is at parameter t of its context.
template <class R>
RAYMO_INLINE Triple<R> place_in_leaf(const Local<R>& local, R t) {
    const R s = t - local.shift;
    return {local.ray.ox + s * local.ray.dx, local.ray.oy + s * local.ray.dy,
            local.ray.oz + s * local.ray.dz};
}

/// From the base frame back to the model's.
template <class R>
struct Surface {
    R t, error, x, y, z, point_error;
};
template <class R>
RAYMO_INLINE Surface<R> surface_at(const CompiledSolid& base, Triple<R> o, Triple<R> d,
                                   Triple<R> normal, R s, R error, R shift, R t_per_s,
                                   const R* step = nullptr) {
    const R unit_roundoff = R(kUnitRoundoff);
    const R two = R(2.0);
    const auto size = [](Triple<R> v) {
        return lane_max(lane_abs(v.x), lane_max(lane_abs(v.y), lane_abs(v.z)));
    };
    const R inverse = R(1.0 / base.scale);  // a power of two
    const R facing = lane_abs(normal.x * d.x + normal.y * d.y + normal.z * d.z);
    // A ray that was moved aside by a step meets the surface that much to the side.
    R aside(0.0);
    R off(0.0);
    if (step != nullptr) {
        off = *step;
        aside = lane_select(off > R(0.0), lane_min(off / lane_max(facing, R(1e-300)), two), aside);
    }
    Surface<R> out;
    out.t = (s + shift) * t_per_s;
    out.error = (error + aside + two * unit_roundoff * lane_abs(shift)) * t_per_s +
                two * unit_roundoff * lane_abs(out.t);
    out.x = R(base.centre.x) + (o.x + d.x * s) * inverse;
    out.y = R(base.centre.y) + (o.y + d.y * s) * inverse;
    out.z = R(base.centre.z) + (o.z + d.z * s) * inverse;
    const Triple<R> point{out.x, out.y, out.z};
    out.point_error =
        (error * facing + off + R(4.0) * unit_roundoff * (size(o) + lane_abs(s))) * inverse +
        two * unit_roundoff * (size(point) + R(max_norm(base.centre)));
    return out;
}
