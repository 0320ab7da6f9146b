// Where leaves stand: from the frame of a compiled solid to the canonical ones of its leaves.
#pragma once

#include "raymo/trace/data.hpp"

namespace raymo::trace {

/// The frame of a leaf whose canonical frame is placed by `map`, in the model's scale.
[[nodiscard]] Frame frame_of(const Affine& map, std::uint32_t type, std::uint32_t index);

// A half-space has neither a size nor a place along its plane: all there is of it is a normal and a distance. So that what
// is near and what is far on its plane is judged as the model sees it, it has the frame of the compiled solid, normalised
// and turned, and a centre near that one's.

inline constexpr std::uint32_t kHalfspace = solids::Inventory::index_of<solids::Halfspace>();

/// The same of a half-space, in any scale: `frame` without all but the direction of its normal.
[[nodiscard]] Frame half_space_frame(Frame frame);

/// Moves the centre of a half-space along its plane to where it is nearest to the middle of the model. A plane that passes
/// the model by is brought so near that it just does. All in the normalised frame, in which the model has a radius below 1.
void place_half_space(const Frame& frame, Vec3& centre, double& displacement);

}  // namespace raymo::trace
