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

/// The tangent turns by no more than this in a step.
constexpr double kMostTurn = 0x1p-5;
constexpr std::size_t kMostNodes = 8192;
/// Steps, as parts of the box.
constexpr double kLongest = 0x1p-7;
constexpr double kShortest = 0x1p-26;
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
    bool is_smooth = true;
};

/// Follows the curve from p, first along its direction, until it closes, leaves the box or touches.
Trace follow(const Surface& a, const Surface& b, const Aabb& box, Vec3 start) {
    Trace trace;
    trace.nodes.push_back(start);
    const auto way_out = direction(a, b, start);
    if (!way_out) return trace;
    const double longest = kLongest * size_of(box);
    const double shortest = kShortest * size_of(box);
    for (const double sense : {1.0, -1.0}) {
        Vec3 p = start;
        auto way = way_out;
        double h = longest;
        while (way && box.contains(p)) {
            if (trace.nodes.size() >= kMostNodes) {
                trace.is_smooth = false;
                break;
            }
            Vec3 next = p + *way * (sense * h);
            const bool is_found = to_step(a, b, p, h, next);
            const auto after = is_found ? direction(a, b, next) : std::nullopt;
            const double turn =
                after ? std::acos(std::clamp(dot(*way, *after), -1.0, 1.0)) : std::numbers::pi;
            if (turn > kMostTurn || dot(next - p, *way) * sense < 0.0) {
                h *= 0.5;
                if (h >= shortest) continue;
                // Where the surfaces touch it ends, anywhere else it is too sharp.
                trace.is_smooth = is_found && !after && trace.is_smooth;
                break;
            }
            // Past the start again?
            if (sense > 0.0 && trace.nodes.size() > 3 && norm(next - start) < h &&
                norm(p - start) < 2.0 * h && dot(next - start, *way_out) >= 0.0) {
                trace.is_closed = true;
                if (norm(p - start) < 0.25 * h) trace.nodes.pop_back();
                trace.nodes.push_back(start);
                return trace;
            }
            trace.nodes.push_back(next);
            p = next;
            way = after;
            if (turn < 0.25 * kMostTurn) h = std::min(2.0 * h, longest);
        }
        if (sense > 0.0) std::reverse(trace.nodes.begin(), trace.nodes.end());
    }
    return trace;
}

/// Meetings of a leaning wall with another surface: along its rulings, and along its run, where another wall of the same apex
/// meets it in a ruling.
std::vector<Vec3> leaning_seeds(const Surface& a, const Surface& b, const Aabb& box) {
    std::vector<Vec3> out;
    const double size = size_of(box);
    std::vector<double> at;
    for (const Vec2 p : a.run->samples()) {
        EdgeCurve line;
        line.along = unit(a.place(p) - a.apex());
        line.origin = a.place(p) + line.along * dot(box.centre() - a.place(p), line.along);
        make_frame(line.along, line.across, line.up);
        at.clear();
        append_crossings(line, {}, b, -size, size, at);
        for (const double t : at) out.push_back(line.place({}, t));
    }
    for (const Vec2 p : a.run->crossings([&](Vec2 q) { return b.distance(a.place(q)); }))
        out.push_back(a.place(p));
    return out;
}

/// Meetings of a free-form surface with another: along its rulings, or along its meridians from sample to sample.
std::vector<Vec3> free_seeds(const Surface& a, const Surface& b, const Aabb& box) {
    if (a.kind == SurfaceKind::leaning) return leaning_seeds(a, b, box);
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

/// The point on both surfaces that shortest steps lead to.
bool to_both(const Surface& a, const Surface& b, Vec3& p) {
    for (int i = 0; i < 50; ++i) {
        const Vec3 na = a.normal(p);
        const Vec3 nb = b.normal(p);
        const double cosine = dot(na, nb);
        const double square = (1.0 - cosine) * (1.0 + cosine);
        if (!(square > kTouch * kTouch)) return false;
        const double off_a = a.distance(p);
        const double off_b = b.distance(p);
        const Vec3 step =
            na * ((off_a - cosine * off_b) / square) + nb * ((off_b - cosine * off_a) / square);
        p = p - step;
        if (!is_finite(p)) return false;
        if (norm(step) * std::sqrt(square) <= rounding_at(a, b, p)) return true;
    }
    return false;
}

/// Places on both surfaces near a line or circle on `a` that passes `b` by less than `apart` of its neighbours: at the least
/// distances. The distance from a surface changes by no more than the way, so that no place is stepped over.
template <class Apart>
void append_misses(const EdgeCurve& line, Vec2 section, const Surface& a, const Surface& b,
                   const Aabb& box, Apart&& apart, std::vector<Vec3>& out) {
    constexpr int kMostSteps = 4096;
    const double speed = line.is_circle ? section.x : 1.0;
    const double size = size_of(box);
    const double reach = norm(line.place(section, 0.0) - box.centre()) + size;
    const double end = line.is_circle ? 2.0 * std::numbers::pi : reach;
    double t = line.is_circle ? 0.0 : -reach;
    double last = Aabb::kInf;
    bool is_falling = false;
    Vec3 before;
    for (int i = 0; i < kMostSteps && t < end; ++i) {
        const Vec3 p = line.place(section, t);
        const double miss = std::fabs(b.distance(p));
        if (is_falling && miss >= last && last <= apart(before) && box.contains(before)) {
            Vec3 q = before;
            if (to_both(a, b, q) && norm(q - before) <= 4.0 * apart(before)) out.push_back(q);
        }
        is_falling = miss < last;
        last = miss;
        before = p;
        t += std::max({0.5 * miss, 0.25 * apart(p), 0x1p-12 * size}) / speed;
    }
}

/// Meetings of a family of lines or circles on `a` with `b`, and what may be between them.
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
        if (a.kind == SurfaceKind::plane) return;
        // From one line of the family to the next.
        const auto apart = [&](Vec3 p) {
            const Vec3 d = p - a.point;
            return norm(d - a.axis * dot(d, a.axis)) * (2.0 * std::numbers::pi / kFamily);
        };
        append_misses(line, section, a, b, box, apart, out);
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
            case SurfaceKind::leaning:
                continue;
        }
        make_frame(line.along, line.across, line.up);
        meet({});
    }
    return out;
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

