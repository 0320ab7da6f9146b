#include "raymo/curves/build_path.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "raymo/curves/bernstein.hpp"

namespace raymo::curves {
namespace {

void check_joined(const Path& path) {
    const std::size_t n = path.spans.size();
    for (std::size_t i = 0; i < (path.closed ? n : n - 1); ++i) {
        const PathSpan& a = path.spans[i];
        const PathSpan& b = path.spans[(i + 1) % n];
        CHECK((a.x[3] == b.x[0] && a.y[3] == b.y[0] && a.z[3] == b.z[0] && a.r[3] == b.r[0]));
    }
}

template <class T>
std::string message(const Result<T>& made) {
    return made ? "" : made.error().message;
}

TEST_CASE("a path is one spline for place and radius") {
    const std::vector<Point<4>> p{{0, 0, 0, 1}, {10, 0, 0, 2}, {10, 10, 0, 3}, {10, 10, 10, 1}};
    const auto line = spline_path(p, {SplineKind::linear, 1, false, false});
    REQUIRE(line.has_value());
    CHECK(line->path.spans.size() == 3);
    CHECK(value_at(line->path.spans[1].r, 0.5) == doctest::Approx(2.5).epsilon(1e-15));
    CHECK(!line->path.closed);
    const auto ring = spline_path(p, {SplineKind::bspline, 3, true, false});
    REQUIRE(ring.has_value());
    CHECK(ring->path.closed);
    check_joined(ring->path);
    CHECK(!ring->is_clamped);
}

TEST_CASE("a radius that falls below 0 between its points is 0 there") {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> range(0.0, 1.0);
    int clamped = 0;
    for (int round = 0; round < 3000; ++round) {
        std::vector<Point<4>> p;
        for (int i = 0; i < 7; ++i) {
            const double r = range(random) < 0.5 ? 0.0 : std::pow(range(random), 6.0) * 3.0;
            p.push_back({range(random), range(random), range(random), i == 0 ? 1.0 : r});
        }
        const SplineKind kind = round % 2 == 0 ? SplineKind::catmull : SplineKind::interpolate;
        const SplineForm form{kind, 3, round % 3 == 0, false};
        const auto made = spline_path(p, form);
        REQUIRE(made.has_value());
        check_joined(made->path);
        CHECK(made->path.closed == form.closed);
        clamped += made->is_clamped ? 1 : 0;
        // Each span of the spline became one piece or several, in order, that end where it ends.
        std::size_t at = 0;
        const Spline<4> whole = *spline<4>(p, form);
        for (const auto& s : whole.spans) {
            bool is_last = false;
            while (!is_last) {
                REQUIRE(at < made->path.spans.size());
                const PathSpan& piece = made->path.spans[at++];
                for (int i = 0; i <= 16; ++i) CHECK(value_at(piece.r, i / 16.0) >= 0.0);
                is_last = piece.x[3] == s[3][0] && piece.y[3] == s[3][1] && piece.r[3] == s[3][3];
            }
        }
        CHECK(at == made->path.spans.size());
    }
    CHECK(clamped > 500);
}

TEST_CASE("pieces of a clamped radius follow the spline") {
    // r(u) of the middle span goes from 1 down to below 0 and up to 1 again.
    const std::vector<Point<4>> p{{0, 0, 0, 8}, {1, 0, 0, 0.1}, {2, 0, 0, 0.1}, {3, 0, 0, 8}};
    const auto made = spline_path(p, {SplineKind::catmull, 3, false, false});
    REQUIRE(made.has_value());
    CHECK(made->is_clamped);
    const auto s = spline<4>(p, {SplineKind::catmull, 3, false, false})->spans[1];
    const Bernstein<3> r{s[0][3], s[1][3], s[2][3], s[3][3]};
    const Bernstein<3> x{s[0][0], s[1][0], s[2][0], s[3][0]};
    int positive = 0;
    int zero = 0;
    for (const PathSpan& piece : made->path.spans) {
        for (int i = 0; i <= 8; ++i) {
            const double px = value_at(piece.x, i / 8.0);
            if (px < 1.0 || px > 2.0) continue;
            // x(u) is the parameter, shifted: it rises evenly here.
            const double u = px - 1.0;
            CHECK(value_at(x, u) == doctest::Approx(px).epsilon(1e-12));
            const double expected = std::max(0.0, value_at(r, u));
            CHECK(value_at(piece.r, i / 8.0) ==
                  doctest::Approx(expected).epsilon(1e-12).scale(1.0));
            (expected > 0.0 ? positive : zero) += 1;
        }
    }
    CHECK(positive > 5);
    CHECK(zero > 5);
}

TEST_CASE("a helix is as near to the true one as it says") {
    for (const auto& [radius, pitch, turns] :
         {std::array{10.0, 4.0, 2.0}, std::array{1.0, 100.0, 0.6}, std::array{3.0, -2.0, 7.3},
          std::array{1e-3, 1e3, 0.01}}) {
        const auto made = helix(radius, pitch, turns, 0.5);
        REQUIRE(made.has_value());
        CHECK(made->spans.size() == static_cast<std::size_t>(std::ceil(36.0 * turns)));
        check_joined(*made);
        double plane = 0.0;
        double height = 0.0;
        const double n = static_cast<double>(made->spans.size());
        for (std::size_t i = 0; i < made->spans.size(); i += 7) {
            const PathSpan& s = made->spans[i];
            for (int j = 0; j <= 100; ++j) {
                const double u = j / 100.0;
                const double x = value_at(s.x, u);
                const double y = value_at(s.y, u);
                plane = std::max(plane, std::fabs(std::hypot(x, y) / radius - 1.0));
                // The helix at the same angle.
                double turn = std::atan2(y, x) / (2.0 * std::numbers::pi);
                turn += std::round((static_cast<double>(i) + u) * turns / n - turn);
                height = std::max(height, std::fabs(value_at(s.z, u) / pitch - turn));
            }
        }
        CHECK(plane < 1.1e-9);
        CHECK(height < 3e-9);
        CHECK(made->spans.back().z[3] == pitch * turns);
        // Tangents agree at the joints.
        for (std::size_t i = 0; i + 1 < made->spans.size(); ++i) {
            const PathSpan& a = made->spans[i];
            const PathSpan& b = made->spans[i + 1];
            CHECK(a.x[3] - a.x[2] == doctest::Approx(b.x[1] - b.x[0]).epsilon(1e-12).scale(radius));
            CHECK(a.z[3] - a.z[2] ==
                  doctest::Approx(b.z[1] - b.z[0]).epsilon(1e-12).scale(std::fabs(pitch)));
        }
    }
}

TEST_CASE("functions are fitted to the tolerance, and spans shrink only where they must") {
    for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-9}) {
        const auto f = [](double t) -> Result<Point<4>> {
            return Point<4>{10 * std::cos(t), 10 * std::sin(t), t * t, 1.0 + 0.5 * std::sin(3 * t)};
        };
        const auto made = fit_path(f, -1, 9, tolerance);
        REQUIRE(made.has_value());
        check_joined(made->path);
        // The error is below tolerance from h = (384 tolerance / |f|)^(1/4) on, |f| < 42; halves are at least h / 2.
        const double h = std::pow(384.0 * tolerance / 42.0, 0.25);
        CHECK(static_cast<double>(made->path.spans.size()) < 2.0 * 10.0 / h + 8.0);
        // Places of the cubics are near the function: z = t^2 rises from t = 0 on, so it gives the parameter.
        double worst = 0.0;
        for (const PathSpan& s : made->path.spans) {
            for (int j = 0; j <= 37; ++j) {
                const double u = j / 37.0;
                const double z = value_at(s.z, u);
                if (s.x[0] > 9.9 || z < 1.5) continue;
                const double t = std::sqrt(z);
                worst = std::max(worst, std::hypot(value_at(s.x, u) - 10 * std::cos(t),
                                                   value_at(s.y, u) - 10 * std::sin(t)));
                worst =
                    std::max(worst, std::fabs(value_at(s.r, u) - (1.0 + 0.5 * std::sin(3 * t))));
            }
        }
        // The gap at equal z is the gap at equal t times what a step of t costs in the plane, below 10 / (2 t).
        CHECK(worst < 6.0 * tolerance);
    }
}

