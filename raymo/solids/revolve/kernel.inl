// Spans of a turned contour (revolve.hpp) for one ray or several (see math/lanes.hpp), in the plain case: the ray is neither
// perpendicular nor parallel to the axis, and each piece of the contour is met in certain crossings, away from its ends.
// Other rays are left over for Revolve::Kernel::spans_in_full. The derivation, and the names, are those of
// profile_line.hpp. Included once per instruction set, after solids/swept_kernels.inl.
//
// Flat and steep rays share one form,
//     A = p w + q (z - z0 w),  B = p' w + q' (z - z0 w),  C = d.z x,
// with (p, q, p', q', z0) = (0, sqrt(D), d.z rho, 0, z_c) for flat ones and d.z o.x, d.x, d.z o.y, d.y, o.z for steep ones.

/// Heights of a crossing and of the ray's place nearest to the axis, both at most 2, are known to less than this.
inline constexpr double kProfileBlurred = 64.0 * kUnitRoundoff;

/// Halvings of a piece, at most, before a ray is left over.
inline constexpr int kProfileHalvings = 6;

/// Steps to a zero, at most, before a ray is left over.
inline constexpr int kProfileSteps = 16;

/// A part of a piece in the terms of F.
template <class R>
struct ProfilePart {
    R a[4], b[4], c[4];
};

template <class R>
RAYMO_INLINE void halve(R (&c)[4], R (&left)[4]) {
    const R half(0.5);
    const R m0 = half * (c[0] + c[1]);
    const R m1 = half * (c[1] + c[2]);
    const R m2 = half * (c[2] + c[3]);
    const R n0 = half * (m0 + m1);
    const R n1 = half * (m1 + m2);
    const R middle = half * (n0 + n1);
    left[0] = c[0];
    left[1] = m0;
    left[2] = n0;
    left[3] = c[0] = middle;
    c[1] = n1;
    c[2] = m2;
}

template <class R, class M>
struct ProfileLines {
    Triple<R> o, d, e;
    R length;  ///< |d|
    R across;  ///< sqrt(D)
    R inverse_across, inverse_dz;
    R s_c, z_c, rho;
    R p, q, p2, q2, z0;
    R noise;   ///< of F
    R er, ez;  ///< how near a corner is too near
    R from;    ///< what lies before it does not count (LocalRay)
    M flat;
    M upwards;
    LineCrossings<R, M> found;

    RAYMO_INLINE M meets(const Box2& box) const {
        // The stretch of the ray at the box's heights, and how near and far from the axis it is there.
        const R s1 = (R(box.lo.y) - ez - o.z) * inverse_dz;
        const R s2 = (R(box.hi.y) + ez - o.z) * inverse_dz;
        const R first = lane_min(s1, s2) - s_c;
        const R last = lane_max(s1, s2) - s_c;
        const R far = lane_max(lane_abs(first), lane_abs(last)) * across;
        const R near = lane_max(lane_max(first, R(0.0) - last), R(0.0)) * across;
        const R slack = er + R(0x1p-45) * (R(1.0) + far);
        const R inner = lane_max(R(box.lo.x) - slack, R(0.0));
        const R outer = R(box.hi.x) + slack;
        const M ahead = lane_not(lane_max(s1, s2) < from);
        return lane_and(ahead, lane_and(rho * rho + far * far >= inner * inner,
                                        rho * rho + near * near <= outer * outer));
    }

