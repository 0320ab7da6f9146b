// Isolation by sign variation.
//
// A piece is p on a dyadic interval, in Bernstein form on [0, 1] again. Pieces are taken from left to right. One is done when
// its coefficients leave no doubt, or when its shape is so simple that one or two places tell all; else it is halved.
//
// Parity. A halving takes means of neighbours and drops rows of them. In rounded arithmetic, too, the mean of a and b lies
// between them, so it has the sign of one of them (0 counting as positive; 0.5 (a + b) of two negative numbers does not
// underflow to 0), and putting it between them adds no change of sign. Hence
//     changes(left) + changes(right) <= changes(p) <= N                                                    (1)
// for the coefficients as computed, and both halves share the computed value in the middle bit for bit. Each piece that is
// done tells of an odd number of crossings if the signs at its ends are different and of an even number if they are equal.
// So, whatever rounding does to the values in between, crossings alternate, their parity is that of the ends of p, and there
// are at most N.
//
// Certainty. Each mean of a halving has a relative error of u (and 2^-1074), N of them follow each other, and later means do
// not make errors larger. With `doubt` for the bound of the error of the coefficients of a piece, input noise included,
//     doubt(half) = doubt(piece) + N u size(piece) + N 2^-1074.                                            (2)
// A sign counts as known where the number is larger than the doubt, and at 0 and 1, where it is taken as it stands since
// the neighbours of p take it as well. Pieces that meet where the sign is not known are told together, from the last known
// sign before to the first one after: as a crossing if these are different, else as a touch.
//
// Pieces that are done:
//   clear     all coefficients have one known sign: no zero;
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

#include "raymo/curves/crossing.hpp"
#include "raymo/math/tolerance.hpp"

namespace raymo::curves {
namespace {

constexpr int kMostDepth = 48;
constexpr int kMostHalvings = 1000;
/// Pieces of fewer halvings are not searched for a hump: a halving is cheaper.
constexpr int kHumpDepth = 2;
/// Larger coefficients are scaled down, so that differences and binomial multiples stay finite.
constexpr double kLargest = 0x1p1000;

/// A place on [0, 1] and what is known there.
struct End {
    double u;
    double value;
    bool known;

    [[nodiscard]] bool negative() const { return value < 0.0; }
};

/// Joins what pieces tell, in ascending order, into roots.
template <int N>
class Teller {
public:
    explicit Teller(RootList<N>& out) : out_(out) { out_.count = 0; }

    RAYMO_INLINE void crossing(double u, const End& from, const End& to) {
        put({u, from.u, to.u, true, from.negative()});
    }

    /// Between `from` and `to`, of which not both need be known, p is near zero in [lo, hi] only; u: the crossing, if any.
    void blur(const End& from, const End& to, double lo, double hi, double u) {
        if (!open_) {
            open_ = true;
            start_ = from;
            lo_ = lo;
            has_u_ = false;
        }
        if (from.negative() != to.negative() && !has_u_) {
            has_u_ = true;
            u_ = u;
        }
        if (!to.known) {
            hi_ = hi;
            return;
        }
        open_ = false;
        if (start_.negative() != to.negative()) {
            crossing(has_u_ ? u_ : 0.5 * (lo_ + hi), start_, to);
        } else {
            touch(lo_, hi);
        }
    }

private:
    void put(const Root& root) { out_.root[static_cast<std::size_t>(out_.count++)] = root; }

    void touch(double lo, double hi) {
        if (out_.count > 0) {
            Root& last = out_.root[static_cast<std::size_t>(out_.count - 1)];
            if (!last.crosses && last.hi >= lo) {
                last.hi = hi;
                last.u = 0.5 * (last.lo + hi);
                return;
            }
        }
        if (touches_ == N + 2) return;
        ++touches_;
        put({0.5 * (lo + hi), lo, hi, false, false});
    }

    RootList<N>& out_;
    int touches_ = 0;
    bool open_ = false;
    End start_{};
    double lo_ = 0.0, hi_ = 0.0;
    bool has_u_ = false;
    double u_ = 0.0;
};

template <int N>
struct Piece {
    Bernstein<N> c;
    End lo, hi;
    double least, most;  ///< of c
    double doubt;
    int depth;

