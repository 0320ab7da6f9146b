// Meshes: points, and faces of any number of sides between them.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "raymo/core/result.hpp"
#include "raymo/math/affine.hpp"

namespace raymo::meshes {

using Index = std::uint32_t;
/// Points at both ends, the lower number first.
using Edge = std::array<Index, 2>;

[[nodiscard]] constexpr Edge edge_between(Index a, Index b) {
    return a < b ? Edge{a, b} : Edge{b, a};
}

/// A mesh may be open; what it bounds is asked for by those that need it closed (topology.hpp).
struct Mesh {
    std::vector<Vec3> points;    ///< [model units]; some may be in no face
    std::vector<Index> corners;  ///< of all faces, one after another, round each face
    std::vector<Index>
        first;  ///< corner of each face, and behind them the number of corners; never empty
    std::vector<Edge> creases;  ///< edges that stay sharp; ascending

    [[nodiscard]] std::size_t face_count() const { return first.size() - 1; }
    [[nodiscard]] std::span<const Index> face(std::size_t f) const {
        return std::span(corners).subspan(first[f], first[f + 1] - first[f]);
    }
    [[nodiscard]] bool is_crease(Index a, Index b) const;

    friend bool operator==(const Mesh&, const Mesh&) = default;
};
using MeshPtr = std::shared_ptr<const Mesh>;

/// Largest coordinate that a point may have: products of three are still numbers.
inline constexpr double kLargestPoint = 1e90;
/// Points and corners of a mesh, at most.
inline constexpr std::size_t kMostCorners = 10'000'000;

/// A mesh of these faces, each a list of numbers of points, the first point being 0. Error, with `argument` 0 for points and 1 for faces: a face of less than three corners, a number without a point, a
/// corner twice in a face, a point that is not finite or beyond kLargestPoint, or no face at all.
[[nodiscard]] Result<Mesh> make_mesh(std::vector<Vec3> points,
                                     const std::vector<std::vector<double>>& faces);

/// The mesh with these edges sharp as well. Error: no such edge.
[[nodiscard]] Result<Mesh> creased(Mesh mesh, std::span<const Edge> edges);
/// The mesh with all edges sharp where the normals of the faces beside it differ by more than `degrees`, and all edges
/// that have one face.
[[nodiscard]] Mesh creased_by_angle(Mesh mesh, double degrees);

/// The same with all faces listed the other way round.
[[nodiscard]] Mesh turned_round(Mesh mesh);
/// The image; a map that mirrors turns the faces round, so that they face outwards as before.
[[nodiscard]] Mesh mapped(const Mesh& mesh, const Affine& map);
[[nodiscard]] double extent_of(const Mesh& mesh);  ///< largest coordinate
[[nodiscard]] Aabb box_of(const Mesh& mesh);       ///< of the faces' corners
[[nodiscard]] double bytes_of(const Mesh& mesh);

/// "(1, 2, 3)", in messages.
[[nodiscard]] std::string shown_point(Vec3 p);

}  // namespace raymo::meshes
