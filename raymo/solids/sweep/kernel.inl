// Spans of a sweep for one ray or several (see math/lanes.hpp), in the plain case: every piece that a ray may meet, or every
// part of it after a few halvings, has one chord whose ends are single maxima, and chords meet for certain or keep
// clear of each other. Other rays are left over for Sweep::Kernel::spans_in_full. The derivation, and the letters, are those of
// chords.cpp and part.hpp. Included once per instruction set, after math/triple.inl and solids/interval.inl; needs
// <limits>, math/tolerance.hpp, solids/span.hpp and solids/sweep/swept_spheres.hpp.

/// Error of a place on the line, of a centre and of a radius, in the canonical frame, where all numbers are below 4: the cuts
/// of the path (3 roundings a halving of numbers below 2, for each coordinate and the radius), the line's frame (4 relative
/// ones), coordinates in it (5) and their values at a place (9), and lengths along the line (3).
inline constexpr double kSweepOwnError = 64.0 * kUnitRoundoff;

/// Halvings of a piece, at most, before a ray is left over.
inline constexpr int kSweepHalvings = 3;

/// Steps to a maximum, at most, before a ray is left over.
inline constexpr int kSweepSteps = 14;

/// A part of a piece in a frame about the lines: coefficients along them, beside, above, and the radius.
template <class R>
struct LaneCubics {
    R tau[4], p[4], q[4], radius[4];
};

/// As SpherePlace.
template <class R>
struct LaneSphere {
    R u, tau, tau1, tau2, disc, disc1, disc2, radius;
};

/// As ChordEnd.
template <class R>
struct LaneChordEnd {
    R t, outer, inner, face;
};

template <class R, class M>
RAYMO_INLINE LaneChordEnd<R> choose_end(M mask, const LaneChordEnd<R>& a,
                                        const LaneChordEnd<R>& b) {
    return {lane_select(mask, a.t, b.t), lane_select(mask, a.outer, b.outer),
            lane_select(mask, a.inner, b.inner), lane_select(mask, a.face, b.face)};
}

/// Chords that are inside for certain, none of which shares such a place with another.
template <class R, class M>
struct LaneChords {
    static constexpr int kMost = solids::kSweptSpans;

    M rest;  ///< lines that are left over
    M valid[kMost];
    LaneChordEnd<R> lo[kMost], hi[kMost];

    RAYMO_INLINE explicit LaneChords(M left_over) : rest(left_over) {
        const LaneChordEnd<R> none{R(0.0), R(0.0), R(0.0), R(0.0)};
        for (int i = 0; i < kMost; ++i) {
            valid[i] = lane_and(left_over, lane_not(left_over));
            lo[i] = hi[i] = none;
        }
    }

    /// Whether all of [from, to] is known to be inside.
    RAYMO_INLINE M covers(R from, R to) const {
        M out = lane_and(valid[0], lane_not(valid[0]));
        for (int i = 0; i < kMost; ++i) {
            out =
                lane_or(out, lane_and(valid[i], lane_and(lo[i].inner <= from, to <= hi[i].inner)));
        }
        return out;
    }

    RAYMO_INLINE void add(M there, LaneChordEnd<R> begin, LaneChordEnd<R> end) {
        // What becomes longer may meet what it did not.
        for (int pass = 0; pass < kMost; ++pass) {
            M met = lane_and(there, lane_not(there));
            for (int i = 0; i < kMost; ++i) {
                const M both =
                    lane_and(lane_and(there, valid[i]),
                             lane_and(begin.inner <= hi[i].inner, lo[i].inner <= end.inner));
                if (!lane_any(both)) continue;
                const LaneChordEnd<R> first = choose_end(lo[i].t < begin.t, lo[i], begin);
                const LaneChordEnd<R> last = choose_end(hi[i].t > end.t, hi[i], end);
                begin = choose_end(both,
                                   LaneChordEnd<R>{first.t, lane_min(begin.outer, lo[i].outer),
                                                   lane_min(begin.inner, lo[i].inner), first.face},
                                   begin);
                end = choose_end(both,
                                 LaneChordEnd<R>{last.t, lane_max(end.outer, hi[i].outer),
                                                 lane_max(end.inner, hi[i].inner), last.face},
                                 end);
                valid[i] = lane_and(valid[i], lane_not(both));
                met = lane_or(met, both);
            }
            if (!lane_any(met)) break;
        }
        for (int i = 0; i < kMost; ++i) {
            const M free = lane_and(there, lane_not(valid[i]));
            if (!lane_any(free)) continue;
            lo[i] = choose_end(free, begin, lo[i]);
            hi[i] = choose_end(free, end, hi[i]);
            valid[i] = lane_or(valid[i], free);
            there = lane_and(there, lane_not(free));
        }
        rest = lane_or(rest, there);
    }

