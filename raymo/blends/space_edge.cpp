#include "raymo/blends/space_edge.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "raymo/blends/edge.hpp"
#include "raymo/math/affine.hpp"
#include "raymo/math/tolerance.hpp"

namespace raymo::blends {
namespace {

/// The tangent turns by no more than this in a step: cubics through the nodes are then within 1e-9 of the radius of curvature.
constexpr double kMostTurn = 0x1p-6;
constexpr std::size_t kMostNodes = 8192;
/// Lines or circles by which branches are looked for.
constexpr int kFamily = 96;
/// Surfaces that meet at a smaller sine touch there, as far as following their curve goes.
constexpr double kTouch = 0x1p-12;

double size_of(const Aabb& box) { return norm(box.size()); }

/// What a distance from one of the surfaces may be off by.
double rounding_at(const Surface& a, const Surface& b, Vec3 p) {
    return 16.0 * kUnitRoundoff *
           (max_norm(p) + max_norm(p - a.point) + max_norm(p - b.point) + a.radius + b.radius);
}

std::optional<Vec3> direction(const Surface& a, const Surface& b, Vec3 p) {
    const Vec3 t = cross(a.normal(p), b.normal(p));
    const double sine = norm(t);
    if (!(sine > kTouch)) return std::nullopt;
    return t / sine;
}

/// The point on both surfaces at the distance h from `from`, near to `p`.
bool to_step(const Surface& a, const Surface& b, Vec3 from, double h, Vec3& p) {
    for (int i = 0; i < 30; ++i) {
        const Vec3 d = p - from;
        const double length = norm(d);
        if (!(length > 0.0)) return false;
        const Mat3 m{{a.normal(p), b.normal(p), d / length}};
        if (!is_invertible(m)) return false;
        const Vec3 step = inverse(m) * Vec3{-a.distance(p), -b.distance(p), h - length};
        p = p + step;
        if (!is_finite(p)) return false;
        if (norm(step) <= rounding_at(a, b, p) + 16.0 * kUnitRoundoff * h) {
            return norm(p - from) < 1.5 * h;
        }
    }
    return false;
}

struct Trace {
    std::vector<Vec3> nodes;
    bool is_closed = false;
    double overshoot =
        0.0;  ///< of a closed one: from its first node to where the last step would end
    double sharpest = 0.0;  ///< the largest turn of a step
};

/// Follows the curve from p, first along `sense` times its direction, until it closes, leaves the box or touches.
Trace follow(const Surface& a, const Surface& b, const Aabb& box, Vec3 start, double h,
             std::size_t most) {
    Trace trace;
    trace.nodes.push_back(start);
    for (const double sense : {1.0, -1.0}) {
        Vec3 p = start;
        while (trace.nodes.size() < most) {
            const auto t = direction(a, b, p);
            if (!t) break;
            Vec3 next = p + *t * (sense * h);
            if (!to_step(a, b, p, h, next)) break;
            const auto after = direction(a, b, next);
            if (after) {
                const double cosine = std::clamp(dot(*t, *after), -1.0, 1.0);
                trace.sharpest = std::max(trace.sharpest, std::acos(cosine));
                if (cosine < 0.0) break;
            }
            // Past the start again?
            if (sense > 0.0 && trace.nodes.size() > 3 && norm(next - start) < h) {
                const auto at_start = direction(a, b, start);
                const double ahead = dot(next - start, *at_start);
                if (ahead >= 0.0) {
                    trace.is_closed = true;
                    trace.overshoot = ahead;
                    return trace;
                }
            }
            trace.nodes.push_back(next);
            p = next;
            if (!box.contains(p)) break;
        }
        if (sense > 0.0) std::reverse(trace.nodes.begin(), trace.nodes.end());
    }
    return trace;
}

/// A closed curve in steps that end where they began.
std::optional<Trace> follow_closed(const Surface& a, const Surface& b, const Aabb& box, Vec3 start,
                                   double h) {
    Trace trace = follow(a, b, box, start, h, kMostNodes);
    if (!trace.is_closed) return std::nullopt;
    // n steps overshoot a little: shorten them until they do not. A multiple of 16 can be taken two, four, ... at a time.
    const std::size_t count = (trace.nodes.size() + 15) / 16 * 16;
    const auto n = static_cast<double>(count);
    double step = h * static_cast<double>(trace.nodes.size()) / n;
    trace.nodes.resize(count);
    for (int i = 0; i < 40; ++i) {
        Vec3 p = start;
        for (double k = 0; k < n; ++k) {
            const auto t = direction(a, b, p);
            if (!t) return std::nullopt;
            Vec3 next = p + *t * step;
            if (!to_step(a, b, p, step, next)) return std::nullopt;
            p = next;
            if (k + 1 < n) trace.nodes[static_cast<std::size_t>(k) + 1] = p;
        }
        const auto t = direction(a, b, start);
        const double over = dot(p - start, *t);
        if (std::fabs(over) <= 0x1p-44 * n * step) return trace;
        step -= over / n;
        if (!(step > 0.0)) return std::nullopt;
    }
    return trace;
}

/// Meetings of a free-form surface with another: along its rulings, or along its meridians from sample to sample.
std::vector<Vec3> free_seeds(const Surface& a, const Surface& b, const Aabb& box) {
    std::vector<Vec3> out;
    const auto& samples = a.run->samples();
    if (a.kind == SurfaceKind::wall) {
        const double size = size_of(box);
        EdgeCurve line;
        line.along = a.axis;
        line.across = a.across;
        line.up = a.up;
        line.origin = a.point + a.axis * dot(box.centre() - a.point, a.axis);
        std::vector<double> at;
        for (const Vec2 p : samples) {
            at.clear();
            append_crossings(line, p, b, -size, size, at);
            for (const double t : at) out.push_back(line.place(p, t));
        }
        return out;
    }
    Vec3 u;
    Vec3 v;
    make_frame(a.axis, u, v);
    for (int i = 0; i < kFamily; ++i) {
        const double angle = 2.0 * std::numbers::pi * (i + 0.3819) / kFamily;
        const Vec3 outward = u * std::cos(angle) + v * std::sin(angle);
        const auto place = [&](Vec2 p) { return a.point + outward * p.x + a.axis * p.y; };
        for (std::size_t k = 0; k + 1 < samples.size() + (a.run->is_closed() ? 1 : 0); ++k) {
            Vec2 inner = samples[k];
            Vec2 outer = samples[(k + 1) % samples.size()];
            const bool before = b.distance(place(inner)) < 0.0;
            if ((b.distance(place(outer)) < 0.0) == before) continue;
            for (int step = 0; step < 40; ++step) {
                const Vec2 middle = (inner + outer) * 0.5;
                ((b.distance(place(middle)) < 0.0) == before ? inner : outer) = middle;
            }
            out.push_back(place(inner));
        }
    }
    return out;
}

/// Meetings of a family of lines or circles on `a` with `b`.
std::vector<Vec3> seeds(const Surface& a, const Surface& b, const Aabb& box) {
    std::vector<Vec3> out;
    std::vector<double> at;
    const double size = size_of(box);
    const Vec3 centre = box.centre();
    EdgeCurve line;
    const auto meet = [&](Vec2 section) {
        at.clear();
        append_crossings(line, section, b, -size, size, at);
        for (const double t : at) out.push_back(line.place(section, t));
    };
    Vec3 u;
    Vec3 v;
    make_frame(a.axis, u, v);
    for (int i = 0; i < kFamily; ++i) {
        // Not along anything that a designer would choose.
        const double angle = 2.0 * std::numbers::pi * (i + 0.3819) / kFamily;
        const Vec3 out_at = u * std::cos(angle) + v * std::sin(angle);
        const double along = dot(centre - a.point, a.axis);
        line = {};
        switch (a.kind) {
            case SurfaceKind::plane: {
                const Vec3 foot = centre - a.axis * a.distance(centre);
                const double offset = size * ((i + 0.3819) / kFamily - 0.5);
                for (const auto& [x, y] : {std::pair(u, v), std::pair(v, u)}) {
                    line.origin = foot + x * offset;
                    line.along = y;
                    line.across = x;
                    line.up = a.axis;
                    meet({});
                }
                continue;
            }
            case SurfaceKind::cylinder:
                line.origin = a.point + a.axis * along + out_at * a.radius;
                line.along = a.axis;
                break;
            case SurfaceKind::cone:
                line.along = a.axis * a.cosine + out_at * a.sine;
                line.origin = a.point + line.along * (along / std::max(a.cosine, 0x1p-10));
                break;
            case SurfaceKind::sphere:
                line.is_circle = true;
                line.origin = a.point;
                line.across = a.axis;
                line.along = out_at;
                line.up = cross(line.along, line.across);
                meet({a.radius, 0.0});
                continue;
            case SurfaceKind::torus:
                line.is_circle = true;
                line.origin = a.point + out_at * a.radius;
                line.across = out_at;
                line.up = a.axis;
                line.along = cross(out_at, a.axis);
                meet({a.tube, 0.0});
                continue;
            case SurfaceKind::wall:
            case SurfaceKind::turned:
                continue;
        }
        make_frame(line.along, line.across, line.up);
        meet({});
    }
    return out;
}

/// Whether a point lies on a curve that is known: near one of its nodes.
bool is_known(const std::vector<SpaceEdgePtr>& known, Vec3 p) {
    return std::any_of(known.begin(), known.end(), [&](const SpaceEdgePtr& edge) {
        const double reach = 0.75 * edge->speed();
        for (double t = 0.0; t <= edge->last(); t += 1.0) {
            if (norm(edge->point(t) - p) < reach) return true;
        }
        return false;
    });
}

}  // namespace

bool to_distances(const Surface& a, double from_a, const Surface& b, double from_b, Vec3 across,
                  Vec3& p) {
    const Vec3 start = p;
    for (int i = 0; i < 30; ++i) {
        const Mat3 m{{a.normal(p), b.normal(p), across}};
        if (!is_invertible(m)) return false;
        const Vec3 step = inverse(m) * Vec3{from_a - a.distance(p), from_b - b.distance(p),
                                            dot(across, start - p)};
        p = p + step;
        if (!is_finite(p)) return false;
        // Where the surfaces meet at a small angle their roundings count for more.
        const double sine = norm(cross(m.row[0], m.row[1]));
        const double rounding =
            rounding_at(a, b, p) + 16.0 * kUnitRoundoff * (std::fabs(from_a) + std::fabs(from_b));
        if (norm(step) * sine <= rounding) return true;
    }
    return false;
}

Vec3 SpaceEdge::point(double t) const {
    const auto n = static_cast<double>(nodes_.size());
    if (is_closed_) t -= n * std::floor(t / n);
    const double top = is_closed_ ? n - 1.0 : n - 2.0;
    const double whole = std::clamp(std::floor(t), 0.0, top);
    const auto i = static_cast<std::size_t>(whole);
    const Vec3 from = nodes_[i];
    const Vec3 to = nodes_[(i + 1) % nodes_.size()];
    const double f = t - whole;
    if (f == 0.0) return from;
    if (f == 1.0) return to;
    Vec3 p = from + (to - from) * f;
    const Vec3 chord = p;
    return to_distances(a_, 0.0, b_, 0.0, unit(to - from), p) ? p : chord;
}

Vec3 SpaceEdge::tangent(double t) const {
    const Vec3 p = point(t);
    const Vec3 ahead = point(t + 0.25) - point(t - 0.25);
    const Vec3 across = cross(a_.normal(p), b_.normal(p));
    return unit(dot(across, ahead) < 0.0 ? -across : across);
}

std::vector<SpaceEdgePtr> space_edges(const Surface& a, const Surface& b, const Aabb& box) {
    std::vector<SpaceEdgePtr> out;
    const bool swap = (a.kind == SurfaceKind::sphere || a.kind == SurfaceKind::torus) &&
                      b.kind != SurfaceKind::sphere && b.kind != SurfaceKind::torus;
    const std::vector<Vec3> begin = a.is_free()   ? free_seeds(a, b, box)
                                    : b.is_free() ? free_seeds(b, a, box)
                                    : swap        ? seeds(b, a, box)
                                                  : seeds(a, b, box);
    for (Vec3 p : begin) {
        if (!box.contains(p) || is_known(out, p)) continue;
        const auto t = direction(a, b, p);
        if (!t || !to_distances(a, 0.0, b, 0.0, *t, p)) continue;
        // Shorter steps until the tangent turns little enough in each.
        double h = size_of(box) / 64.0;
        Trace trace;
        bool is_smooth = false;
        for (int i = 0; i < 16 && !is_smooth; ++i) {
            Trace next = follow(a, b, box, p, h, kMostNodes);
            if (next.nodes.size() >= kMostNodes) break;
            trace = std::move(next);
            is_smooth = trace.nodes.size() > 8 && trace.sharpest <= kMostTurn;
            if (!is_smooth) {
                h *= trace.nodes.size() > 8 && trace.sharpest < 2.0 * kMostTurn ? 0.5 : 0.25;
            }
        }
        if (trace.nodes.size() < 3) continue;
        if (trace.is_closed && is_smooth) {
            if (auto closed = follow_closed(a, b, box, p, h)) trace = std::move(*closed);
        }
        out.push_back(std::make_shared<const SpaceEdge>(a, b, std::move(trace.nodes),
                                                        trace.is_closed, is_smooth));
    }
    return out;
}

}  // namespace raymo::blends