    RAYMO_INLINE void meet(const curves::Piece& piece, M asked) {
        // Not where all of the piece, which is monotone, is nearer to the axis than the ray.
        const R inner = rho - er;
        asked = lane_and(asked, lane_or(R(piece.x[0]) >= inner * R(piece.w[0]),
                                        R(piece.x[3]) >= inner * R(piece.w[3])));
        if (!lane_any(asked)) return;
        leave_corner(piece, asked);
        ProfilePart<R> part;
        for (int k = 0; k < 4; ++k) {
            const auto i = static_cast<std::size_t>(k);
            const R w(piece.w[i]);
            const R rise = R(piece.y[i]) - z0 * w;
            part.a[k] = p * w + q * rise;
            part.b[k] = p2 * w + q2 * rise;
            part.c[k] = d.z * R(piece.x[i]);
        }
        R f[7];
        square_sum(part, f);
        const LaneSigns<M> signs = lane_signs<6, M>(f, noise);
        M open = lane_and(asked, lane_not(signs.none));
        if (!lane_any(open)) return;
        const M never = lane_and(open, lane_not(open));
        Search first{part, R(0.0), R(1.0), R(0.0), signs.rises, lane_and(open, signs.one)};
        Search second{part, R(0.0), R(1.0), R(0.0), signs.rises, never};
        open = lane_and(open, lane_not(signs.one));
        // Two crossings that are told apart, or none.
        R lo(0.0);
        double width = 1.0;
        for (int depth = 0; lane_any(open); ++depth) {
            const M apart = lane_and(open, lane_and(flat, has_halves(part, f)));
            if (lane_any(apart)) {
                const M rises = part.a[0] < R(0.0);
                first.take({part, lo, R(width), R(1.0), rises, apart});
                second.take({part, lo, R(width), R(-1.0), rises, apart});
                open = lane_and(open, lane_not(apart));
            }
            if (depth == kProfileHalvings) break;
            ProfilePart<R> left;
            halve(part.a, left.a);
            halve(part.b, left.b);
            halve(part.c, left.c);
            width *= 0.5;
            R g[7];
            square_sum(left, g);
            square_sum(part, f);
            const LaneSigns<M> before = lane_signs<6, M>(g, noise);
            const LaneSigns<M> after = lane_signs<6, M>(f, noise);
            const M two = lane_and(open, lane_and(before.one, after.one));
            if (lane_any(two)) {
                first.take({left, lo, R(width), R(0.0), before.rises, two});
                second.take({part, lo + R(width), R(width), R(0.0), after.rises, two});
            }
            const M to_left =
                lane_and(lane_and(open, after.none), lane_not(lane_or(before.none, before.one)));
            const M to_right =
                lane_and(lane_and(open, before.none), lane_not(lane_or(after.none, after.one)));
            const M done = lane_or(two, lane_and(before.none, after.none));
            leave(lane_and(open, lane_not(lane_or(done, lane_or(to_left, to_right)))));
            open = lane_or(to_left, to_right);
            for (int k = 0; k < 4; ++k) {
                part.a[k] = lane_select(to_left, left.a[k], part.a[k]);
                part.b[k] = lane_select(to_left, left.b[k], part.b[k]);
                part.c[k] = lane_select(to_left, left.c[k], part.c[k]);
            }
            for (int k = 0; k < 7; ++k) f[k] = lane_select(to_left, g[k], f[k]);
            lo = lane_select(to_right, lo + R(width), lo);
        }
        leave(open);
        first.there = lane_and(first.there, lane_not(is_past(first.half)));
        second.there = lane_and(second.there, lane_not(is_past(second.half)));
        cross(piece, first);
        if (lane_any(second.there)) cross(piece, second);
    }

private:
    /// One crossing that is looked for in a part of a piece.
    struct Search {
        ProfilePart<R> part;
        R lo, width;  ///< where in the piece
        R half;       ///< +1, -1: on that half of the hyperbola; 0: on either
        M rises;      ///< F does, or g
        M there;

        RAYMO_INLINE void take(const Search& other) {
            for (int k = 0; k < 4; ++k) {
                part.a[k] = lane_select(other.there, other.part.a[k], part.a[k]);
                part.b[k] = lane_select(other.there, other.part.b[k], part.b[k]);
                part.c[k] = lane_select(other.there, other.part.c[k], part.c[k]);
            }
            lo = lane_select(other.there, other.lo, lo);
            width = lane_select(other.there, other.width, width);
            half = lane_select(other.there, other.half, half);
            rises =
                lane_or(lane_and(other.there, other.rises), lane_and(lane_not(other.there), rises));
            there = lane_or(there, other.there);
        }
    };