    [[nodiscard]] double size() const { return std::max(-least, most); }
};

/// Least and most of c: no value of p lies outside.
template <int N>
RAYMO_INLINE void extremes(const Bernstein<N>& c, double& least, double& most) {
    least = c[0];
    most = c[0];
    for (std::size_t i = 1; i <= N; ++i) {
        least = c[i] < least ? c[i] : least;
        most = c[i] > most ? c[i] : most;
    }
}

/// The place in [x0, x1], with the values y0 and y1 at its ends, where c passes `level`; `otherwise` where it does not.
template <int N>
double place_of(Bernstein<N> c, double level, double x0, double x1, double y0, double y1,
                double otherwise) {
    if ((y0 < level) == (y1 < level)) return otherwise;
    for (double& x : c) x -= level;
    return zero_within<N>(c, {x0, x1, y0 - level, y1 - level, 0.5 * (x0 + x1)});
}

/// p is monotone on [x0, x1] of the piece, whose ends there are e0 and e1.
template <int N>
RAYMO_INLINE void tell_monotone(Teller<N>& teller, const Piece<N>& at, double x0, double x1,
                                const End& e0, const End& e1, double guess) {
    const bool crosses = e0.negative() != e1.negative();
    if (e0.known && e1.known && !crosses) return;
    double u = 0.5 * (e0.u + e1.u);
    if (crosses) {
        const double x = zero_within<N>(at.c, {x0, x1, e0.value, e1.value, guess});
        u = std::min(std::max(at.lo.u + (at.hi.u - at.lo.u) * x, e0.u), e1.u);
        if (e0.known && e1.known) {
            teller.crossing(u, e0, e1);
            return;
        }
    }
    double lo = e0.u;
    double hi = e1.u;
    if (e0.known || e1.known) {
        const double level = (e0.known ? e0 : e1).negative() ? -at.doubt : at.doubt;
        const double x = place_of<N>(at.c, level, x0, x1, e0.value, e1.value, e0.known ? x0 : x1);
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
    End middle{at.lo.u + (at.hi.u - at.lo.u) * m, value, false};
    middle.known = std::fabs(value) > at.doubt + (4 * N * N + 2 * N) * kUnitRoundoff * size;
    // About m it is a parabola.
    const double left = 1.0 - std::sqrt(std::fabs(value / (value - at.lo.value)));
    const double right = std::sqrt(std::fabs(value / (value - at.hi.value)));
    tell_monotone<N>(teller, at, 0.0, m, at.lo, middle, m * left);
    tell_monotone<N>(teller, at, m, 1.0, middle, at.hi, m + (1.0 - m) * right);
}

/// Of `count` bits: whether those from some place on are different from those before it.
constexpr bool changes_once(unsigned bits, unsigned count) {
    const unsigned changes = (bits ^ (bits >> 1U)) & ((1U << (count - 1U)) - 1U);
    return changes != 0 && (changes & (changes - 1U)) == 0;
}

/// Whether the coefficients, the ends apart, are as a simple crossing has them.
template <int N>
RAYMO_INLINE bool is_simple(const Piece<N>& at) {
    const bool rises = at.lo.negative();
    unsigned negative = rises ? 1U : 1U << N;
    unsigned positive = rises ? 1U << N : 1U;
    for (unsigned i = 1; i < N; ++i) {
        negative |= (at.c[i] < -at.doubt ? 1U : 0U) << i;
        positive |= (at.c[i] > at.doubt ? 1U : 0U) << i;
    }
    return changes_once(negative, N + 1) && changes_once(positive, N + 1);
}

/// Whether the piece is done.
template <int N>
RAYMO_INLINE bool tell(Teller<N>& teller, const Piece<N>& at) {
    if (at.lo.known && at.hi.known && at.lo.negative() != at.hi.negative() && is_simple<N>(at)) {
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
            tell_monotone<N>(teller, at, 0.0, 1.0, at.lo, at.hi, 0.5);
            return true;
        }
        if (changes_once(falls, N)) {
            tell_humped<N>(teller, at, d);
            return true;
        }
        return false;
    } else {
        tell_monotone<N>(teller, at, 0.0, 1.0, at.lo, at.hi, 0.5);
        return true;
    }
}

/// 0.5 (a + b) for all neighbours, again and again. `c` becomes the right half.
template <int N>
RAYMO_INLINE void halve(Bernstein<N>& c, Bernstein<N>& left) {
    Bernstein<N> b = c;
    left[0] = b[0];
    for (std::size_t n = N; n > 0; --n) {
        for (std::size_t i = 0; i < n; ++i) b[i] = 0.5 * (b[i] + b[i + 1]);
        left[N + 1 - n] = b[0];
    }
    c = b;
}

constexpr double doubt_of_halves(int degree, double doubt, double size) {
    return doubt + ((degree + 1) * kUnitRoundoff) * size + degree * 0x1p-1074;
}

/// Whether both halves are clear: what is left to do for most polynomials without roots that are not clear themselves.
template <int N>
RAYMO_INLINE bool halves_are_clear(const Bernstein<N>& p, double noise, double least, double most) {
    Bernstein<N> right = p;
    Bernstein<N> left;
    halve<N>(right, left);
    const double doubt = doubt_of_halves(N, noise, std::max(-least, most));
    extremes<N>(left, least, most);
    double least_right, most_right;
    extremes<N>(right, least_right, most_right);
    return std::min(least, least_right) > doubt || std::max(most, most_right) < -doubt;
}

template <int N>
void isolate(const Bernstein<N>& p, double noise, double least, double most, RootList<N>& out) {
    Teller<N> teller(out);
    std::array<Piece<N>, kMostDepth + 1> waiting;
    Piece<N>* at = waiting.data();
    at->c = p;
    at->lo = {0.0, p[0], true};
    at->hi = {1.0, p[N], true};
    at->least = least;
    at->most = most;
    at->doubt = noise;
    at->depth = 0;
    int halvings = 0;
    for (;;) {
        if (tell<N>(teller, *at)) {
            if (at-- == waiting.data()) return;
            continue;
        }
        if (++halvings > kMostHalvings) {
            at->depth = kMostDepth;
            continue;
        }
        Piece<N>& right = *at;
        Piece<N>& left = *(at + 1);
        const double doubt = right.doubt + ((N + 1) * kUnitRoundoff) * right.size() + N * 0x1p-1074;
        halve<N>(right.c, left.c);
        extremes<N>(left.c, left.least, left.most);
        extremes<N>(right.c, right.least, right.most);
        const double value = left.c[N];
        const End middle{0.5 * (right.lo.u + right.hi.u), value, std::fabs(value) > doubt};
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
                right = left;
                continue;
            }
            if (at-- == waiting.data()) return;
            continue;
        }
        if (!left_clear) ++at;
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
            small[i] = p[i] * 0x1p-30;
            if (small[i] == 0.0 && p[i] < 0.0) small[i] = -0x1p-1074;
        }
        double least, most;
        extremes<N>(small, least, most);
        isolate<N>(small, noise * 0x1p-30 + 0x1p-1074, least, most, out);
        return;
    }
    Teller<N>(out).blur({0.0, p[0], true}, {1.0, p[N], true}, 0.0, 1.0, 0.5);
}

}  // namespace

template <int N>
double crossing_of(const Bernstein<N>& p) {
    return zero_across<N>(p);
}

template <int N>
void find_roots(const Bernstein<N>& p, double noise, RootList<N>& out) {
    double least, most;
    extremes<N>(p, least, most);
    if (least > noise || most < -noise) {
        out.count = 0;
        return;
    }
    double sum = noise - noise;
    for (const double x : p) sum += x - x;  // NaN, unless all are finite
    if (noise >= 0.0 && noise <= kLargest && sum == 0.0 && least >= -kLargest && most <= kLargest) {
        if ((p[0] < 0.0) == (p[N] < 0.0) && halves_are_clear<N>(p, noise, least, most)) {
            out.count = 0;
            return;
        }
        isolate<N>(p, noise, least, most, out);
    } else {
        isolate_unfit<N>(p, noise, out);
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
