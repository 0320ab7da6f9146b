#include "raymo/curves/sturm.hpp"

#include "raymo/math/tolerance.hpp"

namespace raymo::curves {
namespace {

template <int N>
void evaluate(const Powers<N>& f, double x, double& value, double& slope) {
    value = f[N];
    slope = 0.0;
    for (std::size_t i = N; i-- > 0;) {
        slope = slope * x + value;
        value = value * x + f[i];
    }
}

/// The zero in [lo, hi], where f has different signs.
template <int N>
double zero_between(const Powers<N>& f, double lo, double hi, bool rises) {
    double x = 0.5 * (lo + hi);
    double last = hi - lo;
    for (int round = 0; round < 100; ++round) {
        double value, slope;
        evaluate<N>(f, x, value, slope);
        if ((value < 0.0) == rises) {
            lo = x;
        } else {
            hi = x;
        }
        const double step = value / slope;
        const double next = x - step;
        if (next > lo && next < hi && 2.0 * std::fabs(step) <= last) {
            last = std::fabs(step);
            x = next;
            // Of second order: what this step leaves is below the last bit.
            if (last <= 0x1p-28) break;
        } else {
            last = 0.5 * (hi - lo);
            x = lo + last;
            if (last <= 0x1p-53) break;
        }
    }
    return x;
}

/// The same, by its sign in the middle.
template <int N>
double zero_by_bisection(const Powers<N>& f, double lo, double hi, bool rises) {
    while (hi - lo > 0x1p-53) {
        const double x = 0.5 * (lo + hi);
        double value = f[N];
        for (std::size_t i = N; i-- > 0;) value = value * x + f[i];
        if ((value < 0.0) == rises) {
            lo = x;
        } else {
            hi = x;
        }
    }
    return 0.5 * (lo + hi);
}

}  // namespace

template <int N>
Powers<N> powers_of(const Bernstein<N>& p) {
    // The coefficient of x^k is binomial(N, k) times the k-th difference at 0.
    Bernstein<N> d = p;
    Powers<N> f{};
    for (std::size_t k = 0; k <= N; ++k) {
        f[k] = binomial(N, static_cast<int>(k)) * d[0];
        for (std::size_t i = 0; i + k < N; ++i) d[i] = d[i + 1] - d[i];
    }
    return f;
}

template <int N>
SturmChain<N>::SturmChain(const Powers<N>& f) {
    std::size_t degree = N;
    while (degree > 0 && f[degree] == 0.0) --degree;
    f_[0] = f;
    degree_[0] = static_cast<int>(degree);
    count_ = 1;
    if (degree == 0) return;
    for (std::size_t i = 0; i < degree; ++i) f_[1][i] = static_cast<double>(i + 1) * f[i + 1];
    degree_[1] = static_cast<int>(degree - 1);
    count_ = 2;
    while (count_ <= N) {
        const auto j = static_cast<std::size_t>(count_ - 2);
        const Powers<N>& a = f_[j];
        const Powers<N>& b = f_[j + 1];
        const auto m = static_cast<std::size_t>(degree_[j]);
        const auto n = static_cast<std::size_t>(degree_[j + 1]);
        if (n == 0) break;
        Powers<N>& r = f_[j + 2];
        const double inverse = 1.0 / b[n];
        if (m == n + 1) {
            const double q1 = a[m] * inverse;
            const double q0 = (a[n] - q1 * b[n - 1]) * inverse;
            q1_[j] = q1;
            q0_[j] = q0;
            r[0] = q0 * b[0] - a[0];
            for (std::size_t i = 1; i < n; ++i) r[i] = q1 * b[i - 1] + q0 * b[i] - a[i];
        } else {
            regular_ = false;
            Powers<N> rest = a;
            for (std::size_t k = m - n + 1; k-- > 0;) {
                const double q = rest[n + k] * inverse;
                for (std::size_t i = 0; i < n; ++i) rest[i + k] -= q * b[i];
            }
            for (std::size_t i = 0; i < n; ++i) r[i] = -rest[i];
        }
        // What is left of a common divisor is rounding of the terms it comes from.
        double size = 0.0;
        for (std::size_t i = 0; i <= m; ++i) size = std::max(size, std::fabs(a[i]));
        std::size_t k = n - 1;
        while (k > 0 && std::fabs(r[k]) <= 4.0 * kUnitRoundoff * size) --k;
        if (std::fabs(r[k]) <= 4.0 * kUnitRoundoff * size) {
            regular_ = false;
            break;
        }
        degree_[j + 2] = static_cast<int>(k);
        ++count_;
    }
    const auto last = static_cast<std::size_t>(count_ - 1);
    regular_ = regular_ && degree_[last] == 0 && count_ == static_cast<int>(degree) + 1;
    if (regular_) {
        q1_[last - 1] = f_[last - 1][1] / f_[last][0];
        q0_[last - 1] = f_[last - 1][0] / f_[last][0];
    }
}

template <int N>
int SturmChain<N>::changes(double x) const {
    int changes = 0;
    if (regular_) {
        double after = 0.0;
        double value = f_[static_cast<std::size_t>(count_ - 1)][0];
        for (auto j = static_cast<std::size_t>(count_ - 1); j-- > 0;) {
            const double before = (q1_[j] * x + q0_[j]) * value - after;
            changes += (before < 0.0) != (value < 0.0) ? 1 : 0;
            after = value;
            value = before;
        }
        return changes;
    }
    bool negative = false;
    for (std::size_t j = 0; j < static_cast<std::size_t>(count_); ++j) {
        double value = 0.0;
        for (auto i = static_cast<std::size_t>(degree_[j]) + 1; i-- > 0;)
            value = value * x + f_[j][i];
        changes += j > 0 && (value < 0.0) != negative ? 1 : 0;
        negative = value < 0.0;
    }
    return changes;
}

template <int N>
SturmRoots<N> sturm_roots(const Powers<N>& f, SturmFinish finish) {
    constexpr double kShortest = 0x1p-40;
    struct Interval {
        double lo, hi;
        int before, after;  ///< V there
    };
    SturmRoots<N> out;
    const SturmChain<N> chain(f);
    std::array<Interval, 44> waiting;
    std::size_t count = 0;
    waiting[count++] = {0.0, 1.0, chain.changes(0.0), chain.changes(1.0)};
    while (count > 0 && out.count < N) {
        const Interval at = waiting[--count];
        const int zeros = at.before - at.after;
        if (zeros <= 0) continue;
        if (zeros == 1) {
            double slope, lo, hi;
            evaluate<N>(f, at.lo, lo, slope);
            evaluate<N>(f, at.hi, hi, slope);
            if ((lo < 0.0) != (hi < 0.0)) {
                out.u[static_cast<std::size_t>(out.count++)] =
                    finish == SturmFinish::newton ? zero_between<N>(f, at.lo, at.hi, lo < 0.0)
                                                  : zero_by_bisection<N>(f, at.lo, at.hi, lo < 0.0);
                continue;
            }
        }
        const double middle = 0.5 * (at.lo + at.hi);
        if (at.hi - at.lo <= kShortest) {
            out.u[static_cast<std::size_t>(out.count++)] = middle;
            continue;
        }
        const int changes = chain.changes(middle);
        waiting[count++] = {middle, at.hi, changes, at.after};
        waiting[count++] = {at.lo, middle, at.before, changes};
    }
    return out;
}

#define RAYMO_DEGREE(N)                                   \
    template Powers<N> powers_of<N>(const Bernstein<N>&); \
    template class SturmChain<N>;                         \
    template SturmRoots<N> sturm_roots<N>(const Powers<N>&, SturmFinish);
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
