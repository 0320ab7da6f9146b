#include "raymo/math/affine.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

#include "raymo/math/tolerance.hpp"

namespace raymo {
namespace {

class Random {
public:
    double uniform(double lo, double hi) {
        return lo + (hi - lo) * static_cast<double>(engine_() >> 11) * 0x1p-53;
    }
    Vec3 in_cube(double r) { return {uniform(-r, r), uniform(-r, r), uniform(-r, r)}; }
    Mat3 matrix() { return {{in_cube(1), in_cube(1), in_cube(1)}}; }

private:
    std::mt19937_64 engine_{42};
};

/// Largest entry of a - b.
double distance(const Mat3& a, const Mat3& b) {
    double most = 0.0;
    for (std::size_t i = 0; i < 3; ++i) most = std::max(most, max_norm(a.row[i] - b.row[i]));
    return most;
}

TEST_CASE("affine: an inverse undoes its map, whatever the scales of the rows") {
    Random random;
    for (int i = 0; i < 1000; ++i) {
        Mat3 m = random.matrix();
        if (std::fabs(determinant(m)) < 0.01) continue;
        for (Vec3& row : m.row) row *= std::ldexp(1.0, static_cast<int>(random.uniform(-300, 300)));
        REQUIRE(is_invertible(m));
        CHECK(distance(inverse(m) * m, Mat3{}) < 1e-11);
    }
}

TEST_CASE("affine: inverses of scalings, turns by 90 degrees and mirrors are exact") {
    CHECK(inverse(Mat3::diagonal(2, 4, -8)) == Mat3::diagonal(0.5, 0.25, -0.125));
    const Affine turn = rotation({0, 0, 1}, 90);
    CHECK(turn({1, 0, 0}) == Vec3{0, 1, 0});
    CHECK((inverse(turn) * turn).linear == Mat3{});
    CHECK(rotation({1, 0, 0}, 180)({0, 1, 2}) == Vec3{0, -1, -2});
    CHECK(rotation({0, 1, 0}, -90)({1, 0, 0}) == Vec3{0, 0, 1});
    CHECK(rotation({0, 1, 0}, 720).linear == Mat3{});
    CHECK(reflection({0, 0, -3})({1, 2, 3}) == Vec3{1, 2, -3});
    CHECK(reflection({1e-200, 0, 0})({1, 2, 3}) == Vec3{-1, 2, 3});
}

TEST_CASE("affine: what is singular is found, what is only badly scaled is not") {
    CHECK_FALSE(is_invertible(Mat3::diagonal(1, 0, 1)));
    CHECK_FALSE(is_invertible({{Vec3{1, 2, 3}, Vec3{2, 4, 6}, Vec3{0, 0, 1}}}));
    CHECK_FALSE(is_invertible({{Vec3{0.1, 0.2, 0.3}, Vec3{0.3, 0.6, 0.9}, Vec3{0, 0, 1}}}));
    const double inf = std::numeric_limits<double>::infinity();
    CHECK_FALSE(is_invertible(Mat3::diagonal(1, inf, 1)));
    CHECK_FALSE(is_invertible(Mat3::diagonal(1, std::nan(""), 1)));
    CHECK_FALSE(is_invertible(Mat3::diagonal(1, 1e-320, 1)));  // its inverse is infinite
    CHECK(is_invertible(Mat3::diagonal(1e-150, 1e150, 1)));
    CHECK(is_invertible({{Vec3{1, 1, 0}, Vec3{1, 1 + 1e-9, 0}, Vec3{0, 0, 1}}}));
}

TEST_CASE("affine: rotations keep lengths, and compose as angles add") {
    Random random;
    for (int i = 0; i < 200; ++i) {
        const Vec3 axis = unit(random.in_cube(1) + Vec3{0, 0, 1.5});
        const double a = random.uniform(-400, 400), b = random.uniform(-400, 400);
        CHECK(distance((rotation(axis, a) * rotation(axis, b)).linear,
                       rotation(axis, a + b).linear) < 1e-13);
        CHECK(determinant(rotation(axis, a).linear) == doctest::Approx(1.0).epsilon(1e-14));
        CHECK(max_norm(rotation(axis, a)(axis) - axis) < 1e-15);
    }
    // Right-handed.
    CHECK(max_norm(rotation({0, 0, 1}, 30)({1, 0, 0}) - Vec3{std::sqrt(0.75), 0.5, 0}) < 1e-16);
}

TEST_CASE("affine: composition applies the right map first") {
    const Affine both = translation({10, 0, 0}) * scaling({2, 3, 4});
    CHECK(both({1, 1, 1}) == Vec3{12, 3, 4});
    CHECK(inverse(both)({12, 3, 4}) == Vec3{1, 1, 1});
}

TEST_CASE("affine: sines of multiples of 30 degrees, and far beyond a turn") {
    for (int k = -12; k <= 12; ++k) {
        const auto [s, c] = sin_cos_degrees(30.0 * k);
        CHECK(s ==
              doctest::Approx(std::sin(30.0 * k * 3.14159265358979323846 / 180)).epsilon(1e-14));
        CHECK(c ==
              doctest::Approx(std::cos(30.0 * k * 3.14159265358979323846 / 180)).epsilon(1e-14));
        CHECK(s * s + c * c == doctest::Approx(1.0).epsilon(1e-15));
    }
    CHECK(sin_cos_degrees(90.0).cos == 0.0);
    CHECK(sin_cos_degrees(180.0).sin == 0.0);
    CHECK(sin_cos_degrees(30.0).sin == 0.5);
    CHECK(sin_cos_degrees(360.0 * 1e9 + 90.0).sin == 1.0);
}

TEST_CASE("affine: the box of a box's image holds its corners, and is touched by them") {
    Random random;
    for (int i = 0; i < 200; ++i) {
        const Affine map{random.matrix(), random.in_cube(5)};
        const Vec3 p = random.in_cube(3), q = random.in_cube(3);
        const Aabb box{min(p, q), max(p, q)};
        const Aabb image = transformed(map, box);
        Aabb corners;
        for (int k = 0; k < 8; ++k) {
            corners.include(map({k & 1 ? box.lo.x : box.hi.x, k & 2 ? box.lo.y : box.hi.y,
                                 k & 4 ? box.lo.z : box.hi.z}));
        }
        CHECK(max_norm(image.lo - corners.lo) < 1e-14);
        CHECK(max_norm(image.hi - corners.hi) < 1e-14);
    }
}

TEST_CASE("affine: infinite sides stay infinite, and empty boxes empty") {
    Aabb half = Aabb::everything();
    half.hi.z = 2;
    const Aabb turned = transformed(rotation({1, 0, 0}, 90), half);
    CHECK(turned.lo.y == -2);
    CHECK(std::isinf(turned.hi.y));
    CHECK(std::isinf(turned.lo.x));
    CHECK(std::isinf(turned.lo.z));
    CHECK(transformed(scaling({-1, 1, 1}), Aabb{}).empty());
    CHECK_FALSE(half.bounded());
    CHECK(Aabb{}.bounded());
}

TEST_CASE("vec: lengths and unit vectors neither overflow nor underflow") {
    CHECK(norm({3e200, 4e200, 0}) == doctest::Approx(5e200));
    CHECK(norm({3e-200, 0, 4e-200}) == doctest::Approx(5e-200));
    CHECK(max_norm(unit({1e300, 1e300, 0}) - Vec3{std::sqrt(0.5), std::sqrt(0.5), 0}) < 1e-15);
    CHECK(unit({0, -1e-300, 0}) == Vec3{0, -1, 0});
}

TEST_CASE("vec: frames are right-handed and orthogonal for every normal") {
    Random random;
    for (int i = 0; i < 1000; ++i) {
        Vec3 n = random.in_cube(1);
        if (i < 6) n = Vec3{};
        if (i < 6) n[i / 2] = i % 2 == 0 ? 1 : -1;
        if (i == 6) n = {1e-9, 0, -1};
        n = unit(n);
        Vec3 s, t;
        make_frame(n, s, t);
        CHECK(std::fabs(dot(s, n)) < 1e-14);
        CHECK(std::fabs(dot(t, n)) < 1e-14);
        CHECK(std::fabs(dot(s, t)) < 1e-14);
        CHECK(max_norm(cross(s, t) - n) < 1e-14);
    }
}

TEST_CASE("tolerance: a step aside clears what is called degenerate") {
    // A ray at an angle of at most  error / kDegenerate  to a face departs from it by less than the step over a length of 2.
    CHECK(kSidestep >= 2.0 / kDegenerate);
    CHECK(1.0 + kUnitRoundoff == 1.0);
    CHECK(1.0 + 2.0 * kUnitRoundoff > 1.0);
}

}  // namespace
}  // namespace raymo