    /// Puts the spans of the lines that are `asked` and not left over into `out`. `length`: of one s; `limit`: the largest
    /// error that is not degenerate. Returns how many there are at most.
    RAYMO_INLINE int spans(M asked, R length, R limit, LaneSpans<R, M, kMost>& out) {
        const R inf(std::numeric_limits<double>::infinity());
        for (int i = 0; i < kMost; ++i) {
            lo[i].t = lane_select(valid[i], lo[i].t, inf);
            lo[i].outer = lane_select(valid[i], lo[i].outer, inf);
        }
        for (int round = 0; round < kMost - 1; ++round) {
            for (int i = 0; i + 1 < kMost - round; ++i) {
                const M swap = lo[i + 1].t < lo[i].t;
                if (!lane_any(swap)) continue;
                const LaneChordEnd<R> begin = lo[i];
                const LaneChordEnd<R> end = hi[i];
                lo[i] = choose_end(swap, lo[i + 1], begin);
                hi[i] = choose_end(swap, hi[i + 1], end);
                lo[i + 1] = choose_end(swap, begin, lo[i + 1]);
                hi[i + 1] = choose_end(swap, end, hi[i + 1]);
            }
        }
        const R unit = R(1.0) / length;
        int count = 0;
        for (int i = 0; i < kMost; ++i) {
            const M there = lane_and(asked, lo[i].t < inf);
            if (!lane_any(there)) break;
            const R enter_error = lane_max(lo[i].t - lo[i].outer, lo[i].inner - lo[i].t);
            const R exit_error = lane_max(hi[i].outer - hi[i].t, hi[i].t - hi[i].inner);
            M clear = lane_and(lane_max(enter_error, exit_error) <= limit,
                               hi[i].t - lo[i].t > enter_error + exit_error);
            if (i + 1 < kMost) clear = lane_and(clear, lo[i + 1].outer > hi[i].outer);
            rest = lane_or(rest, lane_and(there, lane_not(clear)));
            out.valid[i] = there;
            out.enter[i] = lo[i].t * unit;
            out.enter_error[i] = enter_error * unit;
            out.enter_face[i] = lo[i].face;
            out.exit[i] = hi[i].t * unit;
            out.exit_error[i] = exit_error * unit;
            out.exit_face[i] = hi[i].face;
            ++count;
        }
        out.touched = out.degenerate = lane_and(asked, lane_not(asked));
        for (int i = 0; i < count; ++i) out.valid[i] = lane_and(out.valid[i], lane_not(rest));
        return count;
    }
};

/// Value and derivatives of a cubic.
template <class R>
struct LaneBend {
    R value, first, second;
};
template <class R>
RAYMO_INLINE LaneBend<R> lane_bend(const R (&c)[4], R u, R v) {
    const R a0 = v * c[0] + u * c[1];
    const R a1 = v * c[1] + u * c[2];
    const R a2 = v * c[2] + u * c[3];
    const R b0 = v * a0 + u * a1;
    const R b1 = v * a1 + u * a2;
    return {v * b0 + u * b1, R(3.0) * (b1 - b0), R(6.0) * ((a2 - a1) - (a1 - a0))};
}

template <class R>
RAYMO_INLINE LaneSphere<R> sphere_at(const LaneCubics<R>& c, R u) {
    const R v = R(1.0) - u;
    const LaneBend<R> tau = lane_bend(c.tau, u, v);
    const LaneBend<R> p = lane_bend(c.p, u, v);
    const LaneBend<R> q = lane_bend(c.q, u, v);
    const LaneBend<R> a = lane_bend(c.radius, u, v);
    const R two(2.0);
    return {u,
            tau.value,
            tau.first,
            tau.second,
            a.value * a.value - p.value * p.value - q.value * q.value,
            two * (a.value * a.first - p.value * p.first - q.value * q.first),
            two * ((a.first * a.first - p.first * p.first - q.first * q.first) +
                   (a.value * a.second - p.value * p.second - q.value * q.second)),
            lane_abs(a.value)};
}

