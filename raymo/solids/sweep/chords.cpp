// Chords of a line through one piece of a sweep.
//
// In a frame about the line, with t along it, a sphere of the piece has its centre at (tau, p, q) and the radius a, cubics
// of u. It cuts the line in the chord
//     [t-(u), t+(u)],  t-+ = tau -+ h,  h = sqrt(disc),  disc = a^2 - p^2 - q^2,
// when disc >= 0. Where disc >= 0 over an interval of u, these chords change continuously, so their union is the interval
// from the least t- to the largest t+ (the interval theorem): nothing needs to be known about envelopes, engulfed spheres,
// cusps or self-crossings, and the unions of all pieces are united in turn [Wijk84b], [Wijk86 4].
//
// The thesis' candidates for the extrema are the roots of a polynomial of degree 4n - 2, disc'^2 - 4 tau'^2 disc for cubics
// n = 3. The same extrema are found here without forming it. Let z = +-tau + h, of which the largest value is sought for
// either sign, D1 = disc', D2 = disc''. Then
//     z' = +-tau' + D1 / (2 h),   z'' = +-tau'' - (D1^2 - 2 disc D2) / (4 h^3).
// [0, 1] is halved until over each part, with bounds from Bernstein coefficients (m1 <= |D1| <= M1, m2 <= D2 <= M2,
// l^2 <= disc <= H^2, c2 >= +-tau''), these hold. First, the part has one chord, or none:
//     disc > 0, or D2 < 0, or D1 has one sign.
// Second, for either sign one of
//   concave   B = (m1^2 - 2 H^2 M2) / (4 H^3) - c2 > 0. Then z'' <= -B (the fraction falls with h): there is one maximum.
//   monotone  disc > 0, tau' has one sign, and 2 |tau'| l > M1: the maximum is at an end of the part.
//   convex    disc > 0, and +-tau'' >= (M1^2 + 2 H^2 |m2|) / (4 l^3): so it is.
//   nested    D1 has one sign and |D1| > 2 |tau'| H: each sphere's chord holds the next, so that of the last counts.
//   flat      The larger of both ends comes as near to +-tau + H as it is known.
//   covered   All values lie where the line is inside for certain, in one interval with the chord of an end.
// Parts are dropped when all coefficients of disc are below -E (see below), or when all their chords lie inside for certain.
// The extremum of a concave part is found by steps to the extremum of a model with linear tau and quadratic disc, which is
// where a line meets a cylinder or cone,
//     u + D1 / 2c + m sqrt((disc + D1^2 / 4c) / (c (c + m^2))),  m = +-tau',  c = -(D2 +- 2 tau'' h) / 2,
// exact for linear pieces with one step; that c makes it Newton's near the extremum. Since t+ is concave, it is above the
// value at any u by at most t+'^2 / 2B, the `loss`; steps are made until it is far below the error, and it is added to that.
//
// Error. A place of the line, a centre and a radius together are wrong by at most e. So a sphere of the true solid meets the
// true line only if disc >= -E, E = e (2 a + e), and does if disc >= E. With T(x) the maximum of tau + sqrt(disc + x),
//     dT/dx = 1 / 2h  at the extremum belonging to x,
//     dh^2/dx = (-D2 -+ 2 tau'' h) / (2 tau'^2 - D2 -+ 2 tau'' h), in (0, 1] (or 1, where the extremum is at an end).
// So h grows with x, and T(E) <= T(0) + E / 2h. And where the largest disc is at least 4 E, for linear tau and quadratic disc
// h^2 stays above 3/4 of its value, and T(-E) >= T(0) - 1.16 E / 2h; E / h is taken. A part of which the largest disc is
// less may be entered or not: a `maybe`, which has bounds only.
// Coefficients of disc are wrong by another 8 u of the squares they are made of.
#include "raymo/solids/sweep/chords.hpp"

#include <algorithm>
#include <cmath>

#include "raymo/math/tolerance.hpp"

