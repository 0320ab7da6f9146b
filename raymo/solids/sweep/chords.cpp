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
// n = 3. The same extrema are found here without forming it. With D1 = disc', D2 = disc'',
//     t+-' = tau' +- D1 / (2 h),   t+-'' = tau'' -+ (D1^2 - 2 disc D2) / (4 h^3).
// [0, 1] is halved until over each part, with bounds from Bernstein coefficients (m1 <= |D1|, d2 >= D2, disc <= H^2,
// |tau''| <= c2, ...), one of these holds.
//   empty     All coefficients of disc are below -E (see below).
//   known     tau - H' .. tau + H', which holds all chords, lies where the line is inside for certain.
//   concave   B = (m1^2 - 2 H^2 d2) / (4 H^3) - c2 > 0. (The fraction falls with h, so B bounds it.) Then {disc >= 0} is one
//             interval, t+ is concave over it with t+'' <= -B, and t- convex: each has one extremum.
//   monotone  disc > 0, tau' has one sign, and 2 |tau'| h > |D1|: both extrema stand at the ends of the part.
//   nested    D1 has one sign and |D1| > 2 |tau'| H: each sphere's chord holds the next, so the last one's counts.
//   flat      disc > 0, or the chords at both ends overlap, and these come as near to the bounds as they are known.
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
    double d2_most;  ///< of D2, with its sign
    double tau_least, tau_most;
    double tau1_least, tau1_most;  ///< of |tau'|
    double tau2_most;              ///< of |tau''|
    double radius_most;
    double slack;     ///< E
    double rounding;  ///< of coefficients of disc
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
        b.d2_most = d1[1] - d1[0];
        for (std::size_t i = 1; i < 5; ++i) b.d2_most = std::max(b.d2_most, d1[i + 1] - d1[i]);
        b.d2_most = 30.0 * scale * scale * (b.d2_most + 4.0 * b.rounding);
        const double t0 = q.c[1][kTau] - q.c[0][kTau];
        const double t1 = q.c[2][kTau] - q.c[1][kTau];
        const double t2 = q.c[3][kTau] - q.c[2][kTau];
        const auto [t_low, t_high] = std::minmax({t0, t1, t2});
        b.tau1_least = 3.0 * scale * std::max({t_low, -t_high, 0.0});
        b.tau1_most = 3.0 * scale * std::max(t_high, -t_low);
        b.tau2_most = 6.0 * scale * scale * std::max(std::fabs(t1 - t0), std::fabs(t2 - t1));
        return true;
    }

    /// True when the part is done with.
    bool settle(const Part& part, const Bounds& b) {
        const double wide = std::sqrt(std::max(b.disc_most, 0.0) + b.slack + b.rounding);
        if (found_.covers(b.tau_least - wide, b.tau_most + wide)) return true;
        const double h2 = std::max(b.disc_most, b.slack);
        const double h = std::sqrt(h2);
        const double bend =
            (b.d1_least * b.d1_least - 2.0 * h2 * b.d2_most) / (4.0 * h2 * h) - b.tau2_most;
        if (bend > 0.125 * b.tau2_most) {
            add_concave(part, b, bend);
            return true;
        }
        const double certain = 4.0 * (b.slack + b.rounding);
        const Place first = place_at(whole_, part.u0);
        const Place last = place_at(whole_, part.u1);
        Chord at_first, at_last;
        const bool has_first = chord_at(first, at_first);
        const bool has_last = chord_at(last, at_last);
        if (b.disc_least > certain && has_first && has_last &&
            2.0 * b.tau1_least * std::sqrt(b.disc_least) > b.d1_most) {
            add(hull(at_first, at_last));
            return true;
        }
        if (b.d1_least > 2.0 * b.tau1_most * h && (b.d1_rises ? has_last : has_first)) {
            add(b.d1_rises ? at_last : at_first);
            return true;
        }
        if (has_first && has_last && (b.disc_least > certain || overlap(at_first, at_last))) {
            Chord both = hull(at_first, at_last);
            const double near = 2.0 * (std::fabs(both.lo.inner - both.lo.outer) +
                                       std::fabs(both.hi.inner - both.hi.outer));
            if (both.lo.outer - (b.tau_least - wide) <= near &&
                b.tau_most + wide - both.hi.outer <= near) {
                both.lo.outer = b.tau_least - wide;
                both.hi.outer = b.tau_most + wide;
                add(both);
                return true;
            }
        }
        // In the surface over all its length, or in it to within less than where that is known.
        if (b.disc_most < certain &&
            (b.disc_least > -certain || b.tau_most - b.tau_least < 0.25 * kDegenerate)) {
            add_maybe(b.tau_least - wide, b.tau_most + wide);
            return true;
        }
        return false;
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

    void add_concave(const Part& part, const Bounds& b, double bend) {
        // The largest disc, or nearly.
        Place peak{};
        double most;
        double off = 0.0;  // how far the largest may be from there
        const double width = part.u1 - part.u0;
        if (b.d1_least > 0.0) {
            peak = place_at(whole_, b.d1_rises ? part.u1 : part.u0);
            most = peak.disc;
        } else {
            double u = 0.5 * (part.u0 + part.u1);
            for (int i = 0;; ++i) {
                peak = place_at(whole_, u);
                most = peak.disc;
                const double end = peak.disc1 > 0.0 ? part.u1 : part.u0;
                if (u == end) break;
                const double gain = peak.disc1 * peak.disc1 / (2.0 * std::fabs(b.d2_most));
                off = std::min(width, std::fabs(peak.disc1 / b.d2_most));
                most = peak.disc + gain;
                if (i >= 8 || gain <= 0.05 * std::max(peak.disc, b.slack)) break;
                u = std::clamp(u - peak.disc1 / std::min(peak.disc2, b.d2_most), part.u0, part.u1);
            }
        }
        if (most <= -b.slack) return;
        if (!(peak.disc >= 4.0 * b.slack)) {
            const double room = std::max(most, 0.0) + b.slack;
            const double reach = b.d1_least > 0.0
                                     ? std::min(width, room / b.d1_least)
                                     : std::min(width, std::sqrt(2.0 * room / -b.d2_most));
            const double wide = b.tau1_most * (reach + off) + std::sqrt(room);
            add_maybe(peak.tau - wide, peak.tau + wide);
            return;
        }
        Chord chord;
        chord.lo = extremum(part, b, bend, peak, -1.0);
        chord.hi = extremum(part, b, bend, peak, 1.0);
        add(chord);
    }

    /// The largest sign tau + h over the part; concave there.
    ChordEnd extremum(const Part& part, const Bounds& b, double bend, const Place& peak,
                      double sign) const {
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
        (void)b;
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
