#include "raymo/curves/roots.hpp"

#include <doctest/doctest.h>

#include <random>
#include <string>

#include "raymo/math/lanes.hpp"
#include "raymo/math/tolerance.hpp"

namespace raymo::curves {
namespace {

/// The product of (u - root) over some roots.
template <int N>
Bernstein<N> with_roots(const std::array<double, N>& roots) {
    std::array<double, 1> p{1.0};
    if constexpr (N == 1) {
        return product(p, std::array<double, 2>{-roots[0], 1.0 - roots[0]});
    } else {
        std::array<double, N - 1> rest{};
        std::copy_n(roots.begin() + 1, N - 1, rest.begin());
        return product(std::array<double, 2>{-roots[0], 1.0 - roots[0]}, with_roots<N - 1>(rest));
    }
}

TEST_CASE("roots of a product of lines are found in order") {
    RootList<6> list;
    find_roots<6>(with_roots<6>({0.1, 0.9, -0.5, 0.5, 0.3, 2.0}), 1e-16, list);
    REQUIRE(list.count == 4);
    const double expected[] = {0.1, 0.3, 0.5, 0.9};
    for (int i = 0; i < 4; ++i) {
        const Root& root = list.root[static_cast<std::size_t>(i)];
        CHECK(root.crosses);
        CHECK(root.u == doctest::Approx(expected[i]).epsilon(1e-13));
        CHECK(root.rises == (i % 2 == 0));
    }
}

TEST_CASE("a double root is a touch, a triple root one crossing") {
    RootList<2> twice;
    find_roots<2>(with_roots<2>({0.3, 0.3}), 1e-15, twice);
    REQUIRE(twice.count == 1);
    CHECK_FALSE(twice.root[0].crosses);
    CHECK(twice.root[0].lo <= 0.3);
    CHECK(twice.root[0].hi >= 0.3);
    RootList<3> thrice;
    find_roots<3>(with_roots<3>({0.3, 0.3, 0.3}), 1e-15, thrice);
    int crossings = 0;
    for (const Root& root : thrice) {
        if (!root.crosses) continue;
        ++crossings;
        CHECK(root.u == doctest::Approx(0.3).epsilon(1e-4));
    }
    CHECK(crossings == 1);
}

TEST_CASE("the number of crossings has the parity that the signs at the ends ask for") {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (int i = 0; i < 100000; ++i) {
        Bernstein<6> p;
        for (double& c : p) c = any(random) * std::ldexp(1.0, -static_cast<int>(random() % 40));
        if (random() % 4 == 0) p[random() % 7] = 0.0;
        RootList<6> list;
        find_roots<6>(p, 1e-17, list);
        bool negative = p[0] < 0.0;
        double last = -1.0;
        for (const Root& root : list) {
            CHECK(root.lo >= last - 1e-12);
            last = root.lo;
            if (!root.crosses) continue;
            CHECK(root.rises == negative);
            negative = !negative;
            CHECK(std::fabs(value_at(p, root.u)) <= 1e-12);
        }
        CHECK(negative == (p[6] < 0.0));
    }
}

/// c, with |c[i]| in `sizes`, at u, in longer numbers.
template <int N>
long double long_value(const Bernstein<N>& c, double u, long double& sizes, long double& slope) {
    std::array<long double, N + 1> b, size;
    for (std::size_t i = 0; i <= N; ++i) {
        b[i] = c[i];
        size[i] = std::fabs(c[i]);
    }
    const long double v = 1.0L - u;
    for (std::size_t n = N; n > 0; --n) {
        if (n == 1) slope = N * (b[1] - b[0]);
        for (std::size_t i = 0; i < n; ++i) {
            b[i] = v * b[i] + u * b[i + 1];
            size[i] = v * size[i] + u * size[i + 1];
        }
    }
    sizes = size[0];
    return b[0];
}

template <int N>
void check_places() {
    std::mt19937_64 random(23);
    std::uniform_real_distribution<double> any(0.0, 1.0);
    for (int k = 0; k < 20000; ++k) {
        Bernstein<N> p;
        const std::size_t change = 1 + random() % N;
        const bool rises = random() % 2 == 0;
        for (std::size_t i = 0; i <= N; ++i) {
            p[i] =
                any(random) * std::ldexp(1.0, -static_cast<int>(random() % (k % 2 == 0 ? 2 : 40)));
            if ((i < change) == rises) p[i] = -p[i];
        }
        const double u = crossing_of<N>(p);
        REQUIRE(u >= 0.0);
        REQUIRE(u <= 1.0);
        long double sizes, slope;
        const long double value = long_value<N>(p, u, sizes, slope);
        // 2 N roundings of each term, and two of u.
        REQUIRE(std::fabs(value) <=
                (2 * N * sizes + 2.0L * u * std::fabs(slope)) * static_cast<long double>(0x1p-53));
    }
}

TEST_CASE("the place of a crossing is right to the last bit that its values allow") {
    check_places<2>();
    check_places<3>();
    check_places<4>();
    check_places<5>();
    check_places<6>();
    check_places<7>();
    check_places<8>();
    check_places<9>();
    check_places<10>();
}

TEST_CASE("powers of two change nothing") {
    std::mt19937_64 random(17);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    int touches = 0;
    for (int k = 0; k < 3000; ++k) {
        Bernstein<10> p;
        for (double& c : p) c = any(random);
        if (k % 3 == 0)
            p = product(with_roots<2>({0.3, 0.3}),
                        Bernstein<8>{p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7], p[8]});
        const double noise = k % 2 == 0 ? 0.0 : 1e-9;
        RootList<10> list;
        find_roots<10>(p, noise, list);
        for (const int power : {-800, -480, 480, 505, 900}) {
            Bernstein<10> q;
            for (std::size_t i = 0; i <= 10; ++i) q[i] = std::ldexp(p[i], power);
            RootList<10> other;
            find_roots<10>(q, std::ldexp(noise, power), other);
            REQUIRE(list.count == other.count);
            for (int i = 0; i < list.count; ++i) {
                const Root& a = list.root[static_cast<std::size_t>(i)];
                const Root& b = other.root[static_cast<std::size_t>(i)];
                REQUIRE(a.u == b.u);
                REQUIRE(a.lo == b.lo);
                REQUIRE(a.hi == b.hi);
                REQUIRE(a.crosses == b.crosses);
                touches += a.crosses ? 0 : 1;
            }
        }
    }
    CHECK(touches > 100);
}

// Four numbers with the operations of math/lanes.hpp, in place of a register.
struct Mask4 {
    std::array<bool, 4> m;
};
struct Four {
    std::array<double, 4> v;

