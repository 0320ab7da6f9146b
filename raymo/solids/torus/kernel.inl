// Spans of the torus (q - a)^2 + z^2 <= b^2, q^2 = x^2 + y^2, for one ray or several (see
// math/lanes.hpp). Included once per instruction set.
//
// The equation is not squared. With s measured in lengths of d and o.d = 0, along the line
//     G(s) = (q - a)^2 + z^2 - b^2 = s^2 + k - 2 a q(s),  k = |o|^2 + a^2 - b^2,
//     G'(s) = 2 h(s),  h(s) = s - a q'(s),  h'(s) = 1 - a A D^2 / q^3.
// q^2 = A (s - c)^2 + D^2 with A = dx^2 + dy^2: q(s) is a hyperbola, convex, least at
// c = -(ox dx + oy dy) / A = oz dz / A, where the line is at the distance D from the axis, with q'
// rising from -sqrt(A) to sqrt(A), convex before c and concave after. Reverse the line where needed
// so that c >= 0. Then, since h(c) = c,
//   before c  h is concave and rises from below: exactly one zero m, a minimum of G, in
//             [-a sqrt(A), 0];
//   after c   h is convex: no zero, or two of them, a maximum x of G and then a second minimum
//             n <= a sqrt(A).
// G falls before m, rises to x, falls to n and rises again: each part holds at most one end of a
// span. For s > 0, q(-s) >= q(s) and so G(-s) <= G(s): G(m) is the least of all. The line misses
// where G(m) > 0; else the first span holds m. Spindles (b > a) need no special care: {G <= 0} is
// the filled solid, which the squared equation is not.
//
// Error. |grad G| = 2 sqrt(w), w = (q - a)^2 + z^2, so an error of at most e' = |e| + 8 u of the
// point (the line's, and the roundings of o + s d, of q, a and b) changes G by
//     E = 2 sqrt(w) e' + e'^2 <= (w / b + b) e' + e'^2,
// besides 4 u (w + b^2) of G's own. Signs count only where |G| > E. An end is certain to within r
// when G > E at r on its outer side and G < -E at r on its inner side.
// The sign of c is taken from oz dz for flat lines and from ox dx + oy dy for steep ones: where
// what is left of o.d makes it wrong, |c| is no more than some u dz^2 / A or u / sqrt(A), and
// G(s) - G(-s), about 4 s c at the minima, stays within E: in the solid |s dz| <= b + |oz|, and q
// is about a A at the minima, so those of steep lines are in the solid only when b is not small.
//
// Nearly all lines are done directly, with few evaluations of G. What is not certain then is left
// to a search for all extrema, at the end of this file.
//
// m. With c = 0 it is -sqrt(a^2 A - D^2 / A), or 0 where that is not real, and c > 0 moves it to
// the left. So that is a start at m's right, from where Newton's method on the concave h steps to
// m's left, and then rises to m. It ends as soon as G < -E, as any place inside will do, or when
// the line misses: h' falls towards c, so with its value h0' > 0 at the start, at every place met
//     G(m) >= G - h^2 / h0'.
// D is taken 16 u too large, so that roundings never make h' larger. Those of h are at most
// 8 u (1 + 1 / q) = f, and (|h| + f)^2 <= 17/16 h^2 + 17 f^2.
//
// First span. Its ends begin at the zeros of the parabola through G, h, h' at the place inside.
// Then they follow such parabolas: with t = G / 2h and z = h' t / 2h, by the step
//     -t (1 + z + 2 z^2),
// which is of third order. Where the slope is wrong or there is no zero ahead, and where a step
// leads too far, the end begins again from outside, where the line meets the unit ball.
//
// Certainty. Let such a step lead from s to s1, let M = 1 + 2 (1 - h'), and let
//     16 M (|t| + r) < |h|,  20 (|t| + r) < q.
// |z| < 1/32, so up to r from s1 we are within 1.1 (|t| + r) of s. There q changes by less than 6%,
// and, with room for the roundings of q > 80 u,
//     |h'| <= M,  |h''| = 3 (1 - h') |q'| / q <= 2.3 M / q.
// G(s1) is at most what the series leaves, 2 |h t| 5.2 |z|^3, and what h'' adds,
// 2.3 M / q |1.04 t|^3 / 3, and so
//     |G(s1)| <= |t|^3 M (3 / q + M / |2h|) = F.
// |G'| is at least 1.87 |h| at s1, and |G''| at most 2 M. Let r = 3 (E + F) / |2h| + 4 u. At r
// from s1 then
//     |G| >= 1.87 |h| r - M r^2 - F >= 1.8 |h| r - F >= 2.7 E + F / 2,
// more than E there (|h| <= sqrt(w), so w grows by less than 15%), the roundings of G at s, less
// than E, and those of t and h, less than E / 4, together. 4 u are for s1's own rounding. The end
// is taken when F < E / 8. Its slope tells which part of G it is in: the first end falls, and lies
// before a place <= 0 that is inside; the second rises, and lies after it, as the first to rise or
// as the last, which is seen next.
//
// Second span. The squared equation G (G + 4 a q) = (s^2 + k)^2 - 4 a^2 q^2 is
//     s^4 + p s^2 + ..., p = 2 k - 4 a^2 A.
// Divided by the two ends, s0 and s1, it leaves a parabola, which has the zeros
//     -(s0 + s1) / 2 -+ sqrt(R),  R = s0 s1 - p - 3/4 (s0 + s1)^2.
// The errors r0, r1 of the ends, both more than 3 e', and that of the line change R by less than
// 64 (r0 + r1) = H.
//   R < -H  There are no more ends.
//   R > H, both zeros lie between s0 and s1, and G < -E midway
//           The squared equation is positive there, so these are zeros of G + 4 a q, inside a
//           spindle, and there are no more ends.
//   R > H else
//           The ends of a second span begin at these zeros, to be made certain as above. With them
//           all four zeros are known, and s1 is the first that rises when they lie after it.
template <class R>
struct TorusLine {
    R ox, oy, oz;
    R dx, dy, dz;  // of unit length
    R across;      // A
    R centre;      // c
    R distance;    // D, rather too large
    R furthest;    // a sqrt(A): all extrema lie within
    R chord;       // the solid lies within
    R p;           // of the squared equation
    R spread;      // e'
    double a, b;
};