namespace raymo::solids {
namespace {

constexpr std::size_t kTau = 0, kP = 1, kQ = 2, kRadius = 3;

/// Parts are halved so often at most; there they are shorter than places along the line are known.
constexpr int kMostHalvings = 40;
/// Parts of one piece that are looked at, at most. Transversal lines need less than 10, those along a piece less than 50.
constexpr int kMostParts = 600;

/// The piece in the line's frame.
Cubics seen_along(const SweepLine& line, const Cubics& q) {
    Cubics out;
    for (std::size_t i = 0; i < 4; ++i) {
        const double x = q.c[i][0] - line.o.x;
        const double y = q.c[i][1] - line.o.y;
        const double z = q.c[i][2] - line.o.z;
        out.c[i] = {x * line.along.x + y * line.along.y + z * line.along.z,
                    x * line.side.x + y * line.side.y + z * line.side.z,
                    x * line.up.x + y * line.up.y + z * line.up.z, q.c[i][3]};
    }
    return out;
}

/// What is known of the sphere at one u.
struct Place {
    double u;
    double tau, tau1, tau2;
    double disc, disc1, disc2;
    double radius;
};

Place place_at(const Cubics& q, double u) {
    const CubicsJet j = jet_at(q, u);
    const auto sum = [](const std::array<double, 4>& a, const std::array<double, 4>& b) {
        return a[kRadius] * b[kRadius] - a[kP] * b[kP] - a[kQ] * b[kQ];
    };
    return {u,
            j.value[kTau],
            j.first[kTau],
            j.second[kTau],
            sum(j.value, j.value),
            2.0 * sum(j.value, j.first),
            2.0 * (sum(j.first, j.first) + sum(j.value, j.second)),
            std::fabs(j.value[kRadius])};
}

struct Part {
    Cubics q;
    double u0, u1;
    int depth;
};

/// Bounds over a part, with derivatives by u.
struct Bounds {
    double disc_least, disc_most;
    double d1_least, d1_most;  ///< of |D1|; the least is 0 where it has no sign
    bool d1_rises;
    double d2_least, d2_most;  ///< of D2
    double tau_least, tau_most;
    double tau1_least, tau1_most;  ///< of |tau'|
    double tau2_least, tau2_most;  ///< of tau''
    double radius_most;
    double slack;     ///< E
    double rounding;  ///< of coefficients of disc

    /// Where disc is larger than this, it is positive for certain, with room.
    [[nodiscard]] double certain() const { return 4.0 * (slack + rounding); }
};

/// The chords of a part's first and last sphere, where the line meets these for certain.
struct Ends {
    Chord first, last;
    bool has_first, has_last;
    double wide;  ///< H
};

class Search {
public:
    Search(const SweepLine& line, const SweptSpheres& spheres, const SweptPiece& piece,
           ChordUnion& found)
        : line_(line), spheres_(spheres), piece_(piece), found_(found) {}

    void run() {
        std::size_t count = 0;
        whole_ = seen_along(line_, piece_.cubics);
        open_[count++] = {whole_, 0.0, 1.0, 0};
        for (int looked = 0; count > 0; ++looked) {
            const Part part = open_[--count];
            Bounds b;
            if (!bounds(part, b)) continue;
            if (settle(part, b)) continue;
            if (part.depth >= kMostHalvings || looked >= kMostParts) {
                give_up(part, b);
                continue;
            }
            Part& right = open_[count];
            Part& left = open_[count + 1];
            const double middle = 0.5 * (part.u0 + part.u1);
            split(part.q, 0.5, left.q, right.q);
            left.u0 = part.u0;
            left.u1 = right.u0 = middle;
            right.u1 = part.u1;
            left.depth = right.depth = part.depth + 1;
            count += 2;
            Chord chord;
            if (chord_at(place_at(whole_, middle), chord)) add(chord);
        }
    }

private:
    [[nodiscard]] double slack(double radius) const {
        return line_.error * (2.0 * radius + line_.error);
    }

