// From the shared graph of a solid to a flat list of leaves with their groups and active zones.
#pragma once

#include <span>
#include <unordered_map>

#include "raymo/core/progress.hpp"
#include "raymo/core/result.hpp"
#include "raymo/trace/data.hpp"
#include "raymo/trace/tables.hpp"

namespace raymo::trace {

struct Placement;

/// Builds compiled solids into a scene's data; a solid that is used many times becomes one compiled
/// solid with instances.
class Flattener {
public:
    /// `share`: make instances of shared solids. Without it everything is flattened.
    Flattener(CompiledScene::Data& data, bool share, Progress* progress)
        : data_(data), tables_(data), share_(share), progress_(progress) {}

    /// Compiles `parts` side by side; the result is data.solids[returned index]. kNone: all parts
    /// are empty. `depth` counts instances within instances.
    [[nodiscard]] Result<std::uint32_t> compile(std::span<const csg::Solid> parts, int depth);

private:
    struct Item;
    struct Pending;
    struct Work;
    struct Visit;

    [[nodiscard]] Result<void> expand(Work& work, std::span<const csg::Solid> parts, int depth);
    [[nodiscard]] Result<bool> add_instance(Work& work, const Visit& at, int depth);
    [[nodiscard]] Result<void> add_leaf(Work& work, const csg::LeafNode& node, const Visit& at);
    void enlist(Work& work, const Visit& at, Item item, Pending pending, const Placement& place,
                SourceSpan span);
    void combine_boxes(Work& work) const;
    [[nodiscard]] Result<void> check_bounded(const Work& work) const;
    void make_groups(Work& work, CompiledSolid& out);
    void normalise(Work& work, CompiledSolid& out);

    CompiledScene::Data& data_;
    Tables tables_;
    bool share_;
    Progress* progress_;
    std::unordered_map<const csg::Node*, std::uint32_t> compiled_;
    /// The frame that was made last, and what of: frames cost more than all else of a leaf.
    struct {
        std::uint32_t type = kNone;
        std::uint32_t kernel = kNone;
        Mat3 linear;
        Vec3 row_length;
        std::uint32_t frame = kNone;
    } last_;
};

}  // namespace raymo::trace
