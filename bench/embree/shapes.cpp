#include "embree/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "primitive.hpp"
#include "raymo/curves/build_contour.hpp"
#include "raymo/curves/build_path.hpp"

namespace raymo::bench {
namespace {

using std::numbers::pi;

std::uint32_t at_least(double count, double least) {
    return static_cast<std::uint32_t>(std::lround(std::max(count, least)));
}

/// Adds vertices, and triangles between rows of them.
class Mesher {
public:
    std::uint32_t vertex(Vec3 p, Vec3 n) {
        n = unit(n);
        mesh_.places.push_back(single(p));
        mesh_.normals.push_back(single(n));
        return static_cast<std::uint32_t>(mesh_.places.size() - 1);
    }
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (!is_same(a, b) && !is_same(b, c) && !is_same(c, a))
            mesh_.triangles.push_back({a, b, c});
    }
    /// Squares between two closed rows of `count` vertices that begin at a and b.
    void ribbon(std::uint32_t a, std::uint32_t b, std::uint32_t count) {
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t j = (i + 1) % count;
            triangle(a + i, a + j, b + j);
            triangle(a + i, b + j, b + i);
        }
    }
    Mesh take() { return std::move(mesh_); }

private:
    static Mesh::Vertex single(Vec3 v) {
        return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
    }
    [[nodiscard]] bool is_same(std::uint32_t a, std::uint32_t b) const {
        const Mesh::Vertex &p = mesh_.places[a], &q = mesh_.places[b];
        return p.x == q.x && p.y == q.y && p.z == q.z;
    }
    Mesh mesh_;
};

template <std::size_t D>
using Cubic = std::array<std::array<double, 4>, D>;

template <std::size_t D>
std::array<double, D> value(const Cubic<D>& c, double u) {
    const double v = 1.0 - u;
    std::array<double, D> out;
    for (std::size_t k = 0; k < D; ++k)
        out[k] =
            v * v * (v * c[k][0] + 3.0 * u * c[k][1]) + u * u * (3.0 * v * c[k][2] + u * c[k][3]);
    return out;
}
template <std::size_t D>
std::array<double, D> slope(const Cubic<D>& c, double u) {
    const double v = 1.0 - u;
    std::array<double, D> out;
    for (std::size_t k = 0; k < D; ++k)
        out[k] = 3.0 * (v * v * (c[k][1] - c[k][0]) + 2.0 * u * v * (c[k][2] - c[k][1]) +
                        u * u * (c[k][3] - c[k][2]));
    return out;
}

// ------------------------------------------------------------------------------------- torus

constexpr double kRing = 1.0, kTube = 0.4;

Result<csg::Solid> torus() { return primitive("torus", {{"R", kRing}, {"r", kTube}}); }

Mesh torus_mesh(double triangles) {
    // A chord over the angle a of a circle of radius r deviates by r a^2 / 8.
    const double ratio = std::sqrt(kTube / (kRing + kTube));
    const std::uint32_t around = at_least(std::sqrt(triangles / (2.0 * ratio)), 3);
    const std::uint32_t tube = at_least(triangles / (2.0 * around), 3);
    Mesher mesher;
    for (std::uint32_t i = 0; i < around; ++i) {
        const double a = 2.0 * pi * i / around;
        for (std::uint32_t j = 0; j < tube; ++j) {
            const double b = 2.0 * pi * j / tube;
            const Vec3 n{std::cos(a) * std::cos(b), std::sin(a) * std::cos(b), std::sin(b)};
            mesher.vertex(Vec3{std::cos(a), std::sin(a), 0.0} * kRing + n * kTube, n);
        }
    }
    for (std::uint32_t i = 0; i < around; ++i)
        mesher.ribbon(i * tube, (i + 1) % around * tube, tube);
    return mesher.take();
}

// -------------------------------------------------------------------------------- revolution

/// A vase: seven cubics from the axis to the axis.
curves::Curve profile() {
    static constexpr std::array<Vec2, 22> kPoints{
        Vec2{0, -1.0}, {0.2, -1.0},   {0.45, -1.0}, {0.55, -0.97}, {0.62, -0.949}, {0.62, -0.9},
        {0.55, -0.85}, {0.41, -0.75}, {0.3, -0.65}, {0.35, -0.5},  {0.45, -0.2},   {0.85, -0.1},
        {0.85, 0.25},  {0.85, 0.6},   {0.4, 0.65},  {0.35, 0.85},  {0.325, 0.95},  {0.4, 1.0},
        {0.3, 1.0},    {0.2, 1.0},    {0.1, 0.95},  {0, 0.95}};
    return *curves::spline_curve(kPoints, {curves::SplineKind::bezier, 3});
}

Result<csg::Solid> vase() {
    return primitive(
        "revolve",
        {{"contour", std::make_shared<const curves::Outline>(curves::Outline{{profile()}})}});
}

