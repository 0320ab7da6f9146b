#include "raymo/curves/roots.hpp"

namespace raymo::curves {
namespace {

/// p and p' at u.
template <int N>
void evaluate(const Bernstein<N>& c, double u, double& value, double& slope) {
    Bernstein<N> b = c;
    const double v = 1.0 - u;
    for (std::size_t n = N; n > 1; --n) {
        for (std::size_t i = 0; i < n; ++i) b[i] = v * b[i] + u * b[i + 1];
    }
    value = v * b[0] + u * b[1];
    slope = N * (b[1] - b[0]);
}

/// The polynomial on one of the intervals that are looked at.
template <int N>
struct Piece {
    Bernstein<N> c;
    double lo, hi;
};

/// Intervals shorter than this are not halved again.
constexpr double kShortest = 0x1p-40;

template <int N>
void add(RootList<N>& out, const Root& root) {
    // Neighbouring touches are one.
    if (!root.crosses && out.count > 0) {
        Root& last = out.root[static_cast<std::size_t>(out.count - 1)];
        if (!last.crosses && last.hi == root.lo) {
            last.hi = root.hi;
            last.u = 0.5 * (last.lo + last.hi);
            return;
        }
    }
    if (static_cast<std::size_t>(out.count) < out.root.size())
        out.root[static_cast<std::size_t>(out.count++)] = root;
}

template <int N>
bool is_monotone(const Bernstein<N>& c) {
    bool rises = true;
    bool falls = true;
    for (std::size_t i = 0; i < N; ++i) {
        rises = rises && c[i + 1] >= c[i];
        falls = falls && c[i + 1] <= c[i];
    }
    return rises || falls;
}

}  // namespace

template <int N>
double crossing_of(const Bernstein<N>& p) {
    const bool rises = p[0] < 0.0;
    double lo = 0.0;
    double hi = 1.0;
    // From the chord on, Newton's steps; where one leaves the bracket or comes too slowly, a halving.
    double u = p[0] / (p[0] - p[N]);
    double last_width = 1.0;
    for (int i = 0; i < 100; ++i) {
        if (!(u > lo && u < hi)) u = 0.5 * (lo + hi);
        double value, slope;
        evaluate<N>(p, u, value, slope);
        if ((value < 0.0) == rises) {
            lo = u;
        } else {
            hi = u;
        }
        if (value == 0.0) return u;
        double next = u - value / slope;
        if (i % 3 == 2) {
            if (!(hi - lo < 0.5 * last_width)) next = 0.5 * (lo + hi);
            last_width = hi - lo;
        }
        if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
        if (std::fabs(next - u) <= 0x1p-53 * (1.0 + u) || hi - lo <= 0x1p-53) return next;
        u = next;
    }
    return u;
}

template <int N>
void find_roots(const Bernstein<N>& p, double noise, RootList<N>& out) {
    std::array<Piece<N>, 64> open;
    std::size_t count = 0;
    open[count++] = {p, 0.0, 1.0};
    while (count > 0) {
        const Piece<N> at = open[--count];
        const auto [least, most] = std::minmax_element(at.c.begin(), at.c.end());
        if (*least > noise || *most < -noise) continue;
        const int changes = sign_changes(at.c);
        const bool rises = at.c[0] < 0.0;
        if (changes == 1) {
            add(out, {at.lo + (at.hi - at.lo) * crossing_of<N>(at.c), at.lo, at.hi, true, rises});
            continue;
        }
        // Next to a crossing, or to an end, that others tell of.
        if (changes == 0 && is_monotone<N>(at.c)) continue;
        if (at.hi - at.lo <= kShortest || std::max(-*least, *most) <= noise) {
            const bool crosses = (at.c[0] < 0.0) != (at.c[N] < 0.0);
            add(out, {0.5 * (at.lo + at.hi), at.lo, at.hi, crosses, crosses && rises});
            continue;
        }
        const double middle = 0.5 * (at.lo + at.hi);
        Piece<N> left{{}, at.lo, middle};
        Piece<N> right{{}, middle, at.hi};
        split(at.c, 0.5, left.c, right.c);
        open[count++] = right;
        open[count++] = left;
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
