#include "raymo/blends/fit.hpp"

#include "raymo/blends/least_squares.hpp"

namespace raymo::blends {
namespace {

/// The square of the weight with which points stay where they are along the surface.
constexpr double kStay = 0x1p-28;
constexpr int kSteps = 4;
constexpr std::size_t kCount = kPlaces.size();

using Weights = std::array<double, 4>;

constexpr Weights bernstein(double u) {
    const double w = 1.0 - u;
    return {w * w * w, 3.0 * w * w * u, 3.0 * w * u * u, u * u * u};
}
constexpr Weights bernstein_slope(double u) {
    const double w = 1.0 - u;
    return {-3.0 * w * w, 3.0 * w * (w - 2.0 * u), 3.0 * u * (2.0 * w - u), 3.0 * u * u};
}
constexpr Weights bernstein_bend(double u) {
    const double w = 1.0 - u;
    return {6.0 * w, 6.0 * (u - 2.0 * w), 6.0 * (w - 2.0 * u), 6.0 * u};
}

/// The derivatives of Lagrange's polynomials: [k][i] of the one for place i at place k.
constexpr std::array<std::array<double, kCount>, kCount> lagrange_slopes() {
    std::array<std::array<double, kCount>, kCount> d{};
    for (std::size_t i = 0; i < kCount; ++i) {
        for (std::size_t k = 0; k < kCount; ++k) {
            for (std::size_t without = 0; without < kCount; ++without) {
                if (without == i) continue;
                double product = 1.0 / (kPlaces[i] - kPlaces[without]);
                for (std::size_t j = 0; j < kCount; ++j) {
                    if (j == i || j == without) continue;
                    product *= (kPlaces[k] - kPlaces[j]) / (kPlaces[i] - kPlaces[j]);
                }
                d[k][i] += product;
            }
        }
    }
    return d;
}
constexpr auto kSlopes = lagrange_slopes();

/// The derivatives of the polynomial through these points, at them.
Places slopes(const Places& p) {
    Places out;
    for (std::size_t k = 0; k < kCount; ++k) {
        for (std::size_t i = 0; i < kCount; ++i) out[k] += p[i] * kSlopes[k][i];
    }
    return out;
}
/// By the first parameter.
Grid slopes_along(const Grid& grid) {
    Grid out;
    for (std::size_t k = 0; k < kCount; ++k) {
        for (std::size_t l = 0; l < kCount; ++l) {
            for (std::size_t i = 0; i < kCount; ++i) out[k][l] += grid[i][l] * kSlopes[k][i];
        }
    }
    return out;
}

LocalSurface local(Vec3 point, Vec3 along, Vec3 across, Vec3 uu, Vec3 uv, Vec3 vv) {
    const Vec3 n = unit(cross(along, across));
    return {point, along, across, n, dot(n, uu), dot(n, uv), dot(n, vv)};
}

/// Adds the conditions that a sum of N unknown points with these weights takes `now` to the surface: along the normal, and far
/// less back to the surface's point.
template <std::size_t N>
void add_place(LeastSquares<3 * N>& conditions, const std::array<double, N>& weights,
               const LocalSurface& surface, Vec3 now) {
    Vec3 along[2];
    make_frame(surface.normal, along[0], along[1]);
    const auto add = [&](Vec3 way, double by, double square) {
        typename LeastSquares<3 * N>::Row row;
        for (std::size_t k = 0; k < N; ++k) {
            row[3 * k] = weights[k] * way.x;
            row[3 * k + 1] = weights[k] * way.y;
            row[3 * k + 2] = weights[k] * way.z;
        }
        row[3 * N] = by;
        conditions.add(row, square);
    };
    add(surface.normal, -surface.offset(now).off, 1.0);
    for (const Vec3 way : along) add(way, dot(way, surface.point - now), kStay);
}

}  // namespace

LocalSurface::Offset LocalSurface::offset(Vec3 p) const {
    const Vec3 d = p - point;
    const double e = dot(along, along);
    const double f = dot(along, across);
    const double g = dot(across, across);
    const double det = e * g - f * f;
    const double a = dot(d, along);
    const double b = dot(d, across);
    Offset out{};
    out.u = (g * a - f * b) / det;
    out.v = (e * b - f * a) / det;
    out.level = 0.5 * (uu * out.u * out.u + vv * out.v * out.v) + uv * out.u * out.v;
    out.off = dot(normal, d) - out.level;
    return out;
}

LocalLine local_line(const Places& points, Vec3 upright) {
    const Places first = slopes(points);
    const Places second = slopes(first);
    LocalLine out;
    for (std::size_t k = 0; k < kCount; ++k)
        out[k] = local(points[k], first[k], upright, second[k], {}, {});
    return out;
}

LocalGrid local_grid(const Grid& points) {
    const Grid u = slopes_along(points);
    const Grid uu = slopes_along(u);
    LocalGrid out;
    for (std::size_t k = 0; k < kCount; ++k) {
        const Places v = slopes(points[k]);
        const Places vv = slopes(v);
        const Places uv = slopes(u[k]);
        for (std::size_t l = 0; l < kCount; ++l)
            out[k][l] = local(points[k][l], u[k][l], v[l], uu[k][l], uv[l], vv[l]);
    }
    return out;
}

LocalSurface local_patch(const meshes::GivenNet& net, double u, double v) {
    const Weights a[3] = {bernstein(u), bernstein_slope(u), bernstein_bend(u)};
    const Weights b[3] = {bernstein(v), bernstein_slope(v), bernstein_bend(v)};
    const auto sum = [&](std::size_t du, std::size_t dv) {
        Vec3 out;
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t j = 0; j < 4; ++j) out += net[4 * i + j] * (a[du][i] * b[dv][j]);
        }
        return out;
    };
    return local(sum(0, 0), sum(1, 0), sum(0, 1), sum(2, 0), sum(1, 1), sum(0, 2));
}

