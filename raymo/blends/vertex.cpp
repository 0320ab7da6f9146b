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

bool is_same_place(Vec3 a, Vec3 b, double size) {
    return norm(a - b) <= 0x1p-24 * (size + max_norm(a) * 0x1p-20);
}

/// Whether two faces lie in one surface.
bool is_same_surface(const Body& body, std::size_t i, std::size_t k, Vec3 at) {
    if (i == k) return true;
    const Surface& p = body.faces()[i].surface;
    const Surface& q = body.faces()[k].surface;
    return p.kind == q.kind && norm(cross(p.normal(at), q.normal(at))) < kSmooth &&
           std::fabs(p.radius - q.radius) <= 0x1p-30 * std::fabs(p.radius);
}

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

}  // namespace

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
                return {Ending::run_on, f, std::nullopt};
        }
        return {Ending::flat, 0, std::nullopt};
    }
    EndPlan plan;
    for (const std::size_t f : at.faces) {
        const Surface& surface = body.faces()[f].surface;
        const Vec3 n = surface.normal(at.point);
        if (std::fabs(dot(n, s.tangent(at.at))) <= kSmooth) continue;
        if (plan.ending == Ending::flat) plan = {Ending::cut, f, std::nullopt};
        if (at.beyond != kOnlyA && at.beyond != kOnlyB) continue;
        const std::size_t stays = at.beyond == kOnlyA ? s.face_a : s.face_b;
        if (const auto next = job_of(body, jobs, job, at.point, stays, f)) {
            return {Ending::mitre, f, next};
        }
    }
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
        double run = reach_past(body, s, radius, end, body.faces()[plan.face].surface, limit);
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
        solid = on_own_side(body, std::move(*solid), self.segment, end, plan.face, reach,
                            plan.next ? jobs[*plan.next].solid : csg::Solid{}, span);
        if (!solid) return solid;
    }
    return solid;
}

namespace {

/// Three faces with blended edges between each two.
struct Corner {
    Vec3 point;
    bool is_convex;
    std::vector<std::size_t> faces;
    std::vector<double> sides;  ///< of the faces
    std::size_t edges = 0;
};

void add_to(const Body& body, Corner& corner, std::size_t face, double side) {
    for (const std::size_t f : corner.faces) {
        if (is_same_surface(body, f, face, corner.point)) return;
    }
    corner.faces.push_back(face);
    corner.sides.push_back(side);
}

/// The point at the distance `d` from three faces, by Newton's method, followed from the corner as d grows.
std::optional<Vec3> meet(const Body& body, const Corner& corner, double d) {
    constexpr int kSteps = 16;
    Vec3 p = corner.point;
    for (int step = 1; step <= kSteps; ++step) {
        const double now = d * step / kSteps;
        bool is_found = false;
        for (int i = 0; i < 50 && !is_found; ++i) {
            Mat3 m;
            Vec3 off;
            for (int k = 0; k < 3; ++k) {
                const auto at = static_cast<std::size_t>(k);
                const Surface& s = body.faces()[corner.faces[at]].surface;
                m.row[at] = s.normal(p) * corner.sides[at];
                off[k] = now - s.distance(p) * corner.sides[at];
            }
            if (!is_invertible(m)) return std::nullopt;
            const Vec3 way = inverse(m) * off;
            p = p + way;
            if (!is_finite(p)) return std::nullopt;
            is_found = norm(way) <= 8.0 * 0x1p-53 * (max_norm(p) + std::fabs(d));
        }
        if (!is_found && step == kSteps) return std::nullopt;
    }
    return p;
}

/// Between the ball at `c` and the planes through c and two of its contacts each: a pyramid without end but for the planes
/// that touch the ball at the contacts, moved away a little, and as far as the corner is: a hollow wall goes on beyond them.
/// Where all are at right angles it is a block.
Result<csg::Solid> ball_corner(const std::array<Vec3, 3>& to_contact, Vec3 c, Vec3 corner,
                               double radius, SourceSpan span) {
    auto ball = make<solids::Sphere>({radius}, span);
    if (!ball) return ball;
    ball = csg::transform(std::move(*ball), translation(c), span);
    if (!ball) return ball;
    double size = radius;
    for (const Vec3 p : to_contact) size = std::max(size, dot(p, corner - c));
    size += 0x1p-20 * radius;
    const auto is_across = [](Vec3 p, Vec3 q) { return std::fabs(dot(p, q)) <= 0x1p-46; };
    if (is_across(to_contact[0], to_contact[1]) && is_across(to_contact[0], to_contact[2]) &&
        is_across(to_contact[1], to_contact[2])) {
        const Affine map = frame(to_contact[0], to_contact[1], to_contact[2], c);
        auto block = make<solids::Block>({Vec3{size, size, size}, false}, span);
        if (!block) return block;
        block = csg::transform(std::move(*block), map, span);
        if (!block) return block;
        return csg::boolean(csg::Op::difference, {std::move(*block), std::move(*ball)}, span);
    }
    // Its tip is where the three planes at the contacts meet. Oblique planes have no box; a block has.
    const Mat3 contacts{{to_contact[0], to_contact[1], to_contact[2]}};
    const double reach = size + norm(inverse(contacts) * Vec3{size, size, size});
    auto around = make<solids::Block>({Vec3{reach, reach, reach} * 2.0, true}, span);
    if (!around) return around;
    around = csg::transform(std::move(*around), translation(c), span);
    if (!around) return around;
    std::vector<csg::Solid> sides{std::move(*around)};
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 p = to_contact[i];
        const Vec3 q = to_contact[(i + 1) % 3];
        const Vec3 r = to_contact[(i + 2) % 3];
        Vec3 n = cross(p, q);
        if (dot(n, r) > 0.0) n = -n;
        auto side = make<solids::Halfspace>({n, dot(n, c)}, span);
        if (!side) return side;
        sides.push_back(std::move(*side));
        auto end = make<solids::Halfspace>({p, dot(p, c) + size}, span);
        if (!end) return end;
        sides.push_back(std::move(*end));
    }
    return csg::boolean(csg::Op::difference,
                        {csg::boolean(csg::Op::intersection, std::move(sides), span), *ball}, span);
}

}  // namespace