    /// Whether all of one half of the hyperbola lies before `from`: s <= s_c, or s >= s_c there.
    [[nodiscard]] RAYMO_INLINE M is_past(R half) const {
        const R side = lane_select(upwards, half, R(0.0) - half);
        return lane_and(side < R(-0.5), s_c < from);
    }

    RAYMO_INLINE void leave(M lines) { found.rest = lane_or(found.rest, lines); }

    RAYMO_INLINE static void square_sum(const ProfilePart<R>& part, R (&f)[7]) {
        const R(&a)[4] = part.a;
        const R(&b)[4] = part.b;
        const R(&c)[4] = part.c;
        const auto pair = [&](int i, int j)
                              RAYMO_INLINE_BODY { return a[i] * a[j] + b[i] * b[j] - c[i] * c[j]; };
        f[0] = pair(0, 0);
        f[1] = pair(0, 1);
        f[2] = R(0.6) * pair(1, 1) + R(0.4) * pair(0, 2);
        f[3] = R(0.9) * pair(1, 2) + R(0.1) * pair(0, 3);
        f[4] = R(0.6) * pair(2, 2) + R(0.4) * pair(1, 3);
        f[5] = pair(2, 3);
        f[6] = pair(3, 3);
    }

    /// Whether F has two zeros, one for each half of the hyperbola.
    RAYMO_INLINE M has_halves(const ProfilePart<R>& part, const R (&f)[7]) const {
        const R zero(0.0);
        const R one(1.0);
        // A at both ends: mostly of one sign. Both are outside, by the signs of F, which the neighbours see, too.
        const M low = part.a[0] < zero;
        const M high = part.a[3] < zero;
        M apart = lane_and(lane_or(lane_and(low, lane_not(high)), lane_and(high, lane_not(low))),
                           lane_not(f[0] < zero));
        if (!lane_any(apart)) return apart;
        const LaneSigns<M> signs = lane_signs<3, M>(part.a, zero);
        R changes = zero;
        for (int i = 0; i < 6; ++i) {
            const M here = f[i] < zero;
            const M next = f[i + 1] < zero;
            changes = changes + lane_select(lane_or(lane_and(here, lane_not(next)),
                                                    lane_and(next, lane_not(here))),
                                            one, zero);
        }
        apart = lane_and(lane_and(apart, signs.one), lane_and(changes > R(1.5), changes < R(2.5)));
        if (!lane_any(apart)) return apart;
        // C^2 - B^2
        const R(&b)[4] = part.b;
        const R(&c)[4] = part.c;
        const auto pair = [&](int i, int j) RAYMO_INLINE_BODY { return c[i] * c[j] - b[i] * b[j]; };
        const R k[7] = {pair(0, 0),
                        pair(0, 1),
                        R(0.6) * pair(1, 1) + R(0.4) * pair(0, 2),
                        R(0.9) * pair(1, 2) + R(0.1) * pair(0, 3),
                        R(0.6) * pair(2, 2) + R(0.4) * pair(1, 3),
                        pair(2, 3),
                        pair(3, 3)};
        for (int i = 0; i < 7; ++i) apart = lane_and(apart, k[i] > zero);
        const R first = lane_sqrt(lane_max(k[0], zero));
        const R last = lane_sqrt(lane_max(k[6], zero));
        for (const double half : {1.0, -1.0}) {
            const M begin = part.a[0] - R(half) * first < zero;
            const M end = part.a[3] - R(half) * last < zero;
            apart = lane_and(
                apart, lane_or(lane_and(signs.rises, lane_and(begin, lane_not(end))),
                               lane_and(lane_not(signs.rises), lane_and(lane_not(begin), end))));
        }
        return apart;
    }