    /// False: the line misses the part.
    bool bounds(const Part& part, Bounds& b) const {
        const Cubics& q = part.q;
        std::array<double, 7> disc{};
        add_square(q, kRadius, 1.0, disc);
        add_square(q, kP, -1.0, disc);
        add_square(q, kQ, -1.0, disc);
        double size = 0.0;
        b.radius_most = 0.0;
        for (std::size_t i = 0; i < 4; ++i) {
            size = std::max(size, q.c[i][kP] * q.c[i][kP] + q.c[i][kQ] * q.c[i][kQ]);
            b.radius_most = std::max(b.radius_most, std::fabs(q.c[i][kRadius]));
        }
        size += b.radius_most * b.radius_most;
        b.rounding = 8.0 * kUnitRoundoff * size;
        b.slack = slack(b.radius_most);
        b.disc_most = *std::max_element(disc.begin(), disc.end());
        if (!(b.disc_most > -(b.slack + b.rounding))) return false;
        b.disc_least = *std::min_element(disc.begin(), disc.end());

        const auto [tau_least, tau_most] =
            std::minmax({q.c[0][kTau], q.c[1][kTau], q.c[2][kTau], q.c[3][kTau]});
        b.tau_least = tau_least;
        b.tau_most = tau_most;
        const double scale = 1.0 / (part.u1 - part.u0);
        std::array<double, 6> d1;
        for (std::size_t i = 0; i < 6; ++i) d1[i] = disc[i + 1] - disc[i];
        const auto [d1_low, d1_high] = std::minmax_element(d1.begin(), d1.end());
        b.d1_rises = *d1_low > 0.0;
        b.d1_least = 6.0 * scale * std::max({*d1_low, -*d1_high, 0.0});
        b.d1_most = 6.0 * scale * std::max(*d1_high, -*d1_low);
        b.d2_least = b.d2_most = d1[1] - d1[0];
        for (std::size_t i = 1; i < 5; ++i) {
            b.d2_most = std::max(b.d2_most, d1[i + 1] - d1[i]);
            b.d2_least = std::min(b.d2_least, d1[i + 1] - d1[i]);
        }
        b.d2_most = 30.0 * scale * scale * (b.d2_most + 4.0 * b.rounding);
        b.d2_least = 30.0 * scale * scale * (b.d2_least - 4.0 * b.rounding);
        const double t0 = q.c[1][kTau] - q.c[0][kTau];
        const double t1 = q.c[2][kTau] - q.c[1][kTau];
        const double t2 = q.c[3][kTau] - q.c[2][kTau];
        const auto [t_low, t_high] = std::minmax({t0, t1, t2});
        b.tau1_least = 3.0 * scale * std::max({t_low, -t_high, 0.0});
        b.tau1_most = 3.0 * scale * std::max(t_high, -t_low);
        b.tau2_most = 6.0 * scale * scale * std::max(t1 - t0, t2 - t1);
        b.tau2_least = 6.0 * scale * scale * std::min(t1 - t0, t2 - t1);
        return true;
    }

    enum class Rule { none, concave, at_first, at_last, larger };

    /// How the largest sign tau + h over the part is found; `bend`: B.
    [[nodiscard]] Rule rule(const Bounds& b, double sign, const Ends& ends, double& bend) const {
        const double h2 = std::max(b.disc_most, b.slack);
        const double h = std::sqrt(h2);
        const double turn_most = sign > 0.0 ? b.tau2_most : -b.tau2_least;
        bend = (b.d1_least * b.d1_least - 2.0 * h2 * b.d2_most) / (4.0 * h2 * h) - turn_most;
        if (bend > 0.125 * std::fabs(turn_most)) return Rule::concave;
        if (b.d1_least > 2.0 * b.tau1_most * h && (b.d1_rises ? ends.has_last : ends.has_first))
            return b.d1_rises ? Rule::at_last : Rule::at_first;
        if (!ends.has_first && !ends.has_last) return Rule::none;
        const double reach = sign > 0.0 ? b.tau_most + ends.wide : ends.wide - b.tau_least;
        if (found_.covers_side(ends.has_first ? ends.first : ends.last, sign, reach))
            return ends.has_first ? Rule::at_first : Rule::at_last;
        if (!ends.has_first || !ends.has_last) return Rule::none;
        if (b.disc_least > b.certain()) {
            const double l = std::sqrt(b.disc_least);
            if (2.0 * b.tau1_least * l > b.d1_most) return Rule::larger;
            const double turn_least = sign > 0.0 ? b.tau2_least : -b.tau2_most;
            if (turn_least * 4.0 * l * l * l >
                b.d1_most * b.d1_most - 2.0 * h2 * std::min(b.d2_least, 0.0))
                return Rule::larger;
        }
        const ChordEnd& first = sign > 0.0 ? ends.first.hi : ends.first.lo;
        const ChordEnd& last = sign > 0.0 ? ends.last.hi : ends.last.lo;
        const double near =
            2.0 * (std::fabs(first.outer - first.inner) + std::fabs(last.outer - last.inner));
        return reach - std::max(sign * first.t, sign * last.t) <= near ? Rule::larger : Rule::none;
    }

