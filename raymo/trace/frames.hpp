// Where leaves stand: from the frame of a compiled solid to the canonical ones of its leaves.
#pragma once

#include "raymo/trace/data.hpp"
#include "raymo/trace/placement.hpp"

namespace raymo::trace {

/// A displacement of so many times the size of the compiled solid says that a leaf may be anywhere in it.
inline constexpr double kLost = 16.0;
/// How far from the middle of the compiled solid, which has a radius below 1, a plane stands that passes it by. The kernel
/// of half-spaces watches for crossings twice as far.
inline constexpr double kOutside = 4.0;

/// The frame of a leaf whose canonical frame is placed by `map`, in the model's scale.
[[nodiscard]] Frame frame_of(const Affine& map, std::uint32_t type, std::uint32_t index);

// A half-space has neither a size nor a place along its plane: all there is of it is a normal and a distance. So that what
// is near and what is far on its plane is judged as the model sees it, it has the normalised frame of the compiled solid,
// turned, and a centre near that one's.

inline constexpr std::uint32_t kHalfspace = solids::Inventory::index_of<solids::Halfspace>();

struct HalfSpace {
    Frame frame;  ///< its third row is the normal
    Vec3 tilt;    ///< how far the plane may be off, per distance from its centre along the axes
};

/// What `place` makes of a half-space with this normal.
[[nodiscard]] HalfSpace half_space(const Placement& place, Vec3 normal, std::uint32_t index);

/// Moves the centre of a half-space along its plane to where it is nearest to the middle of the compiled solid, and brings a
/// plane that passes that by so near that it just does. All in the normalised frame.
void place_half_space(const Frame& frame, Vec3& centre, double& displacement);

}  // namespace raymo::trace
