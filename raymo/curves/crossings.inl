// Polynomials of low degree (2 or more), one or several at a time (see math/lanes.hpp): which have no root in [0, 1], which have one
// crossing, and where it is. Included once per instruction set.
//
// What is decided is what find_roots decides at once, and the crossing is that of crossing_of (curves/crossing.hpp, where the
// steps are explained) bit for bit: the operations are the same in the same order. What is neither needs find_roots.
template <class M>
struct LaneSigns {
    M none;   ///< certainly no root
    M one;    ///< certainly one crossing, and nothing else
    M rises;  ///< negative at 0: from negative to positive, where there is one crossing
};

/// Crossings in two halves of a part of [0, 1].
template <class R, class M>
struct LanePair {
    M none;           ///< certainly no root
    M two;            ///< certainly two crossings, and nothing else
    R first, second;  ///< their places, where there are two
};

/// A cubic and its derivative at one place.
template <class R>
struct LaneJet {
    R value, slope;
};
template <class R>
RAYMO_INLINE LaneJet<R> lane_jet(const R (&c)[4], R u) {
    const R v = R(1.0) - u;
    const R a = v * c[0] + u * c[1];
    const R b = v * c[1] + u * c[2];
    const R d = v * c[2] + u * c[3];
    const R first = v * a + u * b;
    const R second = v * b + u * d;
    return {v * first + u * second, R(3.0) * (second - first)};
}
template <class R>
RAYMO_INLINE LaneJet<R> lane_jet(const std::array<double, 4>& c, R u) {
    const R all[4] = {R(c[0]), R(c[1]), R(c[2]), R(c[3])};
    return lane_jet(all, u);
}

/// Sum of b[i] s^i, i <= K, even and odd powers side by side; t = s^2.
template <int K, class R>
RAYMO_INLINE R lane_power_sum(const R (&b)[K + 1], R s, R t) {
    R even = b[K / 2 * 2];
    for (int i = K / 2 * 2; i > 0; i -= 2) even = even * t + b[i - 2];
    if constexpr (K == 0) {
        return even;
    } else {
        constexpr int kOdd = (K + 1) / 2 * 2 - 1;
        R odd = b[kOdd];
        for (int i = kOdd; i > 1; i -= 2) odd = odd * t + b[i - 2];
        return even + s * odd;
    }
}

/// g(s) = sum of a[i] s^i is negative at 0 and not at 1: its zero there, in the lanes that are `active`.
template <int N, class R, class M>
RAYMO_INLINE R lane_zero(const R (&a)[N + 1], R s, M active) {
    R lo(0.0), hi(1.0), last(1.0), before(0.0), found(0.5);
    R a1[N], a2[N - 1];
    for (int i = 0; i < N; ++i) a1[i] = R(static_cast<double>(i + 1)) * a[i + 1];
    for (int i = 0; i < N - 1; ++i) a2[i] = R(static_cast<double>(i + 1)) * a1[i + 1];
    s = lane_select(lane_and(s > lo, s < hi), s, R(0.5) * (lo + hi));
    for (int round = 0; round < 200 && lane_any(active); ++round) {
        const R t = s * s;
        const R g = lane_power_sum<N>(a, s, t);
        const R dg = lane_power_sum<N - 1>(a1, s, t);
        const R ddg = lane_power_sum<N - 2>(a2, s, t);
        const M below = g < R(0.0);
        lo = lane_select(below, s, lo);
        hi = lane_select(below, hi, s);
        const R inverse = R(1.0) / dg;
        const R newton = g * inverse;
        R z = newton * (ddg * inverse);
        z = lane_select(z > R(0.5), R(0.5), z);
        z = lane_select(z < R(-0.5), R(-0.5), z);
        const R step = newton * (R(1.0) + R(0.5) * z);
        const R next = s - step;
        const R size = lane_abs(step);
        const R shrinks = size / before;
        const R rest = size * (z * z + shrinks * shrinks * shrinks);
        const M up = dg > R(0.0);
        const M arrives =
            lane_and(up, lane_or(rest <= R(0x1p-56) * next, size <= R(0x1p-53) * next));
        found = lane_select(lane_and(active, arrives), lane_min(lane_max(next, lo), hi), found);
        active = lane_and(active, lane_not(arrives));
        const M steps =
            lane_and(lane_and(size <= R(0.5) * last, up), lane_and(next > lo, next < hi));
        const R half = R(0.5) * (hi - lo);
        last = lane_select(steps, size, half);
        before = lane_select(steps, size, R(0.0));
        s = lane_select(steps, next, lo + half);
        const M stuck = lane_and(active, lane_not(lane_and(s > lo, s < hi)));
        found = lane_select(stuck, s, found);
        active = lane_and(active, lane_not(stuck));
    }
    return lane_select(active, s, found);
}