template <class R, class M>
RAYMO_INLINE LaneSphere<R> choose_sphere(M mask, const LaneSphere<R>& a, const LaneSphere<R>& b) {
    return {lane_select(mask, a.u, b.u),         lane_select(mask, a.tau, b.tau),
            lane_select(mask, a.tau1, b.tau1),   lane_select(mask, a.tau2, b.tau2),
            lane_select(mask, a.disc, b.disc),   lane_select(mask, a.disc1, b.disc1),
            lane_select(mask, a.disc2, b.disc2), lane_select(mask, a.radius, b.radius)};
}

/// Whether a function rises, or falls, all over a part: for all x from -E to E,
///     z' = +-tau' + D1 / (2 sqrt(disc + x))
/// has that sign by the bounds of its terms. Then the largest z is at an end of the part, whatever the error is, and T(E) there
/// is at most T(0) + E / 2h. Most parts that a line meets are of that kind: only one or two hold an end of its chord.
template <class M>
struct LaneSlopes {
    M rises, falls;
    RAYMO_INLINE M one_way() const { return lane_or(rises, falls); }
};

/// As PartBounds.
template <class R, class M>
struct LaneBounds {
    R disc_least, disc_most, d1_least, d2_most;
    R tau_least, tau_most, tau2_least, tau2_most;
    R slack, rounding, wide;
    R disc_first, disc_last;  ///< at the ends
    M d1_rises;
    LaneSlopes<M> first, last;  ///< of -tau + h, and of tau + h
};

template <class R>
RAYMO_INLINE R slack_of(R radius, R error) {
    return error * (R(2.0) * radius + error);
}

/// Lines in lengths, and frames about them.
template <class R, class M>
struct SweepLines {
    Triple<R> o, along, side, up;
    R error;  ///< of a place on it, of a centre and of a radius, together
    R past;   ///< what lies before it does not count (LocalRay::from)
    LaneChords<R, M>& found;

    /// Adds where the lines that are `asked` are inside a piece.
    RAYMO_INLINE void meet(const solids::SweptPiece& piece, M asked) {
        if (!lane_any(asked)) return;
        struct Part {
            LaneCubics<R> c;
            M there;
            double u0, u1;
            int depth;
        };
        Part open[kSweepHalvings + 2];
        std::size_t count = 0;
        Part first;
        for (int i = 0; i < 4; ++i) {
            const auto& point = piece.cubics.c[static_cast<std::size_t>(i)];
            const Triple<R> to{R(point[0]) - o.x, R(point[1]) - o.y, R(point[2]) - o.z};
            first.c.tau[i] = dot(to, along);
            first.c.p[i] = dot(to, side);
            first.c.q[i] = dot(to, up);
            first.c.radius[i] = R(point[3]);
        }
        const LaneCubics<R>& whole = first.c;
        first.there = asked;
        first.u0 = 0.0;
        first.u1 = 1.0;
        first.depth = 0;
        // No part is copied: they are large.
        for (Part* next = &first; next != nullptr; next = count > 0 ? &open[--count] : nullptr) {
            const Part& part = *next;
            LaneBounds<R, M> b;
            R disc[7];
            bound_reach(part.c, part.depth, disc, b);
            M there = lane_and(part.there, b.disc_most > R(0.0) - (b.slack + b.rounding));
            there = lane_and(there, lane_not(lane_or(found.rest, b.tau_most + b.wide < past)));
            if (!lane_any(there)) continue;
            if (piece.cut != 0) {
                leave(there);
                return;
            }
            there =
                lane_and(there, lane_not(found.covers(b.tau_least - b.wide, b.tau_most + b.wide)));
            if (!lane_any(there)) continue;
            bound_slopes(part.c, part.u1 - part.u0, disc, b);
            const M positive = b.disc_least > R(4.0) * (b.slack + b.rounding);
            const M at_ends =
                lane_and(lane_and(there, positive), lane_and(b.first.one_way(), b.last.one_way()));
            if (lane_any(at_ends)) {
                join_ends(piece, part.c, part.u0, part.u1, b, at_ends);
                there = lane_and(there, lane_not(at_ends));
                if (!lane_any(there)) continue;
            }
            const M single = lane_or(positive, lane_or(b.d2_most<R(0.0), b.d1_least> R(0.0)));
            const R bend_first = bend_of(b, R(0.0) - b.tau2_least);
            const R bend_last = bend_of(b, b.tau2_most);
            const M plain = lane_and(lane_and(there, single),
                                     lane_and(lane_or(b.first.one_way(), bend_first > R(0.0)),
                                              lane_or(b.last.one_way(), bend_last > R(0.0))));
            if (lane_any(plain))
                join(piece, whole, part.u0, part.u1, b, bend_first, bend_last, plain);
            there = lane_and(there, lane_not(plain));
            if (!lane_any(there)) continue;
            if (part.depth == kSweepHalvings) {
                leave(there);
                continue;
            }
            // The right half takes the place of what was halved, if that is on the list.
            const double u0 = part.u0, u1 = part.u1;
            const int depth = part.depth + 1;
            Part& right = open[count];
            Part& left = open[count + 1];
            halve(part.c.tau, left.c.tau, right.c.tau);
            halve(part.c.p, left.c.p, right.c.p);
            halve(part.c.q, left.c.q, right.c.q);
            halve(part.c.radius, left.c.radius, right.c.radius);
            left.u0 = u0;
            left.u1 = right.u0 = 0.5 * (u0 + u1);
            right.u1 = u1;
            left.there = right.there = there;
            left.depth = right.depth = depth;
            count += 2;
        }
    }

private:
    RAYMO_INLINE void leave(M lines) { found.rest = lane_or(found.rest, lines); }

