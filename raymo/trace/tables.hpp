// Tables in which what is equal is stored once: kernels and looks for the whole scene, frames for
// one compiled solid.
#pragma once

#include <vector>

#include "raymo/core/row_index.hpp"
#include "raymo/trace/data.hpp"

namespace raymo::trace {

class Tables {
public:
    explicit Tables(CompiledScene::Data& data) : data_(data) {}

    /// Index of the kernel among those of its type.
    [[nodiscard]] std::uint32_t kernel(const solids::AnyKernel& kernel);
    /// Index into frames() of an equal frame, made where there is none.
    [[nodiscard]] std::uint32_t frame(const Frame& frame);
    [[nodiscard]] std::uint32_t look(const Look& look);
    /// The frames of the compiled solid that is being made.
    [[nodiscard]] std::vector<Frame>& frames() { return frames_; }

private:
    CompiledScene::Data& data_;
    std::vector<Frame> frames_;
    RowIndex frame_index_;
    RowIndex look_index_;
};

}  // namespace raymo::trace
