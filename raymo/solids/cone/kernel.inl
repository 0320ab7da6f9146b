// Spans of the cone frustum x^2 + y^2 <= q(z)^2, |z| <= 1, with radius q(z) = m - g z; for one ray
// or several (see math/lanes.hpp). Included once per instruction set, after solids/interval.inl.
//
// k is the radius at z = 1, so m = (1 + k) / 2, g = (1 - k) / 2. Along the line
//     f(s) = x^2 + y^2 - q^2 = A s^2 + 2 B s + C,
//     A = dx^2 + dy^2 - g^2 dz^2,  B = ox dx + oy dy + g dz q0,  C = ox^2 + oy^2 - q0^2,
//     q0 = m - g oz.
//   A > 0  the line is flatter than the cone's generators: it is inside one of the two nappes
//          between the roots.
//   A < 0  it is steeper: inside the one nappe before the first root, inside the other after the
//          second. Ours, q > 0, is the first when the line rises.
// The slab |z| <= 1 cuts off the other nappe. The roots are r1 = Q / A, r2 = C / Q with
//     Q = -(B + sign(B) sqrt(B^2 - A C)):
// no cancellation, and A near 0 (parallel to a generator) sends r1 to infinity.
//
// Error. Within the solid |x|, |y|, q <= 1 and |s| |d| <= sqrt(2). An error e of the line changes f
// by at most 2 (ex + ey + g ez) and squares; eight roundings of the coefficients, of k and of the
// root formula count as at most
//     8 u (d.d s^2 + 2 |B| s + |o|^2 + q0^2) <= 8 u (4 + 2 |o|^2 + 2 q0^2).
// Together E; roots of f +- E differ from those of f by at most E / sqrt(max(D, |A| E)),
// D = B^2 - A C. With A > 0 and D + A E < 0 there is no root.
//
// Near the apex, where D is small though B and C are not, that is far too much. There Lagrange's identity tells D without
// cancellation: with p = g w x d for the line's place w from the apex and its direction d,
//     D = px^2 + py^2 - (pz / g)^2,  px = oy dq + q0 dy,  py = -(ox dq + q0 dx),  pz / g = ox dy - oy dx,
// where dq = g dz. In what follows e and |d| are the sums of their components' sizes. The line's error moves o by e and d by at most
// 1.2 e |d|, and |o|, q0 < 1.5 wherever the solid is met, so with roundings each of px, py, pz / g and B is off by at most h |d|, A
// by h |d|^2 and C by h, where h = 6 (e + e^2) + 8 u (2 + |o|^2). Then
//     D by G = 2 (|px| + |py| + |pz / g|) h |d| + 3 h^2 |d|^2,  sqrt(D) by G / sqrt(D),
//     r1 by (h |d| + G / sqrt(D) + |r1| h |d|^2) / |A|,  r2 by (h + |r2| (h |d| + G / sqrt(D))) / |Q|,
// and r2 = (sign(B) sqrt(D) - B) / A by as much as r1 is.
// Next to a generator it is the other way about: A and B vanish there, but p does not. So D is told by p only where G < |A| E,
// less than what an error of E in f makes of it: then E and its bound hold as well, and of the bounds the best one counts.
template <class R, class M>
RAYMO_INLINE void cone_spans(double k, const LocalRay<R>& ray, LaneSpans<R, M, 1>& out) {
    const R zero = R(0.0);
    const R inf = R(std::numeric_limits<double>::infinity());
    const R m = R(0.5 * (1.0 + k));
    const R g = R(0.5 * (1.0 - k));
    const R q0 = m - g * ray.oz;
    const R dq = g * ray.dz;
    const R oo = ray.ox * ray.ox + ray.oy * ray.oy;
    const R a0 = ray.dx * ray.dx + ray.dy * ray.dy - dq * dq;
    const R a = lane_copysign(lane_max(lane_abs(a0), ray.dd * R(0x1p-200)), a0);
    const R b = ray.ox * ray.dx + ray.oy * ray.dy + dq * q0;
    const R c = oo - q0 * q0;
    const R e = ray.ex + ray.ey + g * ray.ez;
    const R slack =
        e + e + e * e +
        R(8.0 * kUnitRoundoff) * (R(4.0) + R(2.0) * (oo + ray.oz * ray.oz) + R(2.0) * q0 * q0);
    const R px = ray.oy * dq + q0 * ray.dy;
    const R py = ray.ox * dq + q0 * ray.dx;
    const R pz = ray.ox * ray.dy - ray.oy * ray.dx;
    const R p = lane_abs(px) + lane_abs(py) + lane_abs(pz);
    const R all = ray.ex + ray.ey + ray.ez;
    const R along = lane_abs(ray.dx) + lane_abs(ray.dy) + lane_abs(ray.dz);
    const R h =
        R(6.0) * (all + all * all) + R(8.0 * kUnitRoundoff) * (R(2.0) + oo + ray.oz * ray.oz);
    const R h_d = h * along;
    const R d_error = h_d * (R(2.0) * p + R(3.0) * h_d);
    const M by_p = d_error < lane_abs(a) * slack;
    const R d = lane_select(by_p, px * px + py * py - pz * pz - (a - a0) * c, b * b - a * c);
    const R root = lane_sqrt(lane_max(d, zero));
    const R q = zero - (b + lane_copysign(root, b));
    const R per_a = R(1.0) / a;
    const R per_q = R(1.0) / q;
    const M meets = d > zero;
    const R r1 = q * per_a;
    const R anywhere = slack / lane_sqrt(lane_max(d, lane_abs(a) * slack));
    // Where D is 0 what is divided by its root is no number or infinite, and does not count.
    const R off = h_d + d_error / root;
    const R by_a = (off + lane_abs(r1) * h_d * along) * lane_abs(per_a);
    const R e1 = lane_select(by_p, lane_min(by_a, anywhere), anywhere);
    const R product = c * per_q;
    const R by_q = (h + lane_abs(product) * off) * lane_abs(per_q);
    const R known = lane_select(by_p, lane_min(by_q, anywhere), anywhere);
    const R same = (lane_copysign(root, b) - b) * per_a;
    const R by_same = (off + lane_abs(same) * h_d * along) * lane_abs(per_a);
    const M is_same = lane_and(by_p, by_same < known);
    const R r2 = lane_select(meets, lane_select(is_same, same, product), r1);
    const R e2 = lane_select(meets, lane_select(is_same, by_same, known), anywhere);
    const M first = r1 < r2;
    const R low = lane_select(first, r1, r2);
    const R high = lane_select(first, r2, r1);
    const R low_error = lane_select(first, e1, e2);
    const R high_error = lane_select(first, e2, e1);

    const M flat = a > zero;
    const M rising = ray.dz > zero;
    const M open_below = lane_and(lane_not(flat), rising);
    const M open_above = lane_and(lane_not(flat), lane_not(rising));
    Window<R> w;
    open_window(w);
    clip_enter(w, lane_select(open_below, zero - inf, lane_select(flat, low, high)),
               lane_select(open_below, zero, lane_select(flat, low_error, high_error)), zero);
    clip_exit(w, lane_select(open_above, inf, lane_select(flat, high, low)),
              lane_select(open_above, zero, lane_select(flat, high_error, low_error)), zero);
    clip_slab(w, ray.oz, ray.dz, ray.ez, least_direction(ray), 1.0, 2.0);
    close_window(w, ray, lane_or(lane_not(flat), d + a * slack > zero), 0, out);
}

// The normal on face `face`, in the place of a point there: of the mantle, the gradient of sqrt(x^2 + y^2) - q(z), which
// is never zero. At the tip, and as near to it as squares are 0, that is the axis.
template <class R>
RAYMO_INLINE void cone_normal(double ratio, R face, R& x, R& y, R& z) {
    const auto mantle = face == R(0.0);
    const R r = lane_sqrt(x * x + y * y);
    const auto round = lane_and(mantle, r > R(0.0));
    const R inverse = R(1.0) / lane_max(r, R(0x1p-1000));
    x = lane_select(round, x * inverse, R(0.0));
    y = lane_select(round, y * inverse, R(0.0));
    z = lane_select(mantle, lane_select(round, R(0.5 * (1.0 - ratio)), R(1.0)),
                    lane_select(face == R(1.0), R(-1.0), R(1.0)));
}