    RAYMO_INLINE static void halve(const R (&c)[4], R (&left)[4], R (&right)[4]) {
        const R half(0.5);
        const R a0 = half * (c[0] + c[1]);
        const R a1 = half * (c[1] + c[2]);
        const R a2 = half * (c[2] + c[3]);
        const R b0 = half * (a0 + a1);
        const R b1 = half * (a1 + a2);
        left[0] = c[0];
        left[1] = a0;
        left[2] = b0;
        left[3] = right[0] = half * (b0 + b1);
        right[1] = b1;
        right[2] = a2;
        right[3] = c[3];
    }

    /// The coefficients of disc, and how far chords may reach.
    RAYMO_INLINE void bound_reach(const LaneCubics<R>& c, int depth, R (&disc)[7],
                                  LaneBounds<R, M>& b) const {
        const R zero(0.0);
        const R(&a)[4] = c.radius;
        const R(&p)[4] = c.p;
        const R(&q)[4] = c.q;
        const auto pair = [&](int i, int j)
                              RAYMO_INLINE_BODY { return a[i] * a[j] - p[i] * p[j] - q[i] * q[j]; };
        disc[0] = pair(0, 0);
        disc[1] = pair(0, 1);
        disc[2] = R(0.4) * pair(0, 2) + R(0.6) * pair(1, 1);
        disc[3] = R(0.1) * pair(0, 3) + R(0.9) * pair(1, 2);
        disc[4] = R(0.4) * pair(1, 3) + R(0.6) * pair(2, 2);
        disc[5] = pair(2, 3);
        disc[6] = pair(3, 3);
        R size = zero;
        R radius = zero;
        b.tau_least = b.tau_most = c.tau[0];
        for (int i = 0; i < 4; ++i) {
            size = lane_max(size, p[i] * p[i] + q[i] * q[i]);
            radius = lane_max(radius, lane_abs(a[i]));
            b.tau_least = lane_min(b.tau_least, c.tau[i]);
            b.tau_most = lane_max(b.tau_most, c.tau[i]);
        }
        size = size + radius * radius;
        b.rounding = R(8.0 * kUnitRoundoff * (1.0 + 0.5 * depth)) * size;
        b.slack = slack_of(radius, error);
        b.disc_least = b.disc_most = b.disc_first = disc[0];
        b.disc_last = disc[6];
        for (int i = 1; i < 7; ++i) {
            b.disc_least = lane_min(b.disc_least, disc[i]);
            b.disc_most = lane_max(b.disc_most, disc[i]);
        }
        b.wide = lane_sqrt(lane_max(b.disc_most, zero) + b.slack + b.rounding);
    }