/// The crossing of c, which has different signs at 0 and 1, in the lanes that are `active`.
template <int N, class R, class M>
RAYMO_INLINE R lane_crossing(const R (&c)[N + 1], M active) {
    R a[N + 1];
    R sum(0.0);
    for (int i = 0; i <= N; ++i) {
        a[i] = R(curves::binomial(N, i)) * c[i];
        sum = sum + a[i];
    }
    const M rises = c[0] < R(0.0);
    const M middle_below = sum < R(0.0);
    const M from_start =
        lane_or(lane_and(middle_below, lane_not(rises)), lane_and(lane_not(middle_below), rises));
    const M flips =
        lane_or(lane_and(rises, lane_not(from_start)), lane_and(lane_not(rises), from_start));
    for (int i = 0; i < N - i; ++i) {
        const R first = a[i];
        const R other = a[N - i];
        a[i] = lane_select(from_start, first, other);
        a[N - i] = lane_select(from_start, other, first);
    }
    const R sign = lane_select(flips, R(-1.0), R(1.0));
    for (int i = 0; i <= N; ++i) a[i] = a[i] * sign;
    sum = sum * sign;
    const R middle = sum * R(1.0 / (1 << N));
    const R bend = R(2.0) * (a[0] + a[N]) - R(4.0) * middle;
    const R slope = R(4.0) * middle - R(3.0) * a[0] - a[N];
    const R root = lane_sqrt(lane_max(slope * slope - R(4.0) * bend * a[0], R(0.0)));
    const R guess = R(-2.0) * a[0] / (slope + root + R(2.0) * a[0]);
    const R s = lane_zero<N>(a, guess, active);
    return lane_select(from_start, s, R(1.0)) / (R(1.0) + s);
}

/// `noise` (>= 0, finite) as in find_roots; coefficients of at most 2^500, as find_roots makes them.
template <int N, class M, class R>
RAYMO_INLINE LaneSigns<M> lane_signs(const R (&c)[N + 1], R noise) {
    const R minus = R(0.0) - noise;
    const M rises = c[0] < R(0.0);
    const M ends_negative = c[N] < R(0.0);
    const M falls = lane_and(ends_negative, lane_not(rises));
    M above = c[0] > noise;
    M below = c[0] < minus;
    // Signs that are known; at the ends they are taken as they stand.
    M negative = rises;
    M positive = lane_not(rises);
    M back = lane_and(rises, ends_negative);  // some change goes the wrong way
    M forth = lane_and(lane_not(rises), lane_not(ends_negative));
    for (int i = 1; i <= N; ++i) {
        M now_negative = c[i] < minus;
        M now_positive = c[i] > noise;
        above = lane_and(above, now_positive);
        below = lane_and(below, now_negative);
        if (i == N) {
            now_negative = ends_negative;
            now_positive = lane_not(ends_negative);
        }
        back = lane_or(back, lane_or(lane_and(now_negative, lane_not(negative)),
                                     lane_and(positive, lane_not(now_positive))));
        forth = lane_or(forth, lane_or(lane_and(negative, lane_not(now_negative)),
                                       lane_and(now_positive, lane_not(positive))));
        negative = now_negative;
        positive = now_positive;
    }
    LaneSigns<M> out;
    out.none = lane_or(above, below);
    out.rises = rises;
    out.one = lane_and(lane_not(out.none),
                       lane_or(lane_and(lane_and(rises, lane_not(ends_negative)), lane_not(back)),
                               lane_and(falls, lane_not(forth))));
    return out;
}

/// Halvings of lane_pair, at most.
inline constexpr int kPairHalvings = 4;

/// Looks for two crossings, or none, where lane_signs tells neither, in the lanes that are `active`. What it does not find
/// after a few halvings needs find_roots.
template <int N, class R, class M>
RAYMO_INLINE LanePair<R, M> lane_pair(const R (&c)[N + 1], R noise, M active) {
    R part[N + 1], low[N + 1], high[N + 1];
    R size(0.0);
    for (int i = 0; i <= N; ++i) {
        part[i] = low[i] = high[i] = c[i];
        size = lane_max(size, lane_abs(c[i]));
    }
    // Each halving is N means, which are wrong by a unit roundoff each.
    noise = noise + R(2.0 * N * kPairHalvings * kUnitRoundoff) * size;
    R from(0.0), middle(0.0), to(0.0);  // of the two halves
    R lo(0.0);
    double width = 1.0;
    LanePair<R, M> out;
    out.none = out.two = lane_and(active, lane_not(active));
    for (int depth = 0; depth < kPairHalvings && lane_any(active); ++depth) {
        R left[N + 1];
        left[0] = part[0];
        for (int n = N; n > 0; --n) {
            for (int i = 0; i < n; ++i) part[i] = R(0.5) * (part[i] + part[i + 1]);
            left[N + 1 - n] = part[0];
        }
        width *= 0.5;
        const LaneSigns<M> first = lane_signs<N, M>(left, noise);
        const LaneSigns<M> second = lane_signs<N, M>(part, noise);
        out.none = lane_or(out.none, lane_and(active, lane_and(first.none, second.none)));
        const M two = lane_and(active, lane_and(first.one, second.one));
        const M to_left =
            lane_and(lane_and(active, second.none), lane_not(lane_or(first.none, first.one)));
        const M to_right =
            lane_and(lane_and(active, first.none), lane_not(lane_or(second.none, second.one)));
        if (lane_any(two)) {
            out.two = lane_or(out.two, two);
            for (int i = 0; i <= N; ++i) {
                low[i] = lane_select(two, left[i], low[i]);
                high[i] = lane_select(two, part[i], high[i]);
            }
            from = lane_select(two, lo, from);
            middle = lane_select(two, lo + R(width), middle);
            to = lane_select(two, lo + R(width + width), to);
        }
        active = lane_or(to_left, to_right);
        for (int i = 0; i <= N; ++i) part[i] = lane_select(to_left, left[i], part[i]);
        lo = lane_select(to_right, lo + R(width), lo);
    }
    out.first = out.second = R(0.5);
    if (lane_any(out.two)) {
        out.first = from + (middle - from) * lane_crossing<N>(low, out.two);
        out.second = middle + (to - middle) * lane_crossing<N>(high, out.two);
    }
    return out;
}
