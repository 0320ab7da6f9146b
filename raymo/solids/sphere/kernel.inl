// Spans of the unit sphere, for one ray or several (see math/lanes.hpp). Included once per instruction set.
//
// With o the point of the line nearest to the centre, o.d = 0 and  |o + s d|^2 = 1  gives  s = +-h,  h^2 = (1 - o.o)/d.d.
// An error e of the line moves o.o by at most E = 2|o|.e + e.e, hence h^2 by E/d.d, and h by E/(d.d h) while o.o < 1 - E;
// otherwise | sqrt(a) - sqrt(b) | <= sqrt|a - b| leaves nothing that is certainly inside, and so no span.
// What is left of o.d after rounding is covered by e.
template <class R, class M>
inline void sphere_spans(const LocalRay<R>& ray, LaneSpans<R, M, 1>& out) {
    const R oo = ray.ox * ray.ox + ray.oy * ray.oy + ray.oz * ray.oz;
    const R ee = ray.ex * ray.ex + ray.ey * ray.ey + ray.ez * ray.ez;
    const R shift =
        lane_abs(ray.ox) * ray.ex + lane_abs(ray.oy) * ray.ey + lane_abs(ray.oz) * ray.ez;
    const R slack = shift + shift + ee + R(16.0 * kUnitRoundoff);
    const R room = R(1.0) - oo;  // h^2 d.d
    out.valid[0] = room > slack;
    out.degenerate = R(0.0) > R(1.0);
    out.enter_face[0] = R(0.0);
    out.exit_face[0] = R(0.0);
    out.enter[0] = out.exit[0] = out.enter_error[0] = out.exit_error[0] = R(0.0);
    if (!lane_any(out.valid[0])) return;
    const R half = lane_sqrt(lane_max(room, slack));
    const R per_length = R(1.0) / lane_sqrt(ray.dd);
    const R h = half * per_length;
    const R error = slack / half * per_length;
    out.enter[0] = R(0.0) - h;
    out.exit[0] = h;
    out.enter_error[0] = error;
    out.exit_error[0] = error;
}
