// Random meshes and nets, and where points are with respect to the closed surfaces of patches that come of them.
#pragma once

#include "raymo/meshes/mesh.hpp"
#include "raymo/meshes/sew.hpp"
#include "tests/laws/law.hpp"
#include "tests/laws/model.hpp"

namespace raymo::laws {

/// Closed meshes within about 5 of the origin: boxes, prisms and rings with their points moved, some with creases.
[[nodiscard]] meshes::Mesh random_mesh(Random& random);
/// Closed Bezier nets: profiles turned in four patches, with poles, and cushions with sharp edges.
[[nodiscard]] std::vector<meshes::GivenNet> random_nets(Random& random);

/// Where p is, when it is further than `margin` from the surface: how often the surface winds around it, by Newton's steps in
/// extended precision along lines that must agree (solids/freeform/test_field.hpp).
[[nodiscard]] Side classify(const meshes::Shell& shell, const RealPoint& p, Real margin);

}  // namespace raymo::laws
