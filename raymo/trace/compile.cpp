#include <algorithm>
#include <cmath>

#include "raymo/trace/compiled_scene.hpp"
#include "raymo/trace/data.hpp"
#include "raymo/trace/flatten.hpp"

namespace raymo::trace {

namespace {

/// Up to this many leaves a model is flattened; beyond, shared solids become instances.
constexpr double kFlattenLeaves = 2.5e5;
/// More leaves than rays can tell apart; such a model is a mistake (a doubling in a loop), not a
/// design.
constexpr double kMostLeaves = 1e15;

}  // namespace

CompiledScene::CompiledScene(std::unique_ptr<const Data> data) : data_(std::move(data)) {}
CompiledScene::~CompiledScene() = default;
CompiledScene::CompiledScene(CompiledScene&&) noexcept = default;
CompiledScene& CompiledScene::operator=(CompiledScene&&) noexcept = default;

Result<CompiledScene> compile(const scene::Scene& scene, Progress* progress) {
    auto data = std::make_unique<CompiledScene::Data>();
    data->materials = scene.materials;
    data->default_material = scene::default_material();
    // May have it, until the looks are known: most scenes have none, and need not ask for each leaf.
    data->has_transparency =
        data->materials.any_of([](const scene::Material& m) { return m.transmission > 0.0; });
    std::vector<csg::Solid> parts;
    for (const scene::Part& part : scene.parts) {
        parts.push_back(part.solid);
        data->leaf_count += part.solid.node().leaf_count;
    }
    if (!(data->leaf_count <= kMostLeaves)) {
        return fail(ErrorCode::limit, "the model has more than 10^15 primitives",
                    "look for a solid that is doubled in a loop");
    }
    Flattener flattener(*data, data->leaf_count > kFlattenLeaves, progress);
    auto base = flattener.compile(parts, 0);
    if (!base) return Failure(std::move(base).error());
    std::swap(data->solids.front(), data->solids[*base]);
    // The base was compiled last; instances refer to the others by number, so the base takes the
    // first place and the solid that stood there the base's.
    for (Frame& frame : data->frames) {
        if (frame.type == kInstanceType && frame.index == 0) frame.index = *base;
    }
    std::uint32_t first = 0;
    for (CompiledSolid& solid : data->solids) {
        solid.first_leaf = first;
        first += static_cast<std::uint32_t>(solid.leaves.size());
    }
    data->has_transparency =
        data->has_transparency &&
        std::any_of(data->looks.begin(), data->looks.end(),
                    [&](const Look& look) { return data->is_transparent(look.material); });
    data->has_absorption =
        data->has_transparency && data->materials.any_of([](const scene::Material& m) {
            return m.transmission > 0.0 && max_norm(m.absorption) > 0.0;
        });
    return CompiledScene(std::move(data));
}

const Aabb& CompiledScene::bounds() const { return data_->solids.front().bounds; }
std::size_t CompiledScene::part_count() const { return data_->solids.front().parts; }
double CompiledScene::leaf_count() const { return data_->leaf_count; }
bool CompiledScene::has_transparency() const { return data_->has_transparency; }
bool CompiledScene::has_absorption() const { return data_->has_absorption; }

std::size_t CompiledScene::stored_leaves() const {
    std::size_t n = 0;
    for (const CompiledSolid& solid : data_->solids) n += solid.leaves.size();
    return n;
}

std::size_t CompiledScene::bytes() const {
    std::size_t n = data_->frames.size() * sizeof(Frame) + data_->looks.size() * sizeof(Look);
    for (const CompiledSolid& solid : data_->solids) {
        n += solid.leaves.size() * sizeof(Leaf) + solid.groups.size() * sizeof(Group) +
             solid.nodes.size() * sizeof(BvhNode);
    }
    return n;
}

const scene::Material& CompiledScene::material(csg::MaterialId id) const {
    return id < data_->materials.size() ? data_->materials[id] : data_->default_material;
}

}  // namespace raymo::trace