Mesh vase_mesh(double triangles) {
    const curves::Curve curve = profile();
    const auto spans = static_cast<double>(curve.spans.size());
    // Along the profile, about 5 long and twice bent round, nearly as densely as around.
    const std::uint32_t steps = at_least(std::sqrt(0.5 * triangles * 1.3) / spans, 1);
    const std::uint32_t around = at_least(triangles / (2.0 * steps * spans), 3);
    Mesher mesher;
    std::uint32_t rows = 0;
    for (const curves::Span2& span : curve.spans) {
        const Cubic<2> c{span.x, span.y};
        for (std::uint32_t i = rows == 0 ? 0 : 1; i <= steps; ++i, ++rows) {
            const double u = static_cast<double>(i) / steps;
            const auto [r, z] = value(c, u);
            const auto [dr, dz] = slope(c, u);
            for (std::uint32_t j = 0; j < around; ++j) {
                const double a = 2.0 * pi * j / around;
                mesher.vertex({r * std::cos(a), r * std::sin(a), z},
                              {dz * std::cos(a), dz * std::sin(a), -dr});
            }
        }
    }
    for (std::uint32_t i = 0; i + 1 < rows; ++i)
        mesher.ribbon(i * around, (i + 1) * around, around);
    return mesher.take();
}

// ------------------------------------------------------------------------------------- prism

constexpr double kHeight = 0.7;

/// A star knob: a closed B-spline of 24 points.
curves::Curve outline() {
    std::array<Vec2, 24> points;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double a = 2.0 * pi * static_cast<double>(i) / points.size();
        points[i] = Vec2{std::cos(a), std::sin(a)} * (i % 2 == 0 ? 1.1 : 0.85);
    }
    return *curves::spline_curve(points, {curves::SplineKind::bspline, 3, true});
}

Result<csg::Solid> prism() {
    return primitive(
        "prism",
        {{"contour", std::make_shared<const curves::Outline>(curves::Outline{{outline()}})},
         {"h", kHeight}});
}

/// Fills a face: rings towards the middle, each of half as many vertices as the one around it, so that triangles are small
/// and of good shape everywhere.
void fill(Mesher& mesher, std::vector<Vec3> ring, Vec3 normal) {
    std::vector<std::uint32_t> outer;
    for (const Vec3& p : ring) outer.push_back(mesher.vertex(p, normal));
    while (ring.size() > 8) {
        const std::size_t n = ring.size();
        const double scale = 1.0 - 2.0 * pi / static_cast<double>(n);
        std::vector<Vec3> next;
        std::vector<std::uint32_t> inner;
        for (std::size_t i = 0; i < n; i += 2) {
            next.push_back({ring[i].x * scale, ring[i].y * scale, ring[i].z});
            inner.push_back(mesher.vertex(next.back(), normal));
        }
        for (std::size_t i = 0; i < n; i += 2) {
            const std::uint32_t here = inner[i / 2];
            const std::uint32_t there = inner[(i / 2 + 1) % inner.size()];
            mesher.triangle(outer[i], outer[(i + 1) % n], here);
            mesher.triangle(outer[(i + 1) % n], there, here);
            if (i + 1 < n) mesher.triangle(outer[i + 1], outer[(i + 2) % n], there);
        }
        ring = std::move(next);
        outer = std::move(inner);
    }
    for (std::size_t i = 1; i + 1 < outer.size(); ++i)
        mesher.triangle(outer[0], outer[i], outer[i + 1]);
}

Mesh prism_mesh(double triangles) {
    const curves::Curve curve = outline();
    // Two for each step of the wall, and about two for each vertex of a face.
    const std::uint32_t steps =
        at_least(triangles / 6.0 / static_cast<double>(curve.spans.size()), 1);
    Mesher mesher;
    std::vector<Vec3> low, high;
    for (const curves::Span2& span : curve.spans) {
        const Cubic<2> c{span.x, span.y};
        for (std::uint32_t i = 0; i < steps; ++i) {
            const auto [x, y] = value(c, static_cast<double>(i) / steps);
            const auto [dx, dy] = slope(c, static_cast<double>(i) / steps);
            low.push_back({x, y, 0.0});
            high.push_back({x, y, kHeight});
            mesher.vertex(low.back(), {dy, -dx, 0.0});
            mesher.vertex(high.back(), {dy, -dx, 0.0});
        }
    }
    const auto count = static_cast<std::uint32_t>(low.size());
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t a = 2 * i;
        const std::uint32_t b = 2 * ((i + 1) % count);
        mesher.triangle(a, b, b + 1);
        mesher.triangle(a, b + 1, a + 1);
    }
    fill(mesher, std::move(low), {0, 0, -1});
    fill(mesher, std::move(high), {0, 0, 1});
    return mesher.take();
}

