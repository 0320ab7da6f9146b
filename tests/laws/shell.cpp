#include "tests/laws/shell.hpp"

#include <cmath>
#include <numbers>

#include "raymo/meshes/build.hpp"
#include "raymo/solids/freeform/test_field.hpp"
#include "tests/laws/rays.hpp"

namespace raymo::laws {
namespace {

std::vector<Vec2> polygon(Random& random, int n, double r) {
    std::vector<Vec2> out;
    for (int k = 0; k < n; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / n;
        const double q = r * random.uniform(0.7, 1.0);
        out.push_back({q * std::cos(angle), q * std::sin(angle)});
    }
    return out;
}

meshes::Mesh ring(Random& random) {
    const int n = 3 + random.below(4), m = 3 + random.below(3);
    std::vector<std::vector<Vec3>> rows;
    for (int i = 0; i < n; ++i) {
        std::vector<Vec3> row;
        for (int j = 0; j < m; ++j) {
            const double a = 2.0 * std::numbers::pi * i / n, b = 2.0 * std::numbers::pi * j / m;
            const double q = 3.0 + std::cos(b);
            row.push_back({q * std::cos(a), q * std::sin(a), std::sin(b)});
        }
        rows.push_back(std::move(row));
    }
    return meshes::grid_mesh(rows, meshes::Closing::both).value();
}

/// Whether some place of a patch is within `margin` of p.
bool is_near(const meshes::Shell& shell, const meshes::Net& net, const RealPoint& p, Real margin) {
    struct Part {
        Real b[3][16];
    };
    const Real at[3] = {p.x, p.y, p.z};
    Part whole;
    for (std::size_t k = 0; k < 16; ++k) {
        const Vec3 q = shell.points[net[k]];
        for (int i = 0; i < 3; ++i) whole.b[i][k] = static_cast<Real>(q[i]) - at[i];
    }
    std::vector<Part> open{whole};
    for (int looked = 0; !open.empty(); ++looked) {
        Part one = open.back();
        open.pop_back();
        Real away = 0, size = 0;
        for (const auto& c : one.b) {
            const auto [lo, hi] = std::minmax_element(c, c + 16);
            away = std::max({away, *lo, -*hi});
            size = std::max(size, *hi - *lo);
        }
        if (away > margin) continue;
        if (size < margin || looked > 2000) return true;
        // Along the longer of both sides.
        Real along[2] = {0, 0};
        for (const auto& c : one.b) {
            for (std::size_t k = 0; k < 16; ++k) {
                if (k / 4 < 3) along[0] = std::max(along[0], std::fabs(c[k + 4] - c[k]));
                if (k % 4 < 3) along[1] = std::max(along[1], std::fabs(c[k + 1] - c[k]));
            }
        }
        const std::size_t step = along[0] >= along[1] ? 4 : 1;
        Part other;
        for (int i = 0; i < 3; ++i) {
            for (std::size_t n = 0; n < 4; ++n) {
                Real* c = one.b[i] + n * (5 - step);
                Real* d = other.b[i] + n * (5 - step);
                const Real a = (c[0] + c[step]) / 2, m = (c[step] + c[2 * step]) / 2,
                           b = (c[2 * step] + c[3 * step]) / 2;
                const Real am = (a + m) / 2, mb = (m + b) / 2;
                d[3 * step] = c[3 * step], d[2 * step] = b, d[step] = mb;
                c[3 * step] = d[0] = (am + mb) / 2;
                c[step] = a, c[2 * step] = am;
            }
        }
        open.push_back(one);
        open.push_back(other);
    }
    return false;
}

}  // namespace

meshes::Mesh random_mesh(Random& random) {
    meshes::Mesh out;
    switch (random.below(4)) {
        case 0:
            out = ring(random);
            break;
        case 1:
            out = meshes::extrude_mesh(polygon(random, 3 + random.below(5), 3.0), 3.0, 1).value();
            break;
        default:
            out = meshes::mapped(meshes::box_mesh({5, 4, 3}, {1, 1, 1}),
                                 translation({-2.5, -2, -1.5}));
    }
    const double moved = random.chance(0.3) ? 0.0 : 0.4;
    for (Vec3& p : out.points) p += random.in_cube(moved);
    if (random.chance(0.3)) return meshes::creased_by_angle(std::move(out), 0.0);
    if (random.chance(0.4)) {
        // Creases that fade out, pass through points, or meet.
        std::vector<meshes::Edge> edges;
        for (std::size_t f = 0; f < out.face_count(); ++f) {
            if (random.chance(0.3))
                edges.push_back(meshes::edge_between(out.face(f)[0], out.face(f)[1]));
        }
        out = meshes::creased(std::move(out), edges).value();
    }
    return out;
}

std::vector<meshes::GivenNet> random_nets(Random& random) {
    std::vector<meshes::GivenNet> out;
    if (random.chance(0.5)) {
        // A cushion.
        for (int axis = 0; axis < 3; ++axis) {
            for (const double side : {-3.0, 3.0}) {
                meshes::GivenNet net;
                const double bulge = random.uniform(-0.5, 3);
                for (std::size_t k = 0; k < 16; ++k) {
                    const std::size_t i = k / 4, j = k % 4;
                    Vec3 p;
                    p[axis] = i % 3 != 0 && j % 3 != 0 ? side + (side > 0 ? bulge : -bulge) : side;
                    p[(axis + 1) % 3] = 2.0 * static_cast<double>(i) - 3.0;
                    p[(axis + 2) % 3] = 2.0 * static_cast<double>(j) - 3.0;
                    net[k] = p;
                }
                out.push_back(net);
            }
        }
        return out;
    }
    // An egg or a bottle of two cubics, with the same slope where they meet.
    const double r = random.uniform(1, 3), slope = random.uniform(-1, 1);
    const Vec2 edges[2][4] = {
        {{0, -3}, {random.uniform(1, 3), -3}, {r - slope, -1}, {r, 0}},
        {{r, 0}, {r + slope, 1}, {random.uniform(0.5, 2), random.chance(0.5) ? 3.0 : 2.0}, {0, 3}}};
    const double squeeze = random.chance(0.5) ? 1.0 : random.uniform(0.4, 1);
    for (const auto& edge : edges) {
        for (int quarter = 0; quarter < 4; ++quarter) {
            meshes::GivenNet net;
            for (std::size_t j = 0; j < 4; ++j) {
                const double q = edge[j].x;
                const Vec2 arc[4] = {{q, 0}, {q, q * 0.5523}, {q * 0.5523, q}, {0, q}};
                for (std::size_t i = 0; i < 4; ++i) {
                    Vec2 p = arc[i];
                    for (int k = 0; k < quarter; ++k) p = {-p.y, p.x};
                    net[4 * i + j] = {p.x, p.y * squeeze, edge[j].y};
                }
            }
            out.push_back(net);
        }
    }
    return out;
}

ModelPtr grid_smooth(Random& random) {
    const auto n = [&] { return 0.5 * (2 + random.below(7)); };
    meshes::Mesh mesh = meshes::box_mesh({n(), n(), n()}, {1, 1, 1});
    if (random.chance(0.5)) mesh = meshes::creased_by_angle(std::move(mesh), 0.0);
    return smooth(std::move(mesh));
}

Side classify(const meshes::Shell& shell, const RealPoint& p, Real margin) {
    for (const meshes::Net& net : shell.patches) {
        if (is_near(shell, net, p, margin)) return Side::unclear;
    }
    int winding = 0;
    if (!solids::conformance::WindingJudge(shell, p.x, p.y, p.z).winding(winding))
        return Side::unclear;
    return winding != 0 ? Side::in : Side::out;
}

}  // namespace raymo::laws
