// Chords of a line through one piece of a sweep.
//
// In a frame about the line, with t along it, a sphere of the piece has its centre at (tau, p, q) and the radius a, cubics
// of u. It cuts the line in the chord
//     [t-(u), t+(u)],  t-+ = tau -+ h,  h = sqrt(disc),  disc = a^2 - p^2 - q^2,
// when disc >= 0. Where disc >= 0 over an interval of u, these chords change continuously, so their union is the interval
// from the least t- to the largest t+ (the interval theorem): nothing needs to be known about envelopes, engulfed spheres,
// cusps or self-crossings, and the unions of all pieces are united in turn [Wijk84b], [Wijk86 4].
//
// The usual candidates for the extrema are the roots of disc'^2 - 4 tau'^2 disc, of degree 10 for cubics. It is needed here
// only where simpler bounds do not tell. Let z = +-tau + h, of which the largest value is sought for either sign,
// D1 = disc', D2 = disc''. Then
//     z' = +-tau' + D1 / (2 h),   z'' = +-tau'' - (D1^2 - 2 disc D2) / (4 h^3).
// [0, 1] is halved until over each part, with bounds from Bernstein coefficients (m1 <= |D1|, D2 <= d2, disc <= H^2,
// +-tau'' <= c2), these hold. First, the part has one chord, or none:
//     disc > 0, or D2 < 0, or D1 has one sign.
// Second, for either sign one of
//   concave   B = (m1^2 - 2 H^2 d2) / (4 H^3) - c2 > 0. Then z'' <= -B: there is one maximum. (The fraction falls with h
//             up to h^2 = 3 m1^2 / 2 d2 if d2 > 0, where it is least; that takes the place of a larger H^2.)
//   single    disc > 0 or D1 has one sign, and that polynomial has at most one root, by the signs of its coefficients.
//             Then z' at the ends tells whether there is a maximum between them, unless it may be 0 there.
//   covered   All values lie where the line is inside for certain, in one interval with the chord of an end.
//   one way   z' has one sign over all of it, by bounds of tau', D1 and h: the maximum is at an end. (In kernel.inl only.)
//   flat      The larger of both ends comes as near to +-tau + H as it is known.
// Parts are dropped when all coefficients of disc are below -E (see below), or when all their chords lie inside for certain.
// Nearly all parts of transversal lines are concave, at once or after a halving or two; the polynomial is formed for few.
// The maximum is found by steps to that of a model with linear tau and quadratic disc, a line that meets a cylinder or cone,
//     u + D1 / 2c + m sqrt((disc + D1^2 / 4c) / (c (c + m^2))),  m = +-tau',  c = -(D2 +- 2 tau'' h) / 2,
// exact for linear pieces with one step; that c makes it Newton's near the maximum. Where c is not positive, as next to the
// inner side of a bend, that model has no maximum, and Newton's step for z' = 0 is made if z is concave. Since z is concave, its maximum is above
// the value at any u by at most z'^2 / 2B, the `loss` (z'^2 / |z''|, twice what Newton's step gains, where there is no B);
// steps are made until it is far below the error, and it is added to that.
//
// Error. A place of the line, a centre and a radius together are wrong by at most e. So a sphere of the true solid meets the
// true line only if disc >= -E, E = e (2 a + e), and does if disc >= E. With T(x) the maximum of tau + sqrt(disc + x),
//     dT/dx = 1 / 2h  at the extremum belonging to x,
//     dh^2/dx = (-D2 -+ 2 tau'' h) / (2 tau'^2 - D2 -+ 2 tau'' h), in (0, 1] (or 1, where the extremum is at an end).
// So h grows with x, and T(E) <= T(0) + E / 2h. (Where there is no B, T may bend upwards; that counts where T'' is about
// 1 / (2 h E), next to where the maximum is flat, and E is taken a quarter larger for it.) And where the largest disc is at
// least 4 E, for linear tau and quadratic disc h^2 stays above 3/4 of its value, and T(-E) >= T(0) - 1.16 E / 2h; E / h is
// taken. A part of which the largest disc is less may be entered or not: a `maybe`, which has bounds only.
// Coefficients of disc are wrong by another 8 u of the squares they are made of.
#include "raymo/solids/sweep/chords.hpp"

