#include "raymo/blends/tube.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <unordered_map>

#include "raymo/blends/make.hpp"
#include "raymo/blends/vertex.hpp"
#include "raymo/curves/build_spline.hpp"

namespace raymo::blends {
namespace {

using curves::Point;
using curves::SplineSpan;

/// A spline is not sure of itself next to its ends; what it does there fades to a quarter with every node.
constexpr double kSpare = 16.0;

/// How far the ball's path may be off, and how far the end of a wedge from the contacts, as parts of the radius: what the picture
/// and the volume feel of the latter is its square.
constexpr double kTube = 0x1p-32;
constexpr double kContact = 0x1p-24;

Point<4> sphere_at(Vec3 p, double r) { return {p.x, p.y, p.z, r}; }

/// The curve of a contact near t: where, and which way.
struct Contact {
    Vec3 point, normal;
    Vec3 way;  ///< its derivative
};
std::optional<Contact> contact_at(const Body& body, const Segment& segment, double radius, double t,
                                  std::size_t which) {
    constexpr double kStep = 0x1p-6;
    const auto touch = touch_at(body, segment, radius, t);
    const auto before = touch_at(body, segment, radius, t - kStep);
    const auto after = touch_at(body, segment, radius, t + kStep);
    if (!touch || !before || !after) return std::nullopt;
    return Contact{touch->contact[which], touch->outward[which],
                   (after->contact[which] - before->contact[which]) * (0.5 / kStep)};
}

/// A sphere's centre is at least this part of half the chord off it, so that the edge between faces at right angles, for one,
/// is well within.
constexpr double kLeast = 0.125;

/// The sphere that holds both curves of contact, the first at t.
struct EdgeSphere {
    Vec3 centre;
    double radius = 0.0;
    Vec3 edge;            ///< the point of the edge there
    double chord = 0.0;   ///< half the chord, h
    double height = 0.0;  ///< of the chord's middle above the edge
    double covers =
        0.0;  ///< how much of the way from the contacts to the edge lies within it; 1: all
};
std::optional<EdgeSphere> edge_sphere(const Body& body, const Segment& segment, double radius,
                                      double t) {
    const auto p = contact_at(body, segment, radius, t, 0);
    if (!p) return std::nullopt;
    double there = t;
    for (int i = 0; i < 60; ++i) {
        const auto q = contact_at(body, segment, radius, there, 1);
        if (!q) return std::nullopt;
        const Vec3 chord = q->point - p->point;
        const double half = 0.5 * norm(chord);
        const Vec3 to_edge = unit(p->normal + q->normal) * -segment.sign();
        const Mat3 m{{unit(p->way), chord, to_edge}};
        if (!is_invertible(m)) return std::nullopt;
        // The angle between the chord and the faces, less 45 degrees.
        const double steepest =
            std::max(std::fabs(dot(chord, p->normal)), std::fabs(dot(chord, q->normal)));
        const double excess =
            std::asin(std::min(steepest / (2.0 * half), 1.0)) - 0.25 * std::numbers::pi;
        const double shift = half * (kLeast + std::tan(std::max(excess, 0.0)));
        const Vec3 from_p =
            inverse(m) * Vec3{0.0, 0.5 * dot(chord, chord), 0.5 * dot(to_edge, chord) + shift};
        const Vec3 centre = p->point + from_p;
        const double speed = norm(q->way);
        const double off = dot(centre - q->point, q->way) / (speed * speed);
        if (!std::isfinite(off)) return std::nullopt;
        if (std::fabs(off) * speed <= 0x1p-40 * radius || i == 59) {
            const Vec3 edge = segment.point(t);
            const auto covered = [&](Vec3 contact) {
                const Vec3 way = edge - contact;
                return 2.0 * dot(centre - contact, way) / dot(way, way);
            };
            return EdgeSphere{centre,
                              norm(from_p),
                              edge,
                              half,
                              norm(p->point + chord * 0.5 - edge),
                              std::min(covered(p->point), covered(q->point))};
        }
        there += off;
    }
    return std::nullopt;
}

/// The spheres that take the wedge from the contacts to the edge, at each whole parameter.
class EdgeSpheres {
public:
    EdgeSpheres(const Body& body, const Segment& segment, double radius)
        : body_(body), segment_(segment), radius_(radius) {}