TEST_CASE("a corner takes small spans, a jump is an error") {
    const auto corner = [](double t) -> Result<Point<4>> {
        return Point<4>{t, std::fabs(t - 0.3), 0, 1};
    };
    const auto made = fit_path(corner, 0, 1, 1e-6);
    REQUIRE(made.has_value());
    CHECK(made->path.spans.size() < 60);
    const auto jumps = [](double t) -> Result<Point<4>> {
        return Point<4>{t, t < 0.3 ? 0.0 : 1.0, 0, 1};
    };
    CHECK(message(fit_path(jumps, 0, 1, 1e-3)) ==
          "the function jumps, or varies by less than the tolerance can see");
    const auto noise = [](double t) -> Result<Point<4>> {
        const double s = std::sin(t * 1e9) * 43758.5453;
        return Point<4>{t, s - std::floor(s), 0, 1};
    };
    CHECK(!fit_path(noise, 0, 1, 1e-3).has_value());
}

TEST_CASE("a function that comes back makes a closed path") {
    const auto ring = [](double t) -> Result<Point<4>> {
        return Point<4>{std::cos(t), std::sin(t), 0, 0.1};
    };
    const auto made = fit_path(ring, 0, 2.0 * std::numbers::pi, 1e-6);
    REQUIRE(made.has_value());
    CHECK(made->path.closed);
    check_joined(made->path);
}