    /// Where the parabola through F at the ends and in the middle of a part crosses; on one half, the middle.
    RAYMO_INLINE static R first_guess(const Search& at) {
        const R half(0.5);
        const auto value = [](R a, R b, R c) RAYMO_INLINE_BODY { return a * a + b * b - c * c; };
        const auto middle = [](const R(&p)[4]) RAYMO_INLINE_BODY {
            return R(0.125) * (p[0] + p[3]) + R(0.375) * (p[1] + p[2]);
        };
        const R(&a)[4] = at.part.a;
        const R(&b)[4] = at.part.b;
        const R(&c)[4] = at.part.c;
        const R first = value(a[0], b[0], c[0]);
        const R last = value(a[3], b[3], c[3]);
        const R between = value(middle(a), middle(b), middle(c));
        const R bend = R(2.0) * (first + last) - R(4.0) * between;
        const R slope = R(4.0) * between - R(3.0) * first - last;
        const R root = lane_sqrt(lane_max(slope * slope - R(4.0) * bend * first, R(0.0)));
        const R u = R(-2.0) * first / (slope + lane_select(at.rises, root, R(0.0) - root));
        const M either = lane_and(at.half<half, at.half> R(-0.5));
        const M within = lane_and(u > R(0x1p-10), u < R(1.0 - 0x1p-10));
        return lane_select(lane_and(either, within), u, half);
    }

    /// The place of a crossing in its part: Newton's method within a bracket, until what is left is less than rounding. Behind a
    /// step d that is F'' d^2 / 2 F', with F'' from how the slope has changed over the step before, and of the size that the
    /// last two steps show.
    RAYMO_INLINE R place_in_part(const Search& at) {
        const R zero(0.0);
        const bool any_half =
            lane_any(lane_and(at.there, lane_or(at.half > R(0.5), at.half < R(-0.5))));
        R lo = zero;
        R hi(1.0);
        R u = first_guess(at);
        R found_at(0.5);
        R step(1.0);
        R before = zero;  // the last step, if it was one of Newton's
        R slope_before = zero;
        M active = at.there;
        for (int i = 0; i < kProfileSteps && lane_any(active); ++i) {
            const LaneJet<R> a = lane_jet(at.part.a, u);
            const LaneJet<R> b = lane_jet(at.part.b, u);
            const LaneJet<R> c = lane_jet(at.part.c, u);
            R value = a.value * a.value + b.value * b.value - c.value * c.value;
            R slope = R(2.0) * (a.value * a.slope + b.value * b.slope - c.value * c.slope);
            if (any_half) {
                const M either = lane_and(at.half<R(0.5), at.half> R(-0.5));
                const R square = (c.value - b.value) * (c.value + b.value);
                const R root = lane_sqrt(lane_max(square, R(0x1p-1000)));
                const R turn = (c.value * c.slope - b.value * b.slope) / root;
                value = lane_select(either, value, a.value - at.half * root);
                slope = lane_select(either, slope, a.slope - at.half * turn);
            }
            const M low = value < zero;
            const M below =
                lane_or(lane_and(low, at.rises), lane_and(lane_not(low), lane_not(at.rises)));
            lo = lane_select(below, u, lo);
            hi = lane_select(below, hi, u);
            const R newton = u - value / slope;
            const R way = lane_abs(newton - u);
            const M good = lane_and(lane_and(newton > lo, newton < hi), way <= R(0.5) * step);
            // Next to the zero the bracket may end on its wrong side, by a rounding.
            const R square_of_way = way * way;
            const M settled = lane_and(
                way <= R(0x1p-27), lane_and(lane_abs(slope - slope_before) * square_of_way <=
                                                R(0x1p-53) * lane_abs(slope) * before,
                                            way * square_of_way <= R(0x1p-54) * before * before));
            const M arrives = lane_or(way <= R(0x1p-51), lane_and(good, settled));
            found_at = lane_select(lane_and(active, arrives), lane_min(lane_max(newton, lo), hi),
                                   found_at);
            u = lane_select(good, newton, R(0.5) * (lo + hi));
            slope_before = slope;
            step = lane_select(good, way, R(0.5) * (hi - lo));
            before = lane_select(good, way, zero);
            active = lane_and(active, lane_not(arrives));
        }
        leave(active);
        return found_at;
    }