    /// All that is said of derivatives, after bound_reach().
    RAYMO_INLINE void bound_slopes(const LaneCubics<R>& c, double width, const R (&disc)[7],
                                   LaneBounds<R, M>& b) const {
        const R zero(0.0);
        R low(0.0), high(0.0), bend(0.0), last(0.0);
        for (int i = 0; i < 6; ++i) {
            const R d = disc[i + 1] - disc[i];
            low = i == 0 ? d : lane_min(low, d);
            high = i == 0 ? d : lane_max(high, d);
            if (i > 0) bend = i == 1 ? d - last : lane_max(bend, d - last);
            last = d;
        }
        const double scale = 1.0 / width;
        const R two(2.0);
        b.d1_rises = low > zero;
        b.d1_least = R(6.0 * scale) * lane_max(low, lane_max(zero - high, two * b.rounding)) -
                     R(12.0 * scale) * b.rounding;
        b.d2_most = R(30.0 * scale * scale) * (bend + R(4.0) * b.rounding);
        const R t0 = c.tau[1] - c.tau[0];
        const R t1 = c.tau[2] - c.tau[1];
        const R t2 = c.tau[3] - c.tau[2];
        b.tau2_most = R(6.0 * scale * scale) * lane_max(t1 - t0, t2 - t1);
        b.tau2_least = R(6.0 * scale * scale) * lane_min(t1 - t0, t2 - t1);
        // A third of the derivative of +-tau + h by the part's own parameter is +-t + d / h.
        const R t_least = lane_min(t0, lane_min(t1, t2)) - R(2.0 * kSweepOwnError);
        const R t_most = lane_max(t0, lane_max(t1, t2)) + R(2.0 * kSweepOwnError);
        const R d_least = low - two * b.rounding;
        const R d_most = high + two * b.rounding;
        const R narrow = lane_sqrt(lane_max(b.disc_least - (b.slack + b.rounding), zero));
        const R h_least = d_least / lane_select(d_least >= zero, b.wide, narrow);
        const R h_most = d_most / lane_select(d_most <= zero, b.wide, narrow);
        b.first = {h_least > t_most, h_most < t_least};
        b.last = {t_least + h_least > zero, t_most + h_most < zero};
    }

    /// B; `turn`: the most that sign tau'' is.
    RAYMO_INLINE static R bend_of(const LaneBounds<R, M>& b, R turn) {
        const R zero(0.0);
        const R m2 = b.d1_least * b.d1_least;
        R h2 = lane_max(b.disc_most, b.slack);
        h2 = lane_select(b.d2_most > zero, lane_min(h2, R(1.5) * m2 / b.d2_most), h2);
        const R bend = (m2 - R(2.0) * h2 * b.d2_most) / (R(4.0) * h2 * lane_sqrt(h2)) - turn;
        return lane_select(lane_and(h2 > zero, bend > R(0.125) * lane_abs(turn)), bend, zero);
    }

    /// The chord of a part in which -tau + h and tau + h rise or fall all the way: it ends where those of the part's ends do.
    RAYMO_INLINE void join_ends(const solids::SweptPiece& piece, const LaneCubics<R>& c, double u0,
                                double u1, const LaneBounds<R, M>& b, M there) {
        const auto end = [&](M at_last, double sign) RAYMO_INLINE_BODY {
            const R h = lane_sqrt(lane_select(at_last, b.disc_last, b.disc_first));
            const R radius = lane_abs(lane_select(at_last, c.radius[3], c.radius[0]));
            const R t = lane_select(at_last, c.tau[3], c.tau[0]) + R(sign) * h;
            const R e = error * (R(2.5) * radius + error);
            const R inner = e / h;
            const R outer = lane_min(R(0.5) * inner, lane_sqrt(e));
            R face(0.0);
            if (piece.begins && u0 == 0.0) face = lane_select(at_last, face, R(1.0));
            if (piece.ends && u1 == 1.0) face = lane_select(at_last, R(2.0), face);
            return LaneChordEnd<R>{t, t + R(sign) * outer, t - R(sign) * inner, face};
        };
        const LaneChordEnd<R> first = end(b.first.rises, -1.0);
        const LaneChordEnd<R> last = end(b.last.rises, 1.0);
        const M certain = first.inner <= last.inner;
        leave(lane_and(there, lane_not(certain)));
        found.add(lane_and(there, certain), first, last);
    }