template <class R>
struct TorusPlace {
    R q, inverse;  // 1 / q
    R w;
    R g, h;  // G, G' / 2
    R bend;  // h', rather too small
};

template <class R>
RAYMO_INLINE TorusPlace<R> torus_place(const TorusLine<R>& line, R s) {
    const R x = line.ox + s * line.dx;
    const R y = line.oy + s * line.dy;
    const R z = line.oz + s * line.dz;
    TorusPlace<R> v;
    v.q = lane_max(lane_sqrt(x * x + y * y), R(0x1p-300));
    v.inverse = R(1.0) / v.q;
    const R p = v.q - R(line.a);
    const R flatness = line.distance * v.inverse;
    v.w = p * p + z * z;
    v.g = v.w - R(line.b * line.b);
    v.h = p * ((x * line.dx + y * line.dy) * v.inverse) + z * line.dz;
    v.bend = R(1.0) - R(line.a) * line.across * (flatness * flatness) * v.inverse;
    return v;
}

// E
template <class R>
RAYMO_INLINE R torus_error(const TorusLine<R>& line, R w) {
    return (w * R(1.0 / line.b) + R(line.b)) * line.spread + line.spread * line.spread +
           R(4.0 * kUnitRoundoff) * (w + R(line.b * line.b));
}

template <class R>
struct TorusEnd {
    R s;
    R reach;  // the true end is within this
};

// Ends along the line; the inner two belong to the gap, where there are two spans.
template <class R>
struct TorusEnds {
    TorusEnd<R> enter, inner_exit, inner_enter, exit;
};

