// What find_roots has told, judged by another method in wider numbers.
//
// The oracle knows nothing of sign variation: it finds the zeros of all derivatives, from that of degree 1 on, each between
// two of the next derivative, by bisection and Newton's steps. Between the zeros of p' the polynomial is monotone, so its
// values there and at 0 and 1 tell where and how often it crosses zero.
#pragma once

#include <cmath>
#include <limits>
#include <string>

#include "raymo/curves/roots.hpp"

namespace raymo::laws {

/// Numbered by int, as degrees are.
template <class T, int M>
struct Row {
    T items[M];

    T& operator[](int i) { return items[i]; }
    const T& operator[](int i) const { return items[i]; }
};

/// p and its derivatives (without their constant factors) in numbers of type F, of at least 64 bits.
template <class F, int N>
class RootOracle {
public:
    explicit RootOracle(const curves::Bernstein<N>& p) {
        Row<F, N + 1> d;
        for (int i = 0; i <= N; ++i) {
            d[i] = p[static_cast<std::size_t>(i)];
            size_ = std::max(size_, std::fabs(p[static_cast<std::size_t>(i)]));
        }
        for (int n = N; n >= 1; --n) {
            F binomial = 1;
            for (int i = 0; i <= n; ++i) {
                a_[n][i] = binomial * d[i];
                binomial = binomial * (n - i) / (i + 1);
            }
            for (int i = 0; i < n; ++i) d[i] = d[i + 1] - d[i];
        }
        count_ = 0;
        Row<F, N + 2> before;
        for (int n = 1; n < N; ++n) {
            int found = 0;
            Row<F, N + 2> zeros;
            for (int i = 0; i <= count_; ++i) {
                const F lo = i == 0 ? F(0) : before[i - 1];
                const F hi = i == count_ ? F(1) : before[i];
                if (lo < hi && (value(n, lo) < 0) != (value(n, hi) < 0))
                    zeros[found++] = zero(n, lo, hi);
            }
            before = zeros;
            count_ = found;
        }
        for (int i = 0; i < count_; ++i) {
            place_[i] = before[i];
            extreme_[i] = value(N, before[i]);
        }
    }

    [[nodiscard]] F at(double u) const { return value(N, F(u)); }
    [[nodiscard]] double size() const { return size_; }
    /// Of `at`: 3 N operations, each relative to a sum of which the terms' sizes add up to no more than `size`.
    [[nodiscard]] F error() const { return F(4 * N) * std::numeric_limits<F>::epsilon() * size_; }
    [[nodiscard]] int count() const { return count_; }
    [[nodiscard]] const F& place(int i) const { return place_[i]; }
    [[nodiscard]] const F& extreme(int i) const { return extreme_[i]; }

private:
    [[nodiscard]] F value(int n, const F& u) const {
        const F v = 1 - u;
        F power = 1;
        F sum = a_[n][n];
        for (int i = n - 1; i >= 0; --i) {
            power = power * v;
            sum = sum * u + a_[n][i] * power;
        }
        return sum;
    }

    /// Of the derivative of degree n, which is monotone from lo to hi.
    [[nodiscard]] F zero(int n, F lo, F hi) const {
        using std::fabs;
        const bool rises = value(n, lo) < 0;
        F u = (lo + hi) / 2;
        F last = hi - lo;
        for (int round = 0; round < 2000; ++round) {
            const F y = value(n, u);
            if ((y < 0) == rises) {
                lo = u;
            } else {
                hi = u;
            }
            if (hi - lo <= std::numeric_limits<F>::epsilon() / 2) break;
            const F slope = n > 1 ? F(n) * value(n - 1, u) : F(a_[1][1] - a_[1][0]);
            const F step = slope == 0 ? F(2) : F(y / slope);
            if (fabs(step) <= std::numeric_limits<F>::epsilon() / 4) break;
            const F next = u - step;
            if (next > lo && next < hi && 2 * fabs(step) < last) {
                u = next;
                last = fabs(step);
            } else {
                u = (lo + hi) / 2;
                last = (hi - lo) / 2;
            }
        }
        return u;
    }