// ------------------------------------------------------------------------------------- sweep

/// A tentacle: eight cubics, thick to thin.
curves::Path path() {
    std::array<curves::Point<4>, 11> points;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const double t = static_cast<double>(i);
        points[i] = {1.0 * std::cos(0.75 * t), 1.0 * std::sin(0.75 * t), 0.2 * t - 1.0,
                     0.3 - 0.018 * t + 0.02 * std::cos(1.7 * t)};
    }
    return curves::spline_path(points, {curves::SplineKind::bspline, 3})->path;
}

Result<csg::Solid> tentacle() {
    return primitive("sweep", {{"path", std::make_shared<const curves::Path>(path())}});
}

/// One ring of the envelope: centre, radius, tangent, and how much the radius grows along the path. The sphere touches the
/// envelope in the circle where its normal n has n.t = -growth.
struct Ring {
    Vec3 centre, tangent;
    double radius, growth;
};

Mesh tentacle_mesh(double triangles) {
    const curves::Path spine = path();
    const auto spans = static_cast<double>(spine.spans.size());
    // The path bends at a radius of about 1, the rings at 0.25, over a length of some 6.
    const std::uint32_t steps = at_least(std::sqrt(0.5 * triangles * 1.9) / spans, 1);
    const std::uint32_t around = at_least(triangles / (2.0 * steps * spans), 3);
    Mesher mesher;
    Vec3 side{};
    std::uint32_t rows = 0;
    const auto ring = [&](const Ring& at, double growth) {
        const Vec3 up = cross(at.tangent, side);
        const double across = std::sqrt(std::max(1.0 - growth * growth, 0.0));
        for (std::uint32_t j = 0; j < around; ++j) {
            const double a = 2.0 * pi * j / around;
            const Vec3 n = (side * std::cos(a) + up * std::sin(a)) * across - at.tangent * growth;
            mesher.vertex(at.centre + n * at.radius, n);
        }
        ++rows;
    };
    const auto place = [&](const curves::PathSpan& span, double u) {
        const Cubic<4> c{span.x, span.y, span.z, span.r};
        const auto p = value(c, u);
        const auto d = slope(c, u);
        const Vec3 along{d[0], d[1], d[2]};
        const double speed = norm(along);
        return Ring{{p[0], p[1], p[2]}, along * (1.0 / speed), p[3], d[3] / speed};
    };
    // Rings of a cap, from its pole to the rim: growth is the cosine of the angle from the pole, seen backwards.
    const std::uint32_t cap = std::max(around / 4, 1U);
    const auto cap_ring = [&](const Ring& at, double pole, std::uint32_t i) {
        const double rim = std::acos(std::clamp(pole * at.growth, -1.0, 1.0));
        ring(at, pole * std::cos(rim * i / cap));
    };
    const Ring first = place(spine.spans.front(), 0.0);
    Vec3 other;
    make_frame(first.tangent, side, other);
    for (std::uint32_t i = 0; i < cap; ++i) cap_ring(first, 1.0, i);
    for (std::size_t k = 0; k < spine.spans.size(); ++k) {
        for (std::uint32_t i = k == 0 ? 0 : 1; i <= steps; ++i) {
            const Ring at = place(spine.spans[k], static_cast<double>(i) / steps);
            side =
                unit(side - at.tangent *
                                dot(side, at.tangent));  // carried along, so that rows do not twist
            ring(at, at.growth);
        }
    }
    const Ring last = place(spine.spans.back(), 1.0);
    for (std::uint32_t i = cap; i-- > 0;) cap_ring(last, -1.0, i);
    for (std::uint32_t i = 0; i + 1 < rows; ++i)
        mesher.ribbon(i * around, (i + 1) * around, around);
    return mesher.take();
}

scene::Camera camera(Vec3 eye, Vec3 at, double angle) {
    scene::Camera view;
    view.eye = eye;
    view.look_at = at;
    view.angle = angle;
    return view;
}

}  // namespace

std::span<const Shape> shapes() {
    static const std::array<Shape, 4> kShapes{
        Shape{"torus", "R = 1, r = 0.4", torus, torus_mesh, camera({2, -5, 5}, {}, 24)},
        Shape{"revolution", "vase of 7 cubics", vase, vase_mesh, camera({2, -6, 3}, {}, 20)},
        Shape{"prism", "star of 24 cubics", prism, prism_mesh,
              camera({2, -5, 4}, {0, 0, 0.35}, 20)},
        Shape{"sweep", "8 cubics, radius 0.32 to 0.1", tentacle, tentacle_mesh,
              camera({1, -4, 6}, {0, 0, 0}, 22)},
    };
    return kShapes;
}

}  // namespace raymo::bench
