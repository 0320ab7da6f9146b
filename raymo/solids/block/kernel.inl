// Spans of the cube [-1, 1]^3, for one ray or several: three slabs (see solids/interval.inl, to be
// included before).
template <class R, class M>
RAYMO_INLINE void block_spans(const LocalRay<R>& ray, LaneSpans<R, M, 1>& out) {
    const R least = least_direction(ray);
    Window<R> w;
    open_window(w);
    clip_slab(w, ray.ox, ray.dx, ray.ex, least, 0.0, 1.0);
    clip_slab(w, ray.oy, ray.dy, ray.ey, least, 2.0, 3.0);
    clip_slab(w, ray.oz, ray.dz, ray.ez, least, 4.0, 5.0);
    close_window(w, ray, ray.dd > R(0.0), 0, out);
}

// The normal on face `face`, in the place of a point there.
template <class R>
RAYMO_INLINE void block_normal(R face, R& x, R& y, R& z) {
    const auto side = [&](double low) {
        return lane_select(face == R(low), R(-1.0),
                           lane_select(face == R(low + 1.0), R(1.0), R(0.0)));
    };
    x = side(0.0);
    y = side(2.0);
    z = side(4.0);
}
