// Solids of patches along lines that can be judged by hand (P1, P2, P4, P5, P6), and inside-out.
#include "raymo/solids/freeform/freeform.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "raymo/meshes/build.hpp"
#include "raymo/meshes/sew.hpp"
#include "raymo/meshes/smooth.hpp"
#include "raymo/solids/conformance.hpp"

namespace raymo::solids {
namespace {

using conformance::Random;

struct Asked {
    Placed<Freeform> placed;

    explicit Asked(const meshes::Shell& shell) : placed(frame_shell(shell).value()) {}
    [[nodiscard]] double unit() const { return placed.to_object.linear.row[0].x; }
    /// Spans of o + t d, d of unit length, in t.
    [[nodiscard]] std::vector<Span> spans(Vec3 o, Vec3 d, bool* degenerate = nullptr) const {
        const Vec3 at = (o - placed.to_object.offset) / unit();
        const double shift = -dot(at, d) / dot(d, d);
        const Vec3 near = at + d * shift;
        const double e = 0x1p-52;
        SpanList list;
        placed.kernel.spans(
            {near.x, near.y, near.z, d.x, d.y, d.z, e, e, e, dot(d, d), kFromTheBeginning}, list);
        if (degenerate != nullptr) *degenerate = list.degenerate();
        std::vector<Span> out;
        for (std::size_t i = 0; i < list.size(); ++i) {
            Span span = list[i];
            for (SpanEnd* end : {&span.enter, &span.exit}) {
                end->s = (end->s + shift) * unit();
                end->error *= unit();
            }
            out.push_back(span);
        }
        return out;
    }
    [[nodiscard]] Vec3 normal(Vec3 p, std::uint16_t face) const {
        return raymo::unit(placed.kernel.normal((p - placed.to_object.offset) / unit(), face));
    }
    [[nodiscard]] Where where(Vec3 p) const {
        return placed.kernel.where((p - placed.to_object.offset) / unit(), {});
    }
    [[nodiscard]] double volume() const {
        return placed.kernel.volume() * unit() * unit() * unit();
    }
};

/// The six sides of the block from (-1, -1, -1) to (1, 1, 1); the upper one is z = 1 + f(x, y) in its control points.
template <class F>
meshes::Shell block(const F& f) {
    std::vector<meshes::GivenNet> nets;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            meshes::GivenNet net;
            for (std::size_t k = 0; k < 16; ++k) {
                Vec3 p;
                p[axis] = side;
                p[(axis + 1) % 3] = static_cast<double>(k / 4) * (2.0 / 3.0) - 1.0;
                p[(axis + 2) % 3] = static_cast<double>(k % 4) * (2.0 / 3.0) - 1.0;
                if (p.z == 1.0 && axis == 2) p.z += f(p.x, p.y);
                net[k] = p;
            }
            nets.push_back(net);
        }
    }
    return meshes::sew(nets).value();
}

TEST_CASE("P1, P2: flat patches are met where they are") {
    const Asked cube(block([](double, double) { return 0.0; }));
    for (const Vec3 p : {Vec3{-0.4, 0.4, 5}, Vec3{0, 0, 5}, Vec3{1.0 / 3, -1.0 / 3, 5}}) {
        const auto spans = cube.spans(p, {0, 0, -1});
        REQUIRE(spans.size() == 1);
        CHECK(spans[0].enter.s == doctest::Approx(4.0).epsilon(1e-14));
        CHECK(spans[0].exit.s == doctest::Approx(6.0).epsilon(1e-14));
        CHECK(spans[0].exit.error < 1e-12);
        CHECK(norm(cube.normal({p.x, p.y, 1}, spans[0].enter.face) - Vec3{0, 0, 1}) < 1e-12);
    }
    CHECK(cube.volume() == doctest::Approx(8.0).epsilon(1e-14));
    // So is a plane grid as a B-spline: S(u, v) = (1 + u, 1 + v, 1 + u).
    meshes::GivenNet grid;
    for (std::size_t k = 0; k < 16; ++k) {
        const auto i = static_cast<double>(k / 4), j = static_cast<double>(k % 4);
        grid[k] = {i, j, i};
    }
    const meshes::GivenNet flat = meshes::bezier_of_bspline(grid);
    for (std::size_t k = 0; k < 16; ++k) {
        const double u = static_cast<double>(k / 4) / 3.0, v = static_cast<double>(k % 4) / 3.0;
        CHECK(max_norm(flat[k] - Vec3{1 + u, 1 + v, 1 + u}) < 1e-15);
    }
}