    /// True when the part is done with.
    bool settle(const Part& part, const Bounds& b) {
        Ends ends;
        ends.wide = std::sqrt(std::max(b.disc_most, 0.0) + b.slack + b.rounding);
        if (found_.covers(b.tau_least - ends.wide, b.tau_most + ends.wide)) return true;
        if (b.disc_least > b.certain() || b.d2_most < 0.0 || b.d1_least > 0.0) {
            find_ends(part, ends);
            double bend_lo, bend_hi;
            const Rule lo = rule(b, -1.0, ends, bend_lo);
            const Rule hi = lo == Rule::none ? lo : rule(b, 1.0, ends, bend_hi);
            if (hi != Rule::none) {
                join(part, b, ends, lo, bend_lo, hi, bend_hi);
                return true;
            }
        }
        // In the surface over all its length, or in it to within less than where that is known.
        if (b.disc_most < b.certain() &&
            (b.disc_least > -b.certain() || b.tau_most - b.tau_least < 0.25 * kDegenerate)) {
            add_maybe(b.tau_least - ends.wide, b.tau_most + ends.wide);
            return true;
        }
        return false;
    }

    void find_ends(const Part& part, Ends& ends) const {
        const auto place = [&](std::size_t i, double u) {
            const auto& c = part.q.c[i];
            Place at{};
            at.u = u;
            at.tau = c[kTau];
            at.radius = std::fabs(c[kRadius]);
            at.disc = at.radius * at.radius - c[kP] * c[kP] - c[kQ] * c[kQ];
            return at;
        };
        ends.has_first = chord_at(place(0, part.u0), ends.first);
        ends.has_last = chord_at(place(3, part.u1), ends.last);
    }

    /// Adds the one chord of a part.
    void join(const Part& part, const Bounds& b, const Ends& ends, Rule lo, double bend_lo, Rule hi,
              double bend_hi) {
        Chord chord;
        if (lo == Rule::concave || hi == Rule::concave) {
            Place peak;
            if (!find_peak(part, b, peak)) return;
            if (lo == Rule::concave) chord.lo = extremum(part, bend_lo, peak, -1.0);
            if (hi == Rule::concave) chord.hi = extremum(part, bend_hi, peak, 1.0);
        }
        if (lo != Rule::concave) chord.lo = end_of(ends, lo, -1.0, b);
        if (hi != Rule::concave) chord.hi = end_of(ends, hi, 1.0, b);
        add(chord);
    }

    static ChordEnd end_of(const Ends& ends, Rule rule, double sign, const Bounds& b) {
        const ChordEnd& first = sign > 0.0 ? ends.first.hi : ends.first.lo;
        const ChordEnd& last = sign > 0.0 ? ends.last.hi : ends.last.lo;
        if (rule == Rule::at_first) return first;
        if (rule == Rule::at_last) return last;
        const bool later = sign * last.t > sign * first.t;
        ChordEnd out = later ? last : first;
        const ChordEnd& other = later ? first : last;
        // Of a flat part the bounds may be farther out.
        const double reach = sign > 0.0 ? b.tau_most + ends.wide : ends.wide - b.tau_least;
        const double outer = std::max(sign * out.outer, sign * other.outer);
        const double near =
            2.0 * (std::fabs(first.outer - first.inner) + std::fabs(last.outer - last.inner));
        out.outer = sign * (reach - sign * out.t <= near ? std::max(reach, outer) : outer);
        out.inner = sign * std::max(sign * out.inner, sign * other.inner);
        return out;
    }

