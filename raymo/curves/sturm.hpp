// Real roots by Sturm's method, as in [Wijk86 3.5]: what find_roots is compared with, in tests and benchmarks.
//
// F1 = F, F2 = F', and each further F is the negative of the remainder of the two before it:
//     F[j - 1] = Q[j - 1] F[j] - F[j + 1].                                                              (1)
// With V(x) the number of changes of sign among F1(x), F2(x), ..., the number of distinct zeros in (a, b] is V(a) - V(b).
// Nearly always each Q is linear and the last F constant; then (1), read from the end, gives all F at x with two
// multiplications each. Where a degree is left out the F are evaluated one by one.
//
// The remainders lose digits, most of them near multiple zeros, where signs of the last F are noise: pairs of zeros closer
// than about 1e-6 are miscounted now and then. find_roots does without divisions and knows what it does not know.
#pragma once

#include "raymo/curves/bernstein.hpp"

namespace raymo::curves {

/// Coefficients of 1, x, x^2, ...
template <int N>
using Powers = std::array<double, static_cast<std::size_t>(N) + 1>;

template <int N>
[[nodiscard]] Powers<N> powers_of(const Bernstein<N>& p);

template <int N>
class SturmChain {
public:
    /// Cost: 3 N^2 / 2 multiplications and N divisions.
    explicit SturmChain(const Powers<N>& f);

    /// V(x).
    [[nodiscard]] int changes(double x) const;

private:
    /// Row j holds F[j + 1], of degree degree_[j].
    std::array<Powers<N>, static_cast<std::size_t>(N) + 1> f_;
    std::array<int, static_cast<std::size_t>(N) + 1> degree_{};
    std::array<double, static_cast<std::size_t>(N) + 1> q0_{}, q1_{};  ///< Q[j + 1] = q1 x + q0
    int count_ = 0;
    bool regular_ = true;  ///< every Q is linear
};

template <int N>
struct SturmRoots {
    int count = 0;
    std::array<double, static_cast<std::size_t>(N)> u{};
};

/// How a zero that is alone in its interval is found.
enum class SturmFinish {
    bisection,  ///< as printed
    newton,     ///< by Newton's steps that stay within the interval
};

/// The distinct zeros in (0, 1], ascending, isolated by repeated halving, to 2^-53. Zeros closer than 2^-40 count as one.
/// Defined for N = 2..10.
template <int N>
[[nodiscard]] SturmRoots<N> sturm_roots(const Powers<N>& f,
                                        SturmFinish finish = SturmFinish::newton);

}  // namespace raymo::curves