    /// s of the point of the ray that the point (r, z) of the contour is on, or next to.
    RAYMO_INLINE R place(R r, R z, R half) const {
        const R along = lane_sqrt(lane_max((r - rho) * (r + rho), R(0.0)));
        const R rise = z - z_c;
        const M low = rise < R(0.0);
        const M same = lane_or(lane_and(low, lane_not(upwards)), lane_and(lane_not(low), upwards));
        const M either = lane_and(half<R(0.5), half> R(-0.5));
        const R side = lane_select(either, lane_select(same, R(1.0), R(-1.0)),
                                   lane_select(upwards, half, R(0.0) - half));
        const R by_radius = s_c + side * along * inverse_across;
        const R by_height = lane_select(flat, s_c + rise * inverse_dz, (z - o.z) * inverse_dz);
        const M by = lane_and(flat, along * across > r * lane_abs(d.z));
        return lane_select(by, by_radius, by_height);
    }

    RAYMO_INLINE void cross(const curves::Piece& piece, const Search& at) {
        if (!lane_any(at.there)) return;
        const R u = at.lo + at.width * place_in_part(at);
        const LaneJet<R> x = lane_jet(piece.x, u);
        const LaneJet<R> y = lane_jet(piece.y, u);
        const LaneJet<R> w = lane_jet(piece.w, u);
        const R inverse_w = R(1.0) / w.value;
        const R r = x.value * inverse_w;
        const R tr = x.slope * w.value - x.value * w.slope;
        const R tz = y.slope * w.value - y.value * w.slope;
        const R z = y.value * inverse_w;
        const R s = place(r, z, at.half);
        // Which half it is on must not depend on rounding.
        const M blurred = lane_and(lane_and(flat, lane_abs(z - z_c) <= R(kProfileBlurred)),
                                   lane_and(at.half<R(0.5), at.half> R(-0.5)));
        const R px = o.x + s * d.x;
        const R py = o.y + s * d.y;
        const R inverse_r = R(1.0) / lane_sqrt(px * px + py * py);
        const Triple<R> n{tz * px * inverse_r, tz * py * inverse_r, R(0.0) - tr};
        const R size = lane_sqrt(dot(n, n));
        const R slope = lane_abs(dot(n, d));
        const R ds = dot(abs(n), e) / slope;
        // How far the crossing may be off, and by how much the normal turns over that way.
        const R way = ds * length + max_norm(e);
        const R inverse_speed = w.value * w.value / size;
        const R du = way * inverse_speed;
        const R round = lane_abs(tz) / (size * lane_max(r, R(0x1p-200)));
        const M steady = R(16.0 * piece.bend) * du * inverse_speed + round * way <=
                         R(solids::kProfileSteady) * slope / (size * length);
        const M within = lane_and(du <= u, u + du <= R(1.0));
        const double chord =
            std::max(std::fabs(piece.x[3] - piece.x[0]), std::fabs(piece.y[3] - piece.y[0]));
        const M clear =
            lane_max(lane_abs(tr), lane_abs(tz)) > R(0x1p-26 * chord) * w.value * w.value;
        const M certain =
            lane_and(lane_and(lane_and(steady, within), lane_not(blurred)),
                     lane_and(clear, lane_abs(s) < R(std::numeric_limits<double>::infinity())));
        leave(lane_and(at.there, lane_not(certain)));
        const R error = R(1.5) * ds + R(8.0 * kUnitRoundoff) * lane_abs(s);
        // Towards the side where F is larger; on one half, g as seen from there.
        const M forwards = lane_or(lane_and(at.half > R(-0.5), upwards),
                                   lane_and(at.half < R(-0.5), lane_not(upwards)));
        const M right =
            lane_or(lane_and(at.rises, forwards), lane_and(lane_not(at.rises), lane_not(forwards)));
        found.add_within(lane_and(at.there, certain), s, error, lane_select(right, R(1.0), R(-1.0)),
                         solids::right_wall(piece.run), from,
                         R(std::numeric_limits<double>::infinity()));
    }