#include <algorithm>
#include <cmath>

#include "raymo/math/tolerance.hpp"
#include "raymo/solids/sweep/part.hpp"

namespace raymo::solids {
namespace {

/// Parts are halved so often at most; there they are shorter than places along the line are known.
constexpr int kMostHalvings = 40;
/// Parts of one piece that are looked at, at most. Transversal lines need less than 10, those along a piece less than 50.
constexpr int kMostParts = 600;
/// Steps towards the largest disc of a part, at most; every fourth is a halving.
constexpr int kMostPeakSteps = 200;

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

/// How the largest sign tau + h over a part is found.
enum class Rule { none, concave, single, first, last, larger, flat };

/// The chords of a part's first and last sphere, where the line meets these for certain.
struct Ends {
    SpherePlace at_first, at_last;
    Chord first, last;
    bool has_first, has_last;
};

/// The derivative of sign tau + h.
double slope_at(const SpherePlace& at, double sign) {
    return sign * at.tau1 + at.disc1 / (2.0 * std::sqrt(at.disc));
}

/// What that may be wrong by: the coefficients of tau, and of disc, are sums of products of numbers below 4.
double slope_noise(const SpherePlace& at) {
    return 256.0 * kUnitRoundoff * (1.0 + 1.0 / std::sqrt(at.disc));
}

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
            const SweepPart part = open_[--count];
            PartBounds b;
            if (!bound_part(part, line_.error, b)) continue;
            if (settle(part, b)) continue;
            if (part.depth >= kMostHalvings || looked >= kMostParts) {
                give_up(part, b);
                continue;
            }
            SweepPart& right = open_[count];
            SweepPart& left = open_[count + 1];
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
    [[nodiscard]] double slack(double radius) const { return slack_of(radius, line_.error); }

    /// B
    static double bend_of(const PartBounds& b, double sign) {
        // The fraction falls with h as far as h^2 = 3 D1^2 / 2 D2, and on for ever if D2 <= 0.
        const double m2 = b.d1_least * b.d1_least;
        double h2 = std::max(b.disc_most, b.slack);
        if (b.d2_most > 0.0) h2 = std::min(h2, 1.5 * m2 / b.d2_most);
        if (!(h2 > 0.0)) return 0.0;
        const double turn = sign > 0.0 ? b.tau2_most : -b.tau2_least;
        const double bend = (m2 - 2.0 * h2 * b.d2_most) / (4.0 * h2 * std::sqrt(h2)) - turn;
        return bend > 0.125 * std::fabs(turn) ? bend : 0.0;
    }

    [[nodiscard]] Rule rule(const PartBounds& b, double sign, const Ends& ends, bool single) const {
        if (single) {
            const double first = ends.has_first ? slope_at(ends.at_first, sign) : 1.0;
            const double last = ends.has_last ? slope_at(ends.at_last, sign) : -1.0;
            // Where a path stands still all slopes are 0, of a least as of a largest value.
            if ((ends.has_first && std::fabs(first) <= slope_noise(ends.at_first)) ||
                (ends.has_last && std::fabs(last) <= slope_noise(ends.at_last))) {
                return Rule::none;
            }
            const bool rises_first = first > 0.0;
            const bool falls_last = last < 0.0;
            if (rises_first && falls_last) return Rule::single;
            if (!ends.has_first) return Rule::last;
            return ends.has_last ? Rule::larger : Rule::first;
        }
        const double reach = sign > 0.0 ? b.tau_most + b.wide : b.wide - b.tau_least;
        if (found_.covers_side(ends.has_first ? ends.first : ends.last, sign, reach))
            return ends.has_first ? Rule::first : Rule::last;
        if (!ends.has_first || !ends.has_last) return Rule::none;
        const ChordEnd first = end_of(ends, Rule::first, sign);
        const ChordEnd last = end_of(ends, Rule::last, sign);
        const double near =
            2.0 * (std::fabs(first.outer - first.inner) + std::fabs(last.outer - last.inner));
        return reach - std::max(sign * first.t, sign * last.t) <= near ? Rule::flat : Rule::none;
    }

