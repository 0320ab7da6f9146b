// Spans of a swept contour (solids/contour_sweep.hpp) for one ray or several (see math/lanes.hpp), in the plain case: the ray
// keeps clear of the tip, and each piece of the contour is met in one or two certain crossings, away from its ends. Other
// rays are left over for ContourSweep::spans_in_full. Included once per instruction set, after solids/swept_kernels.inl.

/// A ray that stays within this many times its error of one point of the section is taken to be at that point.
inline constexpr double kSectionStays = 1024.0;

/// A crossing that may lie anywhere in more than this part of a piece is not plain.
inline constexpr double kSectionNarrow = 0.25;

/// Rays in the space of (x, y, q): see the head of contour_sweep.hpp.
template <class R, class M>
struct SectionLines {
    Triple<R> a, b, n, e;
    R most_noise;
    R from, to;  ///< what is asked about
    LineCrossings<R, M>& found;
    // Of a prism, boxes that the ray is in only at places from `keep_from` to `keep_to` are looked at. Its place nearest to a
    // point p of the section is s = along.p - s_o.
    bool is_prism;
    R along_x, along_y, s_o, s_slack;
    R keep_from, keep_to;

    static Triple<R> control(const curves::Piece& piece, int k) {
        const auto i = static_cast<std::size_t>(k);
        return {R(piece.x[i]), R(piece.y[i]), R(piece.w[i])};
    }

    RAYMO_INLINE M meets(const Box2& box) const {
        const Vec2 c = box.centre();
        const Vec2 half = box.size() * (0.5 * (1.0 + 0x1p-40));
        const R f = n.x * R(c.x) + n.y * R(c.y) + n.z;
        const M met =
            lane_abs(f) <= lane_abs(n.x) * R(half.x) + lane_abs(n.y) * R(half.y) + most_noise;
        if (!is_prism) return met;
        const R s = along_x * R(c.x) + along_y * R(c.y) - s_o;
        const R reach = lane_abs(along_x) * R(half.x) + lane_abs(along_y) * R(half.y) + s_slack;
        return lane_and(met, lane_and(s + reach >= keep_from, s - reach <= keep_to));
    }

    RAYMO_INLINE void meet(const curves::Piece& piece, M asked) {
        R f[4];
        for (int k = 0; k < 4; ++k) f[k] = dot(n, control(piece, k));
        const LaneSigns<M> signs = lane_signs<3, M>(f, most_noise);
        M open = lane_and(asked, lane_not(signs.none));
        if (!lane_any(open)) return;
        // The corner at its end, which the ray may or may not reach.
        const R corner_noise = dot(e, abs(cross(b, control(piece, 3))));
        leave(lane_and(open, lane_abs(f[3]) <= corner_noise));
        const M one = lane_and(open, signs.one);
        if (lane_any(one)) cross_at(piece, f, lane_crossing<3>(f, one), one, signs.rises);
        open = lane_and(open, lane_not(signs.one));
        if (!lane_any(open)) return;
        const LanePair<R, M> pair = lane_pair<3>(f, most_noise, open);
        leave(lane_and(open, lane_not(lane_or(pair.none, pair.two))));
        const M two = lane_and(open, pair.two);
        if (!lane_any(two)) return;
        cross_at(piece, f, pair.first, two, signs.rises);
        cross_at(piece, f, pair.second, two, lane_not(signs.rises));
    }

private:
    RAYMO_INLINE void leave(M lines) { found.rest = lane_or(found.rest, lines); }

    RAYMO_INLINE void cross_at(const curves::Piece& piece, const R (&f)[4], R u, M there, M rises) {
        const LaneJet<R> x = lane_jet(piece.x, u);
        const LaneJet<R> y = lane_jet(piece.y, u);
        const LaneJet<R> w = lane_jet(piece.w, u);
        const Triple<R> p{x.value, y.value, w.value};
        const Triple<R> dp{x.slope, y.slope, w.slope};
        const Triple<R> m = cross(b, p);
        const R s = R(0.0) - dot(cross(a, p), m) / dot(m, m);
        const Triple<R> t = cross(dp, p);
        const R slope = dot(b, t);
        const R spread = dot(e, abs(t)) / lane_abs(slope);
        const R df = lane_abs(dot(n, dp));
        const R ddf = R(6.0) * lane_max(lane_abs(f[0] - R(2.0) * f[1] + f[2]),
                                        lane_abs(f[1] - R(2.0) * f[2] + f[3]));
        const R off = dot(e, abs(m));
        const R du = off / df;
        const M steady =
            lane_and(R(24.0 * piece.bend) * du<max_norm(dp), df * df> R(8.0) * ddf * off);
        const M within = lane_and(lane_and(du <= u, u + du <= R(1.0)), du < R(kSectionNarrow));
        const M certain =
            lane_and(lane_and(steady, within), spread < R(std::numeric_limits<double>::infinity()));
        leave(lane_and(there, lane_not(certain)));
        const M ahead = dot(a + b * s, p) > R(0.0);
        const R error = R(1.25) * spread + R(8.0 * kUnitRoundoff) * lane_abs(s);
        found.add_within(lane_and(there, lane_and(certain, ahead)), s, error,
                         lane_select(rises, R(1.0), R(-1.0)), solids::right_wall(piece.run), from,
                         to);
    }
};

