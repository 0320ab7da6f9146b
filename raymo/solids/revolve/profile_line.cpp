#include "raymo/solids/revolve/profile_line.hpp"

#include <array>
#include <cmath>

#include "raymo/curves/roots.hpp"
#include "raymo/math/tolerance.hpp"

namespace raymo::solids {

using curves::Bernstein;
using curves::derivative;
using curves::Piece;
using curves::product;
using curves::sum_of;
using curves::value_at;

namespace {

/// Nearer to the axis than this many times its error a ray along it is taken to be at that distance: on the axis itself the
/// contour is never crossed.
constexpr double kOffAxis = 1024.0;

/// A, at a zero of F that is known to a unit roundoff or two, is wrong by less than this part of its largest coefficient: A' is
/// at most 6 times that, and the evaluation adds as much again.
constexpr double kBlurred = 16.0 * kUnitRoundoff;

/// How far behind a zero that was found the sign must have changed.
constexpr double kBeyond = 0x1p-48;

/// Parts shorter than this are not halved again.
constexpr double kShortest = 0x1p-44;

Bernstein<6> square_sum(const Bernstein<3>& a, const Bernstein<3>& b, const Bernstein<3>& c) {
    return sum_of(sum_of(product(a, a), product(b, b), 1.0), product(c, c), -1.0);
}

/// Lengths here are near 1, or may as well be 0: no need for what std::hypot does about very large and small ones.
double length_of(double x, double y) { return std::sqrt(x * x + y * y); }

bool is_monotone(const Bernstein<6>& f) {
    bool rises = true;
    bool falls = true;
    for (std::size_t i = 0; i < 6; ++i) {
        rises = rises && f[i + 1] >= f[i];
        falls = falls && f[i + 1] <= f[i];
    }
    return rises || falls;
}

/// A zero of f in [0, 1] by Newton's method, kept within a bracket; f(u, value, slope) has different signs at 0 and 1. It
/// begins in the middle: at an end f may be nearly zero, and its sign there as good as none.
template <class F>
double bracketed_zero(F&& f, bool rises) {
    double lo = 0.0;
    double hi = 1.0;
    double u = 0.5;
    double step = 1.0;
    for (int i = 0; i < 100; ++i) {
        double value, slope;
        f(u, value, slope);
        if (value == 0.0) return u;
        const bool below = (value < 0.0) == rises;  // the zero is above u
        (below ? lo : hi) = u;
        double next = u - value / slope;
        // Steps that do not get shorter, or lead out of the bracket, are halvings instead.
        if (!(next > lo && next < hi) || std::fabs(next - u) > 0.5 * step) next = 0.5 * (lo + hi);
        step = std::fabs(next - u);
        if (hi - lo <= 0x1p-53) return next;
        if (step <= 0x1p-53) {
            // Next to an end that is nearly zero itself, steps are short without a zero: there must be one close by.
            const double beyond = next + (below ? kBeyond : -kBeyond);
            if (!(beyond > lo && beyond < hi)) return next;
            f(beyond, value, slope);
            if (((value < 0.0) == rises) != below) return next;
            (below ? lo : hi) = beyond;
            next = 0.5 * (lo + hi);
            step = 1.0;
        }
        u = next;
    }
    return u;
}

}  // namespace

ProfileLine::ProfileLine(const curves::Region& region, const LocalRay<double>& ray, Crossings& out)
    : region_(region),
      o_{ray.ox, ray.oy, ray.oz},
      d_{ray.dx, ray.dy, ray.dz},
      e_{ray.ex, ray.ey, ray.ez},
      length_(std::sqrt(ray.dd)),
      across_(length_of(ray.dx, ray.dy)),
      out_(out) {
    const double rounding = 32.0 * kUnitRoundoff * std::max(1.0, max_norm(o_));
    e_ += Vec3{rounding, rounding, rounding};
    const double up = std::fabs(d_.z);
    if (across_ <= kProfileExact * length_) {
        slant_ = Slant::upright;
        rho_ = length_of(o_.x, o_.y);
        const double least = kOffAxis * std::max(e_.x, e_.y);
        if (rho_ < least) {
            rho_ = least;
            e_.x += 2.0 * least;
            e_.y += 2.0 * least;
        }
        return;
    }
    slant_ =
        up <= kProfileExact * length_ ? Slant::level : (up <= across_ ? Slant::flat : Slant::steep);
    s_c_ = -(o_.x * d_.x + o_.y * d_.y) / (across_ * across_);
    z_c_ = o_.z + s_c_ * d_.z;
    rho_ = std::fabs(o_.x * d_.y - o_.y * d_.x) / across_;
    off_ = up * (e_.x + e_.y) + across_ * e_.z;
}

void ProfileLine::meet_all() {
    region_.walk([&](const Box2& box) { return meets(box); },
                 [&](std::uint32_t i) {
                     meet(i);
                     meet_corner(i);
                 });
}

bool ProfileLine::meets(const Box2& box) const {
    const double ez = 4.0 * e_.z;
    const double er = 4.0 * (e_.x + e_.y);
    if (slant_ == Slant::upright) return rho_ >= box.lo.x - er && rho_ <= box.hi.x + er;
    if (slant_ == Slant::level) {
        return o_.z >= box.lo.y - ez && o_.z <= box.hi.y + ez && rho_ <= box.hi.x + er;
    }
    // The stretch of the ray at the box's heights, and how near and far from the axis it is there.
    const double s1 = (box.lo.y - ez - o_.z) / d_.z;
    const double s2 = (box.hi.y + ez - o_.z) / d_.z;
    const double first = std::min(s1, s2) - s_c_;
    const double last = std::max(s1, s2) - s_c_;
    const double far = std::max(std::fabs(first), std::fabs(last)) * across_;
    const double near = first > 0.0 ? first * across_ : (last < 0.0 ? -last * across_ : 0.0);
    const double slack = er + 0x1p-45 * (1.0 + far);
    const double inner = std::max(box.lo.x - slack, 0.0);
    return rho_ * rho_ + far * far >= inner * inner && length_of(rho_, near) <= box.hi.x + slack;
}

void ProfileLine::meet(std::uint32_t i) {
    switch (slant_) {
        case Slant::level:
            return meet_level(i);
        case Slant::upright:
            return meet_upright(i);
        case Slant::flat:
        case Slant::steep:
            return meet_slanted(i);
    }
}

void ProfileLine::meet_level(std::uint32_t i) {
    const Piece& piece = region_.pieces()[i];
    const Cubic h = sum_of(piece.y, piece.w, -o_.z);
    curves::RootList<3> roots;
    curves::find_roots<3>(h, e_.z, roots);
    for (const curves::Root& root : roots) {
        const double r = value_at(piece.x, root.u) / value_at(piece.w, root.u);
        if (r < rho_ - 2.0 * (e_.x + e_.y)) continue;
        if (!root.crosses || r <= rho_) {
            // In a flat wall, or tangent to a circle.
            out_.set_degenerate();
            continue;
        }
        const int turn = root.rises ? 1 : -1;
        cross_at(i, root.u, turn, 1);
        cross_at(i, root.u, -turn, -1);
    }
}

void ProfileLine::meet_upright(std::uint32_t i) {
    const Piece& piece = region_.pieces()[i];
    const Cubic f = sum_of(piece.x, piece.w, -rho_);
    curves::RootList<3> roots;
    curves::find_roots<3>(f, e_.x + e_.y, roots);
    for (const curves::Root& root : roots) {
        if (root.crosses) {
            cross_at(i, root.u, root.rises == (d_.z > 0.0) ? -1 : 1, 1);
        } else {
            out_.set_degenerate();
        }
    }
}

void ProfileLine::meet_slanted(std::uint32_t i) {
    const Piece& piece = region_.pieces()[i];
    const double inner = rho_ - 4.0 * (e_.x + e_.y);
    if (std::max(piece.point(0).x, piece.point(3).x) < inner) return;
    const double off = off_ * curves::size_of(piece.w);
    Part whole{{}, {}, {}, 0.0, 1.0};
    for (std::size_t k = 0; k < 4; ++k) {
        const double w = piece.w[k];
        if (slant_ == Slant::flat) {
            whole.a[k] = across_ * (piece.y[k] - z_c_ * w);
            whole.b[k] = d_.z * rho_ * w;
        } else {
            const double rise = piece.y[k] - o_.z * w;
            whole.a[k] = d_.z * o_.x * w + rise * d_.x;
            whole.b[k] = d_.z * o_.y * w + rise * d_.y;
        }
        whole.c[k] = d_.z * piece.x[k];
    }
    std::array<Part, 64> open;
    std::size_t count = 0;
    open[count++] = whole;
    while (count > 0) {
        const Part part = open[--count];
        const Bernstein<6> f = square_sum(part.a, part.b, part.c);
        const auto [least, most] = std::minmax_element(f.begin(), f.end());
        const double reach = curves::size_of(part.a) + curves::size_of(part.b);
        const double noise = off * (2.0 * reach + off);
        if (*least > noise || *most < -noise) continue;
        if (slant_ == Slant::flat && is_within(part, inner / rho_)) continue;
        const int changes = curves::sign_changes(f);
        const double width = part.hi - part.lo;
        const bool rises = f[0] < 0.0;
        if (changes == 1) {
            const double u = bracketed_zero(
                [&](double v, double& value, double& slope) {
                    const curves::Jet a = curves::jet_at(part.a, v);
                    const curves::Jet b = curves::jet_at(part.b, v);
                    const curves::Jet c = curves::jet_at(part.c, v);
                    value = a.value * a.value + b.value * b.value - c.value * c.value;
                    slope = 2.0 * (a.value * a.slope + b.value * b.slope - c.value * c.slope);
                },
                rises);
            const int half = slant_ == Slant::flat ? half_of(part, u, rises) : 1;
            if (half != 0) {
                cross_at(i, part.lo + width * u, rises == (d_.z > 0.0) ? 1 : -1, half);
                continue;
            }
        }
        if (changes == 0 && is_monotone(f)) continue;
        // By the signs of F at the ends, which the neighbours see, too.
        const bool outside = f[0] >= 0.0 && f[6] >= 0.0;
        if (slant_ == Slant::flat && changes == 2 && outside && split_halves(i, part)) continue;
        if (width <= kShortest || (*most <= noise && *least >= -noise)) {
            // Tangent, or in the wall.
            out_.set_degenerate();
            continue;
        }
        Part left{{}, {}, {}, part.lo, part.lo + 0.5 * width};
        Part right{{}, {}, {}, left.hi, part.hi};
        curves::split(part.a, 0.5, left.a, right.a);
        curves::split(part.b, 0.5, left.b, right.b);
        curves::split(part.c, 0.5, left.c, right.c);
        open[count++] = right;
        open[count++] = left;
    }
}

bool ProfileLine::is_within(const Part& part, double share) const {
    for (std::size_t k = 0; k < 4; ++k) {
        if (!(std::fabs(part.c[k]) < share * std::fabs(part.b[k]))) return false;
    }
    return true;
}

int ProfileLine::half_of(const Part& part, double u, bool rises) const {
    double a = value_at(part.a, u);
    if (std::fabs(a) <= kBlurred * curves::size_of(part.a)) {
        const Bernstein<6> k =
            sum_of(product(part.c, part.c), product(part.b, part.b), -1.0);  // C^2 - B^2
        if (!(*std::min_element(k.begin(), k.end()) > 0.0)) return 0;
        a = rises ? part.a[3] : part.a[0];
    }
    return (a > 0.0) == (d_.z > 0.0) ? 1 : -1;
}

bool ProfileLine::split_halves(std::uint32_t i, const Part& part) {
    if (curves::sign_changes(part.a) != 1) return false;
    const Bernstein<6> k =
        sum_of(product(part.c, part.c), product(part.b, part.b), -1.0);  // C^2 - B^2
    if (!(*std::min_element(k.begin(), k.end()) > 0.0)) return false;
    const double first = std::sqrt(k[0]);
    const double last = std::sqrt(k[6]);
    const bool rises = part.a[0] < 0.0;
    for (const double half : {1.0, -1.0}) {
        if ((part.a[0] - half * first < 0.0) != rises) return false;
        if ((part.a[3] - half * last < 0.0) == rises) return false;
    }
    for (const double half : {1.0, -1.0}) {
        const double u = bracketed_zero(
            [&](double v, double& value, double& slope) {
                const curves::Jet a = curves::jet_at(part.a, v);
                const curves::Jet b = curves::jet_at(part.b, v);
                const curves::Jet c = curves::jet_at(part.c, v);
                const double square = (c.value - b.value) * (c.value + b.value);
                const double root = std::sqrt(std::max(square, 0.0));
                value = a.value - half * root;
                slope = a.slope - half * (c.value * c.slope - b.value * b.slope) / root;
            },
            rises);
        // The half on which z - z_c, and with it d.z (s - s_c), is positive.
        const int side = (half > 0.0) == (d_.z > 0.0) ? 1 : -1;
        cross_at(i, part.lo + (part.hi - part.lo) * u, rises == (side > 0) ? 1 : -1, side);
    }
    return true;
}

double ProfileLine::place(Vec2 p, int half) const {
    if (slant_ == Slant::upright || slant_ == Slant::steep) return (p.y - o_.z) / d_.z;
    const double along = std::sqrt(std::max((p.x - rho_) * (p.x + rho_), 0.0));
    const double rise = p.y - z_c_;
    // By the height, or by the radius: whichever is told better.
    if (slant_ == Slant::flat && along * across_ <= p.x * std::fabs(d_.z)) {
        return s_c_ + rise / d_.z;
    }
    return s_c_ + half * along / across_;
}

void ProfileLine::slope_at(const Piece& piece, double u, double s, double& slope,
                           double& ds) const {
    const Vec2 t = curves::tangent(piece, u);
    const double x = o_.x + s * d_.x;
    const double y = o_.y + s * d_.y;
    const double r = length_of(x, y);
    const double inverse = r > 0.0 ? 1.0 / r : 0.0;
    const Vec3 n{t.y * x * inverse, t.y * y * inverse, -t.x};
    const double size = std::sqrt(dot(n, n));
    slope = dot(n, d_) / size;
    ds = dot(abs(n), e_) / (size * std::fabs(slope));
}

double ProfileLine::across_section(double s, double way) const {
    const double x = o_.x + s * d_.x;
    const double y = o_.y + s * d_.y;
    const double r = length_of(x, y);
    const double ds = way / length_;
    // r'' is at most across^2 / r, and r no less than r - way.
    const double turn = 0.5 * across_ * across_ * ds * ds / std::max(r - way, 0x1p-200);
    const double outwards = std::fabs(x * d_.x + y * d_.y) / std::max(r, 0x1p-200);
    return (outwards + std::fabs(d_.z)) * ds + turn + norm(e_);
}

void ProfileLine::cross_at(std::uint32_t i, double u, int turn, int half) {
    const Piece& piece = region_.pieces()[i];
    const Vec2 p = curves::point_at(piece, u);
    const double s = place(p, half);
    double slope, ds;
    slope_at(piece, u, s, slope, ds);
    if (!(ds < Aabb::kInf) || !(std::fabs(s) < Aabb::kInf)) {
        out_.set_degenerate();
        return;
    }
    // How far the crossing may be off, and by how much the normal turns over that way.
    const double way = ds * length_ + max_norm(e_);
    const Vec2 t = curves::tangent(piece, u);
    const double w = value_at(piece.w, u);
    const double speed = length_of(t.x, t.y) / (w * w);
    double bend = 0.0;
    for (const std::size_t k : {0U, 1U}) {
        bend = std::max({bend, std::fabs(piece.x[k] - 2.0 * piece.x[k + 1] + piece.x[k + 2]),
                         std::fabs(piece.y[k] - 2.0 * piece.y[k + 1] + piece.y[k + 2]),
                         std::fabs(piece.w[k] - 2.0 * piece.w[k + 1] + piece.w[k + 2])});
    }
    const double du = std::min(way, across_section(s, way)) / speed;
    const double round = std::fabs(t.y) / length_of(t.x, t.y) / std::max(p.x, 0x1p-200);
    if (!(16.0 * bend * du / speed + round * way <= kProfileSteady * std::fabs(slope) / length_)) {
        out_.set_degenerate();
        return;
    }
    double error = ds;
    if (u < du || u + du > 1.0) {
        const bool before = u < du;
        const Piece& other = region_.pieces()[before ? piece.previous : piece.next];
        double other_slope, other_ds;
        slope_at(other, before ? 1.0 : 0.0, s, other_slope, other_ds);
        if ((other_slope < 0.0) == (slope < 0.0)) {
            if (!(other_ds < Aabb::kInf)) {
                out_.set_degenerate();
                return;
            }
            error = std::max(error, other_ds);
        }
    }
    error = 1.5 * error + 8.0 * kUnitRoundoff * std::fabs(s);
    out_.add({s, s - error, s + error, turn, piece.run});
}

void ProfileLine::meet_corner(std::uint32_t i) {
    const Piece& piece = region_.pieces()[i];
    const Vec2 p = piece.point(3);
    const double er = 4.0 * (e_.x + e_.y);
    // On the axis, where the wall has a tip or a pole: a ray through it may meet every side of it.
    for (const std::size_t end : {0U, 3U}) {
        const Vec2 tip = piece.point(end);
        if (tip.x > er) continue;
        const Vec3 to = Vec3{0.0, 0.0, tip.y} - o_;
        const Vec3 off = abs(to - d_ * (dot(to, d_) / (length_ * length_)));
        if (off.x <= er && off.y <= er && off.z <= 4.0 * e_.z && slant_ != Slant::upright)
            out_.set_degenerate();
    }
    if (p.x <= er) return;
    const bool halves = slant_ == Slant::level || slant_ == Slant::flat;
    for (const int half : {1, -1}) {
        if (!halves && half < 0) break;
        double s = place(p, half);
        if (halves) {
            s = s_c_ + half * std::sqrt(std::max((p.x - rho_) * (p.x + rho_), 0.0)) / across_;
        }
        const Vec3 at = o_ + s * d_;
        if (!(std::fabs(length_of(at.x, at.y) - p.x) <= er &&
              std::fabs(at.z - p.y) <= 4.0 * e_.z)) {
            continue;
        }
        const Piece& next = region_.pieces()[piece.next];
        double slope, ds, next_slope, next_ds;
        slope_at(piece, 1.0, s, slope, ds);
        slope_at(next, 0.0, s, next_slope, next_ds);
        if (slope * next_slope > 0.0) continue;
        const double error = 4.0 * std::max(ds, next_ds) + 8.0 * kUnitRoundoff * std::fabs(s);
        if (!(error < Aabb::kInf)) {
            out_.set_degenerate();
            return;
        }
        out_.add({s, s - error, s + error, 0, piece.run});
    }
}

}  // namespace raymo::solids