TEST_CASE("P4: a wavy patch is met at all of its roots") {
    // z = 1 + c B_1(u) B_1(v) (inner points only), cut along y = 0 at a height that it passes twice.
    const double c = 1.6;
    const Asked hill(
        block([&](double x, double y) { return x < 0 && y < 0 && x > -1 && y > -1 ? c : 0.0; }));
    // At v = 1/2, B_1 = 3/8; along x, u = (x + 1) / 2.
    const double level = 1.1;
    const auto height = [&](double x) {
        const double u = (x + 1) / 2;
        return 1.0 + c * 0.375 * 3.0 * u * (1 - u) * (1 - u) - level;
    };
    const auto root = [&](double lo, double hi) {
        const bool rises = height(lo) < 0;
        for (int i = 0; i < 100; ++i) {
            const double x = 0.5 * (lo + hi);
            ((height(x) < 0) == rises ? lo : hi) = x;
        }
        return lo;
    };
    const double top = -1.0 / 3;  // u = 1/3
    const auto spans = hill.spans({-5, 0, level}, {1, 0, 0});
    REQUIRE(spans.size() == 1);
    CHECK(spans[0].enter.s - 5 == doctest::Approx(root(-1, top)).epsilon(1e-12));
    CHECK(spans[0].exit.s - 5 == doctest::Approx(root(top, 1)).epsilon(1e-12));
    // At the very top there is nothing, just below it a short span.
    const double most = 1.0 + c * 0.375 * 4.0 / 9;
    CHECK(hill.spans({-5, 0, most + 1e-9}, {1, 0, 0}).empty());
    CHECK(hill.spans({-5, 0, most - 1e-9}, {1, 0, 0}).size() == 1);
}

TEST_CASE("P4: a line meets one patch three times") {
    // z = 1 + c p(u) q(v), p = u (1 - u) (u - w), q = v (1 - v), and at v = 1/2 the line z = 1 + c a (u - w) / 4: they meet
    // where u = w or u (1 - u) = a.
    const double c = 3.0, w = 0.45, a = 0.17;
    const Asked waves(block([&](double x, double y) {
        if (std::fabs(x) > 0.9 || std::fabs(y) > 0.9) return 0.0;
        return c * (x < 0 ? -w : 1 - w) / 9.0;
    }));
    const double slope = c * a / 8.0;  // by x = 2 u - 1
    const Vec3 d = raymo::unit(Vec3{1, 0, slope});
    const double per_x = 1.0 / d.x;
    const auto at = [&](double u) { return (2 * u - 1 + 3) * per_x; };
    const auto spans = waves.spans({-3, 0, 1 + slope * (-3 - (2 * w - 1))}, d);
    REQUIRE(spans.size() == 2);
    const double half = std::sqrt(0.25 - a);
    CHECK(spans[0].enter.s == doctest::Approx(2 * per_x).epsilon(1e-12));
    CHECK(spans[0].exit.s == doctest::Approx(at(0.5 - half)).epsilon(1e-12));
    CHECK(spans[1].enter.s == doctest::Approx(at(w)).epsilon(1e-12));
    CHECK(spans[1].exit.s == doctest::Approx(at(0.5 + half)).epsilon(1e-12));
}

