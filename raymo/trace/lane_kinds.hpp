// Which kernels are computed for several rays side by side.
#pragma once

#include "raymo/solids/inventory.hpp"
#include "raymo/solids/ray_block.hpp"

namespace raymo::trace {

/// Spans that the kernel gives at most, computed side by side; 0: one ray after the other.
template <class K>
inline constexpr int kSpansInLanes = solids::BlockKernel<K> ? solids::kSweptSpans : 0;
template <>
inline constexpr int kSpansInLanes<solids::Block::Kernel> = 1;
template <>
inline constexpr int kSpansInLanes<solids::Sphere::Kernel> = 1;
template <>
inline constexpr int kSpansInLanes<solids::Cylinder::Kernel> = 1;
template <>
inline constexpr int kSpansInLanes<solids::Cone::Kernel> = 1;
template <>
inline constexpr int kSpansInLanes<solids::Torus::Kernel> = 2;
template <>
inline constexpr int kSpansInLanes<solids::Halfspace::Kernel> = 1;

/// The most of any kernel.
inline constexpr int kMostSpansInLanes = solids::kSweptSpans;

}  // namespace raymo::trace