    /// True when the part is done with.
    bool settle(const SweepPart& part, const PartBounds& b) {
        if (found_.covers(b.tau_least - b.wide, b.tau_most + b.wide)) return true;
        const bool positive = b.disc_least > b.certain();
        if ((positive || b.d2_most < 0.0 || b.d1_least > 0.0) && join(part, b, positive))
            return true;
        // In the surface over all its length, or in it to within less than where that is known.
        if (b.disc_most < b.certain() &&
            (b.disc_least > -b.certain() || b.tau_most - b.tau_least < 0.25 * kDegenerate)) {
            add_maybe(b.tau_least - b.wide, b.tau_most + b.wide);
            return true;
        }
        return false;
    }

    /// Adds the one chord of a part, if both of its ends can be found.
    bool join(const SweepPart& part, const PartBounds& b, bool positive) {
        const std::array<double, 2> bend{bend_of(b, -1.0), bend_of(b, 1.0)};
        std::array<Rule, 2> rules{Rule::concave, Rule::concave};
        Ends ends;
        if (!(bend[0] > 0.0 && bend[1] > 0.0)) {
            ends.at_first = place_at(whole_, part.u0);
            ends.at_last = place_at(whole_, part.u1);
            ends.has_first = chord_at(ends.at_first, ends.first);
            ends.has_last = chord_at(ends.at_last, ends.last);
            if (!ends.has_first && !ends.has_last) return false;
            const bool single = (positive ? ends.has_first && ends.has_last : b.d1_least > 0.0) &&
                                at_most_one_stationary(part, b);
            for (std::size_t k = 0; k < 2; ++k) {
                if (!(bend[k] > 0.0)) rules[k] = rule(b, k == 0 ? -1.0 : 1.0, ends, single);
                if (rules[k] == Rule::none) return false;
            }
        }
        SpherePlace peak{};
        const auto searches = [](Rule r) { return r == Rule::concave || r == Rule::single; };
        if ((searches(rules[0]) || searches(rules[1])) && !find_peak(part, b, peak)) return true;
        Chord chord;
        for (std::size_t k = 0; k < 2; ++k) {
            const double sign = k == 0 ? -1.0 : 1.0;
            ChordEnd& end = k == 0 ? chord.lo : chord.hi;
            end = searches(rules[k]) ? extremum(part, bend[k], peak, sign)
                                     : end_of(ends, rules[k], sign);
            if (rules[k] == Rule::flat) {
                const double reach = sign > 0.0 ? b.tau_most + b.wide : b.wide - b.tau_least;
                end.outer = sign * std::max(sign * end.outer, reach);
            }
        }
        add(chord);
        return true;
    }

    static ChordEnd end_of(const Ends& ends, Rule rule, double sign) {
        const ChordEnd& first = sign > 0.0 ? ends.first.hi : ends.first.lo;
        const ChordEnd& last = sign > 0.0 ? ends.last.hi : ends.last.lo;
        if (rule == Rule::first) return first;
        if (rule == Rule::last) return last;
        ChordEnd out = sign * last.t > sign * first.t ? last : first;
        out.outer = sign * std::max(sign * first.outer, sign * last.outer);
        out.inner = sign * std::max(sign * first.inner, sign * last.inner);
        return out;
    }

