// Which faces of a mesh are beside each other.
#pragma once

#include <vector>

#include "raymo/meshes/mesh.hpp"

namespace raymo::meshes {

/// A closed surface: side s of a face runs from corner s of Mesh::corners to the next of its face.
struct Topology {
    std::vector<Index> twin;     ///< the same edge, seen from the other face
    std::vector<Index> next;     ///< side round the face
    std::vector<Index> before;   ///< side round the face, the other way
    std::vector<Index> face;     ///< of a side
    std::vector<Index> leaving;  ///< a side that leaves the point; 0xffffffff for points in no face

    /// The next side round the point that side s leaves, counter-clockwise as seen from outside.
    [[nodiscard]] Index around(Index s) const { return twin[before[s]]; }
};

/// Error (of smooth's mesh, so with `argument` 0): the mesh is open, more than two faces share an edge, two faces beside each
/// other are listed in different directions, or the faces at a point are not one ring; with the points in question.
[[nodiscard]] Result<Topology> close(const Mesh& mesh);

/// Six times the volume between the faces; those of more than three corners count as fans.
[[nodiscard]] double volume6(const Mesh& mesh);

}  // namespace raymo::meshes
