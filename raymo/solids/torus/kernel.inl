// Spans of the torus (q - a)^2 + z^2 <= b^2, q^2 = x^2 + y^2, for one ray or several (see
// math/lanes.hpp). Included once per instruction set.
//
// The equation is not squared. With s measured in lengths of d and o.d = 0, along the line
//     G(s) = (q - a)^2 + z^2 - b^2 = s^2 + |o|^2 + a^2 - b^2 - 2 a q(s),
//     G'(s) = 2 h(s),  h(s) = s - a q'(s).
// q(s) is a hyperbola: convex, least at c = -(ox dx + oy dy) / A, A = dx^2 + dy^2, with q' rising
// from -sqrt(A) to sqrt(A), convex before c and concave after. Reverse the line where needed so
// that c >= 0. Then, since h(c) = c >= 0,
//   before c  h is concave and rises from below: exactly one zero m, a minimum of G, in
//             [-a sqrt(A), 0];
//   after c   h is convex: no zero, or two of them, a maximum x of G and then a second minimum
//             n <= a sqrt(A). Newton's method from the right end falls monotonically onto n, or
//             finds h' <= 0 and there is none.
// Where G(m) < 0 and G(n) < 0 and G(x) > 0 there are two spans, and in every other case at most
// one. Each end lies in a bracket between such places, where G changes sign once, and is found by
// Newton's method kept inside the bracket. Spindles (b > a) need no special care: {G <= 0} is the
// filled solid, which the squared equation is not.
//
// Error. |grad G| = 2 sqrt(w), w = (q - a)^2 + z^2, so an error of at most e' = |e| + 8 u of the
// point (the line's, and the roundings of o + s d, of q, a and b) changes G by
//     E = 2 sqrt(w) e' + e'^2 <= (w / b + b) e' + e'^2,
// besides 4 u (w + b^2) of G's own. Signs count only where |G| > E. An end is certain to within r
// when G > E at r on its outer side and G < -E at r on its inner side; r starts at 3 E / |G'|, or
// sqrt(E) where that is less, and grows until both hold. It does so in the end, since the extrema
// to both sides were found to be certain. This covers contact of any order.
template <class R>
struct TorusLine {
    R ox, oy, oz;
    R dx, dy, dz;  // of unit length
    R spread;      // e'
    double a, b;
};

template <class R>
struct TorusValue {
    R g, slope;  // G, G'
    R error;     // E
};

template <class R>
inline TorusValue<R> torus_value(const TorusLine<R>& line, R s) {
    const R x = line.ox + s * line.dx;
    const R y = line.oy + s * line.dy;
    const R z = line.oz + s * line.dz;
    const R q = lane_max(lane_sqrt(x * x + y * y), R(0x1p-300));
    const R p = q - R(line.a);
    const R w = p * p + z * z;
    const R side = p * (x * line.dx + y * line.dy) / q + z * line.dz;
    TorusValue<R> v;
    v.g = w - R(line.b * line.b);
    v.slope = side + side;
    v.error = (w * R(1.0 / line.b) + R(line.b)) * line.spread + line.spread * line.spread +
              R(4.0 * kUnitRoundoff) * (w + R(line.b * line.b));
    return v;
}

// h and h' at s; `distance` is the distance of the line from the axis, `across` = A.
template <class R>
inline void torus_slope(const TorusLine<R>& line, R across, R distance, R s, R& h, R& dh) {
    const R x = line.ox + s * line.dx;
    const R y = line.oy + s * line.dy;
    const R q = lane_max(lane_sqrt(x * x + y * y), R(0x1p-300));
    const R inverse = R(1.0) / q;
    const R flatness = distance * inverse;
    h = s - R(line.a) * (x * line.dx + y * line.dy) * inverse;
    dh = R(1.0) - R(line.a) * across * flatness * flatness * inverse;
}

template <class R>
struct TorusEnd {
    R s;
    R reach;  // the true end is within this
};

