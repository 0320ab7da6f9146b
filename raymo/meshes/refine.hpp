// One step of refinement [CatmullClark78], with creases [DeRose98].
#pragma once

#include "raymo/meshes/topology.hpp"

namespace raymo::meshes {

/// How many sharp edges leave a point.
[[nodiscard]] std::vector<Index> sharp_valences(const Mesh& mesh);

/// Each face of n sides becomes n faces of four sides. `topology` is that of the mesh. Cost: linear.
[[nodiscard]] Mesh refined(const Mesh& mesh, const Topology& topology);

}  // namespace raymo::meshes