TEST_CASE("P5: lines through corners, along diagonals and borders of patches alternate") {
    const meshes::Shell shell =
        meshes::smooth(
            meshes::mapped(meshes::box_mesh({2, 2, 2}, {1, 1, 1}), translation({-1, -1, -1})))
            .value();
    const Asked body(shell);
    CHECK(body.volume() == doctest::Approx(2.6181203086).epsilon(1e-10));
    Random random(5);
    int met = 0;
    for (const meshes::Net& net : shell.patches) {
        for (const std::size_t k : {0U, 3U, 12U, 15U, 5U}) {
            const Vec3 p = shell.points[net[k]];
            for (const Vec3 q :
                 {Vec3{}, Vec3{0.1, 0, 0}, shell.points[net[10]] * -1.0, random.in_cube(0.2)}) {
                if (!(norm(p - q) > 1e-3)) continue;
                const Vec3 d = raymo::unit(q - p);
                bool degenerate = false;
                const auto spans = body.spans(p - d * 3.0, d, &degenerate);
                CHECK_FALSE(degenerate);
                REQUIRE(spans.size() == 1);
                CHECK(spans[0].exit.error < 1e-9);
                CHECK(dot(body.normal(p - d * (3.0 - spans[0].enter.s), spans[0].enter.face), d) <
                      0);
                ++met;
            }
        }
    }
    CHECK(met > 1500);
}

