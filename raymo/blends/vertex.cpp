#include "raymo/blends/vertex.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "raymo/blends/make.hpp"

namespace raymo::blends {
namespace {

/// A wedge is run on at most so many times its own extent: sharper mitres are cut off there.
constexpr double kLongestRun = 32.0;

// Sectors of an end (segment.hpp), as of a concave edge.
constexpr Sectors kAll = 0xf;
constexpr Sectors kOnlyA = 0xc;  // inside a: bits 2 and 3
constexpr Sectors kOnlyB = 0xa;  // inside b: bits 1 and 3
constexpr Sectors kNothing = 0;

bool has_face(const Body& body, const Segment& s, std::size_t face, Vec3 at) {
    return is_same_surface(body, s.face_a, face, at) || is_same_surface(body, s.face_b, face, at);
}

/// The job, other than `job`, that ends where that does and is an edge of both faces.
std::optional<std::size_t> job_of(const Body& body, const std::vector<Job>& jobs, std::size_t job,
                                  Vec3 at, std::size_t face, std::size_t other) {
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        const Segment& s = jobs[i].segment;
        if (i == job || s.is_closed || s.is_convex != jobs[job].segment.is_convex) continue;
        for (const End& end : s.ends) {
            if (is_same_place(end.point, at, jobs[job].extent) && has_face(body, s, face, at) &&
                has_face(body, s, other, at)) {
                return i;
            }
        }
    }
    return std::nullopt;
}

/// Of an arc of more than half a turn, where one of its ends is cut: what comes beyond the end, up to the middle of the gap
/// that the arc leaves. Without it a plane would cut the other side of the circle, too. Null for other segments.
Result<csg::Solid> about_end(const Segment& segment, std::size_t end, SourceSpan span) {
    const double length = segment.hi - segment.lo;
    if (segment.space || !segment.edge.is_circle || length <= std::numbers::pi) return csg::Solid{};
    const double sense = end == 0 ? -1.0 : 1.0;
    const double at = segment.ends[end].at;
    const double most = at + sense * 0.5 * (2.0 * std::numbers::pi - length);
    const EdgeCurve& e = segment.edge;
    const Vec3 here = -e.turn({1.0, 0.0}, at);
    const Vec3 there = e.tangent(most) * sense;
    auto near = make<solids::Halfspace>({here, dot(here, e.origin)}, span);
    if (!near) return near;
    auto before = make<solids::Halfspace>({there, dot(there, e.origin)}, span);
    if (!before) return before;
    return csg::boolean(csg::Op::intersection, {std::move(*near), std::move(*before)}, span);
}

/// The part of `wedge` on the segment's own side of a face, and what of `more` there is beyond it.
Result<csg::Solid> on_own_side(const Body& body, csg::Solid wedge, const Segment& segment,
                               std::size_t end, std::size_t face, double reach,
                               const csg::Solid& more, SourceSpan span) {
    const Surface& surface = body.faces()[face].surface;
    const Vec3 at = segment.ends[end].point;
    auto inner = surface.kind == SurfaceKind::turned || surface.kind == SurfaceKind::leaning
                     ? whole_leaf(body, face, span)
                     : inner_side(surface, at, reach, span);
    if (!inner) return inner;
    const Vec3 forth = segment.tangent(segment.ends[end].at) * (end == 0 ? 1.0 : -1.0);
    const bool is_inner = dot(surface.normal(at), forth) < 0.0;
    const auto about = about_end(segment, end, span);
    if (!about) return about;
    if (is_inner) {
        csg::Solid kept = more ? csg::boolean(csg::Op::unite, {*inner, more}, span) : *inner;
        if (*about) {
            csg::Solid lost = csg::boolean(csg::Op::difference, {*about, std::move(kept)}, span);
            return csg::boolean(csg::Op::difference, {std::move(wedge), std::move(lost)}, span);
        }
        return csg::boolean(csg::Op::intersection, {std::move(wedge), std::move(kept)}, span);
    }
    csg::Solid lost = more ? csg::boolean(csg::Op::difference, {*inner, more}, span) : *inner;
    if (*about) lost = csg::boolean(csg::Op::intersection, {std::move(lost), *about}, span);
    return csg::boolean(csg::Op::difference, {std::move(wedge), std::move(lost)}, span);
}

/// Whether a face lies in the surface of one that the plan has.
bool is_among(const Body& body, const EndPlan& plan, std::size_t face, Vec3 at) {
    return std::any_of(plan.faces.begin(), plan.faces.end(),
                       [&](std::size_t k) { return is_same_surface(body, k, face, at); });
}

/// In how many of some directions along both faces of an edge, next to the end, these faces end elsewhere than where the
/// others cut them. Nothing is beyond the end.
int count_misses(const Body& body, const Segment& segment, std::size_t end,
                 const std::vector<std::size_t>& others) {
    constexpr int kDirections = 48;
    constexpr double kClear = 0.02;  // directions this near to a face are not asked about
    const Vec3 at = segment.ends[end].point;
    const double step = 0x1p-14 * (segment.hi - segment.lo) * segment.speed();
    const Vec3 back = segment.tangent(segment.ends[end].at) * (end == 0 ? 1.0 : -1.0);
    const auto normal = [&](std::size_t face) { return body.faces()[face].surface.normal(at); };
    const Vec3 a = normal(segment.face_a) * segment.edge.a.side;
    const Vec3 b = normal(segment.face_b) * segment.edge.b.side;
    int misses = 0;
    for (const auto& [face, other] : {std::pair(a, b), std::pair(b, a)}) {
        // On the face, from the edge to where the ball is.
        const Vec3 out = unit(other - face * dot(other, face)) * segment.sign();
        for (int i = 0; i < kDirections; ++i) {
            const double turn = (i + 0.5) * std::numbers::pi / kDirections;
            const Vec3 d = back * std::cos(turn) + out * std::sin(turn);
            bool is_kept = true;
            double clear = 1.0;
            for (const std::size_t f : others) {
                const Vec3 n = normal(f);
                const double height = dot(n, d) * (dot(n, back) < 0.0 ? 1.0 : -1.0);
                is_kept = is_kept && height < 0.0;
                clear = std::min(clear, std::fabs(height));
            }
            if (clear < kClear) continue;
            const auto where = [&](double side) {
                return body.where(at + (d + face * (side * 0.25 * kClear)) * step);
            };
            const bool is_there =
                where(-1.0) == solids::Where::in && where(1.0) == solids::Where::out;
            misses += is_there != is_kept ? 1 : 0;
        }
    }
    return misses;
}

/// Which of several faces that meet at the end of an edge, with nothing beyond it, cut it: the one at which both of its faces end,
/// if there is one, or all. A blend that were cut by one of two such faces alone would go on past the other as a horn.
void choose_cut(const Body& body, const Segment& segment, std::size_t end, EndPlan& plan) {
    const std::vector<std::size_t> all = plan.faces;
    int least = count_misses(body, segment, end, all);
    for (const std::size_t face : all) {
        const int misses = count_misses(body, segment, end, {face});
        if (misses > least || (misses == least && plan.faces.size() == 1)) continue;
        least = misses;
        plan.faces = {face};
    }
}

}  // namespace