template <class R, class M>
RAYMO_INLINE TorusEnd<R> torus_choose(M mask, TorusEnd<R> yes, TorusEnd<R> no) {
    return {lane_select(mask, yes.s, no.s), lane_select(mask, yes.reach, no.reach)};
}

// One step towards an end where G falls (sense -1) or rises (+1), from `limit` where it has gone
// astray. Ends that are certain are taken from `active`.
template <class R, class M>
RAYMO_INLINE void torus_approach(const TorusLine<R>& line, R sense, R limit, M& active,
                                 TorusEnd<R>& end) {
    const TorusPlace<R> v = torus_place(line, end.s);
    const R slope = sense * v.h;
    const R inverse = R(0.5) / v.h;
    const R newton = v.g * inverse;  // t
    const R size = lane_abs(newton);
    const R turn = lane_max(lane_min(v.bend * newton * inverse, R(0.25)), R(-0.25));  // z
    const R next = end.s - (newton + newton * turn * (R(1.0) + turn + turn));

    const R most = R(3.0) - R(2.0) * v.bend;  // M
    const R error = torus_error(line, v.w);
    const R left =
        size * size * size * most * (R(3.0) * v.inverse + most * lane_abs(inverse));  // F
    const R reach = R(3.0) * (error + left) * lane_abs(inverse) + R(4.0 * kUnitRoundoff);
    const R around = size + reach;
    const M near = lane_and(R(16.0) * most * around < slope, R(20.0) * around < v.q);
    const M certain = lane_and(near, R(8.0) * left < error);

    const M within = sense * (limit - next) > R(0.0);
    const M ahead = lane_or(v.bend > R(0.0), turn < R(0.25));
    const M hopeful = lane_or(certain, lane_and(slope > R(0.0), lane_and(within, ahead)));
    end.s = lane_select(active, lane_select(hopeful, next, limit), end.s);
    end.reach = lane_select(active, reach, end.reach);
    active = lane_and(active, lane_not(certain));
}

// The ends of a span that begins after `limit`, improved. Returns for which lines they are certain.
template <class R, class M>
RAYMO_INLINE M torus_span(const TorusLine<R>& line, M asked, R limit, TorusEnd<R>& enter,
                          TorusEnd<R>& exit) {
    M falling = asked;
    M rising = asked;
    for (int i = 0; i < 8; ++i) {
        torus_approach(line, R(-1.0), limit, falling, enter);
        torus_approach(line, R(1.0), line.chord, rising, exit);
        if (!lane_any(lane_or(falling, rising))) break;
    }
    return lane_and(lane_and(asked, lane_not(lane_or(falling, rising))),
                    enter.s + enter.reach < exit.s - exit.reach);
}

