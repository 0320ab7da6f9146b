// Isolation by sign variation.
//
// A piece is p on a dyadic interval, in Bernstein form on [0, 1] again. Pieces are taken from left to right. One is done when
// its coefficients leave no doubt, or when its shape is so simple that one or two places tell all; else it is halved.
//
// Parity. A halving (halving.hpp) takes sums of neighbours, and sums of these, and keeps the first and the last of each row;
// the powers of two that bring the rows to one scale are exact. In rounded arithmetic, too, the sum of two numbers has the
// sign of one of them (0 counting as positive; sums do not underflow), and putting it between them adds no change of sign.
// Hence
//     changes(left) + changes(right) <= changes(p) <= N                                                    (1)
// for the coefficients as computed, and both halves share the computed value in the middle bit for bit. Each piece that is
// done tells of an odd number of crossings if the signs at its ends are different and of an even number if they are equal.
// So, whatever rounding does to the values in between, crossings alternate, their parity is that of the ends of p, and there
// are at most N.
//
// Certainty. Sums in place of means make the halves 2^N times as large as p is there, and so are all numbers of a piece. Each
// sum has a relative error of u, N of them follow each other, and later ones do not make errors larger relative to the scale.
// With `doubt` for the bound of the error of the coefficients of a piece, input noise included,
//     doubt(half) = 2^N (doubt(piece) + N u size(piece)).                                                   (2)
// Where u size underflows the sums are exact.
// A sign counts as known where the number is larger than the doubt, and at 0 and 1, where it is taken as it stands since
// the neighbours of p take it as well. Pieces that meet where the sign is not known are told together, from the last known
// sign before to the first one after: as a crossing if these are different, else as a touch.
//
// Pieces that are done:
//   clear     all coefficients have one known sign: no zero;
//   outweighed  the few of the other sign have two neighbours that outweigh them (outweighed.hpp): no zero;
//   simple    known negative ones, then unknown, then known positive ones, or the other way about: one crossing;
//   blurred   none is larger than twice the doubt: nothing can be told apart here;
//   monotone  the coefficients rise or fall: what happens is told by the ends;
//   humped    they rise and then fall, or the other way about, so p' has one zero m [Lane81]: p is monotone on both sides,
//             and the sign of p(m) decides. A halving would need 20 more to come as near to a double zero.
// What is none of these after kMostDepth halvings is told as blurred. A piece holds its right sibling back, so kMostDepth
// of them wait at most. More than kMostHalvings, which no polynomial is known to need, end in the same way.
//
// Size of the list: between two touches, or a touch and a crossing, that are told apart, |p| has a maximum, and p' has at
// most N - 1 zeros; so there are not more than N. `Teller` refuses touches beyond N + 2, so that room for crossings is sure.
#include "raymo/curves/roots.hpp"

#include <utility>

#include "raymo/curves/crossing.hpp"
#include "raymo/curves/halving.hpp"
#include "raymo/curves/outweighed.hpp"
#include "raymo/curves/root_teller.hpp"
#include "raymo/math/tolerance.hpp"

namespace raymo::curves {
namespace {

constexpr int kMostDepth = 48;
constexpr int kMostHalvings = 1000;
/// Pieces of fewer halvings are not searched for a hump: a halving is cheaper.
constexpr int kHumpDepth = 2;
/// Larger coefficients are scaled down. The others stay finite in kMostDepth halvings, each of which doubles them at most
/// kMostDegree times, and so do differences and binomial multiples.
constexpr double kLargest = 0x1p500;

template <int N>
struct Piece {
    Bernstein<N> c;
    End lo, hi;
    double least, most;  ///< of c
    double doubt;
    int depth;