    void give_up(const SweepPart& part, const PartBounds& b) {
        Chord first, last;
        const bool has_first = chord_at(place_at(whole_, part.u0), first);
        const bool has_last = chord_at(place_at(whole_, part.u1), last);
        if (!has_first && !has_last) {
            add_maybe(b.tau_least - b.wide, b.tau_most + b.wide);
            return;
        }
        Chord chord = has_first ? first : last;
        // What both ends hold need not be joined.
        if (has_first && has_last && overlap(first, last)) chord = hull(first, last);
        chord.lo.outer = b.tau_least - b.wide;
        chord.hi.outer = b.tau_most + b.wide;
        add(chord);
    }

    [[nodiscard]] std::uint16_t face_at(double u) const {
        return static_cast<std::uint16_t>(u == 0.0 && piece_.begins ? 1
                                          : u == 1.0 && piece_.ends ? 2
                                                                    : 0);
    }

    /// The chord of one sphere; false when the line does not meet it for certain.
    bool chord_at(const SpherePlace& at, Chord& out) const {
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
    bool find_peak(const SweepPart& part, const PartBounds& b, SpherePlace& peak) {
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
            double lo = part.u0;
            double hi = part.u1;
            double u = 0.5 * (lo + hi);
            for (int i = 1;; ++i) {
                peak = place_at(whole_, u);
                most = peak.disc;
                if (u == (peak.disc1 > 0.0 ? part.u1 : part.u0)) break;
                const double gain = peak.disc1 * peak.disc1 / (2.0 * std::fabs(b.d2_most));
                off = std::min(width, std::fabs(peak.disc1 / b.d2_most));
                most = peak.disc + gain;
                if (i == kMostPeakSteps || gain <= 0.05 * std::max(peak.disc, b.slack)) break;
                // Newton's steps, and a halving now and then: next to a thin disc's place they may lead to and fro.
                (peak.disc1 > 0.0 ? lo : hi) = u;
                const double next =
                    std::clamp(u - peak.disc1 / std::min(peak.disc2, b.d2_most), part.u0, part.u1);
                u = i % 4 != 0 && next >= lo && next <= hi && next != u ? next : 0.5 * (lo + hi);
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

    /// The largest sign tau + h over the part, where it has one maximum; `bend`: B, or 0 if there is none.
    ChordEnd extremum(const SweepPart& part, double bend, const SpherePlace& peak,
                      double sign) const {
        double lo = part.u0;
        double hi = part.u1;
        bool lo_seen = false;
        bool hi_seen = false;
        SpherePlace at = peak;
        SpherePlace good = peak;
        double loss = 0.0;
        for (int i = 0; i < 64; ++i) {
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
            const double z2 = sign * at.tau2 + (2.0 * at.disc * at.disc2 - at.disc1 * at.disc1) /
                                                   (4.0 * at.disc * h);
            loss = slope * slope / (bend > 0.0 ? 2.0 * bend : std::max(-z2, 0.0));
            if (loss * h <= 0x1p-12 * slack(at.radius)) break;
            (slope > 0.0 ? lo : hi) = at.u;
            (slope > 0.0 ? lo_seen : hi_seen) = true;
            const double c = -0.5 * (at.disc2 + 2.0 * sign * at.tau2 * h);
            double next = slope > 0.0 ? hi : lo;
            if (c > 0.0) {
                const double half = 0.5 * at.disc1 / c;
                next = at.u + half +
                       m * std::sqrt((at.disc + 0.5 * half * at.disc1) / (c * (c + m * m)));
            } else if (bend > 0.0 && z2 < 0.0) {
                next = at.u - slope / z2;
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
    std::array<SweepPart, kMostHalvings + 2> open_;
};

}  // namespace

void add_chords(const SweepLine& line, const SweptSpheres& spheres, const SweptPiece& piece,
                ChordUnion& found) {
    Search(line, spheres, piece, found).run();
}

}  // namespace raymo::solids
