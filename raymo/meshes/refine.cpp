// With V a point of the mesh, E its neighbours and n their number, the points of the refined mesh are
//     of a face     the mean of its corners,
//     of an edge    the mean of its ends and the points of its two faces, or the mean of its ends where it is sharp,
//     of a point    (F + 2 M + (n - 3) V) / n,  F the mean of the points of its faces, M that of the middles of its edges;
//                   (E1 + 6 V + E2) / 8 where the two edges to E1 and E2 are sharp; V where more are.
#include "raymo/meshes/refine.hpp"

#include <algorithm>

namespace raymo::meshes {

std::vector<Index> sharp_valences(const Mesh& mesh) {
    std::vector<Index> out(mesh.points.size(), 0);
    for (const Edge& e : mesh.creases) {
        ++out[e[0]];
        ++out[e[1]];
    }
    return out;
}

Mesh refined(const Mesh& mesh, const Topology& topology) {
    const auto sides = static_cast<Index>(mesh.corners.size());
    const auto points = static_cast<Index>(mesh.points.size());
    const auto faces = static_cast<Index>(mesh.face_count());
    const auto from = [&](Index s) { return mesh.corners[s]; };
    const auto to = [&](Index s) { return mesh.corners[topology.next[s]]; };

    // Points: those of the points, of the faces, of the edges.
    Mesh out;
    out.points.resize(points + faces + sides / 2);
    for (Index f = 0; f < faces; ++f) {
        Vec3 sum;
        for (const Index p : mesh.face(f)) sum += mesh.points[p];
        out.points[points + f] = sum / static_cast<double>(mesh.face(f).size());
    }
    std::vector<Index> edge_point(sides);
    Index used = points + faces;
    for (Index s = 0; s < sides; ++s) {
        const Index t = topology.twin[s];
        if (t < s) continue;
        edge_point[s] = edge_point[t] = used;
        const Vec3 ends = mesh.points[from(s)] + mesh.points[to(s)];
        out.points[used++] = mesh.is_crease(from(s), to(s))
                                 ? ends * 0.5
                                 : (ends + (out.points[points + topology.face[s]] +
                                            out.points[points + topology.face[t]])) *
                                       0.25;
    }
    const std::vector<Index> sharp = sharp_valences(mesh);
    for (Index p = 0; p < points; ++p) {
        const Vec3 v = mesh.points[p];
        out.points[p] = v;
        const Index first = topology.leaving[p];
        if (first == 0xffffffffU || sharp[p] > 2) continue;
        Vec3 face_sum, edge_sum, sharp_sum;
        double n = 0.0;
        Index s = first;
        do {
            face_sum += out.points[points + topology.face[s]];
            edge_sum += (v + mesh.points[to(s)]) * 0.5;
            if (mesh.is_crease(p, to(s))) sharp_sum += mesh.points[to(s)];
            n += 1.0;
            s = topology.around(s);
        } while (s != first);
        out.points[p] = sharp[p] == 2 ? (sharp_sum + v * 6.0) * 0.125
                                      : (face_sum / n + edge_sum * (2.0 / n) + v * (n - 3.0)) / n;
    }
    out.first.reserve(sides + 1);
    out.first.push_back(0);
    out.corners.reserve(4 * static_cast<std::size_t>(sides));
    for (Index s = 0; s < sides; ++s) {
        for (const Index p :
             {from(s), edge_point[s], points + topology.face[s], edge_point[topology.before[s]]})
            out.corners.push_back(p);
        out.first.push_back(static_cast<Index>(out.corners.size()));
        if (mesh.is_crease(from(s), to(s)))
            out.creases.push_back(edge_between(from(s), edge_point[s]));
    }
    std::sort(out.creases.begin(), out.creases.end());
    return out;
}

}  // namespace raymo::meshes