    /// How many shrunk copies it takes from lo to hi, before the one about the edge; -1: not even that one.
    [[nodiscard]] int copies(double lo, double hi) {
        int most = -1;
        for (double t = std::ceil(lo); t <= hi; t += 1.0) {
            const auto& s = at(t);
            if (!s || s->covers >= 1.0) continue;
            int count = 0;
            for (double f = shrink(*s); f * s->height > 2.0 * s->chord && count <= kMostCopies;
                 f *= shrink(*s)) {
                ++count;
            }
            most = std::max(most, count);
        }
        return most;
    }
    /// Whether all of them stay within the curves of contact and reach from there to the edge, from lo to hi. A sphere does not where
    /// the wedge grows faster along the edge than the edge goes on, as at the sharp end of a slanting bore.
    [[nodiscard]] bool are_good(double lo, double hi, int copies) {
        if (copies > kMostCopies) return false;
        struct Ball {
            Vec3 centre;
            double radius;
        };
        std::vector<Ball> balls;
        std::vector<Touch> touches;
        std::vector<Vec3> edge;
        // Some hundred places tell.
        const double stride = std::max(1.0, std::floor((hi - lo) / 512.0));
        for (double t = std::ceil(lo); t <= hi; t += stride) {
            const auto touch = touch_at(body_, segment_, radius_, t);
            if (!touch || !at(t)) return false;
            touches.push_back(*touch);
            edge.push_back(at(t)->edge);
            for (int k = 0; k <= std::max(copies, 0); ++k) add(copy(t, k), balls);
            if (copies >= 0) add(last(t, copies + 1), balls);
        }
        if (touches.empty()) return false;
        const double slack = 16.0 * kContact * radius_;
        for (const Ball& ball : balls) {
            for (const Touch& touch : touches) {
                for (const Vec3 p : touch.contact) {
                    if (norm(p - ball.centre) < ball.radius - slack) return false;
                }
            }
        }
        // Places on both faces, from contact to edge; mostly it is a ball from nearby that holds them.
        const auto each = static_cast<std::ptrdiff_t>(balls.size() / touches.size());
        const auto covered = [&](Vec3 x, std::ptrdiff_t from, std::ptrdiff_t to) {
            return std::any_of(balls.begin() + from, balls.begin() + to, [&](const Ball& b) {
                return norm(x - b.centre) <= b.radius + slack;
            });
        };
        const auto count = static_cast<std::ptrdiff_t>(touches.size());
        for (std::ptrdiff_t i = 0; i < count; ++i) {
            const auto at = static_cast<std::size_t>(i);
            for (std::size_t which = 0; which < 2; ++which) {
                const Surface& face =
                    body_.faces()[which == 0 ? segment_.face_a : segment_.face_b].surface;
                const Vec3 p = touches[at].contact[which];
                for (int k = 1; k <= 16; ++k) {
                    Vec3 x = p + (edge[at] - p) * (k / 16.0);
                    x = x - face.normal(x) * face.distance(x);
                    if (!covered(x, std::max<std::ptrdiff_t>(i - 4, 0) * each,
                                 std::min(i + 5, count) * each) &&
                        !covered(x, 0, count * each)) {
                        return false;
                    }
                }
            }
        }
        return true;
    }
    /// Copy number k.
    [[nodiscard]] std::optional<Point<4>> copy(double t, int k) {
        const auto& s = at(t);
        if (!s) return std::nullopt;
        const double f = std::pow(shrink(*s), k);
        return sphere_at(s->edge + (s->centre - s->edge) * f, s->radius * f);
    }
    /// About the edge, as large as copy number k leaves it to be.
    [[nodiscard]] std::optional<Point<4>> last(double t, int k) {
        const auto& s = at(t);
        if (!s) return std::nullopt;
        return sphere_at(s->edge, std::pow(shrink(*s), k) * std::hypot(s->height, s->chord));
    }

private:
    template <class Balls>
    static void add(const std::optional<Point<4>>& sphere, Balls& balls) {
        if (sphere) balls.push_back({{(*sphere)[0], (*sphere)[1], (*sphere)[2]}, (*sphere)[3]});
    }
    /// More of them mean that the faces are nearly parallel.
    static constexpr int kMostCopies = 6;
    /// The next copy begins a little before this one ends.
    [[nodiscard]] static double shrink(const EdgeSphere& s) {
        return std::max(1.0 - 0.9 * s.covers, 0x1p-6);
    }
    const std::optional<EdgeSphere>& at(double t) {
        const auto [place, is_new] = known_.try_emplace(t);
        if (is_new) place->second = edge_sphere(body_, segment_, radius_, t);
        return place->second;
    }

