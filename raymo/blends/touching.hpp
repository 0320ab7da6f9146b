// Faces that touch without crossing each other: there a ball would have to roll in a crevice that ends in nothing.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "raymo/blends/blend.hpp"

namespace raymo::blends {

class Body;
struct Segment;

struct Touching {
    std::size_t face_a = 0, face_b = 0;
    Vec3 point;  ///< one of those that they share
};

/// Two faces of different operands (of different leaves, if `within_operands`) that share a point and a tangent plane there, have no
/// edge in `edges`, and leave beside that point a crevice between two parts of the solid (`only`: concave), or nothing of a wall
/// (convex). Faces that go on in each other smoothly do not count, nor do planes or what is flush, nor points that are not
/// `chosen`. Error: cancelled, by `spend`.
/// Cost: some 2 us for two faces whose boxes meet, a millisecond where they touch.
[[nodiscard]] Result<std::optional<Touching>> find_touching(const Body& body, bool within_operands,
                                                            std::optional<Edges> only,
                                                            const std::vector<Segment>& edges,
                                                            const std::function<bool(Vec3)>& chosen,
                                                            const Spend& spend = {});

}  // namespace raymo::blends
