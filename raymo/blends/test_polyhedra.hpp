// Convex polyhedra for the tests of this layer: by their planes, and by their corners.
#pragma once

#include <algorithm>
#include <limits>

#include "raymo/blends/test_blends.hpp"

namespace raymo::blends::test {

struct Plane {
    Vec3 normal;
    double offset;
};

/// Distance of a point from the centres of balls of radius r within the planes: from its own place, or from its foot on the planes
/// of one, two or three of the faces.
inline double from_centres(const std::vector<Plane>& planes, double r, Vec3 p) {
    double least = std::numeric_limits<double>::infinity();
    const auto consider = [&](Vec3 c) {
        for (const Plane& plane : planes) {
            if (dot(plane.normal, c) > plane.offset - r + 1e-9) return;
        }
        least = std::min(least, norm(c - p));
    };
    const auto off = [&](const Plane& plane, Vec3 at) {
        return plane.offset - r - dot(plane.normal, at);
    };
    consider(p);
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const Plane& a = planes[i];
        consider(p + a.normal * off(a, p));
        for (std::size_t k = 0; k < i; ++k) {
            const Plane& b = planes[k];
            const Vec3 along = cross(a.normal, b.normal);
            const Mat3 two{{a.normal, b.normal, along}};
            if (!is_invertible(two)) continue;
            consider(p + inverse(two) * Vec3{off(a, p), off(b, p), 0.0});
            for (std::size_t m = 0; m < k; ++m) {
                const Plane& c = planes[m];
                const Mat3 three{{a.normal, b.normal, c.normal}};
                if (!is_invertible(three)) continue;
                consider(p + inverse(three) * Vec3{off(a, p), off(b, p), off(c, p)});
            }
        }
    }
    return least;
}

/// The half-spaces of the planes, in a cube of twice `size`.
inline csg::Solid within(const std::vector<Plane>& planes, double size) {
    std::vector<csg::Solid> sides{centred_block(2 * size, 2 * size, 2 * size)};
    for (const Plane& plane : planes) sides.push_back(halfspace(plane.normal, plane.offset));
    return csg::boolean(csg::Op::intersection, sides);
}

/// A polygon, counter-clockwise, that shrinks to `ratio` times its size at the height `high`.
inline csg::Solid leaning(const std::vector<Vec2>& points, double high, double ratio) {
    std::vector<curves::Span2> spans;
    for (std::size_t i = 0; i < points.size(); ++i)
        spans.push_back(curves::segment(points[i], points[(i + 1) % points.size()]));
    curves::Outline outline;
    outline.curves.push_back({std::move(spans), true});
    return made("conic",
                {std::make_shared<const curves::Outline>(std::move(outline)), high, ratio, false});
}
/// Its planes.
inline std::vector<Plane> planes_of(const std::vector<Vec2>& points, double high, double ratio) {
    std::vector<Plane> planes{{Vec3{0, 0, -1}, 0.0}};
    if (ratio > 0.0) planes.push_back({Vec3{0, 0, 1}, high});
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec2 a = points[i];
        const Vec2 b = points[(i + 1) % points.size()];
        const Vec3 base{a.x, a.y, 0};
        const Vec3 n =
            unit(cross(Vec3{b.x, b.y, 0} - base, Vec3{ratio * a.x, ratio * a.y, high} - base));
        planes.push_back({n, dot(n, base)});
    }
    return planes;
}

/// Over a polygon at z = 0, counter-clockwise, with its tip on the z axis.
inline csg::Solid pyramid(const std::vector<Vec2>& base, double high) {
    return leaning(base, high, 0.0);
}

/// The first corner on the x axis.
inline std::vector<Vec2> regular(int count, double radius) {
    std::vector<Vec2> out;
    for (int i = 0; i < count; ++i) {
        const double turn = 2.0 * kPi * i / count;
        out.push_back({radius * std::cos(turn), radius * std::sin(turn)});
    }
    return out;
}

/// By its corners, and its faces as rings of these, counter-clockwise from outside.
struct Polyhedron {
    struct Edge {
        std::size_t from, to;
        Vec3 left, right;  ///< normals of the faces that have it
    };
    std::vector<Vec3> points;
    std::vector<std::vector<std::size_t>> faces;

    /// Twice the area, along the normal.
    [[nodiscard]] Vec3 area(const std::vector<std::size_t>& face) const {
        Vec3 sum;
        for (std::size_t i = 1; i + 1 < face.size(); ++i) {
            sum = sum +
                  cross(points[face[i]] - points[face[0]], points[face[i + 1]] - points[face[0]]);
        }
        return sum;
    }
    [[nodiscard]] std::vector<Edge> edges() const {
        struct Half {
            std::size_t from, to;
            Vec3 normal;
        };
        std::vector<Half> halves;
        for (const auto& face : faces) {
            for (std::size_t i = 0; i < face.size(); ++i)
                halves.push_back({face[i], face[(i + 1) % face.size()], unit(area(face))});
        }
        std::vector<Edge> out;
        for (const Half& a : halves) {
            for (const Half& b : halves) {
                if (a.from < a.to && a.from == b.to && a.to == b.from)
                    out.push_back({a.from, a.to, a.normal, b.normal});
            }
        }
        return out;
    }
    [[nodiscard]] double volume() const {
        double sum = 0.0;
        for (const auto& face : faces) sum += dot(points[face[0]], area(face)) / 6.0;
        return sum;
    }
    /// Of all that is no farther than r from it [Steiner40].
    [[nodiscard]] double volume_around(double r) const {
        double sum = volume() + 4.0 / 3.0 * kPi * r * r * r;
        for (const auto& face : faces) sum += 0.5 * norm(area(face)) * r;
        for (const Edge& edge : edges()) {
            const double turn =
                std::atan2(norm(cross(edge.left, edge.right)), dot(edge.left, edge.right));
            sum += 0.5 * norm(points[edge.to] - points[edge.from]) * turn * r * r;
        }
        return sum;
    }
};

}  // namespace raymo::blends::test