    void give_up(const Part& part, const Bounds& b) {
        const double wide = std::sqrt(std::max(b.disc_most, 0.0) + b.slack + b.rounding);
        Chord first, last;
        const bool has_first = chord_at(place_at(whole_, part.u0), first);
        const bool has_last = chord_at(place_at(whole_, part.u1), last);
        if (!has_first && !has_last) {
            add_maybe(b.tau_least - wide, b.tau_most + wide);
            return;
        }
        Chord chord = has_first ? first : last;
        // What both ends hold need not be joined.
        if (has_first && has_last && overlap(first, last)) chord = hull(first, last);
        chord.lo.outer = b.tau_least - wide;
        chord.hi.outer = b.tau_most + wide;
        add(chord);
    }

    [[nodiscard]] std::uint16_t face_at(double u) const {
        return static_cast<std::uint16_t>(u == 0.0 && piece_.begins ? 1
                                          : u == 1.0 && piece_.ends ? 2
                                                                    : 0);
    }

    /// The chord of one sphere; false when the line does not meet it for certain.
    bool chord_at(const Place& at, Chord& out) const {
        const double e = slack(at.radius);
        if (!(at.disc > 2.0 * e)) return false;
        const double h = std::sqrt(at.disc);
        const double outer = e / (2.0 * h);
        const double inner = e / h;
        const std::uint16_t face = face_at(at.u);
        out.lo = {at.tau - h, at.tau - h - outer, at.tau - h + inner, face};
        out.hi = {at.tau + h, at.tau + h + outer, at.tau + h - inner, face};
        return true;
    }

    static bool overlap(const Chord& a, const Chord& b) {
        return a.lo.inner <= b.hi.inner && b.lo.inner <= a.hi.inner;
    }
    static Chord hull(const Chord& a, const Chord& b) {
        Chord out = a;
        if (b.lo.t < a.lo.t) out.lo = b.lo;
        if (b.hi.t > a.hi.t) out.hi = b.hi;
        out.lo.outer = std::min(a.lo.outer, b.lo.outer);
        out.lo.inner = std::min(a.lo.inner, b.lo.inner);
        out.hi.outer = std::max(a.hi.outer, b.hi.outer);
        out.hi.inner = std::max(a.hi.inner, b.hi.inner);
        return out;
    }

    /// The place of the largest disc, or nearly. False when the line may miss the part, of which has been told.
    bool find_peak(const Part& part, const Bounds& b, Place& peak) {
        double most = 0.0;
        double off = 0.0;  // how far the largest may be from there
        const double width = part.u1 - part.u0;
        if (b.d1_least > 0.0) {
            peak = place_at(whole_, b.d1_rises ? part.u1 : part.u0);
            most = peak.disc;
        } else if (!(b.d2_most < 0.0)) {
            peak = place_at(whole_, 0.5 * (part.u0 + part.u1));  // disc > 0 everywhere
            most = peak.disc;
        } else {
            double u = 0.5 * (part.u0 + part.u1);
            for (int i = 0;; ++i) {
                peak = place_at(whole_, u);
                most = peak.disc;
                if (u == (peak.disc1 > 0.0 ? part.u1 : part.u0)) break;
                const double gain = peak.disc1 * peak.disc1 / (2.0 * std::fabs(b.d2_most));
                off = std::min(width, std::fabs(peak.disc1 / b.d2_most));
                most = peak.disc + gain;
                if (i >= 8 || gain <= 0.05 * std::max(peak.disc, b.slack)) break;
                u = std::clamp(u - peak.disc1 / std::min(peak.disc2, b.d2_most), part.u0, part.u1);
            }
        }
        if (most <= -b.slack) return false;
        if (peak.disc >= 4.0 * b.slack) return true;
        const double room = std::max(most, 0.0) + b.slack;
        const double reach = b.d1_least > 0.0
                                 ? std::min(width, room / b.d1_least)
                                 : std::min(width, std::sqrt(2.0 * room / std::fabs(b.d2_most)));
        const double wide = b.tau1_most * (reach + off) + std::sqrt(room);
        add_maybe(peak.tau - wide, peak.tau + wide);
        return false;
    }

