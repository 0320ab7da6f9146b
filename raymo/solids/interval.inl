// Intervals of a line with uncertain ends, for one ray or several (see math/lanes.hpp). Included
// once per instruction set, before the kernels that use it.
//
// A convex solid is an intersection of parts, each of which a line meets in one interval [lo, hi]
// whose ends are known to within an error. Of the intersection we keep, beside its most likely
// ends, the widest and the narrowest interval that the errors allow:
//     widest   = [ max(lo - error), min(hi + error) ],
//     narrowest = [ max(lo + error), min(hi - error) ].
// An end lies between the two, so a part that is met at a grazing angle widens the error of the
// whole only when it may really bound it.
template <class R>
struct Window {
    R enter, exit;             // most likely
    R enter_first, exit_last;  // widest
    R enter_last, exit_first;  // narrowest
    R enter_face, exit_face;
};

template <class R>
inline void open_window(Window<R>& w) {
    const R inf = R(std::numeric_limits<double>::infinity());
    w.enter = w.enter_first = w.enter_last = R(0.0) - inf;
    w.exit = w.exit_first = w.exit_last = inf;
    w.enter_face = w.exit_face = R(0.0);
}

template <class R>
inline void clip_enter(Window<R>& w, R s, R error, R face) {
    const auto later = s > w.enter;
    w.enter = lane_select(later, s, w.enter);
    w.enter_face = lane_select(later, face, w.enter_face);
    w.enter_first = lane_max(s - error, w.enter_first);
    w.enter_last = lane_max(s + error, w.enter_last);
}

template <class R>
inline void clip_exit(Window<R>& w, R s, R error, R face) {
    const auto sooner = s < w.exit;
    w.exit = lane_select(sooner, s, w.exit);
    w.exit_face = lane_select(sooner, face, w.exit_face);
    w.exit_first = lane_min(s - error, w.exit_first);
    w.exit_last = lane_min(s + error, w.exit_last);
}

// Clips to -1 <= o + s d <= 1, where o is known to within e; `length` is the length of the ray's
// direction. s = (+-1 - o) / d takes three roundings of a value of at most (1 + |o|) / |d|. A
// direction that is (nearly) parallel is tilted by 2^-400, which moves no point of the solid by
// more than that and keeps every number finite; the ray is then certainly inside, certainly
// outside, or uncertain, as the position alone decides.
template <class R>
inline void clip_slab(Window<R>& w, R o, R d, R e, R length, double face_below, double face_above) {
    const R tilt = lane_copysign(lane_max(lane_abs(d), length * R(0x1p-400)), d);
    const R inverse = R(1.0) / tilt;
    const R below = (R(-1.0) - o) * inverse;
    const R above = (R(1.0) - o) * inverse;
    const R error = (e + R(4.0 * kUnitRoundoff) * (R(1.0) + lane_abs(o))) * lane_abs(inverse);
    const auto rising = tilt > R(0.0);
    clip_enter(w, lane_min(below, above), error, lane_select(rising, R(face_below), R(face_above)));
    clip_exit(w, lane_max(below, above), error, lane_select(rising, R(face_above), R(face_below)));
}

// The window as span number `i`, for lanes where the solid may be met at all. An end is degenerate
// when it is uncertain by more than kDegenerate and this comes from the small angle at which the
// surface is met, not from the ray's own error.
template <class R, class M, int N>
inline void close_window(const Window<R>& w, const LocalRay<R>& ray, R length, M possible, int i,
                         LaneSpans<R, M, N>& out) {
    const R enter_error = lane_max(w.enter_last - w.enter, w.enter - w.enter_first);
    const R exit_error = lane_max(w.exit - w.exit_first, w.exit_last - w.exit);
    const R limit = (R(kDegenerate) + R(1024.0) * (ray.ex + ray.ey + ray.ez)) / length;
    const M met = lane_and(possible, w.enter_first <= w.exit_last);
    out.valid[i] = lane_and(possible, w.exit - w.enter > enter_error + exit_error);
    out.touched = lane_and(met, lane_not(out.valid[i]));
    out.touch_lo = w.enter_first;
    out.touch_hi = w.exit_last;
    out.degenerate = lane_and(met, lane_or(enter_error > limit, exit_error > limit));
    out.enter[i] = w.enter;
    out.exit[i] = w.exit;
    out.enter_error[i] = enter_error;
    out.exit_error[i] = exit_error;
    out.enter_face[i] = w.enter_face;
    out.exit_face[i] = w.exit_face;
}
