// Spans of the unit sphere, for one ray or several (see math/lanes.hpp). Included once per
// instruction set.
//
// With o the point of the line nearest to the centre, o.d = 0 and  |o + s d|^2 = 1  gives  s = +-h,
// h^2 = (1 - o.o)/d.d. Where the line is within the solid, |x| <= 1, an error e of it changes |x|^2
// by at most 2|e| + e.e; what is left of o.d after rounding is at most |e||d|, and changes it by
// 2|e| again. So the ends are those of h^2 to within E/d.d, E = 4|e| + e.e + 16 u, and h moves by
// at most (E/d.d) / sqrt(max(h^2, E/d.d)), since | sqrt(a) - sqrt(b) | <= |a - b| / sqrt(max(a, b))
// <= sqrt|a - b|.
template <class R, class M>
inline void sphere_spans(const LocalRay<R>& ray, LaneSpans<R, M, 1>& out) {
    const R oo = ray.ox * ray.ox + ray.oy * ray.oy + ray.oz * ray.oz;
    const R ee = ray.ex * ray.ex + ray.ey * ray.ey + ray.ez * ray.ez;
    const R slack = R(4.0) * lane_sqrt(ee) + ee + R(16.0 * kUnitRoundoff);
    const R room = R(1.0) - oo;  // h^2 d.d
    const R h = lane_sqrt(lane_max(room, R(0.0)) / ray.dd);
    const R error = slack / (lane_sqrt(lane_max(room, slack)) * lane_sqrt(ray.dd));
    out.valid[0] = h > error;
    out.degenerate = R(0.0) > R(1.0);
    out.enter[0] = R(0.0) - h;
    out.exit[0] = h;
    out.enter_error[0] = error;
    out.exit_error[0] = error;
    out.enter_face[0] = R(0.0);
    out.exit_face[0] = R(0.0);
}