    /// The largest sign tau + h over the part; concave there.
    ChordEnd extremum(const Part& part, double bend, const Place& peak, double sign) const {
        double lo = part.u0;
        double hi = part.u1;
        bool lo_seen = false;
        bool hi_seen = false;
        Place at = peak;
        Place good = peak;
        double loss = 0.0;
        for (int i = 0; i < 16; ++i) {
            if (i > 0 && at.disc <= 0.0) {
                // Beyond the chords: back half the way.
                (at.u > good.u ? hi : lo) = at.u;
                (at.u > good.u ? hi_seen : lo_seen) = true;
                at = place_at(whole_, 0.5 * (at.u + good.u));
                continue;
            }
            good = at;
            const double h = std::sqrt(at.disc);
            const double m = sign * at.tau1;
            const double slope = m + at.disc1 / (2.0 * h);
            loss = 0.0;
            if ((at.u == part.u1 && slope >= 0.0) || (at.u == part.u0 && slope <= 0.0)) break;
            loss = slope * slope / (2.0 * bend);
            if (loss * h <= 0x1p-12 * slack(at.radius)) break;
            (slope > 0.0 ? lo : hi) = at.u;
            (slope > 0.0 ? lo_seen : hi_seen) = true;
            const double c = -0.5 * (at.disc2 + 2.0 * sign * at.tau2 * h);
            double next = slope > 0.0 ? hi : lo;
            if (c > 0.0) {
                const double half = 0.5 * at.disc1 / c;
                next = at.u + half +
                       m * std::sqrt((at.disc + 0.5 * half * at.disc1) / (c * (c + m * m)));
            }
            if (!(next < hi)) next = hi_seen ? 0.5 * (at.u + hi) : hi;
            if (!(next > lo)) next = lo_seen ? 0.5 * (at.u + lo) : lo;
            if (next == at.u) break;
            at = place_at(whole_, next);
        }
        const double h = std::sqrt(good.disc);
        const double t = sign * good.tau + h;
        const double e = line_.error * (2.5 * good.radius + line_.error);
        const bool clipped = good.u == part.u0 || good.u == part.u1;
        const double outer =
            t + loss + (clipped ? std::min(e / (2.0 * h), std::sqrt(e)) : e / (2.0 * h));
        // The highest sphere does for certain, too.
        const double top = std::sqrt(peak.disc);
        const double inner = std::max(t - e / h, sign * peak.tau + top - slack(peak.radius) / top);
        return {sign * t, sign * outer, sign * inner, face_at(good.u)};
    }

    void add_maybe(double lo, double hi) {
        Chord chord;
        chord.lo = {0.5 * (lo + hi), lo, hi, 0};
        chord.hi = {0.5 * (lo + hi), hi, lo, 0};
        add(chord);
    }

    void add(Chord chord) {
        for (std::size_t k = 0; k < 2; ++k) {
            if ((piece_.cut >> k & 1U) == 0) continue;
            // n.(o + t d) >= c
            const CapPlane& plane = spheres_.caps[k];
            const double slope = dot(plane.n, line_.along);
            const double height = dot(plane.n, line_.o) - plane.c;
            const double steep = std::copysign(std::max(std::fabs(slope), 0x1p-100), slope);
            const double t = -height / steep;
            const double error = line_.error / std::fabs(steep);
            const auto face = static_cast<std::uint16_t>(1 + k);
            if (steep > 0.0) {
                if (t > chord.lo.t) chord.lo.t = t, chord.lo.face = face;
                chord.lo.outer = std::max(chord.lo.outer, t - error);
                chord.lo.inner = std::max(chord.lo.inner, t + error);
            } else {
                if (t < chord.hi.t) chord.hi.t = t, chord.hi.face = face;
                chord.hi.outer = std::min(chord.hi.outer, t + error);
                chord.hi.inner = std::min(chord.hi.inner, t - error);
            }
        }
        found_.add(chord);
    }

    const SweepLine& line_;
    const SweptSpheres& spheres_;
    const SweptPiece& piece_;
    ChordUnion& found_;
    Cubics whole_;
    std::array<Part, kMostHalvings + 2> open_;
};

}  // namespace

void add_chords(const SweepLine& line, const SweptSpheres& spheres, const SweptPiece& piece,
                ChordUnion& found) {
    Search(line, spheres, piece, found).run();
}

}  // namespace raymo::solids
