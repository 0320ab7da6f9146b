// Which kernels are computed for several rays side by side.
#pragma once

#include "raymo/solids/inventory.hpp"

namespace raymo::trace {

/// Spans that the kernel gives at most, computed side by side; 0: one ray after the other.
template <class K>
inline constexpr int kSpansInLanes = 0;
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

}  // namespace raymo::trace