    [[nodiscard]] double size() const { return std::max(-least, most); }
};

/// The place in [x0, x1], with the values y0 and y1 at its ends, where c passes `level`; `otherwise` where it does not.
template <int N>
double place_of(Bernstein<N> c, double level, double x0, double x1, double y0, double y1,
                double otherwise) {
    if ((y0 < level) == (y1 < level)) return otherwise;
    for (double& x : c) x -= level;
    return zero_within<N>(c, {x0, x1, y0 - level, y1 - level, 0.5 * (x0 + x1)});
}

/// p is monotone on [x0, x1] of the piece; its ends there are e0 and e1, with the values y0 and y1.
template <int N>
RAYMO_INLINE void tell_monotone(Teller<N>& teller, const Piece<N>& at, const Bracket& in,
                                const End& e0, const End& e1) {
    const bool crosses = e0.negative != e1.negative;
    if (e0.known && e1.known && !crosses) return;
    double u = 0.5 * (e0.u + e1.u);
    if (crosses) {
        const double x = zero_within<N>(at.c, in);
        u = std::min(std::max(at.lo.u + (at.hi.u - at.lo.u) * x, e0.u), e1.u);
        if (e0.known && e1.known) {
            teller.crossing(u, e0, e1);
            return;
        }
    }
    double lo = e0.u;
    double hi = e1.u;
    if (e0.known || e1.known) {
        const double level = (e0.known ? e0 : e1).negative ? -at.doubt : at.doubt;
        const double x =
            place_of<N>(at.c, level, in.lo, in.hi, in.at_lo, in.at_hi, e0.known ? in.lo : in.hi);
        const double place = at.lo.u + (at.hi.u - at.lo.u) * x;
        (e0.known ? lo : hi) = std::min(std::max(place, e0.u), e1.u);
    }
    teller.blur(e0, e1, lo, hi, u);
}

/// p' has one zero within the piece.
template <int N>
void tell_humped(Teller<N>& teller, const Piece<N>& at, const Bernstein<N - 1>& d) {
    // The value at m, computed within 2 N u size. Where the slope is lost in rounding it is no more than 4 N^2 u size there,
    // so that m, wherever it is in that region, misses the extreme value by no more than that.
    const double size = at.size();
    const double m = zero_across<N - 1>(d);
    const double value = value_at(at.c, m);
    const End middle{at.lo.u + (at.hi.u - at.lo.u) * m,
                     std::fabs(value) > at.doubt + (4 * N * N + 2 * N) * kUnitRoundoff * size,
                     value < 0.0};
    // About m it is a parabola.
    const double left = 1.0 - std::sqrt(std::fabs(value / (value - at.c[0])));
    const double right = std::sqrt(std::fabs(value / (value - at.c[N])));
    tell_monotone<N>(teller, at, {0.0, m, at.c[0], value, m * left}, at.lo, middle);
    tell_monotone<N>(teller, at, {m, 1.0, value, at.c[N], m + (1.0 - m) * right}, middle, at.hi);
}

/// Of `count` bits: whether those from some place on are different from those before it.
constexpr bool changes_once(unsigned bits, unsigned count) {
    const unsigned changes = (bits ^ (bits >> 1U)) & ((1U << (count - 1U)) - 1U);
    return changes != 0 && (changes & (changes - 1U)) == 0;
}

/// Whether c, which has different known signs at 0 and 1, is as a simple crossing is.
template <int N>
RAYMO_INLINE bool is_simple(const Bernstein<N>& c, double doubt) {
    const bool rises = c[0] < 0.0;
    unsigned negative = rises ? 1U : 1U << N;
    unsigned positive = rises ? 1U << N : 1U;
    for (unsigned i = 1; i < N; ++i) {
        negative |= (c[i] < -doubt ? 1U : 0U) << i;
        positive |= (c[i] > doubt ? 1U : 0U) << i;
    }
    return changes_once(negative, N + 1) && changes_once(positive, N + 1);
}

/// Whether the piece is done.
template <int N>
RAYMO_INLINE bool tell(Teller<N>& teller, const Piece<N>& at) {
    // The first piece is known not to be simple.
    if (at.depth > 0 && at.lo.known && at.hi.known && at.lo.negative != at.hi.negative &&
        is_simple<N>(at.c, at.doubt)) {
        const double x = zero_across<N>(at.c);
        teller.crossing(at.lo.u + (at.hi.u - at.lo.u) * x, at.lo, at.hi);
        return true;
    }
    const bool blurred = at.depth >= kMostDepth || at.size() <= 2.0 * at.doubt;
    if (blurred) {
        teller.blur(at.lo, at.hi, at.lo.u, at.hi.u, 0.5 * (at.lo.u + at.hi.u));
        return true;
    }
    if (at.depth < kHumpDepth) return false;
    if constexpr (N >= 2) {
        Bernstein<N - 1> d;
        unsigned falls = 0;
        unsigned rises = 0;
        for (unsigned i = 0; i < N; ++i) {
            d[i] = at.c[i + 1] - at.c[i];
            falls |= (d[i] < 0.0 ? 1U : 0U) << i;
            rises |= (d[i] > 0.0 ? 1U : 0U) << i;
        }
        if (falls == 0 || rises == 0) {
            tell_monotone<N>(teller, at, {0.0, 1.0, at.c[0], at.c[N], 0.5}, at.lo, at.hi);
            return true;
        }
        if (changes_once(falls, N)) {
            tell_humped<N>(teller, at, d);
            return true;
        }
        return false;
    } else {
        tell_monotone<N>(teller, at, {0.0, 1.0, at.c[0], at.c[N], 0.5}, at.lo, at.hi);
        return true;
    }
}

/// Of the halves of a piece, times 2^N as they are.
constexpr double doubt_of_halves(std::size_t degree, double doubt, double size) {
    return power_of_two(degree) *
           (doubt + (static_cast<double>(degree + 1) * kUnitRoundoff) * size);
}

/// Whether both halves are clear: what is left to do for most polynomials without roots that are not clear themselves.
template <int N>
RAYMO_INLINE bool halves_are_clear(const Bernstein<N>& p, double noise, double size) {
    Bernstein<N> left, right;
    Halves<N> halves{left, right, {}, {}};
    halve<N>(p, halves);
    const double doubt = doubt_of_halves(N, noise, size);
    const double least = lane_min(halves.least[0], halves.least[1]);
    const double most = lane_max(halves.most[0], halves.most[1]);
    // A number that is none may be lost among the others, but comes to the middle.
    return ((least > doubt) | (most < -doubt)) & (std::fabs(left[N]) > doubt);
}

/// Whether p is as a simple crossing is; then it is told.
template <int N>
RAYMO_INLINE bool tell_simple(const Bernstein<N>& p, double noise, RootList<N>& out) {
    if ((p[0] < 0.0) == (p[N] < 0.0) || !is_simple<N>(p, noise)) return false;
    out.count = 1;
    out.root[0] = {zero_across<N>(p), 0.0, 1.0, true, p[0] < 0.0};
    return true;
}

/// p is neither clear nor simple.
template <int N>
void isolate(const Bernstein<N>& p, double noise, double least, double most, RootList<N>& out) {
    Teller<N> teller(out);
    // Pieces that wait, the next one last; beyond it is room for a half.
    std::array<Piece<N>, kMostDepth + 1> pieces;
    std::array<Piece<N>*, kMostDepth + 1> waiting;
    std::size_t made = 1;
    std::size_t last = 0;
    waiting[0] = pieces.data();
    Piece<N>& first = pieces[0];
    first.c = p;
    first.lo = {0.0, true, p[0] < 0.0};
    first.hi = {1.0, true, p[N] < 0.0};
    first.least = least;
    first.most = most;
    first.doubt = noise;
    first.depth = 0;
    int halvings = 0;
    for (;;) {
        Piece<N>& right = *waiting[last];
        if (tell<N>(teller, right)) {
            if (last-- == 0) return;
            continue;
        }
        if (++halvings > kMostHalvings) {
            right.depth = kMostDepth;
            continue;
        }
        if (made == last + 1) {
            waiting[made] = &pieces[made];
            ++made;
        }
        Piece<N>& left = *waiting[last + 1];
        const double doubt = doubt_of_halves(N, right.doubt, right.size());
        Halves<N> halves{left.c, right.c, {}, {}};
        halve<N>(right.c, halves);
        left.least = halves.least[0];
        left.most = halves.most[0];
        right.least = halves.least[1];
        right.most = halves.most[1];
        const double value = left.c[N];
        const End middle{0.5 * (right.lo.u + right.hi.u), std::fabs(value) > doubt, value < 0.0};
        left.lo = right.lo;
        left.hi = middle;
        right.lo = middle;
        left.doubt = doubt;
        right.doubt = doubt;
        left.depth = ++right.depth;
        const bool left_clear = left.least > doubt || left.most < -doubt;
        const bool right_clear = right.least > doubt || right.most < -doubt;
        if (right_clear) {
            if (!left_clear) {
                std::swap(waiting[last], waiting[last + 1]);
            } else if (last-- == 0) {
                return;
            }
        } else if (!left_clear) {
            ++last;
        }
    }
}

/// Everything is in doubt, or the numbers are too large to compute with.
template <int N>
void isolate_unfit(const Bernstein<N>& p, double noise, RootList<N>& out) {
    bool finite = std::isfinite(noise) && noise >= 0.0;
    for (const double x : p) finite = finite && std::isfinite(x);
    if (finite) {
        // Signs are kept where a number vanishes.
        Bernstein<N> small;
        for (std::size_t i = 0; i <= N; ++i) {
            small[i] = p[i] * 0x1p-530;
            if (small[i] == 0.0 && p[i] < 0.0) small[i] = -0x1p-1074;
        }
        const double more = noise * 0x1p-530 + 0x1p-1074;
        double least, most;
        extremes<N>(small, least, most);
        if (!tell_simple<N>(small, more, out)) isolate<N>(small, more, least, most, out);
        return;
    }
    Teller<N>(out).blur({0.0, true, p[0] < 0.0}, {1.0, true, p[N] < 0.0}, 0.0, 1.0, 0.5);
}

/// Whether a polynomial with these extremes can be computed with; but a coefficient may be NaN.
RAYMO_INLINE bool is_fit(double least, double most, double noise) {
    return lane_max(-least, most) <= kLargest && noise >= 0.0 && noise <= kLargest;
}

template <int N>
RAYMO_INLINE bool has_nan(const Bernstein<N>& p) {
    double sum = 0.0;
    for (const double x : p) sum += x;
    return std::isnan(sum);
}

/// p has the same sign at 0 and 1, and is not clear.
template <int N>
[[gnu::noinline]] void find_none_or_more(const Bernstein<N>& p, double noise, double least,
                                         double most, RootList<N>& out) {
    const bool fit = is_fit(least, most, noise);
    if (fit && halves_are_clear<N>(p, noise, lane_max(-least, most))) {
        out.count = 0;
    } else if (fit && !has_nan<N>(p)) {
        isolate<N>(p, noise, least, most, out);
    } else {
        isolate_unfit<N>(p, noise, out);
    }
}

/// p has different signs at 0 and 1.
template <int N>
[[gnu::noinline]] void find_one_or_more(const Bernstein<N>& p, double noise, double least,
                                        double most, RootList<N>& out) {
    if (!is_fit(least, most, noise) || has_nan<N>(p)) {
        isolate_unfit<N>(p, noise, out);
    } else if (!tell_simple<N>(p, noise, out)) {
        isolate<N>(p, noise, least, most, out);
    }
}

}  // namespace

template <int N>
double crossing_of(const Bernstein<N>& p) {
    return zero_across<N>(p);
}

template <int N>
void find_roots(const Bernstein<N>& p, double noise, RootList<N>& out) {
    const bool same = (p[0] < 0.0) == (p[N] < 0.0);
    if constexpr (N >= kOutweighedFrom) {
        if (same && is_outweighed<N>(p, noise)) {
            out.count = 0;
            return;
        }
    }
    double least, most;
    extremes<N>(p, least, most);
    if ((least > noise) | (most < -noise)) {
        out.count = 0;
    } else if (same) {
        find_none_or_more<N>(p, noise, least, most, out);
    } else {
        find_one_or_more<N>(p, noise, least, most, out);
    }
}

#define RAYMO_DEGREE(N)                                  \
    template double crossing_of<N>(const Bernstein<N>&); \
    template void find_roots<N>(const Bernstein<N>&, double, RootList<N>&);
RAYMO_DEGREE(1)
RAYMO_DEGREE(2)
RAYMO_DEGREE(3)
RAYMO_DEGREE(4)
RAYMO_DEGREE(5)
RAYMO_DEGREE(6)
RAYMO_DEGREE(7)
RAYMO_DEGREE(8)
RAYMO_DEGREE(9)
RAYMO_DEGREE(10)
#undef RAYMO_DEGREE

}  // namespace raymo::curves