TEST_CASE("P6: chords add up to the volume") {
    const meshes::Mesh bracket =
        meshes::extrude_mesh({{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {0, 2}}, 1.0, 1).value();
    meshes::Mesh octahedron =
        meshes::make_mesh({{2, 0, 0}, {-2, 0, 0}, {0, 2, 0}, {0, -2, 0}, {0, 0, 2}, {0, 0, -2}},
                          {{0, 2, 4},
                           {2, 1, 4},
                           {1, 3, 4},
                           {3, 0, 4},
                           {2, 0, 5},
                           {1, 2, 5},
                           {3, 1, 5},
                           {0, 3, 5}})
            .value();
    octahedron = meshes::mapped(octahedron, translation({1.5, 1, 0.5}));
    for (const meshes::Mesh& mesh :
         {bracket, meshes::creased_by_angle(bracket, 30.0), octahedron}) {
        const Asked body(meshes::smooth(mesh).value());
        double sum = 0.0;
        constexpr int kCells = 300;
        const Vec3 d = raymo::unit(Vec3{0.21, 0.34, 0.9});
        Vec3 s, t;
        make_frame(d, s, t);
        constexpr double kReach = 2.5;
        for (int i = 0; i < kCells; ++i) {
            for (int j = 0; j < kCells; ++j) {
                const Vec3 o = Vec3{1.5, 1, 0.5} + s * (kReach * ((2 * i + 1.0) / kCells - 1)) +
                               t * (kReach * ((2 * j + 1.0) / kCells - 1));
                for (const Span& span : body.spans(o, d)) sum += span.exit.s - span.enter.s;
            }
        }
        sum *= 4 * kReach * kReach / (kCells * kCells);
        CHECK(sum == doctest::Approx(body.volume()).epsilon(2e-3));
    }
}

TEST_CASE("a part that is inside out is solid, and its normals face outwards") {
    // Two cubes apart, of which the second lists its faces the other way round.
    const meshes::Mesh one = meshes::box_mesh({1, 1, 1}, {1, 1, 1});
    const meshes::Mesh big = meshes::box_mesh({2, 2, 2}, {1, 1, 1});
    meshes::Mesh both = big;
    const meshes::Mesh other = meshes::turned_round(meshes::mapped(one, translation({5, 0, 0})));
    for (const Vec3 p : other.points) both.points.push_back(p);
    for (const meshes::Index k : other.corners)
        both.corners.push_back(k + static_cast<meshes::Index>(big.points.size()));
    for (std::size_t f = 1; f < other.first.size(); ++f)
        both.first.push_back(other.first[f] + static_cast<meshes::Index>(big.corners.size()));
    const Asked body(meshes::smooth(both).value());
    const auto spans = body.spans({-3, 0.5, 0.5}, {1, 0, 0});
    REQUIRE(spans.size() == 2);
    for (const Span& span : spans) {
        CHECK(body.normal({span.enter.s - 3, 0.5, 0.5}, span.enter.face).x < 0);
        CHECK(body.normal({span.exit.s - 3, 0.5, 0.5}, span.exit.face).x > 0);
    }
    CHECK(body.where({5.5, 0.5, 0.5}) == Where::in);
    CHECK(body.where({3.5, 0.5, 0.5}) == Where::out);
    // Within each other, they leave a hollow.
    meshes::Mesh hollow = both;
    for (std::size_t k = big.points.size(); k < hollow.points.size(); ++k)
        hollow.points[k] -= Vec3{4.5, -0.5, -0.5};
    const Asked shell(meshes::smooth(hollow).value());
    CHECK(shell.where({1, 1, 1}) == Where::out);
    CHECK(shell.spans({-3, 1, 1}, {1, 0, 0}).size() == 2);
}

TEST_CASE("a line through both poles enters at one and leaves at the other") {
    const auto examples = Patches::examples();
    for (const std::size_t example : {std::size_t{2}, std::size_t{3}, std::size_t{4}}) {
        const auto placed = Patches::prepare(examples[example]).value();
        for (const Vec3 aside :
             {Vec3{}, Vec3{1e-14, 2e-14, 0}, Vec3{-3e-11, 1e-11, 0}, Vec3{0, 2e-8, 0}}) {
            const double e = 0x1p-52;
            SpanList spans;
            placed.kernel.spans({aside.x, aside.y, 0, 0, 0, 1, e, e, e, 1, kFromTheBeginning},
                                spans);
            CHECK_FALSE(spans.degenerate());
            REQUIRE(spans.size() == 1);
            CHECK(spans[0].enter.error < 1e-9);
            CHECK(spans[0].enter.s == doctest::Approx(placed.kernel.bounds({}).lo.z).epsilon(1e-7));
            CHECK(spans[0].exit.s == doctest::Approx(placed.kernel.bounds({}).hi.z).epsilon(1e-7));
        }
    }
}

TEST_CASE("a surface of more patches than there are numbers for faces") {
    constexpr int kRows = 200;
    std::vector<std::vector<Vec3>> rows;
    for (int i = 0; i < kRows; ++i) {
        std::vector<Vec3> row;
        for (int j = 0; j < kRows; ++j) {
            const double a = 2 * std::numbers::pi * i / kRows, b = 2 * std::numbers::pi * j / kRows;
            const double q = 3 + std::cos(b);
            row.push_back({q * std::cos(a), q * std::sin(a), std::sin(b)});
        }
        rows.push_back(row);
    }
    const meshes::Shell shell =
        meshes::smooth(meshes::grid_mesh(rows, meshes::Closing::both).value()).value();
    REQUIRE(shell.patches.size() > kPatchNumbers);
    const Asked ring(shell);
    // Nearly a torus, whose normals point away from the circle in its middle.
    Random random(3);
    for (int i = 0; i < 500; ++i) {
        const double a = random.uniform(0, 2 * std::numbers::pi);
        const Vec3 middle{3 * std::cos(a), 3 * std::sin(a), 0};
        const Vec3 d = random.direction();
        for (const Span& span : ring.spans(middle, d)) {
            for (const bool enters : {true, false}) {
                const SpanEnd& end = enters ? span.enter : span.exit;
                const Vec3 p = middle + d * end.s;
                const Vec3 core = Vec3{p.x, p.y, 0} * (3.0 / std::hypot(p.x, p.y));
                CHECK(norm(ring.normal(p, end.face) - raymo::unit(p - core)) < 0.01);
            }
        }
    }
}

TEST_CASE("poles have the normal of the patches around them") {
    const auto examples = Patches::examples();
    const auto placed = Patches::prepare(examples[2]).value();
    for (std::uint16_t patch = 0; patch < 4; ++patch) {
        const Vec3 n = placed.kernel.normal({0, 0, -0.5}, static_cast<std::uint16_t>(2 * patch));
        CHECK(norm(raymo::unit(n) - Vec3{0, 0, -1}) < 1e-7);
    }
}

}  // namespace
}  // namespace raymo::solids