    /// The chord of a part that has one, of which both ends are single maxima.
    RAYMO_INLINE void join(const solids::SweptPiece& piece, const LaneCubics<R>& whole, double u0,
                           double u1, const LaneBounds<R, M>& b, R bend_first, R bend_last,
                           M there) {
        const R zero(0.0);
        // The place of the largest disc, or nearly.
        const M ends = b.d1_least > zero;
        const M humped = lane_and(lane_not(ends), b.d2_most < zero);
        R u = lane_select(ends, lane_select(b.d1_rises, R(u1), R(u0)), R(0.5 * (u0 + u1)));
        LaneSphere<R> peak = sphere_at(whole, u);
        R most = peak.disc;
        M active = lane_and(there, humped);
        for (int i = 0; i < 8 && lane_any(active); ++i) {
            const M stays = u == lane_select(peak.disc1 > zero, R(u1), R(u0));
            const R gain = peak.disc1 * peak.disc1 / (R(-2.0) * b.d2_most);
            most = lane_select(lane_and(active, lane_not(stays)), peak.disc + gain, most);
            const M near = gain <= R(0.05) * lane_max(peak.disc, b.slack);
            active = lane_and(active, lane_not(lane_or(stays, near)));
            if (!lane_any(active)) break;
            const R next = u - peak.disc1 / lane_min(peak.disc2, b.d2_most);
            u = lane_select(active, lane_min(lane_max(next, R(u0)), R(u1)), u);
            const LaneSphere<R> at = sphere_at(whole, u);
            peak = choose_sphere(active, at, peak);
            most = lane_select(active, peak.disc, most);
        }
        // Where the largest has not been found it may be larger.
        there = lane_and(there, lane_or(active, most > zero - b.slack));
        const M met = peak.disc >= R(4.0) * b.slack;
        leave(lane_and(there, lane_not(met)));
        there = lane_and(there, met);
        if (!lane_any(there)) return;
        // A chord that begins in the past may as well begin where this sphere does.
        const R early = peak.tau - lane_sqrt(lane_max(peak.disc, zero));
        const M begun = lane_and(there, early < past);
        const M begins = lane_and(there, lane_not(begun));
        LaneChordEnd<R> first{early, early, early, zero};
        if (lane_any(begins)) {
            first =
                choose_end(begun, first,
                           end_of(piece, whole, u0, u1, b.first, bend_first, peak, -1.0, begins));
        }
        const LaneChordEnd<R> last =
            end_of(piece, whole, u0, u1, b.last, bend_last, peak, 1.0, there);
        const M certain = first.inner <= last.inner;
        leave(lane_and(there, lane_not(certain)));
        found.add(lane_and(there, certain), first, last);
    }

    /// The largest sign tau + h: at an end of the part where it rises or falls all over it.
    RAYMO_INLINE LaneChordEnd<R> end_of(const solids::SweptPiece& piece, const LaneCubics<R>& whole,
                                        double u0, double u1, const LaneSlopes<M>& slopes, R bend,
                                        const LaneSphere<R>& peak, double sign, M there) {
        const M at_end = lane_and(there, slopes.one_way());
        const M between = lane_and(there, lane_not(at_end));
        LaneSphere<R> best = peak;
        R loss(0.0);
        if (lane_any(between)) climb(whole, u0, u1, bend, peak, sign, between, best, loss);
        if (lane_any(at_end)) {
            best = choose_sphere(at_end, sphere_at(whole, lane_select(slopes.rises, R(u1), R(u0))),
                                 best);
        }
        return told(piece, u0, u1, peak, best, loss, sign);
    }

