#include "raymo/solids/contour_sweep.hpp"

#include <cmath>
#include <limits>

#include "raymo/curves/roots.hpp"
#include "raymo/math/lanes.hpp"
#include "raymo/math/tolerance.hpp"
#include "raymo/solids/crossings.hpp"
#include "raymo/solids/lane_kernels.hpp"

namespace raymo::solids {
namespace {

#include "raymo/math/triple.inl"
#include "raymo/solids/swept_kernels.inl"
//
#include "raymo/solids/contour_sweep.inl"

using curves::Piece;
using curves::Region;
using curves::Side;
using curves::value_at;

/// Faces of the ends.
constexpr std::uint16_t kBottom = 0;
constexpr std::uint16_t kTop = 1;

/// Pieces that a grazing ray is followed along, at most.
constexpr int kMostFollowed = 6;

/// The normal of the plane through the ray and the tip.
Vec3 plane_normal(Vec3 a, Vec3 b) {
    const auto n = accurate_cross(Triple<double>{a.x, a.y, a.z}, Triple<double>{b.x, b.y, b.z});
    return {n.x, n.y, n.z};
}

/// The ray in the space of (x, y, q), and the pieces of the contour that it may meet.
class SectionLine {
public:
    SectionLine(const Region& region, Vec3 a, Vec3 b, Vec3 e, Crossings& out)
        : region_(region), a_(a), b_(b), n_(plane_normal(a, b)), e_(e), out_(out) {
        e_ += Vec3{1.0, 1.0, 1.0} * (16.0 * kUnitRoundoff * std::max(1.0, max_norm(a)));
        most_noise_ = 4.0 * (e_.x + e_.y + e_.z) * max_norm(b);
    }

    void meet_all() {
        region_.walk(
            [&](const Box2& box) {
                const Vec2 c = box.centre();
                const Vec2 half = box.size() * 0.5;
                const double f = n_.x * c.x + n_.y * c.y + n_.z;
                return std::fabs(f) <=
                       (std::fabs(n_.x) * half.x + std::fabs(n_.y) * half.y) * (1.0 + 0x1p-40) +
                           most_noise_;
            },
            [&](std::uint32_t i) { meet(i); });
    }

private:
    [[nodiscard]] static Vec3 control(const Piece& piece, std::size_t k) {
        return {piece.x[k], piece.y[k], piece.w[k]};
    }
    [[nodiscard]] curves::Bernstein<3> heights(const Piece& piece) const {
        curves::Bernstein<3> f;
        for (std::size_t k = 0; k < 4; ++k) f[k] = dot(n_, control(piece, k));
        return f;
    }
    [[nodiscard]] static Vec3 point(const Piece& piece, double u) {
        return {curves::jet_at(piece.x, u).value, curves::jet_at(piece.y, u).value,
                curves::jet_at(piece.w, u).value};
    }
    [[nodiscard]] static Vec3 derivative_at(const Piece& piece, double u) {
        return {curves::jet_at(piece.x, u).slope, curves::jet_at(piece.y, u).slope,
                curves::jet_at(piece.w, u).slope};
    }
    /// Where the ray is next to the line through the tip and P.
    [[nodiscard]] double place(Vec3 p) const {
        const Vec3 m = cross(b_, p);
        return -dot(cross(a_, p), m) / dot(m, m);
    }
    [[nodiscard]] bool is_ahead(Vec3 p, double s) const { return dot(a_ + b_ * s, p) > 0.0; }
    [[nodiscard]] double noise(Vec3 p) const { return dot(e_, abs(cross(b_, p))); }
    /// ds at a point with derivative dp; `slope` gets B.T.
    [[nodiscard]] double spread(Vec3 p, Vec3 dp, double& slope) const {
        const Vec3 t = cross(dp, p);
        slope = dot(b_, t);
        return dot(e_, abs(t)) / std::fabs(slope);
    }

    void meet(std::uint32_t i) {
        const Piece& piece = region_.pieces()[i];
        const curves::Bernstein<3> f = heights(piece);
        const auto [least, most] = std::minmax_element(f.begin(), f.end());
        if (*least > most_noise_ || *most < -most_noise_) return;
        if (curves::sign_changes(f) == 1) {
            cross_at(i, f, curves::crossing_of<3>(f), f[0] < 0.0);
        } else {
            curves::RootList<3> roots;
            curves::find_roots<3>(f, most_noise_, roots);
            for (const curves::Root& root : roots) {
                if (root.crosses) {
                    cross_at(i, f, root.u, root.rises);
                } else {
                    come_near(i, root.u);
                }
            }
        }
        // A corner, or an end, that the ray may or may not reach.
        const Piece& next = region_.pieces()[piece.next];
        const Vec3 corner = control(piece, 3);
        if (std::fabs(f[3]) > noise(corner)) return;
        const curves::Bernstein<3> g = heights(next);
        if ((f[3] - f[2]) * (g[1] - g[0]) <= 0.0) come_near(i, 1.0);
    }