    Row<Row<F, N + 1>, N + 1> a_;  ///< of the derivative of degree n, times binomials
    Row<F, N + 1> place_, extreme_;
    int count_;
    double size_ = 0.0;
};

/// Empty when the list is right:
/// - crossings alternate, and as many are told as the signs of the ends ask for;
/// - intervals ascend, and each root is in its own;
/// - p has different signs at the ends of a crossing, and does not cross zero outside of what is told;
/// - nothing that comes within `noise` of zero is left out;
/// - a crossing hides two others, and a touch is told, only where p comes nearer to zero than `blur`.
template <class F, int N>
std::string misjudged(const curves::Bernstein<N>& p, double noise,
                      const curves::RootList<N>& list) {
    using std::fabs;
    const RootOracle<F, N> oracle(p);
    const F error = oracle.error();
    // Twice the doubt of a piece (roots.cpp), with room for ten halvings at full size.
    const F blur =
        2 * (F(noise) + F((4 * N * N + 12 * N) * 0x1p-53) * oracle.size() + F(N * 0x1p-1070));

    // A walk over the ends of the intervals and the extremes in between.
    bool negative = p[0] < 0.0;
    double end = 0.0;
    int next = 0;  // extreme
    const auto sign_at = [&](double u) {
        return u == 0.0 ? F(p[0]) : u == 1.0 ? F(p[N]) : oracle.at(u);
    };
    const auto clear = [&](double lo, double hi) {
        // Outside of what is told: all one sign, as far as this can be known.
        const F ends[] = {sign_at(lo), sign_at(hi)};
        for (const F& y : ends) {
            if (fabs(y) > error && (y < 0) != negative) return false;
        }
        for (; next < oracle.count() && oracle.place(next) < F(hi); ++next) {
            if (oracle.place(next) <= F(lo)) continue;
            const F& y = oracle.extreme(next);
            if (fabs(y) > error && (y < 0) != negative) return false;
            // At 0 and 1 the sign counts as it stands, and p may be level there.
            const bool at_end = (lo == 0.0 && fabs(y - F(p[0])) <= 2 * error) ||
                                (hi == 1.0 && fabs(y - F(p[N])) <= 2 * error);
            if (fabs(y) + error < F(noise) && !at_end) return false;
        }
        return true;
    };
    for (const curves::Root& root : list) {
        if (!(root.lo >= end && root.lo <= root.u && root.u <= root.hi && root.hi <= 1.0))
            return "intervals do not ascend";
        if (!clear(end, root.lo)) return "a zero is missing before a root";
        F least = fabs(sign_at(root.lo));
        bool now = negative;
        int changes = 0;
        for (; next < oracle.count() && oracle.place(next) <= F(root.hi); ++next) {
            const F& y = oracle.extreme(next);
            if (oracle.place(next) < F(root.lo)) continue;
            if (fabs(y) < least) least = fabs(y);
            if (fabs(y) > blur && (y < 0) != now) {
                now = !now;
                ++changes;
            }
        }
        const F last = sign_at(root.hi);
        if (fabs(last) < least) least = fabs(last);
        if (root.crosses) {
            if (root.rises != negative) return "crossings do not alternate";
            const bool known = fabs(last) > error || root.hi == 1.0;
            if (known && (last < 0) == negative) return "a crossing does not cross";
            if (now == negative) ++changes;
            if (changes != 1) return "a crossing hides others";
            negative = !negative;
            if (fabs(oracle.at(root.u)) > blur) return "a crossing is not at its place";
        } else {
            if (root.rises) return "a touch rises";
            if (fabs(last) > blur && (last < 0) != negative) return "a touch crosses";
            if (changes != 0) return "a touch hides crossings";
            if (least > blur) return "a touch does not touch";
        }
        end = root.hi;
    }
    if (!clear(end, 1.0)) return "a zero is missing after the last root";
    if (negative != (p[N] < 0.0)) return "the parity is wrong";
    return {};
}

}  // namespace raymo::laws
