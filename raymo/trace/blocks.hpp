// Leaves whose kernels answer packets in blocks (solids/ray_block.hpp), without their types.
#pragma once

#include <cstdint>

#include "raymo/solids/ray_block.hpp"
#include "raymo/trace/data.hpp"

namespace raymo::trace {

/// Whether the kernels of a type do.
[[nodiscard]] bool answers_blocks(std::uint32_t type);

/// What the kernel of a frame, which answers blocks, says. Rays that it leaves over are done one after the other, as far as a
/// block can hold their spans.
void block_spans(const KernelTables& kernels, const Frame& frame, const solids::RayBlock& rays,
                 std::uint32_t asked, solids::SpanBlock& out);
void spans_in_full(const KernelTables& kernels, const Frame& frame,
                   const solids::LocalRay<double>& ray, solids::SpanList& out);
void block_normals(const KernelTables& kernels, const Frame& frame, solids::PlaceBlock& places,
                   std::uint32_t asked);

}  // namespace raymo::trace
