#include "raymo/meshes/topology.hpp"

#include <algorithm>

namespace raymo::meshes {
namespace {

constexpr Index kNone = 0xffffffffU;

Failure refuse(std::string message, std::string hint) {
    Failure failure = fail(ErrorCode::bad_argument, std::move(message), std::move(hint));
    failure.value().argument = 0;
    return failure;
}

std::string shown_edge(const Mesh& mesh, Edge e) {
    return "from " + shown_point(mesh.points[e[0]]) + " to " + shown_point(mesh.points[e[1]]);
}

}  // namespace

Result<Topology> close(const Mesh& mesh) {
    const auto count = static_cast<Index>(mesh.corners.size());
    Topology out;
    out.twin.assign(count, kNone);
    out.next.resize(count);
    out.before.resize(count);
    out.face.resize(count);
    out.leaving.assign(mesh.points.size(), kNone);
    for (Index f = 0; f < mesh.face_count(); ++f) {
        for (Index s = mesh.first[f]; s < mesh.first[f + 1]; ++s) {
            out.next[s] = s + 1 < mesh.first[f + 1] ? s + 1 : mesh.first[f];
            out.before[out.next[s]] = s;
            out.face[s] = f;
            out.leaving[mesh.corners[s]] = s;
        }
    }
    const auto edge = [&](Index s) {
        return edge_between(mesh.corners[s], mesh.corners[out.next[s]]);
    };
    std::vector<Index> sides(count);
    for (Index s = 0; s < count; ++s) sides[s] = s;
    std::sort(sides.begin(), sides.end(), [&](Index a, Index b) {
        const Edge x = edge(a), y = edge(b);
        return x != y ? x < y : a < b;
    });
    for (Index i = 0; i < count;) {
        const Edge e = edge(sides[i]);
        Index end = i + 1;
        while (end < count && edge(sides[end]) == e) ++end;
        if (end - i == 1) {
            return refuse(
                "the mesh is open: the edge " + shown_edge(mesh, e) + " has one face only",
                "add the faces that are missing");
        }
        if (end - i > 2) {
            return refuse(
                "the edge " + shown_edge(mesh, e) + " has " + std::to_string(end - i) + " faces",
                "two faces may meet at an edge; make a solid of each part, and unite them");
        }
        const Index a = sides[i], b = sides[i + 1];
        if (mesh.corners[a] == mesh.corners[b]) {
            return refuse("the faces beside the edge " + shown_edge(mesh, e) +
                              " are listed in different directions",
                          "list the corners of every face counter-clockwise, as seen from outside");
        }
        out.twin[a] = b;
        out.twin[b] = a;
        i = end;
    }
    std::vector<Index> valence(mesh.points.size(), 0);
    for (const Index p : mesh.corners) ++valence[p];
    for (std::size_t p = 0; p < mesh.points.size(); ++p) {
        if (valence[p] == 0) continue;
        Index around = 0;
        Index s = out.leaving[p];
        do {
            s = out.around(s);
            ++around;
        } while (s != out.leaving[p]);
        if (around == valence[p]) continue;
        return refuse(
            "two parts of the mesh meet in the point " + shown_point(mesh.points[p]) + " only",
            "give each part a point of its own there");
    }
    return out;
}

double volume6(const Mesh& mesh) {
    double sum = 0.0;
    const Vec3 o = mesh.points.empty() ? Vec3{} : mesh.points[0];
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const auto face = mesh.face(f);
        const Vec3 a = mesh.points[face[0]] - o;
        for (std::size_t k = 1; k + 1 < face.size(); ++k)
            sum += dot(a, cross(mesh.points[face[k]] - o, mesh.points[face[k + 1]] - o));
    }
    return sum;
}

}  // namespace raymo::meshes