SpaceEdge::SpaceEdge(Surface a, Surface b, std::vector<Vec3> nodes, bool is_closed, bool is_smooth)
    : a_(std::move(a)),
      b_(std::move(b)),
      nodes_(std::move(nodes)),
      is_closed_(is_closed),
      is_smooth_(is_smooth) {
    at_.reserve(nodes_.size());
    at_.push_back(0.0);
    for (std::size_t i = 1; i < nodes_.size(); ++i) {
        at_.push_back(at_.back() + norm(nodes_[i] - nodes_[i - 1]));
    }
}

SpaceEdge::Place SpaceEdge::place_of(double t) const {
    if (is_closed_) t -= last() * std::floor(t / last());
    const auto above = std::upper_bound(at_.begin() + 1, at_.end() - 1, t);
    const auto step = static_cast<std::size_t>(above - at_.begin()) - 1;
    return {step, (t - at_[step]) / (at_[step + 1] - at_[step])};
}

Vec3 SpaceEdge::point(double t) const {
    const auto [i, part] = place_of(t);
    const Vec3 from = nodes_[i];
    const Vec3 to = nodes_[i + 1];
    if (part == 0.0) return from;
    if (part == 1.0) return to;
    Vec3 p = from + (to - from) * part;
    const Vec3 chord = p;
    return to_distances(a_, 0.0, b_, 0.0, unit(to - from), p) ? p : chord;
}

Vec3 SpaceEdge::tangent(double t) const {
    const Vec3 p = point(t);
    const std::size_t i = place_of(t).step;
    const Vec3 ahead = nodes_[i + 1] - nodes_[i];
    const Vec3 across = cross(a_.normal(p), b_.normal(p));
    return unit(dot(across, ahead) < 0.0 ? -across : across);
}

double SpaceEdge::step_at(double t) const {
    const std::size_t i = place_of(t).step;
    return at_[i + 1] - at_[i];
}

std::optional<double> SpaceEdge::parameter_of(Vec3 p) const {
    // An arc is off its chord by an eighth of the chord times its turn.
    for (std::size_t i = 0; i + 1 < nodes_.size(); ++i) {
        const Vec3 chord = nodes_[i + 1] - nodes_[i];
        const Vec3 d = p - nodes_[i];
        const double part = std::clamp(dot(d, chord) / dot(chord, chord), 0.0, 1.0);
        if (norm(d - chord * part) <= 0.25 * kMostTurn * norm(chord))
            return at_[i] + part * (at_[i + 1] - at_[i]);
    }
    return std::nullopt;
}

std::vector<SpaceEdgePtr> space_edges(const Surface& a, const Surface& b, const Aabb& box) {
    std::vector<SpaceEdgePtr> out;
    std::vector<Vec3> begin;
    if (a.is_free() || b.is_free()) {
        begin = a.is_free() ? free_seeds(a, b, box) : free_seeds(b, a, box);
    } else {
        begin = seeds(a, b, box);
        for (const Vec3 p : seeds(b, a, box)) begin.push_back(p);
    }
    for (Vec3 p : begin) {
        if (!box.contains(p)) continue;
        const auto t = direction(a, b, p);
        if (!t || !to_distances(a, 0.0, b, 0.0, *t, p)) continue;
        if (std::any_of(out.begin(), out.end(), [&](const SpaceEdgePtr& edge) {
                return edge->parameter_of(p).has_value();
            })) {
            continue;
        }
        Trace trace = follow(a, b, box, p);
        if (trace.nodes.size() < 3) continue;
        out.push_back(std::make_shared<const SpaceEdge>(a, b, std::move(trace.nodes),
                                                        trace.is_closed, trace.is_smooth));
    }
    return out;
}

}  // namespace raymo::blends
