#include "raymo/solids/patches/patches.hpp"

#include "raymo/meshes/sew.hpp"

namespace raymo::solids {
namespace {

constexpr std::size_t kBspline = 1;

Argument as_argument(std::vector<meshes::GivenNet> nets) {
    return std::make_shared<const std::vector<meshes::GivenNet>>(std::move(nets));
}

/// Cubics (radius, height) turned about z, by four patches each, as nearly as such patches can be round.
Argument turned(const std::vector<std::array<Vec2, 4>>& profile, double squeeze = 1.0) {
    constexpr double kRound = 0.5522847498307936;
    std::vector<meshes::GivenNet> nets;
    for (const auto& curve : profile) {
        double c = 1.0, s = 0.0;
        for (int quarter = 0; quarter < 4; ++quarter) {
            meshes::GivenNet net;
            for (std::size_t j = 0; j < 4; ++j) {
                const double r = curve[j].x;
                const Vec2 arc[4] = {{r, 0}, {r, r * kRound}, {r * kRound, r}, {0, r}};
                for (std::size_t i = 0; i < 4; ++i)
                    net[4 * i + j] = {arc[i].x * c - arc[i].y * s,
                                      (arc[i].x * s + arc[i].y * c) * squeeze, curve[j].y};
            }
            nets.push_back(net);
            const double turned = -s;
            s = c;
            c = turned;
        }
    }
    return as_argument(std::move(nets));
}

/// The six sides of a cube, as B-splines over its corners' neighbourhood would not close: as Bezier nets, bulging by `b`.
Argument pillow(double b) {
    std::vector<meshes::GivenNet> nets;
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
            meshes::GivenNet net;
            for (std::size_t k = 0; k < 16; ++k) {
                const std::size_t i = k / 4, j = k % 4;
                const bool is_inside = i % 3 != 0 && j % 3 != 0;
                Vec3 p;
                p[axis] = is_inside ? side * (1.0 + b) : side;
                p[(axis + 1) % 3] = 2.0 / 3.0 * static_cast<double>(i) - 1.0;
                p[(axis + 2) % 3] = 2.0 / 3.0 * static_cast<double>(j) - 1.0;
                net[k] = p;
            }
            nets.push_back(net);
        }
    }
    return as_argument(std::move(nets));
}

/// A ring of B-spline nets.
Argument ring(int n, int m) {
    const auto point = [&](int i, int j) {
        static constexpr Vec2 kSquare[4] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
        const Vec2 a = kSquare[(i % n) * 4 / n];
        const Vec2 b = kSquare[(j % m) * 4 / m];
        const double q = 3.0 + b.x;
        return Vec3{a.x * q, a.y * q, b.y + 0.25 * a.x};
    };
    std::vector<meshes::GivenNet> nets;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < m; ++j) {
            meshes::GivenNet net;
            for (int k = 0; k < 16; ++k)
                net[static_cast<std::size_t>(k)] = point(i + k / 4, j + k % 4);
            nets.push_back(net);
        }
    }
    return as_argument(std::move(nets));
}

}  // namespace

const Schema& Patches::schema() {
    static constexpr std::array<std::string_view, 2> kKinds{"bezier", "bspline"};
    static const std::array<Param, 2> kParams{
        Param{.name = "nets",
              .words = "nets",
              .kind = ParamKind::nets,
              .doc = "the control points of the patches; their borders are those of others"},
        Param{.name = "kind",
              .words = "kind",
              .kind = ParamKind::choice,
              .doc = "what the control points are those of: Bézier patches, or uniform B-splines",
              .fallback = std::size_t{0},
              .choices = kKinds}};
    static const Schema kSchema{
        "patches", "All that bicubic patches bound, which close up.", kParams,
        "fn side(bulge) = [for i in 0..3: [for j in 0..3:\n"
        "    (20*i - 30, 20*j - 30, if i in 1..2 and j in 1..2 then 30 + bulge else 30)]]\n"
        "fn turned(net, f) = [for row in net: [for p in row: f(p)]]\n"
        "let top = side(30)\n"
        "patches([top, turned(top, fn(p) (p.x, -p.y, -p.z)),\n"
        "         turned(top, fn(p) (p.z, p.x, p.y)), turned(top, fn(p) (-p.z, p.x, -p.y)),\n"
        "         turned(side(-30), fn(p) (p.y, p.z, p.x)),\n"
        "         turned(side(-30), fn(p) (p.y, -p.z, -p.x))]).paint(\"goldenrod\")"};
    return kSchema;
}

Result<Placed<Patches::Kernel>> Patches::prepare(std::span<const Argument> arguments) {
    const std::vector<meshes::GivenNet>& given = *std::get<meshes::NetsPtr>(arguments[0]);
    const bool is_bspline = std::get<std::size_t>(arguments[1]) == kBspline;
    std::vector<meshes::GivenNet> nets = given;
    if (is_bspline) {
        for (meshes::GivenNet& net : nets) net = meshes::bezier_of_bspline(net);
    }
    return prepare_shell<Patches>(meshes::sew(nets));
}

std::span<const std::vector<Argument>> Patches::examples() {
    // With poles at both ends: an egg, a bottle whose neck turns in, a lens with a sharp rim.
    static const std::array<std::vector<Argument>, 7> kExamples{
        {{pillow(0.5), std::size_t{0}},
         {pillow(0.0), std::size_t{0}},
         {turned({{Vec2{0, -2}, {1, -2}, {1.5, 0}, {1, 1}},
                  {Vec2{1, 1}, {0.6, 1.8}, {0.4, 2}, {0, 2}}}),
          std::size_t{0}},
         {turned({{Vec2{0, 0}, {2, 0}, {2, 1}, {2, 2}},
                  {Vec2{2, 2}, {2, 3}, {0.5, 2.5}, {0.5, 4}},
                  {Vec2{0.5, 4}, {0.5, 4.2}, {0.2, 4.2}, {0, 4.2}}},
                 0.7),
          std::size_t{0}},
         {turned({{Vec2{0, -0.5}, {1, -0.5}, {2, -0.3}, {3, 0}},
                  {Vec2{3, 0}, {2, 0.3}, {1, 0.5}, {0, 0.5}}}),
          std::size_t{0}},
         {ring(4, 4), std::size_t{1}},
         {pillow(-0.3), std::size_t{0}}}};
    return kExamples;
}

}  // namespace raymo::solids