// The only zero of G between `outer`, where G > E, and `inner`, where G < -E.
template <class R, class M>
inline TorusEnd<R> torus_end(const TorusLine<R>& line, R outer, R inner, R guess, M active) {
    const R half = R(0.5);
    const M all = active;
    R lo = lane_min(outer, inner);
    R hi = lane_max(outer, inner);
    const M rising = outer > inner;  // G rises towards larger s
    R s = lane_select(lane_and(guess > lo, guess < hi), guess, half * (lo + hi));
    R reach = R(2.0);
    for (int i = 0; i < 80; ++i) {
        const TorusValue<R> v = torus_value(line, s);
        const M low_side =
            lane_or(lane_and(rising, v.g < R(0.0)), lane_and(lane_not(rising), v.g > R(0.0)));
        lo = lane_select(lane_and(active, low_side), s, lo);
        hi = lane_select(lane_and(active, lane_not(low_side)), s, hi);
        const R newton = s - v.g / v.slope;
        const R next = lane_select(lane_and(newton > lo, newton < hi), newton, half * (lo + hi));
        // Newton's steps shrink quadratically: after one below 2^-42 there is nothing left to gain.
        const M moving = lane_abs(next - s) > R(0x1p-42);
        const R start = R(3.0) * v.error / lane_abs(v.slope) + R(4.0 * kUnitRoundoff);
        const R contact = lane_sqrt(v.error);  // the right order where the line touches
        reach = lane_select(active, lane_select(start < contact, start, contact), reach);
        s = lane_select(active, next, s);
        active = lane_and(active, moving);
        if (!lane_any(active)) break;
    }
    // Certain when the sign is on both sides; see the head of this file.
    const R outward = lane_select(rising, R(1.0), R(-1.0));
    const R out_room = lane_abs(outer - s);
    const R in_room = lane_abs(inner - s);
    active = all;
    for (int i = 0; i < 32; ++i) {
        const TorusValue<R> out = torus_value(line, s + outward * lane_min(reach, out_room));
        const TorusValue<R> in = torus_value(line, s - outward * lane_min(reach, in_room));
        const M certain = lane_and(out.g > out.error, in.g < R(0.0) - in.error);
        active = lane_and(active, lane_not(certain));
        if (!lane_any(active)) break;
        reach = lane_select(active, reach * R(4.0), reach);
    }
    return {s, reach};
}