    void cross_at(std::uint32_t i, const curves::Bernstein<3>& f, double u, bool rises) {
        const Piece& piece = region_.pieces()[i];
        const Vec3 p = point(piece, u);
        const double s = place(p);
        const Vec3 dp = derivative_at(piece, u);
        double slope;
        double error = spread(p, dp, slope);
        const double df = std::fabs(dot(n_, dp));
        const double ddf = 6.0 * std::max(std::fabs(f[0] - 2.0 * f[1] + f[2]),
                                          std::fabs(f[1] - 2.0 * f[2] + f[3]));
        const double off = noise(p);
        const int turn = rises ? 1 : -1;
        const double du = off / df;
        // Next to a cusp the tangent itself turns.
        double bend = 0.0;
        for (const std::size_t k : {0U, 1U}) {
            bend = std::max(bend, max_norm(control(piece, k) - control(piece, k + 1) * 2.0 +
                                           control(piece, k + 2)));
        }
        if (!(24.0 * bend * du < max_norm(dp) && df * df > 8.0 * ddf * off && du < kSectionNarrow &&
              error < Aabb::kInf)) {
            follow({s, s, s, turn, piece.run}, i, u, 2.0 * off);
            return;
        }
        if (!is_ahead(p, s)) return;
        if (u < du || u + du > 1.0) {
            const Piece& other = region_.pieces()[u < du ? piece.previous : piece.next];
            const double end = u < du ? 1.0 : 0.0;
            double other_slope;
            const double other_error =
                spread(point(other, end), derivative_at(other, end), other_slope);
            if (!(other_error < Aabb::kInf)) {
                follow({s, s, s, turn, piece.run}, i, u, 2.0 * off);
                return;
            }
            if ((other_slope < 0.0) == (slope < 0.0)) error = std::max(error, other_error);
        }
        error = 1.25 * error + 8.0 * kUnitRoundoff * std::fabs(s);
        out_.add({s, s - error, s + error, turn, piece.run});
    }

    void come_near(std::uint32_t i, double u) {
        const Piece& piece = region_.pieces()[i];
        const double s = place(point(piece, u));
        follow({s, s, s, 0, piece.run}, i, u, 2.0 * most_noise_);
    }

    /// Widens a crossing by all of the contour about it where |f| <= off.
    void follow(Crossing crossing, std::uint32_t i, double u, double off) {
        int ahead = is_ahead(point(region_.pieces()[i], u), crossing.s) ? 1 : 0;
        int places = 1;
        for (const bool forward : {false, true}) {
            std::uint32_t at = i;
            double from = u;
            for (int steps = 0;; ++steps) {
                if (steps == kMostFollowed) {
                    out_.set_degenerate();
                    break;
                }
                const Piece& piece = region_.pieces()[at];
                const double to = first_beyond(heights(piece), from, off, forward);
                const Vec3 p = point(piece, to);
                const double s = place(p);
                ahead += is_ahead(p, s) ? 1 : 0;
                ++places;
                crossing.lo = std::min(crossing.lo, s);
                crossing.hi = std::max(crossing.hi, s);
                if (to != (forward ? 1.0 : 0.0)) break;
                at = forward ? piece.next : piece.previous;
                from = forward ? 0.0 : 1.0;
            }
        }
        if (ahead == 0) return;
        // It passes through q = 0: the ray runs in the wall.
        if (ahead < places || !(crossing.hi - crossing.lo < Aabb::kInf)) {
            out_.set_degenerate();
            return;
        }
        // Beside the way across the contour, the ray's error has a part along the ray.
        const Vec3 p = point(region_.pieces()[i], u);
        const double along = norm(e_) * norm(p) / norm(cross(b_, p)) +
                             8.0 * kUnitRoundoff * std::max(1.0, std::fabs(crossing.s));
        crossing.lo -= along;
        crossing.hi += along;
        out_.add(crossing);
    }