TEST_CASE("what is wrong with paths is said") {
    const SplineForm cubic{SplineKind::bspline, 3, false, false};
    const std::vector<Point<4>> good{{0, 0, 0, 1}, {1, 0, 0, 1}, {2, 0, 1, 1}, {3, 1, 0, 1}};
    auto bad = good;
    bad[2][3] = -0.5;
    CHECK(message(spline_path(bad, cubic)) == "every radius must be at least 0");
    CHECK(spline_path(bad, cubic).error().label == "this has -0.5");
    auto thin = good;
    for (auto& p : thin) p[3] = 0;
    CHECK(message(spline_path(thin, cubic)) == "one radius at least must be greater than 0");
    CHECK(message(spline_path(std::vector<Point<4>>(4, {1, 2, 3, 1}), cubic)) ==
          "all points are the same");
    auto far = good;
    far[1][1] = 1e300;
    CHECK(message(spline_path(far, cubic)) == "the coordinates are too large to be computed with");
    CHECK(helix(0, 1, 1, 1).error().argument == 0);
    CHECK(helix(1, 0, 1, 1).error().argument == 1);
    CHECK(helix(1, 1, -1, 1).error().argument == 2);
    CHECK(helix(1, 1, 1e9, 1).error().argument == 2);
    CHECK(helix(1, 1, 1, 0).error().argument == 3);
    const PathFunction f = [](double t) -> Result<Point<4>> { return Point<4>{t, 0, 0, 0.5 - t}; };
    CHECK(message(fit_path(f, 0, 1, 1e-3)) == "the radius must be at least 0");
    CHECK(fit_path(f, 0, 0, 1e-3).error().argument == 1);
    CHECK(fit_path(f, 1e30, 1e30 * (1.0 + 1e-15), 1e-3).error().argument == 1);
    CHECK(fit_path(f, 0, 0.4, 0).error().argument == 2);
    const PathFunction wild = [](double t) -> Result<Point<4>> {
        return Point<4>{std::cos(1e6 * t), std::sin(1e6 * t), 0, 1};
    };
    CHECK(fit_path(wild, 0, 1, 1e-6).error().argument == 2);
    const PathFunction failing = [](double) -> Result<Point<4>> {
        return fail(ErrorCode::evaluation, "no");
    };
    CHECK(message(fit_path(failing, 0, 1, 1e-3)) == "no");
}

}  // namespace
}  // namespace raymo::curves
