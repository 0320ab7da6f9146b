// Spans of the half-space z <= 0, for one ray or several (see math/lanes.hpp). Included once per
// instruction set.
//
// The line meets the plane at s = -oz / dz. The solid has no size, so the crossing may lie anywhere
// on the line: the error of the line, which holds for |s| |d| <= 1, grows in proportion beyond.
// With it,  error = (1 + |s| |d|) ez / |dz|  and two roundings of s. A line that is parallel to
// within its error is inside altogether or outside altogether, unless it lies so near the plane
// that it may cross within `reach` of the leaf's origin: then it is degenerate, and so is a line
// that crosses there at so small an angle that the crossing is uncertain by more than kDegenerate
// of its distance. Those who look at a model as a whole choose a frame of its size, near it (see
// trace/frames.hpp), so that what happens farther away is of no interest.
template <class R, class M>
RAYMO_INLINE void halfspace_spans(const LocalRay<R>& ray, LaneSpans<R, M, 1>& out) {
    const R inf = R(std::numeric_limits<double>::infinity());
    const R reach = R(8.0);
    const R length = lane_sqrt(ray.dd);
    const R slack = ray.ez + R(2.0 * kUnitRoundoff) * lane_abs(ray.oz);
    const R sine = lane_abs(ray.dz) / length;
    const M parallel = lane_not(sine > slack);
    const R dz = lane_select(parallel, length, ray.dz);
    const R s = R(0.0) - ray.oz / dz;
    const R error = (R(1.0) + lane_abs(s) * length) * ray.ez / lane_abs(dz) +
                    R(2.0 * kUnitRoundoff) * lane_abs(s);
    const M rising = dz > R(0.0);
    const M all = lane_and(parallel, ray.oz <= R(0.0));
    const M none = lane_and(parallel, ray.oz > R(0.0));
    const M near = lane_abs(ray.oz) <= reach * (sine + slack);
    const M uncertain = ray.ez > sine * (R(kDegenerate) + R(1024.0) * ray.ez);
    const M from_infinity = lane_or(all, rising);
    const M to_infinity = lane_or(all, lane_not(rising));
    out.valid[0] = lane_not(none);
    out.touched = R(0.0) > R(1.0);
    out.touch_lo = out.touch_hi = R(0.0);
    out.degenerate = lane_and(near, lane_or(parallel, uncertain));
    out.enter[0] = lane_select(from_infinity, R(0.0) - inf, s);
    out.exit[0] = lane_select(to_infinity, inf, s);
    out.enter_error[0] = lane_select(from_infinity, R(0.0), error);
    out.exit_error[0] = lane_select(to_infinity, R(0.0), error);
    out.enter_face[0] = R(0.0);
    out.exit_face[0] = R(0.0);
}

// The normal, in the place of a point of the plane.
template <class R>
RAYMO_INLINE void halfspace_normal(R& x, R& y, R& z) {
    x = y = R(0.0);
    z = R(1.0);
}