    /// The first u from `from` on, forwards or back, at which |f| >= off; the end of the piece when there is none.
    [[nodiscard]] static double first_beyond(const curves::Bernstein<3>& f, double from, double off,
                                             bool forward) {
        if (std::fabs(value_at(f, from)) > off) return from;
        double first = forward ? 1.0 : 0.0;
        for (const double level : {-off, off}) {
            curves::Bernstein<3> g = f;
            for (double& c : g) c -= level;
            curves::RootList<3> roots;
            curves::find_roots<3>(g, 0.0, roots);
            for (const curves::Root& root : roots) {
                if (forward ? root.u > from && root.u < first : root.u < from && root.u > first) {
                    first = root.u;
                }
            }
        }
        return first;
    }

    const Region& region_;
    Vec3 a_, b_, n_, e_;
    double most_noise_;
    Crossings& out_;
};

}  // namespace

void ContourSweep::spans(const LocalRay<double>& ray, SpanList& out) const {
    LaneSpans<double, bool, kSweptSpans> lanes;
    bool left_over = false;
    const int count = contour_sweep_spans(*region_, ratio_, ray, true, lanes, left_over);
    if (left_over) {
        spans_in_full(ray, out);
    } else {
        append(lanes, count, out);
    }
}

void ContourSweep::spans_in_full(const LocalRay<double>& ray, SpanList& out) const {
    const double g = shrink();
    const Vec3 a{ray.ox, ray.oy, middle() - g * ray.oz};
    const Vec3 b{ray.dx, ray.dy, -g * ray.dz};
    const Vec3 e{ray.ex, ray.ey, g * ray.ez};
    const double length = std::sqrt(ray.dd);
    Window<double> between_ends;
    open_window(between_ends);
    clip_slab(between_ends, ray.oz, ray.dz, ray.ez, least_direction(ray), kBottom, kTop);
    bool touched = false;
    const auto touch = [&](double lo, double hi) {
        // Beyond the ends there is nothing to touch.
        lo = std::max(lo, between_ends.enter_first);
        hi = std::min(hi, between_ends.exit_last);
        if (lo > hi) return;
        // Two can not be told, and one that is long is a ray in the wall.
        if (touched || (hi - lo) * length > kDegenerate) out.set_degenerate();
        touched = true;
        out.set_touch(lo, hi);
    };
    const auto emit = [&](const SpanEnd& enter, const SpanEnd& exit) {
        Window<double> w = between_ends;
        if (!std::isinf(enter.s)) clip_enter<double>(w, enter.s, enter.error, enter.face);
        if (!std::isinf(exit.s)) clip_exit<double>(w, exit.s, exit.error, exit.face);
        LaneSpans<double, bool, 1> lanes;
        close_window(w, ray, ray.dd > 0.0, 0, lanes);
        if (lanes.degenerate) out.set_degenerate();
        if (lanes.touched) touch(lanes.touch_lo, lanes.touch_hi);
        if (!lanes.valid[0]) return;
        out.push(
            {{lanes.enter[0], lanes.enter_error[0],
              static_cast<std::uint16_t>(lanes.enter_face[0])},
             {lanes.exit[0], lanes.exit_error[0], static_cast<std::uint16_t>(lanes.exit_face[0])}});
    };

    const Vec3 error = e + Vec3{1.0, 1.0, 1.0} * (16.0 * kUnitRoundoff);
    if (max_norm(cross(a, b)) <= kSectionStays * max_norm(error) * length) {
        if (std::fabs(ray.dz) <= 0x1p-20 * length) {  // at the height of the tip
            if (std::fabs(ray.oz) <= 1.0 + ray.ez) out.set_degenerate();
            return;
        }
        // Where q = 1 it is asked about. From there to q the ray moves by less than off / q in the section.
        const double base = (-1.0 - ray.oz) / ray.dz;
        const Vec3 p = a + b * base;
        const double off = 8.0 * kSectionStays * max_norm(error);
        const bool to_tip = ratio_ < std::sqrt(off);
        const double margin = to_tip ? std::sqrt(off) : off / ratio_;
        const Side side = region_->where({p.x / p.z, p.y / p.z}, {margin, margin});
        if (side == Side::out) return;
        if (side == Side::on) out.set_degenerate();
        // Not known at the tip is what comes after q = off / margin.
        const SpanEnd tip{-a.z / b.z, off / (margin * std::fabs(b.z)), kTop};
        emit(to_tip && b.z > 0.0 ? tip : SpanEnd{-Aabb::kInf, 0.0, 0},
             to_tip && b.z < 0.0 ? tip : SpanEnd{Aabb::kInf, 0.0, 0});
        return;
    }
    Crossings crossings;
    SectionLine line(*region_, a, b, e, crossings);
    line.meet_all();
    if (crossings.degenerate()) out.set_degenerate();
    // The way from the tip outwards is that of the ray where q grows along it.
    if (b.z >= 0.0) {
        crossings.resolve(*region_, false, emit, touch);
    } else {
        SmallList<Span, 8> spans;
        crossings.resolve(
            *region_, true,
            [&](const SpanEnd& enter, const SpanEnd& exit) {
                spans.push_back({enter, exit});
            },
            touch);
        for (std::size_t i = spans.size(); i-- > 0;) emit(spans[i].enter, spans[i].exit);
    }
}

Aabb ContourSweep::bounds(const Affine& map) const {
    Aabb box;
    for (int i = 0; i < 3; ++i) {
        const Vec3 n = map.linear.row[static_cast<std::size_t>(i)];
        const double most = region_->support({n.x, n.y});
        const double least = -region_->support({-n.x, -n.y});
        box.lo[i] = map.offset[i] + std::min(least - n.z, ratio_ * least + n.z);
        box.hi[i] = map.offset[i] + std::max(most - n.z, ratio_ * most + n.z);
    }
    return box;
}

Vec3 ContourSweep::normal(Vec3 p, std::uint16_t face) const {
    Triple<double> n{p.x, p.y, p.z};
    if (contour_sweep_normals(*region_, ratio_, static_cast<double>(face), true, n))
        return normal_in_full(p, face);
    return {n.x, n.y, n.z};
}

Vec3 ContourSweep::normal_in_full(Vec3 p, std::uint16_t face) const {
    if (face == kBottom) return {0.0, 0.0, -1.0};
    if (face == kTop) return {0.0, 0.0, 1.0};
    const std::uint32_t wall = face - kFirstWall;
    const double q = middle() - shrink() * p.z;
    const double inverse = 1.0 / std::max(q, 0x1p-60);
    const Vec2 section{p.x * inverse, p.y * inverse};
    Vec2 n = region_->normal(section, wall / 2, kMostWalls);
    if ((wall & 1U) != 0) n = -n;
    // The gradient of n.(x, y) / q(z), times q.
    return {n.x, n.y, shrink() * dot(n, section)};
}

Where ContourSweep::where(Vec3 p, Vec3 e) const {
    const double g = shrink();
    const double q = middle() - g * p.z;
    const double slack = e.z + 2.0 * kUnitRoundoff;
    const double depth = 1.0 - std::fabs(p.z);
    if (depth < -slack) return Where::out;
    if (!(q > 4.0 * g * slack)) return Where::on;  // at the tip
    const Vec2 section{p.x / q, p.y / q};
    const double off = g * e.z;
    const Vec2 margin{(e.x + off * std::fabs(section.x)) / q * 1.5,
                      (e.y + off * std::fabs(section.y)) / q * 1.5};
    const Side side = region_->where(section, margin);
    if (side == Side::out) return Where::out;
    return side == Side::in && depth > slack ? Where::in : Where::on;
}

std::span<const std::string_view> ContourSweep::faces() const {
    static constexpr std::array<std::string_view, 3> kFaces{"bottom", "top", "side"};
    static constexpr std::array<std::string_view, 3> kFlipped{"top", "bottom", "side"};
    return flipped_ ? kFlipped : kFaces;
}

Result<FramedRegion> frame_region(const curves::Outline& outline, bool centred) {
    Box2 box;
    for (const curves::Curve& curve : outline.curves) {
        for (const curves::Span2& span : curve.spans) box.include(curves::box_of(span));
    }
    FramedRegion out;
    if (centred && !box.empty()) out.centre = box.centre();
    const Vec2 far{
        std::max(std::fabs(box.lo.x - out.centre.x), std::fabs(box.hi.x - out.centre.x)),
        std::max(std::fabs(box.lo.y - out.centre.y), std::fabs(box.hi.y - out.centre.y))};
    const double radius = max_norm(far);
    if (!(radius > 0.0) || !std::isfinite(radius) || !is_finite(out.centre)) {
        return fail(ErrorCode::bad_argument, "the contour encloses nothing",
                    "give points that are not all the same");
    }
    if (!(radius >= 1e-90 && radius <= 1e90)) {
        return fail(ErrorCode::out_of_range, "the contour is too large or too small",
                    "keep its points between 1e-90 and 1e90");
    }
    out.size = std::ldexp(1.0, std::ilogb(radius) + 1);
    auto region = curves::Region::make(outline, out.centre, 1.0 / out.size);
    if (!region) return Failure(std::move(region).error());
    out.region = std::move(*region);
    return out;
}

}  // namespace raymo::solids
