#include "raymo/meshes/mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "raymo/core/shown.hpp"

namespace raymo::meshes {
namespace {

Failure refuse(int argument, ErrorCode code, std::string message, std::string hint,
               std::string label) {
    Failure failure = fail(code, std::move(message), std::move(hint));
    failure.value().label = std::move(label);
    failure.value().argument = argument;
    return failure;
}

bool is_usable(Vec3 p) { return is_finite(p) && max_norm(p) <= kLargestPoint; }

std::string shown_face(std::size_t f) { return "face " + std::to_string(f); }

}  // namespace

std::string shown_point(Vec3 p) {
    return "(" + shown(p.x) + ", " + shown(p.y) + ", " + shown(p.z) + ")";
}

bool Mesh::is_crease(Index a, Index b) const {
    return std::binary_search(creases.begin(), creases.end(), edge_between(a, b));
}

Result<Mesh> make_mesh(std::vector<Vec3> points, const std::vector<std::vector<double>>& faces) {
    std::size_t count = 0;
    for (const auto& face : faces) count += face.size();
    if (std::max(count, points.size()) > kMostCorners) {
        return refuse(count > points.size() ? 1 : 0, ErrorCode::limit, "the mesh is too large",
                      "use a coarser mesh",
                      "these are " + std::to_string(std::max(count, points.size())) + ", and " +
                          std::to_string(kMostCorners) + " are the most");
    }
    for (std::size_t k = 0; k < points.size(); ++k) {
        if (is_usable(points[k])) continue;
        return refuse(0, ErrorCode::out_of_range, "a point is too far away to be computed with",
                      "stay within 1e90 of the origin",
                      "[" + std::to_string(k) + "] is " + shown_point(points[k]));
    }
    if (faces.empty()) {
        return refuse(1, ErrorCode::bad_argument, "a mesh needs a face",
                      "list the numbers of its points for each face: [[0, 1, 2], ...]",
                      "this list is empty");
    }
    Mesh out;
    out.first.push_back(0);
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const auto& face = faces[f];
        if (face.size() < 3) {
            return refuse(1, ErrorCode::bad_argument, "a face needs three corners or more",
                          "list the numbers of its points in order",
                          shown_face(f) + " has " + std::to_string(face.size()));
        }
        for (const double n : face) {
            if (!(n >= 0.0 && n < static_cast<double>(points.size()) && n == std::floor(n))) {
                return refuse(1, ErrorCode::bad_argument, "a face names a point that there is not",
                              points.empty() ? "there are no points"
                                             : "the points have the numbers 0 to " +
                                                   std::to_string(points.size() - 1),
                              shown_face(f) + " has " + shown(n));
            }
            out.corners.push_back(static_cast<Index>(n));
        }
        std::vector<double> sorted = face;
        std::sort(sorted.begin(), sorted.end());
        const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
        if (twice != sorted.end()) {
            return refuse(1, ErrorCode::bad_argument, "a face has a point twice",
                          "make two faces of it",
                          shown_face(f) + " has " + shown(*twice) + " twice");
        }
        out.first.push_back(static_cast<Index>(out.corners.size()));
    }
    out.points = std::move(points);
    return out;
}

namespace {

/// All edges, ascending, once.
std::vector<Edge> edges_of(const Mesh& mesh) {
    std::vector<Edge> out;
    out.reserve(mesh.corners.size());
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const auto face = mesh.face(f);
        for (std::size_t k = 0; k < face.size(); ++k)
            out.push_back(edge_between(face[k], face[(k + 1) % face.size()]));
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

void add_creases(Mesh& mesh, std::vector<Edge> edges) {
    edges.insert(edges.end(), mesh.creases.begin(), mesh.creases.end());
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    mesh.creases = std::move(edges);
}

/// Of any length.
Vec3 normal_of(const Mesh& mesh, std::size_t f) {
    const auto face = mesh.face(f);
    Vec3 sum;
    const Vec3 o = mesh.points[face[0]];
    for (std::size_t k = 1; k + 1 < face.size(); ++k)
        sum += cross(mesh.points[face[k]] - o, mesh.points[face[k + 1]] - o);
    return sum;
}

}  // namespace

Result<Mesh> creased(Mesh mesh, std::span<const Edge> edges) {
    const std::vector<Edge> known = edges_of(mesh);
    for (const Edge& e : edges) {
        if (e[0] < mesh.points.size() && e[1] < mesh.points.size() &&
            std::binary_search(known.begin(), known.end(), edge_between(e[0], e[1])))
            continue;
        const auto end = [&](Index i) {
            return i < mesh.points.size() ? shown_point(mesh.points[i]) : std::to_string(i);
        };
        return refuse(1, ErrorCode::bad_argument, "the mesh has no such edge",
                      "an edge is a pair of points that are next to each other in a face",
                      "there is none from " + end(e[0]) + " to " + end(e[1]));
    }
    std::vector<Edge> sorted;
    for (const Edge& e : edges) sorted.push_back(edge_between(e[0], e[1]));
    add_creases(mesh, std::move(sorted));
    return mesh;
}

Mesh creased_by_angle(Mesh mesh, double degrees) {
    struct Side {
        Edge edge;
        std::size_t face;
    };
    std::vector<Side> sides;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const auto face = mesh.face(f);
        for (std::size_t k = 0; k < face.size(); ++k)
            sides.push_back({edge_between(face[k], face[(k + 1) % face.size()]), f});
    }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return a.edge != b.edge ? a.edge < b.edge : a.face < b.face;
    });
    const double limit = degrees * std::numbers::pi / 180.0;
    std::vector<Edge> sharp;
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t end = i + 1;
        while (end < sides.size() && sides[end].edge == sides[i].edge) ++end;
        bool is_sharp = end - i != 2;
        if (!is_sharp) {
            const Vec3 a = normal_of(mesh, sides[i].face);
            const Vec3 b = normal_of(mesh, sides[i + 1].face);
            is_sharp = std::atan2(norm(cross(a, b)), dot(a, b)) > limit;
        }
        if (is_sharp) sharp.push_back(sides[i].edge);
        i = end;
    }
    add_creases(mesh, std::move(sharp));
    return mesh;
}

Mesh turned_round(Mesh mesh) {
    for (std::size_t f = 0; f < mesh.face_count(); ++f)
        std::reverse(mesh.corners.begin() + mesh.first[f],
                     mesh.corners.begin() + mesh.first[f + 1]);
    return mesh;
}

Mesh mapped(const Mesh& mesh, const Affine& map) {
    Mesh out = mesh;
    for (Vec3& p : out.points) p = map(p);
    return determinant(map.linear) < 0.0 ? turned_round(std::move(out)) : out;
}

Aabb box_of(const Mesh& mesh) {
    Aabb box;
    for (const Index p : mesh.corners) box.include(mesh.points[p]);
    return box;
}

double extent_of(const Mesh& mesh) {
    double most = 0.0;
    for (const Vec3 p : mesh.points) {
        const double size = max_norm(p);
        if (!(size <= most)) most = size;
        if (std::isnan(most)) return Aabb::kInf;
    }
    return most;
}

double bytes_of(const Mesh& mesh) {
    return static_cast<double>(sizeof(Mesh) + mesh.points.capacity() * sizeof(Vec3) +
                               (mesh.corners.capacity() + mesh.first.capacity()) * sizeof(Index) +
                               mesh.creases.capacity() * sizeof(Edge));
}

}  // namespace raymo::meshes