    const Body& body_;
    const Segment& segment_;
    double radius_;
    std::unordered_map<double, std::optional<EdgeSphere>> known_;
};

/// The part of a cubic from u on, or up to u.
SplineSpan<4> cut(const SplineSpan<4>& span, double u, bool from_u) {
    SplineSpan<4> left = span;
    SplineSpan<4> right = span;
    SplineSpan<4> b = span;
    for (std::size_t n = 1; n < 4; ++n) {
        for (std::size_t i = 0; i + n < 4; ++i) {
            for (std::size_t k = 0; k < 4; ++k) b[i][k] = (1.0 - u) * b[i][k] + u * b[i + 1][k];
        }
        left[n] = b[0];
        right[3 - n] = b[3 - n];
    }
    return from_u ? right : left;
}

curves::PathSpan path_span(const SplineSpan<4>& s) {
    curves::PathSpan out;
    for (std::size_t i = 0; i < 4; ++i) {
        out.x[i] = s[i][0];
        out.y[i] = s[i][1];
        out.z[i] = s[i][2];
        out.r[i] = std::max(s[i][3], 0.0);
    }
    return out;
}

/// Values of a function at whole parameters from `first` on.
struct Row {
    double first = 0.0;
    std::vector<Point<4>> points;
};

Failure lost() {
    return fail(ErrorCode::out_of_range, "no ball of this radius rolls along the whole edge",
                "take a smaller radius");
}

/// f at the nodes of a segment: all round, or from lo to hi and some beyond.
template <class F>
Result<Row> values(const Segment& segment, double lo, double hi, F&& f) {
    Row row;
    const bool ring = segment.is_closed;
    double end = segment.space->last() - 1.0;
    if (!ring) {
        row.first = std::floor(lo) - kSpare;
        end = std::ceil(hi) + kSpare;
        if (!segment.space->is_closed()) {
            row.first = std::max(row.first, 0.0);
            end = std::min(end, segment.space->last());
        }
    }
    for (double t = row.first; t <= end; t += 1.0) {
        const std::optional<Point<4>> p = f(t);
        if (p) {
            row.points.push_back(*p);
        } else if (ring || (t >= lo && t <= hi)) {
            return lost();
        } else if (t < lo) {
            // Beyond the ends it may be lost.
            row.points.clear();
            row.first = t + 1.0;
        } else {
            break;
        }
    }
    return row;
}

Point<4> value_at(const SplineSpan<4>& span, double u) { return cut(span, u, true)[0]; }

/// The spline through every `stride`-th point, and how far it passes the others by.
struct Fitted {
    curves::Spline<4> spline;
    double error = 0.0;
};
Result<Fitted> fit(const Row& row, bool ring, std::size_t stride) {
    std::vector<Point<4>> points;
    for (std::size_t i = 0; i < row.points.size(); i += stride) points.push_back(row.points[i]);
    curves::SplineForm form;
    form.kind = curves::SplineKind::interpolate;
    form.closed = ring;
    auto spline = curves::spline<4>(points, form);
    if (!spline) return Failure(std::move(spline).error());
    Fitted out{std::move(*spline), 0.0};
    for (std::size_t i = 0; i < row.points.size(); ++i) {
        const std::size_t span = i / stride;
        if (span >= out.spline.spans.size()) break;
        // Next to open ends it is not to be relied upon, nor is it used there.
        if (!ring && (i < row.points.size() / 8 || i > row.points.size() - row.points.size() / 8))
            continue;
        const double u = static_cast<double>(i % stride) / static_cast<double>(stride);
        const Point<4> p = value_at(out.spline.spans[span], u);
        for (std::size_t k = 0; k < 4; ++k) {
            out.error = std::max(out.error, std::fabs(p[k] - row.points[i][k]));
        }
    }
    return out;
}

/// The path of spheres f(t) from lo to hi, or all round, to within `tolerance`, with as few spans as that allows: a ray that meets
/// a thick tube meets many of them.
template <class F>
Result<curves::PathPtr> path_through(const Segment& segment, double lo, double hi, double tolerance,
                                     F&& f) {
    const bool ring = segment.is_closed;
    auto row = values(segment, lo, hi, f);
    if (!row) return Failure(std::move(row).error());
    lo = std::max(lo, row->first);
    hi = std::min(hi, row->first + static_cast<double>(row->points.size()) - 1.0);
    if (row->points.size() < 8 || !(lo < hi)) return lost();
    std::size_t stride = 0;
    Result<Fitted> fitted = lost();
    for (std::size_t k = 16; stride == 0; k /= 2) {
        // A ring must come out even; an open row ends where its last stride does.
        if (row->points.size() < 8 * k || (ring && row->points.size() % k != 0)) continue;
        Row part = *row;
        if (!ring) {
            const std::size_t whole = (part.points.size() - 1) / k * k + 1;
            if (row->first + static_cast<double>(whole - 1) < hi) continue;
            part.points.resize(whole);
        }
        fitted = fit(part, ring, k);
        // All of the points are the best there is.
        if (k == 1 && !fitted) return Failure(std::move(fitted).error());
        if (k == 1 || (fitted && fitted->error <= tolerance)) stride = k;
    }
    curves::Path path;
    path.closed = ring;
    const auto step = static_cast<double>(stride);
    for (std::size_t i = 0; i < fitted->spline.spans.size(); ++i) {
        SplineSpan<4> span = fitted->spline.spans[i];
        if (!ring) {
            const double from = row->first + step * static_cast<double>(i);
            if (from + step <= lo || from >= hi) continue;
            // The later cut first: it leaves the place of the earlier one.
            const double top = std::min((hi - from) / step, 1.0);
            const double low = std::max((lo - from) / step, 0.0);
            if (top < 1.0) span = cut(span, top, false);
            if (low > 0.0) span = cut(span, low / top, true);
        }
        path.spans.push_back(path_span(span));
    }
    return std::make_shared<const curves::Path>(std::move(path));
}

Result<csg::Solid> swept(Result<curves::PathPtr> path, SourceSpan span) {
    if (!path) return Failure(std::move(path).error());
    constexpr std::size_t kFlat = 1;
    return make<solids::Sweep>({std::move(*path), kFlat}, span);
}

/// The surface at a distance from another.
Surface offset(Surface s, double by) {
    switch (s.kind) {
        case SurfaceKind::plane:
            s.point = s.point + s.axis * by;
            break;
        case SurfaceKind::sphere:
        case SurfaceKind::cylinder:
            s.radius += by;
            break;
        case SurfaceKind::cone:
            s.point = s.point - s.axis * (by / s.sine);
            break;
        case SurfaceKind::torus:
            s.tube += by;
            break;
        case SurfaceKind::wall:
        case SurfaceKind::turned:
            break;
    }
    return s;
}

}  // namespace

Result<csg::Solid> tube_wedge(const Body& body, const Segment& segment, double radius, double lo,
                              double hi, SourceSpan span) {
    EdgeSpheres spheres(body, segment, radius);
    const int copies = spheres.copies(lo, hi);
    if (!spheres.are_good(lo, hi, copies)) {
        return fail(
            ErrorCode::out_of_range,
            body.name_of(body.faces()[segment.face_a]) + " and " +
                body.name_of(body.faces()[segment.face_b]) +
                " meet at too sharp an angle where their edge bends for a ball of this radius",
            "take a smaller radius, or let them meet less slantingly");
    }
    std::vector<csg::Solid> parts;
    for (int k = 0; k <= std::max(copies, 0); ++k) {
        auto part = swept(path_through(segment, lo, hi, kContact * radius,
                                       [&](double t) { return spheres.copy(t, k); }),
                          span);
        if (!part) return part;
        parts.push_back(std::move(*part));
    }
    if (copies >= 0) {
        auto part = swept(path_through(segment, lo, hi, kContact * radius,
                                       [&](double t) { return spheres.last(t, copies + 1); }),
                          span);
        if (!part) return part;
        parts.push_back(std::move(*part));
    }
    const csg::Solid along_edge =
        parts.size() == 1 ? parts[0] : csg::boolean(csg::Op::unite, std::move(parts), span);
    // The tube is longer, so that its ends cut nothing.
    auto tube = swept(path_through(segment, lo - 4.0, hi + 4.0, kTube * radius,
                                   [&](double t) -> std::optional<Point<4>> {
                                       const auto touch = touch_at(body, segment, radius, t);
                                       if (!touch) return std::nullopt;
                                       return sphere_at(touch->centre, radius);
                                   }),
                      span);
    if (!tube) return tube;
    std::vector<csg::Solid> kept;
    std::vector<csg::Solid> lost{*tube};
    const Aabb box = csg::bounds(along_edge);
    const double s = segment.sign();
    for (std::size_t i = 0; i < 2; ++i) {
        const Surface& surface = body.faces()[i == 0 ? segment.face_a : segment.face_b].surface;
        const double side = (i == 0 ? segment.edge.a : segment.edge.b).side;
        auto inner = surface.is_free()
                         ? whole_leaf(body, i == 0 ? segment.face_a : segment.face_b, span)
                         : inner_side(offset(surface, -s * side * kBeyond * radius), box.centre(),
                                      2.0 * norm(box.size()), span);
        if (!inner) return inner;
        // A round lies within the faces' own side, a fillet beyond it.
        ((s < 0.0) == (side > 0.0) ? kept : lost).push_back(std::move(*inner));
    }
    kept.insert(kept.begin(), along_edge);
    lost.insert(lost.begin(), kept.size() == 1
                                  ? kept[0]
                                  : csg::boolean(csg::Op::intersection, std::move(kept), span));
    return csg::boolean(csg::Op::difference, std::move(lost), span);
}

}  // namespace raymo::blends
