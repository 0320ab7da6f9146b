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
RAYMO_INLINE void open_window(Window<R>& w) {
    const R inf = R(std::numeric_limits<double>::infinity());
    w.enter = w.enter_first = w.enter_last = R(0.0) - inf;
    w.exit = w.exit_first = w.exit_last = inf;
    w.enter_face = w.exit_face = R(0.0);
}

template <class R>
RAYMO_INLINE void clip_enter(Window<R>& w, R s, R error, R face) {
    const auto later = s > w.enter;
    w.enter = lane_select(later, s, w.enter);
    w.enter_face = lane_select(later, face, w.enter_face);
    w.enter_first = lane_max(s - error, w.enter_first);
    w.enter_last = lane_max(s + error, w.enter_last);
}

template <class R>
RAYMO_INLINE void clip_exit(Window<R>& w, R s, R error, R face) {
    const auto sooner = s < w.exit;
    w.exit = lane_select(sooner, s, w.exit);
    w.exit_face = lane_select(sooner, face, w.exit_face);
    w.exit_first = lane_min(s - error, w.exit_first);
    w.exit_last = lane_min(s + error, w.exit_last);
}

// Clips to -1 <= o + s d <= 1, where o is known to within e. With i = 1 / d,
//     s = -|i| - o i  where it enters,  s = |i| - o i  where it leaves,
// each with four roundings of at most (1 + |o|) |i|. `least` is 2^-400 of the size of the ray's direction: a direction that
// is (nearly) parallel is tilted by as much, which moves no point of the solid by more than that and keeps every number
// finite; the ray is then certainly inside, certainly outside, or uncertain, as the position alone decides.
template <class R>
RAYMO_INLINE void clip_slab(Window<R>& w, R o, R d, R e, R least, double face_below,
                            double face_above) {
    const R inverse = R(1.0) / lane_copysign(lane_max(lane_abs(d), least), d);
    const R half = lane_abs(inverse);
    const R middle = R(0.0) - o * inverse;
    const R error = (e + R(4.0 * kUnitRoundoff) * (R(1.0) + lane_abs(o))) * half;
    const auto rising = inverse > R(0.0);
    const R first = lane_select(rising, R(face_below), R(face_above));
    clip_enter(w, middle - half, error, first);
    clip_exit(w, middle + half, error, R(face_below + face_above) - first);
}

// 2^-400 of the size of the ray's direction, for clip_slab.
template <class R>
RAYMO_INLINE R least_direction(const LocalRay<R>& ray) {
    return (lane_abs(ray.dx) + lane_abs(ray.dy) + lane_abs(ray.dz)) * R(0x1p-400);
}

// The window as span number `i`, for lanes where the solid may be met at all. An end is degenerate
// when it is uncertain by more than kDegenerate, in lengths, and this comes from the small angle at which the
// surface is met, not from the ray's own error.
template <class R, class M, int N>
RAYMO_INLINE void close_window(const Window<R>& w, const LocalRay<R>& ray, M possible, int i,
                               LaneSpans<R, M, N>& out) {
    const R enter_error = lane_max(w.enter_last - w.enter, w.enter - w.enter_first);
    const R exit_error = lane_max(w.exit - w.exit_first, w.exit_last - w.exit);
    const R limit = R(kDegenerate) + R(1024.0) * (ray.ex + ray.ey + ray.ez);
    const R worst = lane_max(enter_error, exit_error);
    const M met = lane_and(possible, w.enter_first <= w.exit_last);
    out.valid[i] = lane_and(possible, w.exit - w.enter > enter_error + exit_error);
    out.touched = lane_and(met, lane_not(out.valid[i]));
    out.touch_lo = w.enter_first;
    out.touch_hi = w.exit_last;
    out.degenerate = lane_and(met, worst * worst * ray.dd > limit * limit);
    out.enter[i] = w.enter;
    out.exit[i] = w.exit;
    out.enter_error[i] = enter_error;
    out.exit_error[i] = exit_error;
    out.enter_face[i] = w.enter_face;
    out.exit_face[i] = w.exit_face;
}
