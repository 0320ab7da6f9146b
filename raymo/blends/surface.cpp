#include "raymo/blends/surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace raymo::blends {
namespace {

struct Polar {
    double along;    ///< the axis, from the surface's point
    double across;   ///< distance from the axis
    Vec3 direction;  ///< unit, away from the axis
};

Polar polar(const Surface& s, Vec3 p) {
    const Vec3 d = p - s.point;
    const double along = dot(d, s.axis);
    const Vec3 away = d - along * s.axis;
    const double across = norm(away);
    if (across > 0.0) return {along, across, away / across};
    Vec3 u;
    Vec3 v;
    make_frame(s.axis, u, v);
    return {along, 0.0, u};
}

/// The ruling of a leaning wall that is nearest to a point.
struct Ruling {
    Vec3 at;      ///< where it meets the plane of the run
    Vec3 normal;  ///< unit
};
Ruling ruling(const Surface& s, Vec3 p) {
    const Vec3 d = p - s.point;
    const auto seen = s.run->seen({dot(d, s.across), dot(d, s.up), dot(d, s.axis)}, s.height);
    // Across the ruling (P, h), too.
    const Vec3 normal = s.across * seen.normal.x + s.up * seen.normal.y -
                        s.axis * (dot(seen.normal, seen.point) / s.height);
    return {s.place(seen.point), unit(normal)};
}

}  // namespace

std::string_view kind_name(SurfaceKind kind) {
    switch (kind) {
        case SurfaceKind::plane:
            return "plane";
        case SurfaceKind::sphere:
            return "sphere";
        case SurfaceKind::cylinder:
            return "cylinder";
        case SurfaceKind::cone:
            return "cone";
        case SurfaceKind::torus:
            return "torus";
        case SurfaceKind::wall:
            return "wall";
        case SurfaceKind::turned:
            return "surface of revolution";
        case SurfaceKind::leaning:
            return "leaning wall";
    }
    return "";
}

double Surface::distance(Vec3 p) const {
    switch (kind) {
        case SurfaceKind::plane:
            return dot(p - point, axis);
        case SurfaceKind::sphere:
            return norm(p - point) - radius;
        case SurfaceKind::cylinder:
            return polar(*this, p).across - radius;
        case SurfaceKind::cone: {
            const Polar q = polar(*this, p);
            return q.across * cosine - q.along * sine;
        }
        case SurfaceKind::torus: {
            const Polar q = polar(*this, p);
            return std::hypot(q.across - radius, q.along) - tube;
        }
        case SurfaceKind::wall:
            return run->nearest({dot(p - point, across), dot(p - point, up)}).distance;
        case SurfaceKind::turned: {
            const Polar q = polar(*this, p);
            return run->nearest({q.across, q.along}).distance;
        }
        case SurfaceKind::leaning: {
            const Ruling r = ruling(*this, p);
            return dot(p - r.at, r.normal);
        }
    }
    return 0.0;
}

double Surface::least_round(Vec3 p) const {
    switch (kind) {
        case SurfaceKind::plane:
            return std::numeric_limits<double>::infinity();
        case SurfaceKind::sphere:
            return norm(p - point);
        case SurfaceKind::cylinder:
        case SurfaceKind::cone:
            return polar(*this, p).across;
        case SurfaceKind::torus: {
            const Polar q = polar(*this, p);
            return std::min(q.across, std::hypot(q.across - radius, q.along));
        }
        case SurfaceKind::wall:
        case SurfaceKind::turned:
        case SurfaceKind::leaning:
            return 0.0;
    }
    return 0.0;
}

Vec3 Surface::normal(Vec3 p) const {
    switch (kind) {
        case SurfaceKind::plane:
            return axis;
        case SurfaceKind::sphere: {
            const Vec3 d = p - point;
            const double r = norm(d);
            return r > 0.0 ? d / r : Vec3{1, 0, 0};
        }
        case SurfaceKind::cylinder:
            return polar(*this, p).direction;
        case SurfaceKind::cone:
            return polar(*this, p).direction * cosine - axis * sine;
        case SurfaceKind::torus: {
            const Polar q = polar(*this, p);
            const double x = q.across - radius;
            const double r = std::hypot(x, q.along);
            return r > 0.0 ? q.direction * (x / r) + axis * (q.along / r) : q.direction;
        }
        case SurfaceKind::wall: {
            const Vec2 n = run->nearest({dot(p - point, across), dot(p - point, up)}).normal;
            return across * n.x + up * n.y;
        }
        case SurfaceKind::turned: {
            const Polar q = polar(*this, p);
            const Vec2 n = run->nearest({q.across, q.along}).normal;
            return q.direction * n.x + axis * n.y;
        }
        case SurfaceKind::leaning:
            return ruling(*this, p).normal;
    }
    return axis;
}

}  // namespace raymo::blends