LocalSurface local_cubic(const Cubic& c, Vec3 upright, double u) {
    const Weights bend = bernstein_bend(u);
    const Vec3 second = c[0] * bend[0] + c[1] * bend[1] + c[2] * bend[2] + c[3] * bend[3];
    return local(value_at(c, u), slope_at(c, u) * 3.0, upright, second, {}, {});
}

Cubic cubic_through(const LocalLine& line) {
    Places points;
    for (std::size_t k = 0; k < kCount; ++k) points[k] = line[k].point;
    const Places slope = slopes(points);
    const Vec3 from = points.front();
    const Vec3 to = points.back();
    Cubic cubic{from, from + slope.front() / 3.0, to - slope.back() / 3.0, to};
    for (int step = 0; step < kSteps; ++step) {
        LeastSquares<6> conditions;
        for (std::size_t k = 1; k + 1 < kCount; ++k) {
            const Weights b = bernstein(kPlaces[k]);
            add_place<2>(conditions, {b[1], b[2]}, line[k], value_at(cubic, kPlaces[k]));
        }
        const auto x = conditions.solved();
        cubic[1] += Vec3{x[0], x[1], x[2]};
        cubic[2] += Vec3{x[3], x[4], x[5]};
    }
    return cubic;
}

meshes::GivenNet patch_through(const Borders& borders, const LocalGrid& grid) {
    meshes::GivenNet net;
    const auto part = [](Vec3 a, Vec3 b, double t) { return a * (1.0 - t) + b * t; };
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < 4; ++j) {
            const double u = static_cast<double>(i) / 3.0;
            const double v = static_cast<double>(j) / 3.0;
            // Coons' patch; the borders as they are.
            if (j == 0) {
                net[4 * i] = borders.lo[i];
            } else if (j == 3) {
                net[4 * i + 3] = borders.hi[i];
            } else if (i == 0) {
                net[j] = borders.from[j];
            } else if (i == 3) {
                net[12 + j] = borders.to[j];
            } else {
                net[4 * i + j] = part(borders.from[j], borders.to[j], u) +
                                 part(borders.lo[i], borders.hi[i], v) -
                                 part(part(borders.lo[0], borders.hi[0], v),
                                      part(borders.lo[3], borders.hi[3], v), u);
            }
        }
    }
    for (int step = 0; step < kSteps; ++step) {
        LeastSquares<12> conditions;
        for (std::size_t k = 1; k + 1 < kCount; ++k) {
            const Weights a = bernstein(kPlaces[k]);
            for (std::size_t l = 1; l + 1 < kCount; ++l) {
                const Weights b = bernstein(kPlaces[l]);
                Vec3 now;
                for (std::size_t i = 0; i < 4; ++i) {
                    for (std::size_t j = 0; j < 4; ++j) now += net[4 * i + j] * (a[i] * b[j]);
                }
                add_place<4>(conditions, {a[1] * b[1], a[1] * b[2], a[2] * b[1], a[2] * b[2]},
                             grid[k][l], now);
            }
        }
        const auto x = conditions.solved();
        constexpr std::size_t kInner[] = {5, 6, 9, 10};
        for (std::size_t k = 0; k < 4; ++k)
            net[kInner[k]] += Vec3{x[3 * k], x[3 * k + 1], x[3 * k + 2]};
    }
    return net;
}

}  // namespace raymo::blends
