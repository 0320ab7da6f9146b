// Spans of the unit sphere, for one ray or several (see math/lanes.hpp). Included once per instruction set.
//
// With o the point of the line nearest to the centre, o.d = 0 and  |o + s d|^2 = 1  gives  s = +-h,  h^2 = (1 - o.o)/d.d.
// Where the line is within the solid, |x| <= 1, an error e of it, in any direction, changes |x|^2 by at most 2|e| + e.e;
// what is left of o.d after rounding is at most |e||d| and changes it by 2|e| again. So the ends are those of h^2 to
// within E/d.d with E = 4|e| + e.e + 16 u, |e| <= ex + ey + ez, and h moves by at most E/(d.d h) while o.o < 1 - E;
// otherwise nothing is certainly inside, and there is no span.
// (The part of e along the line counts: it moves the ends of a line through the centre, too.)
template <class R, class M>
RAYMO_INLINE void sphere_spans(const LocalRay<R>& ray, LaneSpans<R, M, 1>& out) {
    const R oo = ray.ox * ray.ox + ray.oy * ray.oy + ray.oz * ray.oz;
    const R e = ray.ex + ray.ey + ray.ez;
    const R slack = R(4.0) * e + e * e + R(16.0 * kUnitRoundoff);
    const R room = R(1.0) - oo;  // h^2 d.d
    out.valid[0] = room > slack;
    out.degenerate = R(0.0) > R(1.0);
    out.enter_face[0] = R(0.0);
    out.exit_face[0] = R(0.0);
    out.enter[0] = out.exit[0] = out.enter_error[0] = out.exit_error[0] = R(0.0);
    // Where the ray is inside at all, h^2 d.d <= room + slack.
    out.touched = lane_and(lane_not(out.valid[0]), room > R(0.0) - slack);
    out.touch_lo = out.touch_hi = R(0.0);
    if (!lane_any(lane_or(out.valid[0], out.touched))) return;
    // h = room / sqrt(room d.d), and E/(d.d h) = E / sqrt(room d.d).
    const R some_room = lane_max(room, slack);
    const R inverse = R(1.0) / lane_sqrt(some_room * ray.dd);
    const R h = some_room * inverse;
    const R error = slack * inverse;
    out.touch_hi = R(1.5) * h;
    out.touch_lo = R(0.0) - out.touch_hi;
    out.enter[0] = R(0.0) - h;
    out.exit[0] = h;
    out.enter_error[0] = error;
    out.exit_error[0] = error;
}
