#include "raymo/meshes/build.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "raymo/core/shown.hpp"

namespace raymo::meshes {
namespace {

Failure refuse(std::string message, std::string hint, std::string label = {}) {
    Failure failure = fail(ErrorCode::bad_argument, std::move(message), std::move(hint));
    failure.value().argument = 0;
    failure.value().label = std::move(label);
    return failure;
}

void add_face(Mesh& mesh, std::initializer_list<Index> corners) {
    mesh.corners.insert(mesh.corners.end(), corners.begin(), corners.end());
    mesh.first.push_back(static_cast<Index>(mesh.corners.size()));
}

}  // namespace

Mesh box_mesh(Vec3 size, std::array<Index, 3> cuts) {
    Mesh out;
    out.first.push_back(0);
    std::map<std::array<Index, 3>, Index> numbers;
    const auto point = [&](const std::array<Index, 3>& at) {
        const auto [found, is_new] = numbers.try_emplace(at, static_cast<Index>(out.points.size()));
        if (is_new) {
            Vec3 p;
            for (std::size_t a = 0; a < 3; ++a) {
                p[static_cast<int>(a)] = at[a] == cuts[a] ? size[static_cast<int>(a)]
                                                          : size[static_cast<int>(a)] * at[a] /
                                                                static_cast<double>(cuts[a]);
            }
            out.points.push_back(p);
        }
        return found->second;
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
        for (const bool far : {false, true}) {
            for (Index i = 0; i < cuts[b]; ++i) {
                for (Index j = 0; j < cuts[c]; ++j) {
                    const auto at = [&](Index db, Index dc) {
                        std::array<Index, 3> p{};
                        p[axis] = far ? cuts[axis] : 0;
                        p[b] = i + db;
                        p[c] = j + dc;
                        return point(p);
                    };
                    if (far) {
                        add_face(out, {at(0, 0), at(1, 0), at(1, 1), at(0, 1)});
                    } else {
                        add_face(out, {at(0, 0), at(0, 1), at(1, 1), at(1, 0)});
                    }
                }
            }
        }
    }
    return out;
}

Result<Mesh> extrude_mesh(std::vector<Vec2> points, double h, Index cuts) {
    const auto n = static_cast<Index>(points.size());
    if (n < 3) {
        return refuse("a polygon needs three points or more",
                      "write them as [(0, 0), (10, 0), (5, 8)]", "these are " + std::to_string(n));
    }
    double area = 0.0;
    Box2 box;
    for (Index k = 0; k < n; ++k) {
        const Vec2 a = points[k] - points[0], b = points[(k + 1) % n] - points[0];
        if (points[k] == points[(k + 1) % n]) {
            return refuse("two points in a row are the same",
                          "leave one out; a polygon closes by itself",
                          "[" + std::to_string(k) + "] is (" + shown(points[k].x) + ", " +
                              shown(points[k].y) + ")");
        }
        area += cross(a, b);
        box.include(points[k]);
    }
    const double size = max_norm(box.size());
    if (!(std::fabs(area) > 1e-12 * size * size)) {
        return refuse("the polygon has no area", "give points that are not on one line");
    }
    if (area < 0.0) std::reverse(points.begin(), points.end());
    Mesh out;
    out.first.push_back(0);
    for (Index ring = 0; ring <= cuts; ++ring) {
        const double z = ring == cuts ? h : h * ring / static_cast<double>(cuts);
        for (const Vec2 p : points) out.points.push_back({p.x, p.y, z});
    }
    for (Index k = n; k-- > 0;) out.corners.push_back(k);
    out.first.push_back(static_cast<Index>(out.corners.size()));
    for (Index k = 0; k < n; ++k) out.corners.push_back(cuts * n + k);
    out.first.push_back(static_cast<Index>(out.corners.size()));
    for (Index ring = 0; ring < cuts; ++ring) {
        for (Index k = 0; k < n; ++k) {
            const Index next = (k + 1) % n;
            add_face(out,
                     {ring * n + k, ring * n + next, (ring + 1) * n + next, (ring + 1) * n + k});
        }
    }
    return out;
}

Result<Mesh> grid_mesh(const std::vector<std::vector<Vec3>>& rows, Closing closing) {
    const auto count = static_cast<Index>(rows.size());
    const Index least_rows = closing == Closing::both ? 3 : 2;
    const Index least_points = closing == Closing::none ? 2 : 3;
    if (count < least_rows) {
        return refuse("a grid needs " + std::to_string(least_rows) + " rows or more",
                      "give a list of rows, each a list of points",
                      "these are " + std::to_string(count));
    }
    const auto n = static_cast<Index>(rows[0].size());
    for (Index i = 0; i < count; ++i) {
        if (rows[i].size() < least_points) {
            return refuse("a row needs " + std::to_string(least_points) + " points or more",
                          "a tip is a row in which one point stands as often as others have points",
                          "[" + std::to_string(i) + "] has " + std::to_string(rows[i].size()));
        }
        if (rows[i].size() != n) {
            return refuse("all rows must have as many points", "[0] has " + std::to_string(n),
                          "[" + std::to_string(i) + "] has " + std::to_string(rows[i].size()));
        }
    }
    Mesh out;
    out.first.push_back(0);
    const auto is_tip = [&](Index i) {
        return closing == Closing::rows && (i == 0 || i + 1 == count) &&
               std::all_of(rows[i].begin(), rows[i].end(), [&](Vec3 p) { return p == rows[i][0]; });
    };
    std::vector<Index> first(count);
    for (Index i = 0; i < count; ++i) {
        first[i] = static_cast<Index>(out.points.size());
        out.points.insert(out.points.end(), rows[i].begin(),
                          is_tip(i) ? rows[i].begin() + 1 : rows[i].end());
    }
    if (is_tip(0) && is_tip(count - 1) && count == 2) {
        return refuse("a grid of two tips has no faces", "put a row between them");
    }
    const Index rings = closing == Closing::both ? count : count - 1;
    const Index sides = closing == Closing::none ? n - 1 : n;
    for (Index i = 0; i < rings; ++i) {
        const Index j = (i + 1) % count;
        for (Index k = 0; k < sides; ++k) {
            const Index next = (k + 1) % n;
            if (is_tip(i)) {
                add_face(out, {first[i], first[j] + next, first[j] + k});
            } else if (is_tip(j)) {
                add_face(out, {first[i] + k, first[i] + next, first[j]});
            } else {
                add_face(out, {first[i] + k, first[i] + next, first[j] + next, first[j] + k});
            }
        }
    }
    if (closing != Closing::rows) return out;
    if (!is_tip(0)) {
        for (Index k = n; k-- > 0;) out.corners.push_back(first[0] + k);
        out.first.push_back(static_cast<Index>(out.corners.size()));
    }
    if (!is_tip(count - 1)) {
        for (Index k = 0; k < n; ++k) out.corners.push_back(first[count - 1] + k);
        out.first.push_back(static_cast<Index>(out.corners.size()));
    }
    return out;
}

}  // namespace raymo::meshes
