// Patches of meshes: volumes, tangent planes across all borders, and nets that are sewn.
#include "raymo/meshes/smooth.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "raymo/meshes/build.hpp"
#include "raymo/meshes/sew.hpp"

namespace raymo::meshes {
namespace {

/// A border of patches, with the patches beside it.
struct Side {
    std::size_t patch;
    int side;
    bool reversed;
};
using Borders = std::map<std::array<Index, 4>, std::vector<Side>>;

Borders borders_of(const Shell& shell) {
    Borders out;
    for (std::size_t n = 0; n < shell.patches.size(); ++n) {
        const Net& net = shell.patches[n];
        for (int side = 0; side < 4; ++side) {
            std::array<Index, 4> key{};
            for (std::size_t k = 0; k < 4; ++k) {
                const std::size_t at = side == 0   ? 4 * k
                                       : side == 1 ? 4 * k + 3
                                       : side == 2 ? k
                                                   : 12 + k;
                key[k] = net[at];
            }
            std::array<Index, 4> back{key[3], key[2], key[1], key[0]};
            const bool reversed = back < key;
            out[reversed ? back : key].push_back({n, side, reversed});
        }
    }
    return out;
}

Vec3 normal_at(const Shell& shell, const Side& side, double t) {
    if (side.reversed) t = 1.0 - t;
    const double u = side.side < 2 ? t : (side.side == 2 ? 0.0 : 1.0);
    const double v = side.side < 2 ? (side.side == 0 ? 0.0 : 1.0) : t;
    const auto weights = [](double x, std::array<double, 4>& f, std::array<double, 4>& g) {
        const double w = 1.0 - x;
        f = {w * w * w, 3 * w * w * x, 3 * w * x * x, x * x * x};
        g = {-3 * w * w, 3 * w * w - 6 * w * x, 6 * w * x - 3 * x * x, 3 * x * x};
    };
    std::array<double, 4> fu, gu, fv, gv;
    weights(u, fu, gu);
    weights(v, fv, gv);
    Vec3 du, dv;
    for (std::size_t k = 0; k < 16; ++k) {
        const Vec3 b = shell.points[shell.patches[side.patch][k]];
        du += b * (gu[k / 4] * fv[k % 4]);
        dv += b * (fu[k / 4] * gv[k % 4]);
    }
    return unit(cross(du, dv));
}

/// The largest sine of the angle between normals across the borders for which `counts`, and whether they face alike.
template <class Counts>
double largest_turn(const Shell& shell, const Counts& counts) {
    double most = 0.0;
    for (const auto& [key, sides] : borders_of(shell)) {
        REQUIRE(sides.size() == 2);
        for (int i = 0; i <= 16; ++i) {
            const double t = i / 16.0;
            const Vec3 a = normal_at(shell, sides[0], t);
            const Vec3 b = normal_at(shell, sides[1], t);
            if (!counts(shell.points[key[0]], shell.points[key[3]])) continue;
            CHECK(dot(a, b) > 0.0);
            most = std::max(most, norm(cross(a, b)));
        }
    }
    return most;
}
double largest_turn(const Shell& shell) {
    return largest_turn(shell, [](Vec3, Vec3) { return true; });
}

/// Borders across which the surface has an edge, and the ends of these at which it has none.
struct SharpBorders {
    std::size_t borders = 0;
    std::size_t smooth_ends = 0;
};
/// Tells sharp borders from smooth ones; nothing may lie between.
SharpBorders sharp_borders(const Shell& shell) {
    SharpBorders out;
    for (const auto& [key, sides] : borders_of(shell)) {
        REQUIRE(sides.size() == 2);
        const auto turn = [&](double t) {
            return norm(cross(normal_at(shell, sides[0], t), normal_at(shell, sides[1], t)));
        };
        double most = 0.0;
        for (int i = 0; i <= 16; ++i) most = std::max(most, turn(i / 16.0));
        if (most < 1e-10) continue;
        CHECK(most > 1e-4);
        ++out.borders;
        for (const double end : {0.0, 1.0}) out.smooth_ends += turn(end) < 1e-10 ? 1 : 0;
    }
    return out;
}

Vec3 moved_at_random(Vec3 p, unsigned& seed) {
    const auto random = [&] {
        seed = seed * 1664525U + 1013904223U;
        return seed / 4294967296.0 - 0.5;
    };
    return p + Vec3{0.4 * random(), 0.4 * random(), 0.6 * random()};
}

std::vector<Vec2> regular_polygon(int n) {
    std::vector<Vec2> points;
    for (int k = 0; k < n; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / n;
        points.push_back({2.0 * std::cos(angle), 2.0 * std::sin(angle)});
    }
    return points;
}

/// A prism of n sides, its points moved at random.
Mesh uneven_prism(int n, unsigned seed) {
    Mesh out = extrude_mesh(regular_polygon(n), 2.0, 1).value();
    for (Vec3& p : out.points) p = moved_at_random(p, seed);
    return out;
}

/// Two pyramids of n sides with one base, their points moved at random: n edges meet at both tips, the points n and n + 1.
Mesh uneven_pyramids(int n, unsigned seed) {
    std::vector<Vec3> points;
    for (const Vec2 p : regular_polygon(n)) points.push_back({p.x, p.y, 0});
    points.push_back({0, 0, 1.5});
    points.push_back({0, 0, -1.5});
    for (Vec3& p : points) p = moved_at_random(p, seed);
    std::vector<std::vector<double>> faces;
    for (int k = 0; k < n; ++k) {
        const double a = k, b = (k + 1) % n;
        faces.push_back({a, b, double(n)});
        faces.push_back({b, a, double(n + 1)});
    }
    return make_mesh(points, faces).value();
}

TEST_CASE("P3: the cube's cage has the volume and the symmetry that it must have") {
    const Shell shell =
        smooth(mapped(box_mesh({2, 2, 2}, {1, 1, 1}), translation({-1, -1, -1}))).value();
    CHECK(shell.patches.size() == 96);
    CHECK(volume_of(shell) == doctest::Approx(2.6181203086).epsilon(1e-10));
    CHECK(largest_turn(shell) < 1e-12);
    // Each control point turned by a quarter about an axis, or mirrored, is one again.
    const auto is_point = [&](Vec3 p) {
        for (const Vec3 q : shell.points) {
            if (max_norm(p - q) < 1e-13) return true;
        }
        return false;
    };
    for (const Vec3 p : shell.points) {
        CHECK(is_point({p.y, -p.x, p.z}));
        CHECK(is_point({p.y, p.z, p.x}));
        CHECK(is_point({-p.x, p.y, p.z}));
    }
}

TEST_CASE("the octahedron's cage has the volume that it must have") {
    const Mesh mesh =
        make_mesh({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                  {{0, 2, 4},
                   {2, 1, 4},
                   {1, 3, 4},
                   {3, 0, 4},
                   {2, 0, 5},
                   {1, 2, 5},
                   {3, 1, 5},
                   {0, 3, 5}})
            .value();
    CHECK(volume_of(smooth(mesh).value()) == doctest::Approx(0.4912533958).epsilon(1e-10));
}

TEST_CASE("tangent planes agree across all borders, for 3 to 12 edges at a point") {
    for (int n = 3; n <= 12; ++n) {
        CAPTURE(n);
        const auto seed = static_cast<unsigned>(n);
        CHECK(largest_turn(smooth(uneven_prism(n, seed)).value()) < 1e-10);
        CHECK(largest_turn(smooth(uneven_pyramids(n, seed)).value()) < 1e-10);
    }
}

TEST_CASE("beside creases tangent planes agree, for 3 to 12 edges at a point") {
    for (int n = 3; n <= 12; ++n) {
        CAPTURE(n);
        const auto count = static_cast<Index>(n);
        const Index tip = count;
        const Mesh mesh = uneven_pyramids(n, static_cast<unsigned>(n));
        // How many borders are sharp, of the four that come of each crease, and where creases end.
        const auto sharp = [&](const std::vector<Edge>& edges) {
            return sharp_borders(smooth(creased(mesh, edges).value()).value());
        };
        std::vector<Edge> rim;
        for (Index k = 0; k < count; ++k) rim.push_back(edge_between(k, (k + 1) % count));
        const SharpBorders round = sharp(rim);
        CHECK(round.borders == 4 * count);
        CHECK(round.smooth_ends == 0);
        // One that ends at both of its points, and one that ends at the tips.
        const SharpBorders short_one = sharp({edge_between(0, tip)});
        CHECK(short_one.borders == 4);
        CHECK(short_one.smooth_ends == 2);
        const SharpBorders over = sharp({edge_between(0, tip), edge_between(0, tip + 1)});
        CHECK(over.borders == 8);
        CHECK(over.smooth_ends == 2);
        // One that passes through the tip, with fans of all sizes beside it.
        for (Index k = 2; k <= count / 2; ++k) {
            CAPTURE(k);
            const SharpBorders through = sharp({edge_between(0, tip), edge_between(k, tip)});
            CHECK(through.borders == 8);
            CHECK(through.smooth_ends == 2);
        }
        // Three of them meet there.
        const Index third = count / 3;
        const SharpBorders corner =
            sharp({edge_between(0, tip), edge_between(third, tip), edge_between(2 * third, tip)});
        CHECK(corner.borders == 12);
        CHECK(corner.smooth_ends == 3);
    }
}

TEST_CASE("P7: a ring of four-sided faces is a B-spline as it stands") {
    std::vector<std::vector<Vec3>> rows;
    for (int i = 0; i < 6; ++i) {
        std::vector<Vec3> row;
        for (int j = 0; j < 5; ++j) {
            const double a = 2 * std::numbers::pi * i / 6, b = 2 * std::numbers::pi * j / 5;
            const double q = 3 + std::cos(b);
            row.push_back({q * std::cos(a), q * std::sin(a), std::sin(b)});
        }
        rows.push_back(row);
    }
    const Shell shell = smooth(grid_mesh(rows, Closing::both).value()).value();
    CHECK(shell.patches.size() == 30);
    CHECK(largest_turn(shell) < 1e-12);
    // The same, sewn of B-spline nets.
    std::vector<GivenNet> nets;
    for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t j = 0; j < 5; ++j) {
            GivenNet net;
            for (std::size_t k = 0; k < 16; ++k) net[k] = rows[(i + k / 4) % 6][(j + k % 4) % 5];
            nets.push_back(bezier_of_bspline(net));
        }
    }
    CHECK(volume_of(sew(nets).value()) == doctest::Approx(volume_of(shell)).epsilon(1e-13));
}

TEST_CASE("creases are sharp, and all other borders smooth") {
    const Mesh box = box_mesh({1, 1, 1}, {1, 1, 1});
    const Shell block = smooth(creased_by_angle(box, 30.0)).value();
    CHECK(block.patches.size() == 6);
    CHECK(volume_of(block) == doctest::Approx(1.0).epsilon(1e-14));
    // A prism whose upper rim is sharp; there the normals differ, and elsewhere they agree.
    for (const int n : {4, 5, 7}) {
        CAPTURE(n);
        Mesh prism = extrude_mesh({{2, 0}, {0, 2}, {-2, 0}, {0, -2}}, 2.0, 1).value();
        if (n != 4) {
            prism = uneven_prism(n, 77);
            for (Vec3& p : prism.points) p.z = p.z > 1.0 ? 2.0 : 0.0;
        }
        std::vector<Edge> rim;
        const auto count = static_cast<Index>(n);
        for (Index k = 0; k < count; ++k) rim.push_back({count + k, count + (k + 1) % count});
        const Shell shell = smooth(creased(prism, rim).value()).value();
        const auto is_rim = [](Vec3 a, Vec3 b) { return a.z > 2.0 - 1e-9 && b.z > 2.0 - 1e-9; };
        CHECK(largest_turn(shell, [&](Vec3 a, Vec3 b) { return !is_rim(a, b); }) < 1e-10);
    }
    // Corners where three creases meet and four faces: three quarters of a cube's surroundings.
    Mesh steps = extrude_mesh({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, 1.0, 1).value();
    const Shell cut = smooth(creased_by_angle(steps, 30.0)).value();
    CHECK(volume_of(cut) == doctest::Approx(3.0).epsilon(1e-12));
}

TEST_CASE("nets are sewn whatever side they face, and told apart where they do not close") {
    std::vector<GivenNet> nets;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {0.0, 3.0}) {
            GivenNet net;
            for (std::size_t k = 0; k < 16; ++k) {
                Vec3 p;
                p[axis] = side;
                p[(axis + 1) % 3] = static_cast<double>(k / 4);
                p[(axis + 2) % 3] = static_cast<double>(k % 4);
                net[k] = p + Vec3{1e-15, 0, 0} * (axis - 1.0);
            }
            nets.push_back(net);
        }
    }
    const Shell shell = sew(nets).value();
    CHECK(volume_of(shell) == doctest::Approx(27.0));
    for (const auto& [key, sides] : borders_of(shell)) CHECK(sides.size() == 2);
    std::vector<GivenNet> open(nets.begin(), nets.end() - 1);
    CHECK(sew(open).error().message.find("belongs to one of them only") != std::string::npos);
    CHECK_FALSE(sew({}));
    CHECK_FALSE(sew({GivenNet{}}));
}

}  // namespace
}  // namespace raymo::meshes
