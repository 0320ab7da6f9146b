#include "tests/laws/blend_pairs.hpp"

#include <array>
#include <cmath>

namespace raymo::laws {
namespace {

Real r(double x) { return static_cast<Real>(x); }

Affine frame(Vec3 origin, bool is_turned_over) {
    Affine map;
    // Half a turn about x.
    if (is_turned_over) map.linear = Mat3::diagonal(1, -1, -1);
    map.offset = origin;
    return map;
}

/// About the z axis.
Operand turned(RealSurface::Kind kind, Random& random) {
    const double z = random.uniform(-1.5, 1.5);
    const double size = random.uniform(0.5, 2.0);
    Operand out;
    RealSurface& s = out.surface;
    s.kind = kind;
    switch (kind) {
        case RealSurface::Kind::plane:
            out.model =
                moved(block({10 * kFar, 10 * kFar, kFar}), Vec3{-5 * kFar, -5 * kFar, -kFar});
            break;
        case RealSurface::Kind::sphere:
            out.model = sphere(size);
            s.radius = r(size);
            break;
        case RealSurface::Kind::cylinder:
            out.model = cylinder(size, 5 * kFar, true);
            s.radius = r(size);
            break;
        case RealSurface::Kind::cone: {
            const double tangent = random.uniform(0.2, 1.7);
            out.model = cone(0, 2.5 * kFar * tangent, 2.5 * kFar);
            s.half_angle = std::atan2(r(2.5 * kFar * tangent), r(2.5 * kFar));
            break;
        }
        case RealSurface::Kind::torus: {
            const double tube = size * random.uniform(0.2, 0.9);
            out.model = torus(size, tube);
            s.radius = r(size);
            s.tube = r(tube);
            break;
        }
    }
    const Affine map = frame({0, 0, z}, random.chance(0.5));
    out.model = moved(out.model, map);
    s = s.mapped(map);
    return out;
}

/// Along the z axis: a plane or a cylinder.
Operand straight(bool is_plane, double length, Random& random) {
    Operand out;
    RealSurface& s = out.surface;
    if (is_plane) {
        s.kind = RealSurface::Kind::plane;
        // The top of a block whose y axis is turned to z.
        const double top = random.uniform(-1, 1);
        const Affine turn = rotation({0, 0, 1}, random.uniform(0, 360)) * rotation({1, 0, 0}, 90);
        out.model = moved(
            moved(block({10 * kFar, length, kFar}), Vec3{-5 * kFar, -0.5 * length, top - kFar}),
            turn);
        s.point.z = r(top);
        s = s.mapped(turn);
    } else {
        const double radius = random.uniform(0.5, 2.0);
        const Vec3 at{random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), 0};
        out.model = moved(cylinder(radius, length, true), at);
        s.kind = RealSurface::Kind::cylinder;
        s.point = real(at);
        s.radius = r(radius);
    }
    return out;
}

Affine similarity(Random& random, double& scale) {
    scale = std::pow(10.0, random.uniform(-3, 3));
    Affine map = translation(random.in_cube(20 * scale)) *
                 rotation(random.direction(), random.uniform(0, 360)) *
                 scaling({scale, scale, scale});
    if (random.chance(0.3)) map = map * reflection(random.direction());
    return map;
}

constexpr std::array<std::array<RealSurface::Kind, 2>, 13> kTurned{{
    {RealSurface::Kind::plane, RealSurface::Kind::sphere},
    {RealSurface::Kind::plane, RealSurface::Kind::cylinder},
    {RealSurface::Kind::plane, RealSurface::Kind::cone},
    {RealSurface::Kind::plane, RealSurface::Kind::torus},
    {RealSurface::Kind::sphere, RealSurface::Kind::sphere},
    {RealSurface::Kind::sphere, RealSurface::Kind::cylinder},
    {RealSurface::Kind::sphere, RealSurface::Kind::cone},
    {RealSurface::Kind::sphere, RealSurface::Kind::torus},
    {RealSurface::Kind::cylinder, RealSurface::Kind::cone},
    {RealSurface::Kind::cylinder, RealSurface::Kind::torus},
    {RealSurface::Kind::cone, RealSurface::Kind::cone},
    {RealSurface::Kind::cone, RealSurface::Kind::torus},
    {RealSurface::Kind::torus, RealSurface::Kind::torus},
}};

std::array<RealSurface::Kind, 2> kinds_of(int kind) {
    if (kind < static_cast<int>(kTurned.size())) return kTurned[static_cast<std::size_t>(kind)];
    return {kind < 15 ? RealSurface::Kind::plane : RealSurface::Kind::cylinder,
            kind < 14 ? RealSurface::Kind::plane : RealSurface::Kind::cylinder};
}
bool is_about_axis(int kind) { return kind < static_cast<int>(kTurned.size()); }

}  // namespace

RealVec Pair::place(RealVec p, double t) const {
    const RealVec d = p - section.origin;
    const Real x = dot(d, section.u);
    if (!is_circle) return p + along * (r(t) * r(scale));
    const RealVec w = cross(along, section.u);
    return p - section.u * x + (section.u * std::cos(r(t)) + w * std::sin(r(t))) * x;
}

std::string pair_name(int kind) {
    static constexpr std::array<const char*, 5> kNames{"plane", "sphere", "cylinder", "cone",
                                                       "torus"};
    const auto [a, b] = kinds_of(kind);
    return std::string(kNames[static_cast<std::size_t>(a)]) + " and " +
           kNames[static_cast<std::size_t>(b)] +
           (is_about_axis(kind) ? ", one axis" : ", one direction");
}

std::optional<Pair> any_pair(int kind, Random& random) {
    Pair pair;
    const auto [first, second] = kinds_of(kind);
    pair.is_circle = is_about_axis(kind);
    if (pair.is_circle) {
        pair.a = turned(first, random);
        pair.b = turned(second, random);
    } else {
        pair.a = straight(first == RealSurface::Kind::plane, 2.0 * kFar, random);
        pair.b = straight(second == RealSurface::Kind::plane, 2.4 * kFar, random);
    }
    if (random.chance(0.5)) std::swap(pair.a, pair.b);
    pair.map = similarity(random, pair.scale);
    for (Operand* operand : {&pair.a, &pair.b}) {
        operand->model = moved(operand->model, pair.map);
        operand->surface = operand->surface.mapped(pair.map);
    }
    pair.op = static_cast<csg::Op>(random.below(3));
    const auto axis = [&](int i) { return unit(real(pair.map.linear.column(i))); };
    pair.along = axis(2);
    pair.section = {real(pair.map.offset), axis(0), axis(pair.is_circle ? 2 : 1), pair.is_circle};
    const Rolled surfaces(pair.a.surface, pair.b.surface, r(pair.scale));
    const auto edges = surfaces.level(pair.section, 0, r(kReach * pair.scale));
    if (edges.empty()) return std::nullopt;
    pair.edge = edges[static_cast<std::size_t>(random.below(static_cast<int>(edges.size())))];
    const RealVec n = cross(pair.a.surface.gradient(pair.edge), pair.b.surface.gradient(pair.edge));
    if (norm(n) < 0.2L || !pair.a.surface.has_smooth_foot(pair.edge) ||
        !pair.b.surface.has_smooth_foot(pair.edge))
        return std::nullopt;
    // Two edges that are close to each other can not be told by a point.
    for (const RealVec& other : edges) {
        const Real d = norm(other - pair.edge);
        if (d > 0 && d < 0.05L * r(pair.scale)) return std::nullopt;
    }
    return pair;
}

}  // namespace raymo::laws
