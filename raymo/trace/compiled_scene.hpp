// A scene made ready for rays.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include "raymo/core/progress.hpp"
#include "raymo/core/result.hpp"
#include "raymo/math/aabb.hpp"
#include "raymo/scene/scene.hpp"

namespace raymo::trace {

/// A leaf as the user knows it.
struct LeafInfo {
    std::string_view primitive;  ///< "sphere"
    SourceSpan span;             ///< the expression that made it
};

/// Immutable, so any number of tracers in any number of threads may share one.
class CompiledScene {
public:
    struct Data;

    explicit CompiledScene(std::unique_ptr<const Data> data);
    ~CompiledScene();
    CompiledScene(CompiledScene&&) noexcept;
    CompiledScene& operator=(CompiledScene&&) noexcept;

    /// Box around all parts (around the leaves' active zones, so often tighter than csg::bounds).
    /// Empty for an empty model.
    [[nodiscard]] const Aabb& bounds() const;
    [[nodiscard]] std::size_t part_count() const;
    /// Leaves after instancing: those that are stored.
    [[nodiscard]] std::size_t stored_leaves() const;
    /// Leaves as the model counts them.
    [[nodiscard]] double leaf_count() const;
    [[nodiscard]] std::size_t bytes() const;
    /// True when some material lets light through, so that shadows need all surfaces on the way.
    [[nodiscard]] bool has_transparency() const;
    /// True when the inside of some such material takes away light.
    [[nodiscard]] bool has_absorption() const;
    /// Material by id; the default material for csg::kNoMaterial.
    [[nodiscard]] const scene::Material& material(csg::MaterialId id) const;
    [[nodiscard]] const Data& data() const { return *data_; }

private:
    std::unique_ptr<const Data> data_;
};

/// Flattens the graph to leaves, one table per primitive, and builds the tree of boxes.
/// Errors: unbounded, naming the operand, when a part reaches to infinity; cancelled; limit.
/// Cost: O(n log n) in stored leaves; a solid used many times is stored once when the model is
/// large.
[[nodiscard]] Result<CompiledScene> compile(const scene::Scene& scene,
                                            Progress* progress = nullptr);

}  // namespace raymo::trace