template <class R, class M>
inline void torus_spans(double a, double b, const LocalRay<R>& ray, LaneSpans<R, M, 2>& out) {
    const R zero = R(0.0);
    const R far = R(1.25);  // beyond the solid, which lies in the unit ball
    const M never = zero > R(1.0);
    for (int i = 0; i < 2; ++i) {
        out.valid[i] = never;
        out.enter[i] = out.exit[i] = zero;
        out.enter_error[i] = out.exit_error[i] = zero;
        out.enter_face[i] = out.exit_face[i] = zero;
    }
    out.degenerate = out.touched = never;
    out.touch_lo = out.touch_hi = zero;

    // Unit ball and slab |z| <= b, both a little widened.
    const R length = lane_sqrt(ray.dd);
    const R unit = R(1.0) / length;
    const R oo = ray.ox * ray.ox + ray.oy * ray.oy + ray.oz * ray.oz;
    const R ee = lane_sqrt(ray.ex * ray.ex + ray.ey * ray.ey + ray.ez * ray.ez);
    const R chord = lane_sqrt(lane_max(R(1.0) - oo, zero)) + R(0x1p-20) + ee + ee;
    const M possible =
        lane_and(oo < R(1.0 + 0x1p-20) + ee * R(4.0),
                 lane_abs(ray.oz) < R(b) + chord * lane_abs(ray.dz * unit) + R(0x1p-20) + ee);
    if (!lane_any(possible)) return;

    TorusLine<R> line;
    line.ox = ray.ox;
    line.oy = ray.oy;
    line.oz = ray.oz;
    line.a = a;
    line.b = b;
    line.spread = ee + R(8.0 * kUnitRoundoff);
    // The line, of unit direction, tilted where it is (nearly) parallel to the axis, and reversed
    // where c < 0.
    const R across0 = (ray.dx * ray.dx + ray.dy * ray.dy) * unit * unit;
    const M upright = across0 < R(0x1p-200);
    const R dx = lane_select(upright, R(0x1p-100), ray.dx * unit);
    const R dy = lane_select(upright, zero, ray.dy * unit);
    const R along = ray.ox * dx + ray.oy * dy;
    const R turn = lane_select(along > zero, R(-1.0), R(1.0));
    line.dx = dx * turn;
    line.dy = dy * turn;
    line.dz = ray.dz * unit * turn;
    const R across = dx * dx + dy * dy;
    const R root = lane_sqrt(across);
    const R centre = lane_abs(along) / across;  // c
    const R distance = lane_abs(ray.ox * dy - ray.oy * dx) / root;
    const R end = R(a) * root;

    // m: Newton's method from the left, where h is concave, never passes the zero.
    R m = zero - end;
    M active = possible;
    for (int i = 0; i < 60; ++i) {
        R h, dh;
        torus_slope(line, across, distance, m, h, dh);
        const R step = h / dh;
        const M moving = lane_abs(step) > R(0x1p-20);
        m = lane_select(active, lane_min(lane_max(m - step, m), zero), m);
        active = lane_and(active, moving);
        if (!lane_any(active)) break;
    }
    // n: from the right, where h is convex.
    R n = end;
    M second = lane_and(possible, centre < end);
    active = second;
    if (lane_any(active)) {
        for (int i = 0; i < 60; ++i) {
            R h, dh;
            torus_slope(line, across, distance, n, h, dh);
            const R step = h / dh;
            const M lost = lane_not(lane_and(dh > zero, n > centre));
            second = lane_and(second, lane_not(lane_and(active, lost)));
            active = lane_and(active, lane_not(lost));
            const M moving = lane_abs(step) > R(0x1p-20);
            n = lane_select(active, lane_max(n - step, centre), n);
            active = lane_and(active, moving);
            if (!lane_any(active)) break;
        }
    }

    const TorusValue<R> at_m = torus_value(line, m);
    const TorusValue<R> at_n = torus_value(line, n);
    const M has_a = lane_and(possible, at_m.g < zero - at_m.error);
    const M has_b = lane_and(second, at_n.g < zero - at_n.error);
    const M met = lane_or(has_a, has_b);
    if (!lane_any(met)) return;

    // Between m and n there is a gap when G(x) > E. Mostly c, between m and x, lies in it already;
    // else x is found, where h falls from positive to negative between c and n.
    R x = centre;
    M gap = lane_and(met, second);
    if (lane_any(gap)) {
        TorusValue<R> at_x = torus_value(line, lane_select(second, x, zero));
        const M search = lane_and(gap, lane_not(at_x.g > at_x.error));
        if (lane_any(search)) {
            R lo = centre;
            R hi = n;
            x = lane_select(search, R(0.5) * (lo + hi), x);
            active = search;
            for (int i = 0; i < 60; ++i) {
                R h, dh;
                torus_slope(line, across, distance, x, h, dh);
                const M rises = h > zero;
                lo = lane_select(lane_and(active, rises), x, lo);
                hi = lane_select(lane_and(active, lane_not(rises)), x, hi);
                const R newton = x - h / dh;
                const R next =
                    lane_select(lane_and(newton > lo, newton < hi), newton, R(0.5) * (lo + hi));
                const M moving = lane_abs(next - x) > R(0x1p-20);
                x = lane_select(active, next, x);
                active = lane_and(active, moving);
                if (!lane_any(active)) break;
            }
            at_x = torus_value(line, lane_select(second, x, zero));
        }
        gap = lane_and(gap, at_x.g > at_x.error);
    }

    // Near a minimum G is close to a parabola; its zeros are where Newton's method starts.
    R h, bend_m, bend_n;
    torus_slope(line, across, distance, m, h, bend_m);
    torus_slope(line, across, distance, n, h, bend_n);
    const R half_m = lane_sqrt(lane_max((zero - at_m.g) / bend_m, zero));
    const R half_n = lane_sqrt(lane_max((zero - at_n.g) / bend_n, zero));

    // First span: from before m, or from before n when only that is inside.
    // Last span: to after n, or to after m when only that is inside. They are the same unless there
    // are two.
    const M two = lane_and(gap, lane_and(has_a, has_b));
    const R before = zero - far;
    const R first_inner = lane_select(has_a, m, n);
    const R first_outer = lane_select(lane_or(has_a, lane_not(gap)), before, x);
    const R first_guess = lane_select(has_a, m - half_m, n - half_n);
    const R last_inner = lane_select(has_b, n, m);
    const R last_outer = lane_select(lane_or(has_b, lane_not(gap)), far, x);
    const R last_guess = lane_select(has_b, n + half_n, m + half_m);
    const TorusEnd<R> enter = torus_end(line, first_outer, first_inner, first_guess, met);
    const TorusEnd<R> exit = torus_end(line, last_outer, last_inner, last_guess, met);
    TorusEnd<R> inner_exit = exit;
    TorusEnd<R> inner_enter = enter;
    if (lane_any(two)) {
        const TorusEnd<R> e0 = torus_end(line, x, m, m + half_m, two);
        const TorusEnd<R> e1 = torus_end(line, x, n, n - half_n, two);
        inner_exit.s = lane_select(two, e0.s, exit.s);
        inner_exit.reach = lane_select(two, e0.reach, exit.reach);
        inner_enter.s = lane_select(two, e1.s, enter.s);
        inner_enter.reach = lane_select(two, e1.reach, enter.reach);
    }

    // Back to the ray's own sense and parameter.
    const M reversed = turn < zero;
    const R scale = turn * unit;
    out.enter[0] = scale * lane_select(reversed, exit.s, enter.s);
    out.exit[0] = scale * lane_select(reversed, inner_enter.s, inner_exit.s);
    out.enter[1] = scale * lane_select(reversed, inner_exit.s, inner_enter.s);
    out.exit[1] = scale * lane_select(reversed, enter.s, exit.s);
    out.enter_error[0] = unit * lane_select(reversed, exit.reach, enter.reach);
    out.exit_error[0] = unit * lane_select(reversed, inner_enter.reach, inner_exit.reach);
    out.enter_error[1] = unit * lane_select(reversed, inner_exit.reach, inner_enter.reach);
    out.exit_error[1] = unit * lane_select(reversed, enter.reach, exit.reach);
    out.valid[0] =
        lane_and(met, out.exit[0] - out.enter[0] > out.enter_error[0] + out.exit_error[0]);
    out.valid[1] =
        lane_and(two, out.exit[1] - out.enter[1] > out.enter_error[1] + out.exit_error[1]);
}
