// Materials made ready for shading, when they are first seen.
#pragma once

#include <memory>
#include <vector>

#include "raymo/render/light_model.hpp"
#include "raymo/trace/tracer.hpp"

namespace raymo::render {

class SurfaceTable {
public:
    explicit SurfaceTable(const trace::CompiledScene& scene) : scene_(&scene), known_(2) {
        known_[slot_of(trace::Hit::kAir)] = std::make_unique<const Surface>();
    }
    /// Of a material, of the default material (csg::kNoMaterial), or of air (trace::Hit::kAir). Stays where it is.
    [[nodiscard]] const Surface& operator[](csg::MaterialId id) {
        const std::size_t slot = slot_of(id);
        if (slot < known_.size() && known_[slot]) return *known_[slot];
        return make(id);
    }

private:
    static_assert(csg::kNoMaterial == 0xffffffffU && trace::Hit::kAir == 0xfffffffeU);
    [[nodiscard]] static std::size_t slot_of(csg::MaterialId id) { return id + 2U; }
    const Surface& make(csg::MaterialId id) {
        const std::size_t slot = slot_of(id);
        if (slot >= known_.size()) known_.resize(2 * slot);
        known_[slot] = std::make_unique<const Surface>(scene_->material(id));
        return *known_[slot];
    }

    const trace::CompiledScene* scene_;
    std::vector<std::unique_ptr<const Surface>> known_;
};

}  // namespace raymo::render
