#include "raymo/solids/smooth/smooth.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "raymo/meshes/build.hpp"
#include "raymo/meshes/smooth.hpp"

namespace raymo::solids {
namespace {

Argument as_argument(meshes::Mesh mesh) {
    return std::make_shared<const meshes::Mesh>(std::move(mesh));
}

std::vector<Vec2> regular(int n, double r) {
    std::vector<Vec2> out;
    for (int i = 0; i < n; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / n;
        out.push_back({r * std::cos(angle), r * std::sin(angle)});
    }
    return out;
}

meshes::Mesh octahedron() {
    return meshes::make_mesh({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                             {{0, 2, 4},
                              {2, 1, 4},
                              {1, 3, 4},
                              {3, 0, 4},
                              {2, 0, 5},
                              {1, 2, 5},
                              {3, 1, 5},
                              {0, 3, 5}})
        .value();
}

/// All faces of four sides, four at each point.
meshes::Mesh ring(int n, int m) {
    std::vector<std::vector<Vec3>> rows;
    for (int i = 0; i < n; ++i) {
        const double a = 2.0 * std::numbers::pi * i / n;
        std::vector<Vec3> row;
        for (int j = 0; j < m; ++j) {
            const double b = 2.0 * std::numbers::pi * j / m;
            const double q = 3.0 + std::cos(b);
            row.push_back({q * std::cos(a), q * std::sin(a), std::sin(b)});
        }
        rows.push_back(std::move(row));
    }
    return meshes::grid_mesh(rows, meshes::Closing::both).value();
}

/// A prism of n sides whose upper rim is sharp.
meshes::Mesh cup(int n) {
    meshes::Mesh mesh = meshes::extrude_mesh(regular(n, 10.0), 12.0, 1).value();
    std::vector<meshes::Edge> rim;
    const auto count = static_cast<meshes::Index>(n);
    for (meshes::Index i = 0; i < count; ++i) rim.push_back({count + i, count + (i + 1) % count});
    return meshes::creased(std::move(mesh), rim).value();
}

/// A box of which one edge is sharp in its middle and fades out.
meshes::Mesh dented() {
    meshes::Mesh mesh = meshes::box_mesh({3, 2, 1}, {3, 1, 1});
    const auto number = [&](Vec3 p) {
        return static_cast<meshes::Index>(std::find(mesh.points.begin(), mesh.points.end(), p) -
                                          mesh.points.begin());
    };
    const std::vector<meshes::Edge> edges{
        meshes::edge_between(number({1, 0, 1}), number({2, 0, 1}))};
    return meshes::creased(std::move(mesh), edges).value();
}

}  // namespace

const Schema& Smooth::schema() {
    static const std::array<Param, 1> kParams{
        Param{.name = "mesh",
              .words = "mesh",
              .kind = ParamKind::mesh,
              .doc = "closed; its faces have any number of sides, its creases stay sharp"}};
    static const Schema kSchema{
        "smooth", "A mesh as a coarse description of a smooth body.", kParams,
        "let cage = box_mesh(60, 36, 12, cuts: (3, 2, 1)).move(-30, -18, 0)\n"
        "fn height(p) = if p.z > 0 then 24 - (p.x + 8)^2 / 110 - p.y^2 / 60 else 0\n"
        "smooth(cage.warp(fn(p) (p.x, p.y, height(p)))).paint(\"teal\")"};
    return kSchema;
}

Result<Placed<Smooth::Kernel>> Smooth::prepare(std::span<const Argument> arguments) {
    return prepare_shell<Smooth>(meshes::smooth(*std::get<meshes::MeshPtr>(arguments[0])));
}

std::span<const std::vector<Argument>> Smooth::examples() {
    static const std::array<std::vector<Argument>, 8> kExamples{
        {{as_argument(meshes::box_mesh({2, 3, 1}, {1, 1, 1}))},
         {as_argument(octahedron())},
         {as_argument(ring(4, 4))},
         {as_argument(ring(10, 10))},
         {as_argument(cup(6))},
         {as_argument(dented())},
         {as_argument(meshes::creased_by_angle(meshes::box_mesh({1, 1, 1}, {1, 1, 1}), 30.0))},
         {as_argument(meshes::extrude_mesh(regular(5, 1.0), 40.0, 1).value())}}};
    return kExamples;
}

}  // namespace raymo::solids