// The ends of lines that are plain. Returns which lines meet the solid, and in `two` which twice;
// these, and those that miss, are taken from `open`.
template <class R, class M>
RAYMO_INLINE M torus_direct(const TorusLine<R>& line, M& open, TorusEnds<R>& ends, M& two) {
    const R zero = R(0.0);
    const M never = zero > R(1.0);
    two = never;

    // m, begun a little to the right of where it is without c, so that h >= 0.
    const R inward = line.furthest * line.furthest - line.distance * line.distance / line.across;
    R s = zero - lane_sqrt(lane_max(inward, zero)) * R(1.0 - 0x1p-20);
    R least_bend = zero;                                        // 15/16 h0'
    R at_s = zero, at_g = zero, at_h = zero, at_bend = R(1.0);  // at the place inside
    M met = never;
    M active = open;
    for (int i = 0; i < 8; ++i) {
        const TorusPlace<R> v = torus_place(line, s);
        if (i == 0) {
            least_bend = lane_select(v.h < zero, zero, R(0.9375) * lane_max(v.bend, zero));
        }
        const R blur = R(0x1p-47) + R(0x1p-47) * v.inverse;  // more than sqrt(17) f
        const M inside = lane_and(active, v.g < zero - torus_error(line, v.w));
        const M missed = lane_and(active, v.g * least_bend > v.h * v.h + blur * blur);
        at_s = lane_select(inside, s, at_s);
        at_g = lane_select(inside, v.g, at_g);
        at_h = lane_select(inside, v.h, at_h);
        at_bend = lane_select(inside, v.bend, at_bend);
        met = lane_or(met, inside);
        open = lane_and(open, lane_not(missed));
        active = lane_and(active, lane_not(lane_or(inside, missed)));
        if (!lane_any(active)) break;
        s = lane_select(active, lane_min(s - v.h / v.bend, zero), s);
    }
    met = lane_and(met, at_bend > zero);
    if (!lane_any(met)) return met;

    const R inverse = R(1.0) / at_bend;
    const R top = at_s - at_h * inverse;
    const R half = lane_sqrt(lane_max(at_h * at_h - at_g * at_bend, zero)) * inverse;
    TorusEnd<R> enter = {lane_max(top - half, zero - line.chord), zero};
    TorusEnd<R> exit = {lane_min(top + half, line.chord), zero};
    met = torus_span(line, met, zero - line.chord, enter, exit);
    met = lane_and(met, lane_and(enter.s < at_s, at_s < exit.s));
    ends = {enter, exit, enter, exit};

    const R middle = R(-0.5) * (enter.s + exit.s);
    const R room = enter.s * exit.s - line.p - R(3.0) * middle * middle;  // R
    const R doubt = R(64.0) * (enter.reach + exit.reach);                 // H
    M more = lane_and(met, lane_not(room < zero - doubt));
    if (lane_any(more)) {
        const R spread = lane_sqrt(lane_max(room, zero));
        TorusEnd<R> low = {middle - spread, zero};
        TorusEnd<R> high = {middle + spread, zero};
        M sure = lane_and(more, room > doubt);
        const M within = lane_and(sure, lane_and(low.s > enter.s, high.s < exit.s));
        sure = lane_and(sure, lane_not(within));
        if (lane_any(within)) {
            const TorusPlace<R> v = torus_place(line, middle);
            const M filled = lane_and(within, v.g < zero - torus_error(line, v.w));
            more = lane_and(more, lane_not(filled));
        }
        if (lane_any(sure)) {
            two = torus_span(line, sure, exit.s, low, high);
            two = lane_and(two, low.s - low.reach > exit.s + exit.reach);
            more = lane_and(more, lane_not(two));
            ends.inner_enter = torus_choose(two, low, ends.inner_enter);
            ends.exit = torus_choose(two, high, ends.exit);
        }
        met = lane_and(met, lane_not(more));
    }
    open = lane_and(open, lane_not(met));
    return met;
}

