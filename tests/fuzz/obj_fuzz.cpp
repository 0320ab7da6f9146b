// libFuzzer: whatever the bytes, a mesh is read or refused; one that closes becomes patches that bound a volume, and lines
// through them enter as often as they leave.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "raymo/meshes/obj.hpp"
#include "raymo/meshes/smooth.hpp"
#include "raymo/solids/freeform/freeform.hpp"

namespace {

/// The mesh without creases, with all edges sharp, and with one edge of every other face.
raymo::meshes::Mesh variant(const raymo::meshes::Mesh& mesh, int number) {
    using namespace raymo;
    if (number == 0) return mesh;
    if (number == 1) return meshes::creased_by_angle(mesh, 0.0);
    std::vector<meshes::Edge> edges;
    for (std::size_t f = 0; f < mesh.face_count(); f += 2)
        edges.push_back(meshes::edge_between(mesh.face(f)[0], mesh.face(f)[1]));
    return meshes::creased(mesh, edges).value();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace raymo;
    int questions = 0;
    const auto mesh =
        meshes::read_obj(std::string_view(reinterpret_cast<const char*>(data), size),
                         [&](double bytes) { return bytes < 3e7 && ++questions < 2000; });
    if (!mesh) {
        if (mesh.error().message.empty()) __builtin_trap();
        return 0;
    }
    if (mesh->corners.size() > 100) return 0;
    for (const int number : {0, 1, 2}) {
        const auto shell = meshes::smooth(variant(*mesh, number));
        if (!shell) {
            if (shell.error().message.empty()) __builtin_trap();
            continue;
        }
        const auto placed = solids::frame_shell(*shell);
        if (!placed) continue;
        for (const Vec3 d : {Vec3{1, 0, 0}, Vec3{0.6, 0, 0.8}, Vec3{0.36, 0.48, -0.8}}) {
            solids::SpanList spans;
            placed->kernel.spans({0, 0, 0, d.x, d.y, d.z, 0x1p-50, 0x1p-50, 0x1p-50, dot(d, d)},
                                 spans);
            for (std::size_t i = 0; i < spans.size(); ++i) {
                if (!(spans[i].enter.s < spans[i].exit.s)) __builtin_trap();
                const Vec3 n = placed->kernel.normal(d * spans[i].exit.s, spans[i].exit.face);
                if (!is_finite(n) || !(max_norm(n) > 0.0)) __builtin_trap();
            }
        }
        static_cast<void>(placed->kernel.where({0.1, 0.2, 0.3}, {1e-12, 1e-12, 1e-12}));
        static_cast<void>(placed->kernel.bounds({}));
    }
    return 0;
}
