// Roots: what find_roots tells, against the oracle in long double and in 100 digits.
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cstdio>

#include "tests/laws/law.hpp"
#include "tests/laws/root_oracle.hpp"

namespace raymo::laws {
namespace {

using Digits100 = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<100, boost::multiprecision::digit_base_10, void,
                                         std::int32_t>,
    boost::multiprecision::et_off>;

double power_of_ten(Random& random, int lo, int hi) {
    return std::pow(10.0, random.uniform(lo, hi));
}

/// Somewhere in [0, 1]; ends, middle and other dyadic places more often than by chance.
double somewhere(Random& random) {
    switch (random.below(4)) {
        case 0:
            return random.below(2);
        case 1:
            return random.below(17) / 16.0;
        default:
            return random.uniform(0, 1);
    }
}

/// Multiplies p, of degree n, by a polynomial of degree 1 with the values a and b at 0 and 1.
template <int N>
void multiply(curves::Bernstein<N>& p, int n, double a, double b) {
    for (int i = n + 1; i >= 0; --i) {
        const double part = static_cast<double>(i) / (n + 1);
        const double from = i > 0 ? p[static_cast<std::size_t>(i - 1)] : 0.0;
        const double stay = i <= n ? p[static_cast<std::size_t>(i)] : 0.0;
        p[static_cast<std::size_t>(i)] = part * b * from + (1.0 - part) * a * stay;
    }
}

/// Roots that are hard to tell apart; the other factors at random.
template <int N>
curves::Bernstein<N> crowded(Random& random) {
    curves::Bernstein<N> p{};
    p[0] = random.chance(0.5) ? 1.0 : -1.0;
    const int many = 1 + random.below(std::min(N, random.chance(0.7) ? 2 : 4));
    const double centre = somewhere(random);
    const double apart = random.chance(0.2) ? 0.0 : power_of_ten(random, -17, -1);
    const double shift = random.chance(0.5) ? 0.0 : random.uniform(-2, 2) * apart;
    for (int n = 0; n < N; ++n) {
        if (n <= many) {
            const double root = centre + shift + (n == 0 ? 0.0 : (n % 2 == 0 ? -apart : apart) * n);
            multiply<N>(p, n, -root, 1.0 - root);
        } else {
            multiply<N>(p, n, random.uniform(-0.3, 1), random.uniform(-0.3, 1));
        }
    }
    return p;
}

template <int N>
curves::Bernstein<N> polynomial(Random& random) {
    curves::Bernstein<N> p{};
    switch (random.below(9)) {
        case 0:
            for (double& c : p) c = random.uniform(-1, 1);
            break;
        case 1:
            for (double& c : p) c = random.uniform(-1, 1) + 0.9;
            break;
        case 2:
            for (double& c : p) c = random.uniform(-1, 1) * std::ldexp(1.0, -random.below(60));
            break;
        case 3: {
            const int least = -300 + random.below(590);
            for (double& c : p)
                c = random.uniform(-1, 1) * power_of_ten(random, least, std::min(300, least + 40));
            break;
        }
        case 4:
            for (double& c : p) c = random.below(5) - 2;
            break;
        case 5:
            for (double& c : p) c = random.chance(0.3) ? 0.0 : random.uniform(-1, 1);
            break;
        case 6:  // a hump that comes near to zero
            for (double& c : p) c = random.uniform(0, 1);
            p[static_cast<std::size_t>(random.below(N + 1))] -= random.uniform(0, N);
            break;
        default:
            p = crowded<N>(random);
    }
    return p;
}

template <class F, int N>
void judge_one(Random& random, Tally& tally) {
    const curves::Bernstein<N> p = polynomial<N>(random);
    const double noise =
        random.chance(0.5) ? 0.0 : curves::size_of(p) * power_of_ten(random, -18, -7);
    curves::RootList<N> list;
    curves::find_roots<N>(p, noise, list);
    ++tally.rays;
    tally.samples += static_cast<std::uint64_t>(list.count) + 1;
    const std::string wrong = misjudged<F, N>(p, noise, list);
    if (wrong.empty()) return;
    std::string report = wrong + ": noise";
    char text[64];
    std::snprintf(text, sizeof text, " %.17g, p", noise);
    report += text;
    for (const double c : p) {
        std::snprintf(text, sizeof text, " %.17g", c);
        report += text;
    }
    tally.exception(std::move(report));
}

template <class F>
void judge(std::uint64_t polynomials, Random& random, Tally& tally) {
    constexpr void (*kOfDegree[])(Random&, Tally&) = {
        judge_one<F, 1>, judge_one<F, 2>, judge_one<F, 3>, judge_one<F, 4>, judge_one<F, 5>,
        judge_one<F, 6>, judge_one<F, 7>, judge_one<F, 8>, judge_one<F, 9>, judge_one<F, 10>};
    for (std::uint64_t i = 0; i < polynomials; ++i) kOfDegree[random.below(10)](random, tally);
}

}  // namespace

void add_root_laws(std::vector<Law>& laws) {
    laws.push_back({"roots of polynomials, told by long double", 100'000'000, judge<long double>});
    laws.push_back({"roots of polynomials, told by 100 digits", 1'000'000, judge<Digits100>});
}

}  // namespace raymo::laws