// The only zero of G between `outer`, where G > E, and `inner`, where G < -E.
template <class R, class M>
RAYMO_INLINE TorusEnd<R> torus_end(const TorusLine<R>& line, R outer, R inner, R guess, M active) {
    const R half = R(0.5);
    const M all = active;
    R lo = lane_min(outer, inner);
    R hi = lane_max(outer, inner);
    const M rising = outer > inner;  // G rises towards larger s
    R s = lane_select(lane_and(guess > lo, guess < hi), guess, half * (lo + hi));
    R reach = R(2.0);
    for (int i = 0; i < 80; ++i) {
        const TorusPlace<R> v = torus_place(line, s);
        const M low_side =
            lane_or(lane_and(rising, v.g < R(0.0)), lane_and(lane_not(rising), v.g > R(0.0)));
        lo = lane_select(lane_and(active, low_side), s, lo);
        hi = lane_select(lane_and(active, lane_not(low_side)), s, hi);
        const R slope = v.h + v.h;
        const R newton = s - v.g / slope;
        const R next = lane_select(lane_and(newton > lo, newton < hi), newton, half * (lo + hi));
        // Newton's steps shrink quadratically: after one below 2^-42 there is nothing left to gain.
        const M moving = lane_abs(next - s) > R(0x1p-42);
        const R error = torus_error(line, v.w);
        const R start = R(3.0) * error / lane_abs(slope) + R(4.0 * kUnitRoundoff);
        const R contact = lane_sqrt(error);  // the right order where the line touches
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
    for (int i = 0; i < 60; ++i) {
        const TorusPlace<R> out = torus_place(line, s + outward * lane_min(reach, out_room));
        const TorusPlace<R> in = torus_place(line, s - outward * lane_min(reach, in_room));
        const M certain =
            lane_and(out.g > torus_error(line, out.w), in.g < R(0.0) - torus_error(line, in.w));
        active = lane_and(active, lane_not(certain));
        if (!lane_any(active)) break;
        reach = lane_select(active, reach + reach, reach);
    }
    return {s, reach};
}

// The ends by way of all extrema. Returns which lines meet the solid; `two`: twice.
template <class R, class M>
RAYMO_INLINE M torus_search(const TorusLine<R>& line, M asked, TorusEnds<R>& ends, M& two) {
    const R zero = R(0.0);
    const R far = R(1.25);  // beyond the solid, which lies in the unit ball
    const R centre = line.centre;
    two = zero > R(1.0);

    // m: Newton's method from the left, where h is concave, never passes the zero.
    R m = zero - line.furthest;
    M active = asked;
    TorusPlace<R> at_m;
    for (int i = 0; i < 60; ++i) {
        at_m = torus_place(line, m);
        const R step = at_m.h / at_m.bend;
        const M moving = lane_abs(step) > R(0x1p-20);
        m = lane_select(active, lane_min(lane_max(m - step, m), zero), m);
        active = lane_and(active, moving);
        if (!lane_any(active)) break;
    }
    at_m = torus_place(line, m);
    const M met = lane_and(asked, at_m.g < zero - torus_error(line, at_m.w));
    if (!lane_any(met)) return met;

    // n: from the right, where h is convex.
    R n = line.furthest;
    M second = lane_and(met, centre < line.furthest);
    active = second;
    if (lane_any(active)) {
        for (int i = 0; i < 60; ++i) {
            const TorusPlace<R> v = torus_place(line, n);
            const R step = v.h / v.bend;
            const M lost = lane_not(lane_and(v.bend > zero, n > centre));
            second = lane_and(second, lane_not(lane_and(active, lost)));
            active = lane_and(active, lane_not(lost));
            const M moving = lane_abs(step) > R(0x1p-20);
            n = lane_select(active, lane_max(n - step, centre), n);
            active = lane_and(active, moving);
            if (!lane_any(active)) break;
        }
    }
    const TorusPlace<R> at_n = torus_place(line, n);
    const M again = lane_and(second, at_n.g < zero - torus_error(line, at_n.w));

    // Between m and n there is a gap when G(x) > E. Mostly c, between m and x, lies in it already;
    // else x is found, where h falls from positive to negative between c and n.
    R x = centre;
    M gap = second;
    if (lane_any(gap)) {
        TorusPlace<R> at_x = torus_place(line, lane_select(gap, x, zero));
        const M search = lane_and(gap, lane_not(at_x.g > torus_error(line, at_x.w)));
        if (lane_any(search)) {
            R lo = centre;
            R hi = n;
            x = lane_select(search, R(0.5) * (lo + hi), x);
            active = search;
            for (int i = 0; i < 60; ++i) {
                const TorusPlace<R> v = torus_place(line, x);
                const M rises = v.h > zero;
                lo = lane_select(lane_and(active, rises), x, lo);
                hi = lane_select(lane_and(active, lane_not(rises)), x, hi);
                const R newton = x - v.h / v.bend;
                const R next =
                    lane_select(lane_and(newton > lo, newton < hi), newton, R(0.5) * (lo + hi));
                const M moving = lane_abs(next - x) > R(0x1p-20);
                x = lane_select(active, next, x);
                active = lane_and(active, moving);
                if (!lane_any(active)) break;
            }
            at_x = torus_place(line, lane_select(gap, x, zero));
        }
        gap = lane_and(gap, at_x.g > torus_error(line, at_x.w));
    }
    two = lane_and(gap, again);

    // Near a minimum G is close to a parabola; its zeros are where Newton's method starts.
    const R half_m = lane_sqrt(lane_max((zero - at_m.g) / at_m.bend, zero));
    const R half_n = lane_sqrt(lane_max((zero - at_n.g) / at_n.bend, zero));
    ends.enter = torus_end(line, zero - far, m, m - half_m, met);
    const R last = lane_select(again, n, m);
    const R beyond = lane_select(lane_or(again, lane_not(gap)), far, x);
    ends.exit = torus_end(line, beyond, last, last + lane_select(again, half_n, half_m), met);
    ends.inner_exit = ends.exit;
    ends.inner_enter = ends.enter;
    if (lane_any(two)) {
        ends.inner_exit =
            torus_choose(two, torus_end(line, x, m, m + half_m, two), ends.inner_exit);
        ends.inner_enter =
            torus_choose(two, torus_end(line, x, n, n - half_n, two), ends.inner_enter);
    }
    return met;
}

template <class R, class M>
RAYMO_INLINE void torus_spans(double a, double b, const LocalRay<R>& ray, LaneSpans<R, M, 2>& out) {
    const R zero = R(0.0);
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
    TorusLine<R> line;
    line.chord = lane_sqrt(lane_max(R(1.0) - oo, zero)) + R(0x1p-20) + ee + ee;
    const M possible =
        lane_and(oo < R(1.0 + 0x1p-20) + ee * R(4.0),
                 lane_abs(ray.oz) < R(b) + line.chord * lane_abs(ray.dz * unit) + R(0x1p-20) + ee);
    if (!lane_any(possible)) return;

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
    const R along =
        lane_select(across0 > R(0.5), zero - ray.oz * (ray.dz * unit), ray.ox * dx + ray.oy * dy);
    const R turn = lane_select(along > zero, R(-1.0), R(1.0));
    line.dx = dx * turn;
    line.dy = dy * turn;
    line.dz = ray.dz * unit * turn;
    line.across = dx * dx + dy * dy;
    const R root = lane_sqrt(line.across);
    line.centre = lane_abs(along) / line.across;
    line.distance = lane_abs(ray.ox * dy - ray.oy * dx) / root + R(16.0 * kUnitRoundoff);
    line.furthest = R(a) * root;
    line.p = R(2.0) * (oo + R(a * a - b * b)) - R(4.0 * a * a) * line.across;

    const TorusEnd<R> none = {zero, zero};
    TorusEnds<R> ends = {none, none, none, none};
    M two;
    M open = possible;
    M met = torus_direct(line, open, ends, two);
    if (lane_any(open)) {
        TorusEnds<R> found = ends;
        M again;
        const M hard = torus_search(line, open, found, again);
        ends.enter = torus_choose(open, found.enter, ends.enter);
        ends.inner_exit = torus_choose(open, found.inner_exit, ends.inner_exit);
        ends.inner_enter = torus_choose(open, found.inner_enter, ends.inner_enter);
        ends.exit = torus_choose(open, found.exit, ends.exit);
        met = lane_or(met, hard);
        two = lane_or(two, again);
    }
    if (!lane_any(met)) return;

    // Back to the ray's own sense and parameter.
    const M reversed = turn < zero;
    const R scale = turn * unit;
    const auto place = [&](const TorusEnd<R>& forth, const TorusEnd<R>& back, R& s, R& error) {
        const TorusEnd<R> end = torus_choose(reversed, back, forth);
        s = scale * end.s;
        error = unit * end.reach;
    };
    place(ends.enter, ends.exit, out.enter[0], out.enter_error[0]);
    place(ends.inner_exit, ends.inner_enter, out.exit[0], out.exit_error[0]);
    place(ends.inner_enter, ends.inner_exit, out.enter[1], out.enter_error[1]);
    place(ends.exit, ends.enter, out.exit[1], out.exit_error[1]);
    out.valid[0] =
        lane_and(met, out.exit[0] - out.enter[0] > out.enter_error[0] + out.exit_error[0]);
    out.valid[1] =
        lane_and(two, out.exit[1] - out.enter[1] > out.enter_error[1] + out.exit_error[1]);
}