    /// Leaves rays that come near the end of a piece, or to where it begins or ends on the axis.
    RAYMO_INLINE void leave_corner(const curves::Piece& piece, M asked) {
        for (const std::size_t end : {0U, 3U}) {
            const Vec2 tip = piece.point(end);
            if (tip.x > 0x1p-20) continue;
            const Triple<R> to{R(0.0) - o.x, R(0.0) - o.y, R(tip.y) - o.z};
            const R along = dot(to, d) / (length * length);
            const Triple<R> off = abs(to - d * along);
            const M near = lane_and(lane_and(off.x <= er, off.y <= er), off.z <= ez);
            leave(lane_and(asked, lane_and(near, R(tip.x) <= er)));
        }
        leave(lane_and(asked, er > R(0x1p-20)));
        // Where the curve runs on smoothly a ray that only touches it finds a zero on both sides.
        if (!piece.ends_in_corner) return;
        const Vec2 corner = piece.point(3);
        const R r(corner.x);
        const R z(corner.y);
        const R steep_s = (z - o.z) * inverse_dz;
        const R x = o.x + steep_s * d.x;
        const R y = o.y + steep_s * d.y;
        const R near_r = lane_abs(lane_sqrt(x * x + y * y) - r);
        const R along = lane_sqrt(lane_max((r - rho) * (r + rho), R(0.0))) * inverse_across;
        const R rise = lane_abs(lane_abs(z - z_c) - along * lane_abs(d.z));
        const M near = lane_or(lane_and(lane_not(flat), near_r <= er),
                               lane_and(flat, lane_and(rho - r <= er, rise <= ez)));
        leave(lane_and(asked, lane_and(near, r > er)));
    }
};

/// Clips to the side n.x <= 0 of a plane through the axis.
template <class R>
RAYMO_INLINE void clip_side(Window<R>& w, const LocalRay<R>& ray, double nx, double ny,
                            double face) {
    const R offset = R(nx) * ray.ox + R(ny) * ray.oy;
    const R along = R(nx) * ray.dx + R(ny) * ray.dy;
    const R slack = R(std::fabs(nx)) * ray.ex + R(std::fabs(ny)) * ray.ey +
                    R(8.0 * kUnitRoundoff) * (lane_abs(ray.ox) + lane_abs(ray.oy) + R(1.0));
    const R slope = lane_copysign(lane_max(lane_abs(along), least_direction(ray)), along);
    const R s = (R(0.0) - offset) / slope;
    const R error = slack / lane_abs(slope);
    const R inf = R(std::numeric_limits<double>::infinity());
    const auto leaves = slope > R(0.0);
    clip_exit(w, lane_select(leaves, s, inf), lane_select(leaves, error, R(0.0)), R(face));
    clip_enter(w, lane_select(leaves, R(0.0) - inf, s), lane_select(leaves, R(0.0), error),
               R(face));
}

