#include "raymo/blends/edge.hpp"

#include <cmath>
#include <numbers>

#include "raymo/curves/roots.hpp"

namespace raymo::blends {
namespace {

using curves::Bernstein;

/// Directions and axes count as shared where they differ by no more than roundings do that came with transformations: 2^-40 of
/// the length concerned, by which the surfaces then differ.
constexpr double kShared = 0x1p-40;

bool is_parallel(Vec3 a, Vec3 b) { return norm(cross(a, b)) <= kShared; }

double size_of(const Surface& s) { return std::fabs(s.radius) + s.tube + max_norm(s.point); }

/// Whether a point lies on a line, to within kShared of what is concerned.
bool is_on(Vec3 p, Vec3 origin, Vec3 direction, double size) {
    const Vec3 d = p - origin;
    return norm(cross(d, direction)) <= kShared * (size + norm(d));
}

bool has_axis(const Surface& s) {
    return s.kind == SurfaceKind::cylinder || s.kind == SurfaceKind::cone ||
           s.kind == SurfaceKind::torus || s.kind == SurfaceKind::turned;
}
/// Whether it may be moved along a direction without changing, and which.
bool has_direction(const Surface& s) {
    return s.kind == SurfaceKind::cylinder || s.kind == SurfaceKind::wall;
}

/// The axis about which both are surfaces of revolution.
struct Axis {
    Vec3 origin, direction;
};
std::optional<Axis> common_axis(const Surface& a, const Surface& b) {
    const auto is_wall = [](const Surface& s) {
        return s.kind == SurfaceKind::wall || s.kind == SurfaceKind::leaning;
    };
    if (is_wall(a) || is_wall(b)) return std::nullopt;
    const double size = size_of(a) + size_of(b);
    if (has_axis(a) && has_axis(b)) {
        if (is_parallel(a.axis, b.axis) && is_on(b.point, a.point, a.axis, size)) {
            return Axis{a.point, a.axis};
        }
        return std::nullopt;
    }
    if (has_axis(b)) return common_axis(b, a);
    if (has_axis(a)) {
        const bool shared = b.kind == SurfaceKind::plane ? is_parallel(a.axis, b.axis)
                                                         : is_on(b.point, a.point, a.axis, size);
        return shared ? std::optional(Axis{a.point, a.axis}) : std::nullopt;
    }
    // Planes and spheres.
    if (a.kind == SurfaceKind::plane && b.kind == SurfaceKind::plane) return std::nullopt;
    if (b.kind == SurfaceKind::plane) return Axis{a.point, b.axis};
    if (a.kind == SurfaceKind::plane) return Axis{b.point, a.axis};
    const Vec3 d = b.point - a.point;
    const double length = norm(d);
    if (!(length > kShared * size)) return std::nullopt;
    return Axis{a.point, d / length};
}

/// The direction along which both may be moved without changing.
std::optional<Vec3> common_direction(const Surface& a, const Surface& b) {
    const bool plane_a = a.kind == SurfaceKind::plane;
    const bool plane_b = b.kind == SurfaceKind::plane;
    if (plane_a && plane_b) {
        if (is_parallel(a.axis, b.axis)) return std::nullopt;
        // a x b by the sum and the difference, which stand on each other: it stands on both normals at small angles, too.
        return unit(cross(unit(a.axis + b.axis), unit(b.axis - a.axis)));
    }
    if (plane_b) return common_direction(b, a);
    if (!has_direction(b)) return std::nullopt;
    if (plane_a) {
        return std::fabs(dot(a.axis, b.axis)) <= kShared ? std::optional(b.axis) : std::nullopt;
    }
    return has_direction(a) && is_parallel(a.axis, b.axis) ? std::optional(a.axis) : std::nullopt;
}

SectionCurve line(Vec2 normal, double offset) {
    SectionCurve c;
    c.normal = normal;
    c.offset = offset;
    return c;
}
SectionCurve circle(Vec2 centre, double radius) {
    SectionCurve c;
    c.is_line = false;
    c.centre = centre;
    c.radius = radius;
    return c;
}

/// The run of a free-form surface, mapped to the section.
SectionCurve curve_of(const Surface& s, const Affine2& map) {
    SectionCurve c;
    c.is_line = false;
    c.run = map == Affine2{} ? s.run : std::make_shared<const Run>(s.run->mapped(map));
    return c;
}

/// In the half-plane beside the axis, (radius, along).
SectionCurve section_beside(const EdgeCurve& e, const Surface& s) {
    const double z = dot(s.point - e.origin, e.along);
    const double up = dot(s.axis, e.along) < 0.0 ? -1.0 : 1.0;
    switch (s.kind) {
        case SurfaceKind::plane:
            return line({0.0, up}, up * z);
        case SurfaceKind::sphere:
            return circle({0.0, z}, s.radius);
        case SurfaceKind::cylinder: {
            SectionCurve wall = line({1.0, 0.0}, s.radius);
            wall.round = s.radius;
            return wall;
        }
        case SurfaceKind::cone:
            return line({s.cosine, -up * s.sine}, -up * s.sine * z);
        case SurfaceKind::torus:
            return circle({s.radius, z}, s.tube);
        case SurfaceKind::turned:
            // On its head where the section's axis runs the other way.
            return curve_of(s, {.xx = 1.0, .xy = 0.0, .x = 0.0, .yx = 0.0, .yy = up, .y = z});
        case SurfaceKind::wall:
        case SurfaceKind::leaning:
            break;
    }
    return {};
}

/// In the plane (across, up).
SectionCurve section_across(const EdgeCurve& e, const Surface& s) {
    const Vec3 d = s.point - e.origin;
    if (s.kind == SurfaceKind::plane) {
        return line({dot(s.axis, e.across), dot(s.axis, e.up)}, dot(s.axis, d));
    }
    if (s.kind == SurfaceKind::wall) {
        return curve_of(s, {.xx = dot(s.across, e.across),
                            .xy = dot(s.up, e.across),
                            .x = dot(d, e.across),
                            .yx = dot(s.across, e.up),
                            .yy = dot(s.up, e.up),
                            .y = dot(d, e.up)});
    }
    return circle({dot(d, e.across), dot(d, e.up)}, s.radius);
}

void add_edges(EdgeCurve edge, std::vector<EdgeCurve>& out) {
    if (edge.a.run || edge.b.run) {
        for (const Vec2 at : run_meetings(edge.a, edge.b)) {
            if (edge.is_circle && !(at.x > 0.0)) continue;
            edge.at = at;
            out.push_back(edge);
        }
        return;
    }
    for (const Branch branch : {Branch::left, Branch::right}) {
        const auto at = meet(edge.a, 0.0, edge.b, 0.0, branch);
        if (!at || (edge.is_circle && !(at->x > 0.0))) continue;
        edge.branch = branch;
        edge.at = *at;
        out.push_back(edge);
    }
}

// A point of a line or a quarter of a circle in homogeneous coordinates, relative to a surface's own point.
struct Arc {
    Bernstein<2> x, y, z, w;
};

Bernstein<4> operator-(Bernstein<4> p, const Bernstein<4>& q) {
    for (std::size_t i = 0; i < p.size(); ++i) p[i] -= q[i];
    return p;
}
template <std::size_t M>
std::array<double, M> plus(std::array<double, M> p, const std::array<double, M>& q, double factor) {
    for (std::size_t i = 0; i < M; ++i) p[i] += factor * q[i];
    return p;
}
Bernstein<4> square(const Bernstein<2>& p) { return curves::product(p, p); }

template <int N>
void append_roots(const Bernstein<N>& p, std::vector<double>& out) {
    double size = 0.0;
    for (const double c : p) size = std::max(size, std::fabs(c));
    if (!(size > 0.0)) return;
    curves::RootList<N> roots;
    // The coefficients carry some tens of roundings of the largest.
    curves::find_roots<N>(p, 0x1p-46 * size, roots);
    for (const curves::Root& root : roots) out.push_back(root.u);
}

void append_roots(const Arc& arc, const Surface& s, std::vector<double>& out) {
    const auto along =
        plus(plus(plus(Bernstein<2>{}, arc.x, s.axis.x), arc.y, s.axis.y), arc.z, s.axis.z);
    if (s.kind == SurfaceKind::plane) return append_roots<2>(along, out);
    const Bernstein<4> all = plus(plus(square(arc.x), square(arc.y), 1.0), square(arc.z), 1.0);
    const Bernstein<4> one = square(arc.w);
    const Bernstein<4> high = square(along);
    switch (s.kind) {
        case SurfaceKind::plane:
            return;
        case SurfaceKind::sphere:
            return append_roots<4>(plus(all, one, -s.radius * s.radius), out);
        case SurfaceKind::cylinder:
            return append_roots<4>(plus(all - high, one, -s.radius * s.radius), out);
        case SurfaceKind::cone:
            return append_roots<4>(
                plus(plus(Bernstein<4>{}, all - high, s.cosine * s.cosine), high, -s.sine * s.sine),
                out);
        case SurfaceKind::torus: {
            const Bernstein<4> k = plus(all, one, (s.radius - s.tube) * (s.radius + s.tube));
            const Bernstein<8> far = curves::product(all - high, one);
            return append_roots<8>(plus(curves::product(k, k), far, -4.0 * s.radius * s.radius),
                                   out);
        }
        case SurfaceKind::wall:
        case SurfaceKind::turned:
        case SurfaceKind::leaning:
            return;
    }
}

/// Where a line or circle crosses a free-form surface: between places at which the distances have different signs.
void append_free(const EdgeCurve& edge, Vec2 section, const Surface& surface, double lo, double hi,
                 std::vector<double>& out) {
    // What runs along with a surface is as far from it everywhere.
    if (runs_along(edge, surface)) return;
    constexpr int kPlaces = 256;
    if (edge.is_circle) {
        lo = 0.0;
        hi = 2.0 * std::numbers::pi;
    }
    const auto d = [&](double t) { return surface.distance(edge.place(section, t)); };
    double from = lo;
    double before = d(lo);
    for (int i = 1; i <= kPlaces; ++i) {
        const double to = lo + (hi - lo) * i / kPlaces;
        const double after = d(to);
        if ((before < 0.0) != (after < 0.0)) {
            double inner = from;
            double outer = to;
            for (int k = 0; k < 60; ++k) {
                const double middle = 0.5 * (inner + outer);
                ((d(middle) < 0.0) == (before < 0.0) ? inner : outer) = middle;
            }
            out.push_back(0.5 * (inner + outer));
        }
        from = to;
        before = after;
    }
}

}  // namespace

Vec3 EdgeCurve::place(Vec2 p, double t) const {
    if (!is_circle) return origin + across * p.x + up * p.y + along * t;
    return origin + (across * std::cos(t) + up * std::sin(t)) * p.x + along * p.y;
}

Vec3 EdgeCurve::turn(Vec2 v, double t) const {
    if (!is_circle) return across * v.x + up * v.y;
    return (across * std::cos(t) + up * std::sin(t)) * v.x + along * v.y;
}

std::optional<Vec2> EdgeCurve::at_distances(double from_a, double from_b) const {
    if (a.run || b.run) return follow(a, from_a, b, from_b, at);
    return meet(a, from_a, b, from_b, branch);
}

Vec3 EdgeCurve::tangent(double t) const {
    return is_circle ? up * std::cos(t) - across * std::sin(t) : along;
}

Meeting meeting_of(const Surface& a, const Surface& b) {
    Meeting meeting;
    EdgeCurve edge;
    if (const auto axis = common_axis(a, b)) {
        edge.is_circle = true;
        edge.origin = axis->origin;
        edge.along = axis->direction;
        make_frame(edge.along, edge.across, edge.up);
        edge.a = section_beside(edge, a);
        edge.b = section_beside(edge, b);
        add_edges(edge, meeting.edges);
        return meeting;
    }
    if (const auto direction = common_direction(a, b)) {
        edge.along = *direction;
        make_frame(edge.along, edge.across, edge.up);
        // A run keeps its own frame.
        for (const Surface* s : {&b, &a}) {
            if (!s->is_free()) continue;
            edge.across = s->across;
            edge.up = s->up;
            edge.along = cross(s->across, s->up);
        }
        // A point of the line is a better origin than one far from it.
        edge.origin = b.kind == SurfaceKind::plane || a.is_free() ? a.point : b.point;
        edge.a = section_across(edge, a);
        edge.b = section_across(edge, b);
        add_edges(edge, meeting.edges);
        return meeting;
    }
    // Parallel planes and concentric spheres have nothing in common.
    const bool never =
        a.kind == b.kind && (a.kind == SurfaceKind::plane || a.kind == SurfaceKind::sphere);
    meeting.is_general = !never;
    return meeting;
}

bool runs_along(const EdgeCurve& edge, const Surface& s) {
    if (!edge.is_circle) {
        if (s.kind == SurfaceKind::plane) return std::fabs(dot(s.axis, edge.along)) <= kShared;
        return has_direction(s) && is_parallel(s.axis, edge.along);
    }
    if (s.kind == SurfaceKind::plane) return is_parallel(s.axis, edge.along);
    if (s.kind != SurfaceKind::sphere && !(has_axis(s) && is_parallel(s.axis, edge.along)))
        return false;
    return is_on(edge.origin, s.point, edge.along, size_of(s));
}

bool is_one(const Surface& a, const Surface& b) {
    if (a.kind != b.kind || a.is_free()) return false;
    const double size = size_of(a) + size_of(b);
    const auto is_near = [&](double x, double y) { return std::fabs(x - y) <= kShared * size; };
    if (!is_near(a.radius, b.radius) || !is_near(a.tube, b.tube)) return false;
    const Vec3 d = b.point - a.point;
    switch (a.kind) {
        case SurfaceKind::plane:
            return is_parallel(a.axis, b.axis) && is_near(dot(d, a.axis), 0.0);
        case SurfaceKind::sphere:
            return is_near(norm(d), 0.0);
        case SurfaceKind::cylinder:
            return is_parallel(a.axis, b.axis) && is_on(b.point, a.point, a.axis, size);
        case SurfaceKind::torus:
            return is_parallel(a.axis, b.axis) && is_near(norm(d), 0.0);
        case SurfaceKind::cone:
            return is_parallel(a.axis, b.axis) && dot(a.axis, b.axis) > 0.0 &&
                   is_near(norm(d), 0.0) && std::fabs(a.sine - b.sine) <= kShared;
        case SurfaceKind::wall:
        case SurfaceKind::turned:
        case SurfaceKind::leaning:
            break;
    }
    return false;
}

void append_crossings(const EdgeCurve& edge, Vec2 section, const Surface& surface, double lo,
                      double hi, std::vector<double>& out) {
    if (surface.is_free()) return append_free(edge, section, surface, lo, hi, out);
    std::vector<double> roots;
    Arc arc;
    const auto set = [&](Vec3 start, Vec3 first, Vec3 second) {
        // start w + first c + second s, relative to the surface.
        const Vec3 base = start - surface.point;
        const Bernstein<2> c{1.0, 1.0, 0.0};
        const Bernstein<2> s{0.0, 1.0, 2.0};
        const Bernstein<2> w{1.0, 1.0, 2.0};
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 p = base * w[i] + first * c[i] + second * s[i];
            arc.x[i] = p.x;
            arc.y[i] = p.y;
            arc.z[i] = p.z;
        }
        arc.w = w;
    };
    if (edge.is_circle) {
        const Vec3 centre = edge.origin + edge.along * section.y;
        const Vec3 u = edge.across * section.x;
        const Vec3 v = edge.up * section.x;
        for (int quarter = 0; quarter < 4; ++quarter) {
            const Vec3 first = quarter == 0 ? u : quarter == 1 ? v : quarter == 2 ? -u : -v;
            const Vec3 second = quarter == 0 ? v : quarter == 1 ? -u : quarter == 2 ? -v : u;
            roots.clear();
            set(centre, first, second);
            append_roots(arc, surface, roots);
            for (const double r : roots) {
                out.push_back(0.5 * std::numbers::pi * quarter + 2.0 * std::atan(r));
            }
        }
        return;
    }
    if (!(lo < hi)) return;
    const Vec3 from = edge.place(section, lo) - surface.point;
    const Vec3 to = edge.place(section, hi) - surface.point;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 p = from + (to - from) * (0.5 * static_cast<double>(i));
        arc.x[i] = p.x;
        arc.y[i] = p.y;
        arc.z[i] = p.z;
        arc.w[i] = 1.0;
    }
    append_roots(arc, surface, roots);
    for (const double r : roots) out.push_back(lo + r * (hi - lo));
}

}  // namespace raymo::blends
