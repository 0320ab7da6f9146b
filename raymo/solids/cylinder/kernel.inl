// Spans of the cylinder x^2 + y^2 <= 1, |z| <= 1, for one ray or several (see math/lanes.hpp).
// Included once per instruction set, after solids/interval.inl.
//
// In the plane z = 0 the line has the point nearest to the axis at s0 and the distance p from it:
//     s0 = -(ox dx + oy dy) / a,  p^2 = (ox dy - oy dx)^2 / a,  a = dx^2 + dy^2.
// It is inside for |s - s0| <= h,  h^2 = (1 - p^2) / a.
//
// Error. Along the line f(s) = |xy(s)|^2 - 1 = a ((s - s0)^2 - h^2). Where the line is within the
// solid, |x|, |y| <= 1, an error e of it changes f by at most E = 2 (ex + ey) + ex^2 + ey^2, plus
// rounding: of p^2 and 1 - p^2, below 16 u (1 + ox^2 + oy^2). The ends move from h to sqrt(h^2 +- E / a). With
// q^2 = max(1 - p^2, E) / a that is at most by (E / a) / q; and h is max(1 - p^2, 0) / (a q), which is right where 1 - p^2 > E,
// and elsewhere together with the error E / (a q) = q still covers sqrt(h^2 + E / a). Rounding of s0 adds
// 6 u |o| / sqrt(a) <= 3 u (1 + |o|^2) / sqrt(a).
// A line (nearly) parallel to the axis, a < 2^-200 d.d, is tilted by 2^-100, which changes nothing
// within the solid.
template <class R, class M>
RAYMO_INLINE void cylinder_spans(const LocalRay<R>& ray, LaneSpans<R, M, 1>& out) {
    const R u = R(kUnitRoundoff);
    const R one = R(1.0);
    const R across = ray.dx * ray.dx + ray.dy * ray.dy;
    const M upright = across < ray.dd * R(0x1p-200);
    const R dx = lane_select(upright, lane_abs(ray.dz) * R(0x1p-100), ray.dx);
    const R dy = lane_select(upright, R(0.0), ray.dy);
    const R inverse = one / (dx * dx + dy * dy);
    const R oo = ray.ox * ray.ox + ray.oy * ray.oy;
    const R s0 = (R(0.0) - (ray.ox * dx + ray.oy * dy)) * inverse;
    const R side = ray.ox * dy - ray.oy * dx;
    const R room = one - side * side * inverse;
    const R e = ray.ex + ray.ey;
    const R slack = e + e + e * e + R(16.0) * u * (one + oo);
    const R q = lane_sqrt(lane_max(room, slack) * inverse);
    const R share = inverse / q;
    const R h = lane_max(room, R(0.0)) * share;
    const R error = slack * share + R(3.0) * u * (one + oo) * lane_sqrt(inverse) + R(4.0) * u * h;

    Window<R> w;
    open_window(w);
    clip_enter(w, s0 - h, error, R(0.0));
    clip_exit(w, s0 + h, error, R(0.0));
    clip_slab(w, ray.oz, ray.dz, ray.ez, least_direction(ray), 1.0, 2.0);
    close_window(w, ray, room + slack > R(0.0), 0, out);
}

// The normal on face `face`, in the place of a point there.
template <class R>
RAYMO_INLINE void cylinder_normal(R face, R& x, R& y, R& z) {
    const auto mantle = face == R(0.0);
    x = lane_select(mantle, x, R(0.0));
    y = lane_select(mantle, y, R(0.0));
    z = lane_select(mantle, R(0.0), lane_select(face == R(1.0), R(-1.0), R(1.0)));
}