    /// The place of the largest sign tau + h between, where it bends down all over the part, and by what it may be larger there.
    RAYMO_INLINE void climb(const LaneCubics<R>& whole, double u0, double u1, R bend,
                            const LaneSphere<R>& peak, double sign, M there, LaneSphere<R>& good,
                            R& loss) {
        const R zero(0.0);
        const R half(0.5);
        const R s(sign);
        R lo(u0);
        R hi(u1);
        LaneSphere<R> at = peak;
        M active = there;
        const M never = lane_and(there, lane_not(there));
        M lo_seen = never;
        M hi_seen = never;
        for (int i = 0;; ++i) {
            // Beyond the chords: back half the way.
            const M beyond = at.disc <= zero;
            const M above = at.u > good.u;
            const M down = lane_and(active, lane_and(beyond, above));
            const M up_ = lane_and(active, lane_and(beyond, lane_not(above)));
            hi = lane_select(down, at.u, hi);
            lo = lane_select(up_, at.u, lo);
            hi_seen = lane_or(hi_seen, down);
            lo_seen = lane_or(lo_seen, up_);
            const M here = lane_and(active, lane_not(beyond));
            good = choose_sphere(here, at, good);
            const R h = lane_sqrt(lane_max(at.disc, R(0x1p-1000)));
            const R m = s * at.tau1;
            const R slope = m + at.disc1 / (R(2.0) * h);
            const M rises = slope > zero;
            const M stops = lane_or(lane_and(at.u == R(u1), slope >= zero),
                                    lane_and(at.u == R(u0), slope <= zero));
            const R off = lane_select(stops, zero, slope * slope / (R(2.0) * bend));
            loss = lane_select(here, off, loss);
            const M arrives = lane_or(stops, off * h <= R(0x1p-12) * slack_of(at.radius, error));
            active = lane_and(active, lane_not(lane_and(here, arrives)));
            if (!lane_any(active)) break;
            if (i == kSweepSteps) {
                leave(active);
                break;
            }
            const M forth = lane_and(here, rises);
            const M back = lane_and(here, lane_not(rises));
            lo = lane_select(forth, at.u, lo);
            hi = lane_select(back, at.u, hi);
            lo_seen = lane_or(lo_seen, forth);
            hi_seen = lane_or(hi_seen, back);
            const R c = R(-0.5) * (at.disc2 + R(2.0 * sign) * at.tau2 * h);
            const R halfway = half * at.disc1 / c;
            const R step =
                m * lane_sqrt(
                        lane_max((at.disc + half * halfway * at.disc1) / (c * (c + m * m)), zero));
            // Where that model has no maximum: Newton's step for the slope.
            const R fall =
                (at.disc1 * at.disc1 - R(2.0) * at.disc * at.disc2) / (R(4.0) * at.disc * h) -
                s * at.tau2;
            const R newton =
                lane_select(fall > zero, at.u + slope / fall, lane_select(rises, hi, lo));
            R next = lane_select(c > zero, at.u + halfway + step, newton);
            next = lane_select(next < hi, next, lane_select(hi_seen, half * (at.u + hi), hi));
            next = lane_select(next > lo, next, lane_select(lo_seen, half * (at.u + lo), lo));
            next = lane_select(beyond, half * (at.u + good.u), next);
            // Where no number lies between, there is nothing left to gain.
            active = lane_and(active, lane_not(lane_and(here, next == at.u)));
            at = sphere_at(whole, next);
        }
    }

    /// The end of a chord at a sphere.
    RAYMO_INLINE LaneChordEnd<R> told(const solids::SweptPiece& piece, double u0, double u1,
                                      const LaneSphere<R>& peak, const LaneSphere<R>& good, R loss,
                                      double sign) const {
        const R s(sign);
        const R zero(0.0);
        const R one(1.0);
        const R h = lane_sqrt(lane_max(good.disc, R(0x1p-1000)));
        const R t = s * good.tau + h;
        const R e = error * (R(2.5) * good.radius + error);
        const M clipped = lane_or(good.u == R(u0), good.u == R(u1));
        const R wide = e / (R(2.0) * h);
        const R outer = t + loss + lane_select(clipped, lane_min(wide, lane_sqrt(e)), wide);
        // The highest sphere does for certain, too.
        const R top = lane_sqrt(lane_max(peak.disc, R(0x1p-1000)));
        const R inner =
            lane_max(t - e / h, s * peak.tau + top - slack_of(peak.radius, error) / top);
        R face = zero;
        if (piece.begins) face = lane_select(good.u == zero, one, face);
        if (piece.ends) face = lane_select(good.u == one, R(2.0), face);
        return {s * t, s * outer, s * inner, face};
    }
};

template <class R, class M>
RAYMO_INLINE SweepLines<R, M> sweep_lines(const LocalRay<R>& ray, LaneChords<R, M>& found) {
    const R unit = R(1.0) / lane_sqrt(ray.dd);
    SweepLines<R, M> out{{ray.ox, ray.oy, ray.oz},
                         {ray.dx * unit, ray.dy * unit, ray.dz * unit},
                         {},
                         {},
                         ray.ex + ray.ey + ray.ez + R(kSweepOwnError),
                         ray.from / unit,
                         found};
    lane_frame(out.along, out.side, out.up);
    return out;
}

/// The largest error of an end that is not degenerate, as a length.
template <class R>
RAYMO_INLINE R sweep_limit(const LocalRay<R>& ray) {
    return R(kDegenerate) + R(1024.0) * (ray.ex + ray.ey + ray.ez);
}
