// Normals of the curves of a region at points on them, one or several at a time (see math/lanes.hpp). Included once per
// instruction set, after curves/crossings.inl and curves/walk_lanes.inl; needs curves/region.hpp.

/// How far a point may lie from its curve: hits lie within rounding of it.
inline constexpr double kOnCurve = 0x1p-40;

template <class R, class M>
struct LaneNormals {
    R x, y;   ///< to the right of the curve, of any length > 0
    M found;  ///< others need Region::normal
};

/// What Region::normal tells, of the points that are `asked`. `run`: as there, a whole number.
template <class R, class M>
RAYMO_INLINE LaneNormals<R, M> lane_normals(const curves::Region& region, R px, R py, R run,
                                            std::uint32_t modulus, M asked) {
    const R zero(0.0);
    const R one(1.0);
    const R margin(kOnCurve);
    LaneNormals<R, M> out{zero, zero, lane_and(asked, lane_not(asked))};
    R least(kOnCurve * kOnCurve);
    walk_lanes<R>(
        region, asked,
        [&](const Box2& box) RAYMO_INLINE_BODY {
            return lane_and(lane_and(px >= R(box.lo.x) - margin, px <= R(box.hi.x) + margin),
                            lane_and(py >= R(box.lo.y) - margin, py <= R(box.hi.y) + margin));
        },
        [&](std::uint32_t i, M met) RAYMO_INLINE_BODY {
            const curves::Piece& piece = region.pieces()[i];
            met = lane_and(met, run == R(static_cast<double>(piece.run % modulus)));
            if (!lane_any(met)) return;
            const double wide = std::fabs(piece.x[3] - piece.x[0]);
            const double high = std::fabs(piece.y[3] - piece.y[0]);
            const bool by_x = wide >= high;
            R f[4];
            for (std::size_t k = 0; k < 4; ++k) {
                f[k] =
                    by_x ? R(piece.x[k]) - R(piece.w[k]) * px : R(piece.y[k]) - R(piece.w[k]) * py;
            }
            const M first = f[0] < zero;
            const M last = f[3] < zero;
            const M crosses =
                lane_or(lane_and(first, lane_not(last)), lane_and(last, lane_not(first)));
            R u = lane_select(lane_abs(f[0]) <= lane_abs(f[3]), zero, one);
            if (lane_any(lane_and(met, crosses)))
                u = lane_select(crosses, lane_crossing<3>(f, lane_and(met, crosses)), u);
            const LaneJet<R> x = lane_jet(piece.x, u);
            const LaneJet<R> y = lane_jet(piece.y, u);
            const LaneJet<R> w = lane_jet(piece.w, u);
            const R inverse = one / w.value;
            const R dx = x.value * inverse - px;
            const R dy = y.value * inverse - py;
            const R distance = dx * dx + dy * dy;
            const R tx = x.slope * w.value - x.value * w.slope;
            const R ty = y.slope * w.value - y.value * w.slope;
            const M closer = lane_and(met, distance < least);
            // Where the tangent vanishes, another way is needed.
            const M clear = lane_max(lane_abs(tx), lane_abs(ty)) >
                            R(0x1p-26 * std::max(wide, high)) * w.value * w.value;
            least = lane_select(closer, distance, least);
            out.found = lane_or(lane_and(out.found, lane_not(closer)), lane_and(closer, clear));
            out.x = lane_select(closer, ty, out.x);
            out.y = lane_select(closer, zero - tx, out.y);
        });
    return out;
}