Result<std::vector<std::pair<csg::Solid, bool>>> corners_of(const Body& body,
                                                            const std::vector<Job>& jobs,
                                                            const Form& form, SourceSpan span) {
    std::vector<Corner> corners;
    for (const Job& job : jobs) {
        const Segment& s = job.segment;
        if (s.is_closed) continue;
        for (const End& end : s.ends) {
            if (end.beyond != kAll) continue;
            auto corner = std::find_if(corners.begin(), corners.end(), [&](const Corner& c) {
                return c.is_convex == s.is_convex && is_same_place(c.point, end.point, form.radius);
            });
            if (corner == corners.end()) {
                corners.push_back({end.point, s.is_convex, {}, {}, 0});
                corner = corners.end() - 1;
            }
            ++corner->edges;
            add_to(body, *corner, s.face_a, s.edge.a.side);
            add_to(body, *corner, s.face_b, s.edge.b.side);
        }
    }
    std::vector<std::pair<csg::Solid, bool>> out;
    for (const Corner& corner : corners) {
        if (corner.edges < 3) continue;
        if (corner.faces.size() > 3 && form.profile == Profile::ball) {
            return fail(ErrorCode::bad_argument,
                        "more than three faces meet in one corner, which no ball touches all of",
                        "blend these edges one after another, with `near` or `where`");
        }
        if (corner.faces.size() < 3 || form.profile != Profile::ball) continue;
        const double d = corner.is_convex ? -form.radius : form.radius;
        const auto centre = meet(body, corner, d);
        if (!centre) {
            return fail(ErrorCode::out_of_range,
                        "no ball of this radius fits the corner where " +
                            body.name_of(body.faces()[corner.faces[0]]) + ", " +
                            body.name_of(body.faces()[corner.faces[1]]) + " and " +
                            body.name_of(body.faces()[corner.faces[2]]) + " meet",
                        "take a smaller radius");
        }
        std::array<Vec3, 3> to_contact;
        for (std::size_t i = 0; i < 3; ++i) {
            const Surface& s = body.faces()[corner.faces[i]].surface;
            to_contact[i] =
                s.normal(*centre) * (corner.is_convex ? corner.sides[i] : -corner.sides[i]);
        }
        auto solid = ball_corner(to_contact, *centre, corner.point, form.radius, span);
        if (!solid) return Failure(std::move(solid).error());
        const csg::MaterialId material = body.leaves()[body.faces()[corner.faces[0]].leaf].material;
        if (material != csg::kNoMaterial) solid = csg::paint(std::move(*solid), material, span);
        out.emplace_back(std::move(*solid), corner.is_convex);
    }
    return out;
}

}  // namespace raymo::blends