bool is_same_place(Vec3 a, Vec3 b, double size) {
    return norm(a - b) <= 0x1p-24 * (size + max_norm(a) * 0x1p-20);
}

bool is_same_surface(const Body& body, std::size_t i, std::size_t k, Vec3 at) {
    if (i == k) return true;
    const Surface& p = body.faces()[i].surface;
    const Surface& q = body.faces()[k].surface;
    return p.kind == q.kind && norm(cross(p.normal(at), q.normal(at))) < kSmooth &&
           std::fabs(p.radius - q.radius) <= 0x1p-30 * std::fabs(p.radius);
}

Result<csg::Solid> whole_leaf(const Body& body, std::size_t face, SourceSpan span) {
    const Leaf& leaf = body.leaves()[body.faces()[face].leaf];
    const Affine& own = csg::as_leaf(leaf.solid.node()).solid.to_object;
    return csg::transform(leaf.solid, leaf.map * inverse(own), span);
}

Result<csg::Solid> inner_side(const Surface& s, Vec3 at, double reach, SourceSpan span) {
    const auto placed = [&](Result<csg::Solid> solid, Vec3 origin) {
        if (!solid) return solid;
        Vec3 u;
        Vec3 v;
        make_frame(s.axis, u, v);
        return csg::transform(std::move(*solid), frame(u, v, s.axis, origin), span);
    };
    const double along = dot(at - s.point, s.axis);
    switch (s.kind) {
        case SurfaceKind::plane:
            return make<solids::Halfspace>({s.axis, dot(s.axis, s.point)}, span);
        case SurfaceKind::sphere:
            return placed(make<solids::Sphere>({s.radius}, span), s.point);
        case SurfaceKind::cylinder:
            return placed(make<solids::Cylinder>({s.radius, 4.0 * reach, true}, span),
                          s.point + s.axis * along);
        case SurfaceKind::cone: {
            const double height = std::fabs(along) + 2.0 * reach;
            return placed(
                make<solids::Cone>({0.0, height * s.sine / s.cosine, height, false}, span),
                s.point);
        }
        case SurfaceKind::torus:
            return placed(make<solids::Torus>({s.radius, s.tube}, span), s.point);
        case SurfaceKind::wall: {
            const Vec3 d = at - s.point;
            auto outline = std::make_shared<const curves::Outline>(
                s.run->left_of({dot(d, s.across), dot(d, s.up)}, reach));
            auto prism = make<solids::Prism>({std::move(outline), 4.0 * reach, true}, span);
            if (!prism) return prism;
            const Vec3 up = cross(s.across, s.up);
            return csg::transform(std::move(*prism),
                                  frame(s.across, s.up, up, s.point + up * dot(d, up)), span);
        }
        case SurfaceKind::turned:
        case SurfaceKind::leaning:
            break;
    }
    return fail(ErrorCode::evaluation, "unknown surface");
}