    Four() = default;
    explicit Four(double x) : v{x, x, x, x} {}
};
template <class F>
Four each(Four a, Four b, F f) {
    for (std::size_t i = 0; i < 4; ++i) a.v[i] = f(a.v[i], b.v[i]);
    return a;
}
template <class F>
Mask4 test(Four a, Four b, F f) {
    Mask4 out{};
    for (std::size_t i = 0; i < 4; ++i) out.m[i] = f(a.v[i], b.v[i]);
    return out;
}
Four operator+(Four a, Four b) { return each(a, b, std::plus<>()); }
Four operator-(Four a, Four b) { return each(a, b, std::minus<>()); }
Four operator*(Four a, Four b) { return each(a, b, std::multiplies<>()); }
Four operator/(Four a, Four b) { return each(a, b, std::divides<>()); }
Mask4 operator<(Four a, Four b) { return test(a, b, std::less<>()); }
Mask4 operator>(Four a, Four b) { return test(a, b, std::greater<>()); }
Mask4 operator<=(Four a, Four b) { return test(a, b, std::less_equal<>()); }
Four lane_abs(Four a) {
    return each(a, a, [](double x, double) { return std::fabs(x); });
}
Four lane_sqrt(Four a) {
    return each(a, a, [](double x, double) { return std::sqrt(x); });
}
Four lane_select(Mask4 mask, Four yes, Four no) {
    for (std::size_t i = 0; i < 4; ++i) no.v[i] = mask.m[i] ? yes.v[i] : no.v[i];
    return no;
}
Four lane_min(Four a, Four b) { return lane_select(a < b, a, b); }
Four lane_max(Four a, Four b) { return lane_select(a > b, a, b); }
Mask4 lane_and(Mask4 a, Mask4 b) {
    for (std::size_t i = 0; i < 4; ++i) a.m[i] = a.m[i] && b.m[i];
    return a;
}
Mask4 lane_not(Mask4 a) {
    for (bool& x : a.m) x = !x;
    return a;
}
Mask4 lane_or(Mask4 a, Mask4 b) { return lane_not(lane_and(lane_not(a), lane_not(b))); }
bool lane_any(Mask4 a) { return a.m[0] || a.m[1] || a.m[2] || a.m[3]; }

using raymo::lane_abs;
using raymo::lane_and;
using raymo::lane_any;
using raymo::lane_max;
using raymo::lane_min;
using raymo::lane_not;
using raymo::lane_or;
using raymo::lane_select;
using raymo::lane_sqrt;
#include "raymo/curves/crossings.inl"

template <int N>
void compare_lanes() {
    std::mt19937_64 random(11);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    int none = 0;
    int one = 0;
    int no_pair = 0;
    int two = 0;
    int touches = 0;
    for (int k = 0; k < 30000; ++k) {
        Bernstein<N> p[4];
        Four c[N + 1];
        for (std::size_t lane = 0; lane < 4; ++lane) {
            for (std::size_t i = 0; i <= N; ++i) {
                double x = any(random) + (k % 2 == 0 ? 0.4 : 0.0);
                if (k % 3 == 0) x *= std::ldexp(1.0, -static_cast<int>(random() % 60));
                if (random() % 16 == 0) x = 0.0;
                p[lane][i] = x;
                c[i].v[lane] = x;
            }
        }
        const double noise = k % 5 == 0 ? 1e-9 : 0.0;
        const auto told = lane_signs<N, Mask4>(c, Four(noise));
        const Four u = lane_crossing<N>(c, told.one);
        const Mask4 neither = lane_not(lane_or(told.none, told.one));
        const auto pair = lane_pair<N>(c, Four(noise), neither);
        for (std::size_t lane = 0; lane < 4; ++lane) {
            double alone[N + 1];
            std::copy_n(p[lane].begin(), N + 1, alone);
            const auto single = lane_signs<N, bool>(alone, noise);
            REQUIRE(single.none == told.none.m[lane]);
            REQUIRE(single.one == told.one.m[lane]);
            RootList<N> list;
            find_roots<N>(p[lane], noise, list);
            if (single.none) {
                ++none;
                REQUIRE(list.count == 0);
            }
            if (single.one) {
                ++one;
                REQUIRE(list.count == 1);
                const Root& root = list.root[0];
                REQUIRE(root.crosses);
                REQUIRE(root.rises == told.rises.m[lane]);
                REQUIRE(root.u == u.v[lane]);
                REQUIRE(root.u == lane_crossing<N>(alone, true));
                REQUIRE(crossing_of<N>(p[lane]) == root.u);
            }
            if (!neither.m[lane]) continue;
            REQUIRE_FALSE((pair.none.m[lane] && pair.two.m[lane]));
            if (pair.none.m[lane]) {
                ++no_pair;
                REQUIRE(list.count == 0);
            }
            if (pair.two.m[lane]) {
                ++two;
                // A minimum that is just below -noise may be a touch with the little that find_roots adds to it.
                if (list.count == 1 && !list.root[0].crosses) {
                    ++touches;
                    continue;
                }
                REQUIRE(list.count == 2);
                REQUIRE(list.root[0].crosses);
                REQUIRE(list.root[0].rises == told.rises.m[lane]);
                REQUIRE(std::fabs(list.root[0].u - pair.first.v[lane]) <= 1e-12);
                REQUIRE(std::fabs(list.root[1].u - pair.second.v[lane]) <= 1e-12);
            }
            const auto same = lane_pair<N>(alone, noise, true);
            REQUIRE(same.none == pair.none.m[lane]);
            REQUIRE(same.two == pair.two.m[lane]);
            if (!same.two) continue;
            REQUIRE(same.first == pair.first.v[lane]);
            REQUIRE(same.second == pair.second.v[lane]);
        }
    }
    CHECK(none > 1000);
    CHECK(one > 1000);
    CHECK(no_pair > 1000);
    CHECK(two > 1000);
    CHECK(touches < two / 10);
}

TEST_CASE("several polynomials at a time give the same bits as one") {
    compare_lanes<3>();
    compare_lanes<4>();
}

/// "X0.5+ T0.25" for a crossing at 0.5 that rises and a touch at 0.25.
template <int N>
std::string told(const Bernstein<N>& p, double noise) {
    RootList<N> list;
    find_roots<N>(p, noise, list);
    std::string out;
    for (const Root& root : list) {
        char text[40];
        std::snprintf(text, sizeof text, "%s%c%.4g%s", out.empty() ? "" : " ",
                      root.crosses ? 'X' : 'T', root.u, root.crosses ? root.rises ? "+" : "-" : "");
        out += text;
    }
    return out;
}

TEST_CASE("roots at dyadic places, where pieces meet") {
    CHECK(told<2>({0.25, -0.25, 0.25}, 0.0) == "T0.5");     // (u - 1/2)^2
    CHECK(told<2>({-0.25, 0.25, -0.25}, 1e-16) == "T0.5");  // from below
    CHECK(told<3>({-1, 1, -1, 1}, 0.0) == "X0.5+");         // (2 u - 1)^3
    CHECK(told<4>({1, -1, 1, -1, 1}, 0.0) == "T0.5");       // (2 u - 1)^4
    CHECK(told<1>({-1, 1}, 0.0) == "X0.5+");
}

TEST_CASE("0 counts as positive at both ends") {
    CHECK(told<2>({0, 1, 1}, 0.0).empty());
    CHECK(told<1>({0, -1}, 0.0) == "X0-");
    CHECK(told<1>({-1, 0}, 0.0) == "X1+");
    CHECK(told<2>({-0.0, 1, 1}, 0.0).empty());
    CHECK(told<4>({-2, -1, 0, 1, 0}, 0.0).substr(0, 1) == "X");
    CHECK(told<3>({1, 1, 0, 0}, 1e-15).empty());  // level at the end: the next piece knows
}

TEST_CASE("what is within the noise is in doubt") {
    CHECK(told<3>({0, 0, 0, 0}, 0.0) == "T0.5");
    CHECK(told<3>({1e-17, -1e-17, 1e-17, -1e-17}, 1e-15) == "X0.5-");
    CHECK(told<2>({0.25, -0.25 + 1e-9, 0.25}, 1e-8) == "T0.5");
    CHECK(told<2>({0.25, -0.25 + 1e-9, 0.25}, 1e-12).empty());
    RootList<2> touch;
    find_roots<2>({0.25, -0.25, 0.25}, 1e-6, touch);
    REQUIRE(touch.count == 1);
    CHECK(touch.root[0].lo == doctest::Approx(0.499).epsilon(1e-6));
    CHECK(touch.root[0].hi == doctest::Approx(0.501).epsilon(1e-6));
}

TEST_CASE("a pair of roots closer than halvings would come") {
    // (u - 1/3)^2 - d^2
    for (const double d : {1e-3, 1e-5, 1e-6}) {
        const double third = 1.0 / 3.0;
        const Bernstein<2> p{third * third - d * d, -third * (1 - third) - d * d,
                             (1 - third) * (1 - third) - d * d};
        RootList<2> list;
        find_roots<2>(p, 0.0, list);
        REQUIRE(list.count == 2);
        CHECK(list.root[0].u == doctest::Approx(third - d).epsilon(1e-9));
        CHECK(list.root[1].u == doctest::Approx(third + d).epsilon(1e-9));
        CHECK(list.root[0].hi <= list.root[1].lo);
    }
}

TEST_CASE("numbers that are none, and very large ones, have a defined answer") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    CHECK(told<3>({1, nan, 0, -1}, 0.0) == "X0.5-");
    CHECK(told<3>({1, infinity, -1, 1}, 0.0) == "T0.5");
    CHECK(told<3>({1, -1, 1, 1}, nan) == "T0.5");
    CHECK(told<3>({1, -1, 1, 1}, infinity) == "T0.5");
    CHECK(told<3>({1e308, -1e308, 1e308, -1e308}, 0.0) == "X0.5-");
    CHECK(told<3>({-1e-308, -1e308, 1e308, -1e-308}, 0.0).substr(0, 5) == "X0.5+");
    CHECK(told<2>({5e-324, -5e-324, 5e-324}, 0.0).substr(0, 1) == "T");
    for (const double bad : {nan, infinity, -infinity}) {
        for (std::size_t i = 0; i <= 6; ++i) {
            Bernstein<6> p{1, 1, -0.1, 1, 1, 1, 1};
            p[i] = bad;
            RootList<6> list;
            find_roots<6>(p, 0.0, list);
            REQUIRE(list.count <= 1);
            for (const Root& root : list) CHECK(root.u == 0.5);
        }
    }
    for (const double u : {crossing_of<3>({nan, nan, nan, nan}), crossing_of<3>({1, 1, 1, 1})})
        CHECK_FALSE(u > 1.0);
}

}  // namespace
}  // namespace raymo::curves