/// Returns how many spans `out` has at most. `left_over` gets the rays, of those that are `asked`, that are not plain.
template <class R, class M>
RAYMO_INLINE int contour_sweep_spans(const curves::Region& region, double ratio,
                                     const LocalRay<R>& ray, M asked,
                                     LaneSpans<R, M, solids::kSweptSpans>& out, M& left_over) {
    const double g = 0.5 * (1.0 - ratio);
    const Triple<R> a{ray.ox, ray.oy, R(0.5 * (1.0 + ratio)) - R(g) * ray.oz};
    const Triple<R> b{ray.dx, ray.dy, R(-g) * ray.dz};
    const Triple<R> off{ray.ex, ray.ey, R(g) * ray.ez};
    const R rounding = R(16.0 * kUnitRoundoff);
    const R more = rounding * lane_max(R(1.0), max_norm(a));
    const Triple<R> e{off.x + more, off.y + more, off.z + more};
    Window<R> between_ends;
    open_window(between_ends);
    clip_slab(between_ends, ray.oz, ray.dz, ray.ez, least_direction(ray), 0.0, 1.0);
    // Rays that miss the slab for certain, or have left it, are done with.
    const R from = lane_max(between_ends.enter_first, ray.from);
    const R to = between_ends.exit_last;
    asked = lane_and(asked, from <= to);
    const R stays = R(kSectionStays) * (max_norm(off) + rounding) * lane_sqrt(ray.dd);
    left_over = lane_and(asked, max_norm(cross(a, b)) <= stays);
    const M plain = lane_and(asked, lane_not(left_over));
    if (!lane_any(plain)) return 0;
    LineCrossings<R, M> found(left_over, region.fill());
    // The winding number at `from` follows from the crossings before it, where the ray comes from outside, or from those
    // behind it, where it goes there. A prism's rays do both, and the shorter way is taken; of the others those do along
    // which q grows, or falls.
    const R inf(std::numeric_limits<double>::infinity());
    const bool is_prism = ratio == 1.0;
    const R inverse_square = R(1.0) / (b.x * b.x + b.y * b.y);
    const R along_x = b.x * inverse_square;
    const R along_y = b.y * inverse_square;
    const R s_o = along_x * a.x + along_y * a.y;
    const M by_past = is_prism ? lane_abs(from + s_o) > lane_abs(to + s_o) : b.z >= R(0.0);
    const R spread = lane_abs(along_x) + lane_abs(along_y);
    const R s_slack = R(2.0) * (lane_abs(along_x) * e.x + lane_abs(along_y) * e.y) +
                      R(0x1p-46) * (spread + lane_abs(s_o));
    SectionLines<R, M> lines{a,
                             b,
                             accurate_cross(a, b),
                             e,
                             R(4.0) * (e.x + e.y + e.z) * max_norm(b),
                             from,
                             to,
                             found,
                             is_prism,
                             along_x,
                             along_y,
                             s_o,
                             s_slack,
                             lane_select(by_past, R(0.0) - inf, from),
                             lane_select(by_past, to, inf)};
    walk_lanes<R>(
        region, plain, [&](const Box2& box) RAYMO_INLINE_BODY { return lines.meets(box); },
        [&](std::uint32_t i, M met) RAYMO_INLINE_BODY { lines.meet(region.pieces()[i], met); });
    const R winding = found.before - lane_select(by_past, R(0.0), found.total);
    const int count = found.spans(ray, plain, winding, between_ends, out);
    left_over = lane_and(asked, found.rest);
    return count;
}

/// From places on faces to the normals there, of the rays that are `asked`. Returns for which of them it needs
/// ContourSweep::normal_in_full.
template <class R, class M>
RAYMO_INLINE M contour_sweep_normals(const curves::Region& region, double ratio, R face, M asked,
                                     Triple<R>& p) {
    const double g = 0.5 * (1.0 - ratio);
    const R zero(0.0);
    const M wall = lane_and(asked, face > R(1.5));
    const M top = face > R(0.5);
    const Triple<R> end{zero, zero, lane_select(top, R(1.0), R(-1.0))};
    const R q = R(0.5 * (1.0 + ratio)) - R(g) * p.z;
    const R inverse = R(1.0) / lane_max(q, R(0x1p-60));
    const R x = p.x * inverse;
    const R y = p.y * inverse;
    const WallOfFace<R> at = wall_of_face(face);
    const LaneNormals<R, M> n = lane_normals(region, x, y, at.run, solids::kMostWalls, wall);
    const R nx = n.x * at.sign;
    const R ny = n.y * at.sign;
    // The gradient of n.(x, y) / q(z), times q.
    p.x = lane_select(wall, nx, end.x);
    p.y = lane_select(wall, ny, end.y);
    p.z = lane_select(wall, R(g) * (nx * x + ny * y), end.z);
    return lane_and(wall, lane_not(n.found));
}
