// Faces that touch without crossing each other: there a ball would have to roll in a crevice that ends in nothing.
#pragma once

#include <cstddef>
#include <functional>
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
/// edge in `edges`, and all about that point have between them a crevice of the solid (`only`: concave), or a wall that ends in
/// nothing (convex). Faces that go on in each other smoothly do not count, nor do planes or what is flush, nor points that are
/// not `chosen`, nor those on the rim of a face. Error: cancelled, by `spend`.
/// Cost: some 2 us for two faces whose boxes meet, up to a millisecond where they touch; after 0.2 s no more is looked for.
[[nodiscard]] Result<std::optional<Touching>> find_touching(const Body& body, bool within_operands,
                                                            std::optional<Edges> only,
                                                            const std::vector<Segment>& edges,
                                                            const std::function<bool(Vec3)>& chosen,
                                                            const Spend& spend = {});

}  // namespace raymo::blends
