#include "raymo/sml/builtins/box.hpp"

#include "raymo/solids/sweep/sweep.hpp"

namespace raymo::sml {
namespace {

bool box_of_path(Call& call, std::size_t i, Aabb& out) {
    const curves::PathPtr& path = call[i].as<PathObject>().value;
    if (!call.evaluator().worked(static_cast<double>(path->spans.size()), call.node()))
        return false;
    const auto swept =
        solids::Sweep::prepare(std::array<solids::Argument, 2>{path, std::size_t{0}});
    if (!swept) return call.fail(swept.error());
    out = swept->kernel.bounds(swept->to_object);
    return true;
}

}  // namespace

bool box_of(Call& call, std::size_t i, Aabb& out) {
    if (call.has(i) && call[i].is(Tag::contour)) {
        const Box2 box = curves::box_of(call[i].as<ContourObject>().value);
        if (box.empty()) return call.fail(i, ErrorCode::empty, "the contour is empty");
        out = {{box.lo.x, box.lo.y, 0.0}, {box.hi.x, box.hi.y, 0.0}};
        return call.evaluator().worked(1000.0, call.node());
    }
    if (call.has(i) && call[i].is(Tag::path)) return box_of_path(call, i, out);
    if (call.has(i) && call[i].is(Tag::mesh)) {
        const meshes::Mesh& mesh = *call[i].as<MeshObject>().value;
        out = meshes::box_of(mesh);
        return call.evaluator().worked(0.01 * static_cast<double>(mesh.corners.size()),
                                       call.node());
    }
    csg::Solid solid;
    if (!call.solid(i, solid)) return false;
    out = csg::bounds(solid);
    if (out.empty()) return call.fail(i, ErrorCode::empty, "the solid is empty");
    if (out.bounded()) return true;
    return call.fail(i, ErrorCode::unbounded, "the solid has no finite size",
                     "intersect it with a block first");
}

}  // namespace raymo::sml
