// Cubics and bicubics along curves and surfaces that have formulas.
#include "raymo/blends/fit.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

namespace raymo::blends {
namespace {

/// How far the cubic is off that follows an arc of a circle of radius 1, whose parameter may speed up along it.
double off_circle(double angle, double speed_up) {
    Places p;
    for (std::size_t k = 0; k < p.size(); ++k) {
        const double v = kPlaces[k];
        const double at = angle * (v + speed_up * v * (v - 1.0));
        p[k] = {std::cos(at), std::sin(at), 0.0};
    }
    const Cubic c = cubic_through(local_line(p, {0, 0, 1}));
    CHECK(c[0] == p.front());
    CHECK(c[3] == p.back());
    double most = 0.0;
    for (int i = 0; i <= 100; ++i)
        most = std::max(most, std::fabs(norm(value_at(c, 0.01 * i)) - 1.0));
    return most;
}

Vec3 on_torus(double u, double v) {
    const double across = 3.0 + std::cos(v);
    return {across * std::cos(u), across * std::sin(u), std::sin(v)};
}
double off_torus(Vec3 p) { return std::hypot(std::hypot(p.x, p.y) - 3.0, p.z) - 1.0; }

}  // namespace

TEST_CASE("fits: an arc of a circle is met to the sixth order") {
    for (const double angle : {0.8, 0.4, 0.2}) {
        CAPTURE(angle);
        CHECK(off_circle(angle, 0.0) < 5e-6 * std::pow(angle, 6.0));
    }
}

TEST_CASE("fits: points give way along a curve where its parameter speeds up") {
    // Cubics through given points at given parameters would be off by some 1e-4.
    CHECK(off_circle(0.4, 0.02) < 1e-7);
}

TEST_CASE("fits: a patch of a torus, and its borders") {
    for (const double size : {0.4, 0.2}) {
        CAPTURE(size);
        Grid points;
        for (std::size_t k = 0; k < points.size(); ++k) {
            for (std::size_t l = 0; l < points.size(); ++l)
                points[k][l] = on_torus(0.3 + 0.5 * size * kPlaces[k], 2.0 + size * kPlaces[l]);
        }
        const LocalGrid grid = local_grid(points);
        const auto column = [&](std::size_t l) {
            LocalLine line;
            for (std::size_t k = 0; k < line.size(); ++k) line[k] = grid[k][l];
            return line;
        };
        const Borders borders{cubic_through(grid.front()), cubic_through(grid.back()),
                              cubic_through(column(0)), cubic_through(column(5))};
        const meshes::GivenNet net = patch_through(borders, grid);
        for (std::size_t i = 0; i < 4; ++i) {
            CHECK(net[i] == borders.from[i]);
            CHECK(net[12 + i] == borders.to[i]);
            CHECK(net[4 * i] == borders.lo[i]);
            CHECK(net[4 * i + 3] == borders.hi[i]);
        }
        double most = 0.0;
        for (int i = 0; i <= 20; ++i) {
            for (int j = 0; j <= 20; ++j) {
                const LocalSurface at = local_patch(net, 0.05 * i, 0.05 * j);
                most = std::max(most, std::fabs(off_torus(at.point)));
            }
        }
        CHECK(most < 1e-5 * std::pow(size, 5.0));
    }
}

TEST_CASE("fits: the height of a surface next to a point is known to the second order") {
    Grid points;
    for (std::size_t k = 0; k < points.size(); ++k) {
        for (std::size_t l = 0; l < points.size(); ++l)
            points[k][l] = on_torus(0.2 * kPlaces[k], 1.0 + 0.2 * kPlaces[l]);
    }
    const LocalGrid grid = local_grid(points);
    for (const double step : {1e-2, 1e-3}) {
        const Vec3 beside = on_torus(0.2 * (kPlaces[2] + step), 1.0 + 0.2 * (kPlaces[3] - step));
        const auto offset = grid[2][3].offset(beside);
        CHECK(offset.u == doctest::Approx(step).epsilon(0.01));
        CHECK(offset.v == doctest::Approx(-step).epsilon(0.01));
        CHECK(std::fabs(offset.off) < 0.1 * step * step * step);
    }
}

}  // namespace raymo::blends