EndPlan plan_of(const Body& body, const std::vector<Job>& jobs, std::size_t job, std::size_t end) {
    const Segment& s = jobs[job].segment;
    const End& at = s.ends[end];
    if (at.beyond == kAll) {
        // A face that continues a or b without an edge ends the wedge; where the tube goes on it has a wedge of its own.
        for (const std::size_t f : at.faces) {
            const Surface& surface = body.faces()[f].surface;
            if (std::fabs(dot(surface.normal(at.point), s.tangent(at.at))) > kSmooth)
                return {Ending::run_on, {f}, std::nullopt};
        }
        return {};
    }
    EndPlan plan;
    for (const std::size_t f : at.faces) {
        const Surface& surface = body.faces()[f].surface;
        const Vec3 n = surface.normal(at.point);
        if (std::fabs(dot(n, s.tangent(at.at))) <= kSmooth) continue;
        if (plan.ending == Ending::flat) {
            plan = {Ending::cut, {f}, std::nullopt};
        } else if (at.beyond == kNothing && !is_among(body, plan, f, at.point)) {
            plan.faces.push_back(f);
        }
        if (at.beyond != kOnlyA && at.beyond != kOnlyB) continue;
        const std::size_t stays = at.beyond == kOnlyA ? s.face_a : s.face_b;
        if (const auto next = job_of(body, jobs, job, at.point, stays, f)) {
            return {Ending::mitre, {f}, next};
        }
    }
    if (plan.faces.size() > 1) choose_cut(body, s, end, plan);
    return plan;
}

void extend(const Body& body, std::vector<Job>& jobs, std::size_t job, double radius,
            const std::array<EndPlan, 2>& plans) {
    Job& self = jobs[job];
    const Segment& s = self.segment;
    self.lo = s.lo;
    self.hi = s.hi;
    if (s.is_closed) return;
    const double extent = self.extent;
    for (std::size_t end = 0; end < 2; ++end) {
        const EndPlan& plan = plans[end];
        if (plan.ending == Ending::flat) {
            // Faces that touch each other end where a double root is, which is known to half the digits.
            const double more = 0x1p-20 * extent / s.speed();
            (end == 0 ? self.lo : self.hi) += end == 0 ? -more : more;
            continue;
        }
        const double limit = kLongestRun * extent / s.speed();
        double run = 0.0;
        for (const std::size_t face : plan.faces)
            run =
                std::max(run, reach_past(body, s, radius, end, body.faces()[face].surface, limit));
        run += 0x1p-10 * extent / s.speed();
        if (plan.next) {
            // Along both edges the mitre's tip is as far away as half the angle between them says.
            const Job& next = jobs[*plan.next];
            const std::size_t there =
                is_same_place(next.segment.ends[0].point, s.ends[end].point, extent) ? 0 : 1;
            const Vec3 mine = s.tangent(s.ends[end].at) * (end == 0 ? 1.0 : -1.0);
            const Vec3 its =
                next.segment.tangent(next.segment.ends[there].at) * (there == 0 ? 1.0 : -1.0);
            const double half = 0.5 * std::acos(std::clamp(dot(mine, its), -1.0, 1.0));
            const double width = std::max(extent, next.extent);
            run += 2.0 * width / std::max(std::tan(half), 1.0 / kLongestRun) / s.speed();
        }
        run = std::min(run, limit);
        // In a sharp corner the ball may roll on far past the end, until it touches another face.
        run = std::max(run, 0x1p-10 * extent / s.speed() - s.ends[end].rest);
        (end == 0 ? self.lo : self.hi) += end == 0 ? -run : run;
    }
    if (s.space ? s.space->is_closed() : s.edge.is_circle) {
        const double excess = (self.hi - self.lo) - s.period();
        if (excess > 0.0) {
            self.lo += 0.5 * excess;
            self.hi -= 0.5 * excess;
        }
    }
}

Result<csg::Solid> cut_at_ends(const Body& body, const std::vector<Job>& jobs, std::size_t job,
                               const std::array<EndPlan, 2>& plans, SourceSpan span) {
    const Job& self = jobs[job];
    Result<csg::Solid> solid = self.solid;
    if (self.segment.is_closed) return solid;
    const double reach =
        (self.hi - self.lo) * self.segment.speed() + 2.0 * kLongestRun * self.extent;
    for (std::size_t end = 0; end < 2; ++end) {
        const EndPlan& plan = plans[end];
        if (plan.ending != Ending::cut && plan.ending != Ending::mitre) continue;
        const csg::Solid more = plan.next ? jobs[*plan.next].solid : csg::Solid{};
        for (const std::size_t face : plan.faces) {
            solid =
                on_own_side(body, std::move(*solid), self.segment, end, face, reach, more, span);
            if (!solid) return solid;
        }
    }
    return solid;
}

}  // namespace raymo::blends
