// The plain case of solids/crossings.hpp, for one line or several (see math/lanes.hpp): no two crossings that overlap, and, where
// the winding number counts, one that changes between 0 and +-1. Included once per instruction set, after solids/interval.inl.
//
// Lines for which that does not hold, and those that meet too many crossings, are left over: `rest`.
template <class R, class M>
struct LineCrossings {
    /// Of one line, at most.
    static constexpr int kMost = 2 * solids::kSweptSpans;

    M rest;    ///< lines that are left over
    R before;  ///< winding number before all that is asked about, if it is 0 where the line begins
    R total;   ///< that where the line ends
    bool even_odd;  ///< only 0 or 1 matters
    int used = 0;
    R s[kMost], error[kMost];
    R turned_face[kMost];  ///< number of the right face of the wall; negative: it turns to the left

    RAYMO_INLINE LineCrossings(M left_over, curves::Fill fill)
        : rest(left_over), before(0.0), total(0.0), even_odd(fill == curves::Fill::even_odd) {}

    /// Adds one crossing of each line that is `there`, in its order along the line. `turn`: +-1, as in Crossing.
    RAYMO_INLINE void add(M there, R at, R off, R turn, double right_face) {
        R face = turn * R(right_face);
        R next_at = lane_select(there, at, R(std::numeric_limits<double>::infinity()));
        R next_off = off;
        for (int i = 0; i < used; ++i) {
            const M earlier = next_at < s[i];
            const R last_at = s[i], last_off = error[i], last_face = turned_face[i];
            s[i] = lane_select(earlier, next_at, last_at);
            error[i] = lane_select(earlier, next_off, last_off);
            turned_face[i] = lane_select(earlier, face, last_face);
            next_at = lane_select(earlier, last_at, next_at);
            next_off = lane_select(earlier, last_off, next_off);
            face = lane_select(earlier, last_face, face);
        }
        const M left = next_at < R(std::numeric_limits<double>::infinity());
        if (!lane_any(left)) return;
        if (used == kMost) {
            rest = lane_or(rest, left);
            return;
        }
        s[used] = next_at;
        error[used] = lane_select(left, next_off, R(0.0));
        turned_face[used] = lane_select(left, face, R(1.0));
        ++used;
    }

    /// The same, where of interest are only those that may lie in [from, to].
    RAYMO_INLINE void add_within(M there, R at, R off, R turn, double right_face, R from, R to) {
        const M early = lane_and(there, at + off < from);
        before = lane_select(early, wound(before, turn), before);
        total = lane_select(there, wound(total, turn), total);
        add(lane_and(there, lane_and(lane_not(early), at - off <= to)), at, off, turn, right_face);
    }

    RAYMO_INLINE R wound(R winding, R turn) const {
        return even_odd ? R(1.0) - winding : winding + turn;
    }

    /// Puts the spans of the lines that are `asked` and not left over into `out`, each clipped to `window`, and returns how
    /// many there are at most; spans of `out` beyond these are not touched. `winding`: at the place from which on crossings were kept.
    RAYMO_INLINE int spans(const LocalRay<R>& ray, M asked, R winding, const Window<R>& window,
                           LaneSpans<R, M, solids::kSweptSpans>& out) {
        const R zero(0.0);
        const R inf = R(std::numeric_limits<double>::infinity());
        const M inside = lane_or(winding > R(0.5), winding < R(-0.5));
        rest = lane_or(rest, lane_or(winding > R(1.5), winding < R(-1.5)));
        // Before anything in the solid's box: at infinity no window could be closed.
        if (lane_any(lane_and(asked, inside)))
            add(inside, R(-4.0) / lane_sqrt(ray.dd), zero, winding, 1.0);
        int count = 0;
        for (int i = 0; i < used; i += 2) {
            const bool last = i + 1 == used;
            const R enter = s[i];
            const R exit = last ? inf : s[i + 1];
            const R enter_error = error[i];
            const R exit_error = last ? zero : error[i + 1];
            const R exit_face = last ? R(1.0) : turned_face[i + 1];
            const M there = lane_and(asked, enter < inf);
            const M ends = exit < inf;
            const M falls = turned_face[i] < zero;
            M doubtful = lane_and(ends, enter + enter_error >= exit - exit_error);
            if (!even_odd) {
                // Two turns the same way.
                const M same = lane_or(lane_and(falls, exit_face < zero),
                                       lane_and(lane_not(falls), exit_face > zero));
                doubtful = lane_or(doubtful, lane_and(ends, same));
            }
            if (i + 2 < used) {
                doubtful = lane_or(doubtful, lane_and(s[i + 2] < inf, exit + exit_error >=
                                                                          s[i + 2] - error[i + 2]));
            }
            Window<R> w = window;
            clip_enter(w, enter, enter_error,
                       lane_select(falls, zero - turned_face[i], turned_face[i] + R(1.0)));
            clip_exit(w, exit, exit_error,
                      lane_select(exit_face > zero, exit_face, R(1.0) - exit_face));
            close_window(w, ray, there, count, out);
            // Both would have to be told once only.
            doubtful = lane_or(doubtful, lane_or(out.touched, out.degenerate));
            rest = lane_or(rest, lane_and(there, doubtful));
            ++count;
        }
        out.touched = out.degenerate = lane_not(lane_or(asked, lane_not(asked)));
        const M plain = lane_and(asked, lane_not(rest));
        for (int i = 0; i < count; ++i) out.valid[i] = lane_and(out.valid[i], plain);
        return count;
    }
};