/// Returns how many spans `out` has at most. `left_over` gets the rays, of those that are `asked`, that are not plain.
/// `angle`: of the turn [degrees]; `end`: the outward normal of the cut there.
template <class R, class M>
RAYMO_INLINE int revolve_spans(const curves::Region& region, double angle, Vec3 end,
                               const LocalRay<R>& ray, M asked,
                               LaneSpans<R, M, solids::kSweptSpans>& out, M& left_over) {
    const Triple<R> o{ray.ox, ray.oy, ray.oz};
    const Triple<R> d{ray.dx, ray.dy, ray.dz};
    const R rounding = R(32.0 * kUnitRoundoff) * lane_max(R(1.0), max_norm(o));
    const Triple<R> e{ray.ex + rounding, ray.ey + rounding, ray.ez + rounding};
    const R length = lane_sqrt(ray.dd);
    const R across = lane_sqrt(d.x * d.x + d.y * d.y);
    const R up = lane_abs(d.z);
    const R least = R(solids::kProfileExact) * length;
    const M slanted = lane_and(across > least, up > least);
    left_over = lane_and(asked, lane_not(slanted));
    // The parts of the turn that are taken: one wedge, or all but one.
    Window<R> wedge;
    open_window(wedge);
    if (angle < 360.0) {
        Window<R> other;
        open_window(other);
        const bool convex = angle <= 180.0;
        const double side = convex ? 1.0 : -1.0;
        clip_side(convex ? wedge : other, ray, 0.0, -side, 0.0);
        clip_side(convex ? wedge : other, ray, side * end.x, side * end.y, 1.0);
        asked = lane_and(asked, wedge.enter_first <= wedge.exit_last);
        // Where the gap is met a span may become two.
        if (!convex)
            left_over = lane_or(left_over, lane_and(asked, other.enter_first <= other.exit_last));
    }
    const M plain = lane_and(asked, lane_not(left_over));
    if (!lane_any(plain)) {
        left_over = lane_and(asked, left_over);
        return 0;
    }
    const M flat = up <= across;
    const R zero(0.0);
    const R inverse_across = R(1.0) / across;
    const R s_c = (zero - (o.x * d.x + o.y * d.y)) * inverse_across * inverse_across;
    const R z_c = o.z + s_c * d.z;
    const R rho = lane_abs(o.x * d.y - o.y * d.x) * inverse_across;
    ProfileLines<R, M> lines{o,
                             d,
                             e,
                             length,
                             across,
                             inverse_across,
                             R(1.0) / d.z,
                             s_c,
                             z_c,
                             rho,
                             lane_select(flat, zero, d.z * o.x),
                             lane_select(flat, across, d.x),
                             lane_select(flat, d.z * rho, d.z * o.y),
                             lane_select(flat, zero, d.y),
                             lane_select(flat, z_c, o.z),
                             R(2.0) * (up * up * (e.x + e.y) + up * across * e.z),
                             R(4.0) * (e.x + e.y),
                             R(4.0) * e.z,
                             ray.from,
                             flat,
                             d.z > zero,
                             LineCrossings<R, M>(left_over, region.fill())};
    walk_lanes<R>(
        region, plain, [&](const Box2& box) RAYMO_INLINE_BODY { return lines.meets(box); },
        [&](std::uint32_t i, M met) RAYMO_INLINE_BODY { lines.meet(region.pieces()[i], met); });
    // The line ends outside, so what it meets behind its past tells where it was then.
    const R winding = lane_select(ray.from > R(solids::kFromTheBeginning),
                                  lines.found.before - lines.found.total, zero);
    const int count = lines.found.spans(ray, plain, winding, wedge, out);
    left_over = lane_and(asked, lines.found.rest);
    return count;
}

/// From places on faces to the normals there, of the rays that are `asked`. Returns for which of them it needs
/// Revolve::Kernel::normal_in_full.
template <class R, class M>
RAYMO_INLINE M revolve_normals(const curves::Region& region, Vec3 end, R face, M asked,
                               Triple<R>& p) {
    const M wall = lane_and(asked, face > R(1.5));
    const M first = face < R(0.5);
    const R r = lane_sqrt(p.x * p.x + p.y * p.y);
    const WallOfFace<R> at = wall_of_face(face);
    const LaneNormals<R, M> n = lane_normals(region, r, p.z, at.run, solids::kMostWalls, wall);
    const R out = n.x * at.sign / r;
    p.x = lane_select(wall, out * p.x, lane_select(first, R(0.0), R(end.x)));
    p.y = lane_select(wall, out * p.y, lane_select(first, R(-1.0), R(end.y)));
    p.z = lane_select(wall, n.y * at.sign, R(0.0));
    return lane_and(wall, lane_not(lane_and(n.found, r > R(0.0))));
}
