#include "raymo/blends/tube.hpp"

#include <algorithm>
#include <cmath>

#include "raymo/blends/make.hpp"
#include "raymo/blends/path.hpp"
#include "raymo/blends/sector.hpp"
#include "raymo/blends/vertex.hpp"

namespace raymo::blends {
namespace {

/// How far the tube may be off, as part of the radius.
constexpr double kTube = 0x1p-30;
/// How far the tube goes on beyond the wedge, as part of the radius: its ends cut nothing.
constexpr double kSpare = 0x1p-4;
Failure lost() {
    return fail(ErrorCode::out_of_range, "no ball of this radius rolls along the whole edge");
}

/// The tube of a ball of radius `radius` that takes the spine's way from parameter lo to hi, and a little beyond; off by no more
/// than `tolerance`.
Result<csg::Solid> tube(const Spine& spine, double lo, double hi, double tolerance, double radius,
                        SourceSpan span) {
    curves::Path path;
    path.closed = spine.segment().is_closed;
    const auto append = [&](const Station& from, const Station& to) {
        return append_path(spine, from, to, tolerance, radius, path.spans);
    };
    const auto beyond = [&](double from, double to) {
        const auto p = spine.at(from);
        const auto q = spine.at(to);
        // Where it is lost there it ends with the wedge.
        return !p || !q || append(*p, *q);
    };
    const auto first = spine.at(lo);
    auto last = path.closed ? first : spine.at(hi);
    if (!first || !last) return lost();
    last->t = hi;
    const double spare = kSpare * spine.radius();
    if (!path.closed && !beyond(lo - spare, lo)) path.spans.clear();
    if (!append(*first, *last)) return lost();
    if (!path.closed) {
        const std::size_t count = path.spans.size();
        if (!beyond(hi, hi + spare)) path.spans.resize(count);
    }
    constexpr std::size_t kFlat = 1;
    return make<solids::Sweep>({std::make_shared<const curves::Path>(std::move(path)), kFlat},
                               span);
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
        case SurfaceKind::leaning:
            break;
    }
    return s;
}

/// Whether a box is on a face's side where its leaf is, all of it. Of other than planes that is not asked.
bool is_within(const Face& face, const Aabb& box) {
    if (face.surface.kind != SurfaceKind::plane) return false;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const Vec3 p{(corner & 1U) != 0 ? box.hi.x : box.lo.x,
                     (corner & 2U) != 0 ? box.hi.y : box.lo.y,
                     (corner & 4U) != 0 ? box.hi.z : box.lo.z};
        if (!(face.side * face.surface.distance(p) < 0.0)) return false;
    }
    return true;
}

/// Whether a leaf is what its faces have in common on its side of them.
bool is_of_its_faces(const Leaf& leaf) {
    const auto& kernel = csg::as_leaf(leaf.solid.node()).solid.kernel;
    return leaf.unknown.empty() && (std::holds_alternative<solids::Block::Kernel>(kernel) ||
                                    std::holds_alternative<solids::Sphere::Kernel>(kernel) ||
                                    std::holds_alternative<solids::Cylinder::Kernel>(kernel) ||
                                    std::holds_alternative<solids::Cone::Kernel>(kernel) ||
                                    std::holds_alternative<solids::Torus::Kernel>(kernel));
}

/// Whether nothing of the body is in a box beyond the faces of a convex edge, on their far side. Beyond a face its leaf is not, if it
/// lies on the near side; or it is everywhere in the box, if its other faces are not there. All other leaves are as they may be.
bool is_free_beyond(const Body& body, const Segment& segment, const Aabb& box) {
    constexpr auto kMay = solids::Where::on;
    std::vector<solids::Where> states;
    for (const Leaf& leaf : body.leaves())
        states.push_back(overlap(leaf.near, box).empty() ? solids::Where::out : kMay);
    for (const bool beyond_a : {true, false}) {
        const Face& face = body.faces()[beyond_a ? segment.face_a : segment.face_b];
        const Leaf& leaf = body.leaves()[face.leaf];
        if (!is_of_its_faces(leaf)) return false;
        const double side = (beyond_a ? segment.edge.a : segment.edge.b).side;
        std::vector<solids::Where> known = states;
        if (side == face.side) {
            known[face.leaf] = solids::Where::out;
        } else {
            for (std::size_t f = leaf.first_face; f < leaf.first_face + leaf.face_count; ++f) {
                if (&body.faces()[f] != &face && !is_within(body.faces()[f], box)) return false;
            }
            known[face.leaf] = solids::Where::in;
        }
        if (body.where(known) != solids::Where::out) return false;
    }
    return true;
}

}  // namespace

Result<csg::Solid> tube_wedge(const Body& body, const Segment& segment, const Form& form, double lo,
                              double hi, SourceSpan span) {
    const double radius = form.radius;
    const Spine spine(body, segment, radius);
    auto sector = sector_solid(spine, form, lo, hi, span);
    if (!sector) return sector;
    const Aabb box = csg::bounds(*sector);
    // Nothing else is taken away then by what of the sectors is beyond the faces.
    if (form.profile != Profile::ball && segment.is_closed && segment.is_convex &&
        is_free_beyond(body, segment, box)) {
        return sector;
    }
    std::vector<csg::Solid> kept{std::move(*sector)};
    std::vector<csg::Solid> lost;
    if (form.profile == Profile::ball) {
        auto ball = tube(spine, lo, hi, kTube * radius, radius, span);
        if (!ball) return ball;
        lost.push_back(std::move(*ball));
    }
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
    csg::Solid whole =
        kept.size() == 1 ? kept[0] : csg::boolean(csg::Op::intersection, std::move(kept), span);
    if (lost.empty()) return whole;
    lost.insert(lost.begin(), std::move(whole));
    return csg::boolean(csg::Op::difference, std::move(lost), span);
}

Result<std::optional<RoundedRing>> rounded_ring(const Body& body, const Segment& segment,
                                                double radius, SourceSpan span) {
    if (!segment.space || !segment.is_closed || !segment.is_convex) return std::nullopt;
    const Spine spine(body, segment, radius);
    Form ball;
    ball.radius = radius;
    RoundedRing out;
    auto sectors = sector_solid(spine, ball, segment.lo, segment.hi, span);
    if (!sectors || !is_free_beyond(body, segment, csg::bounds(*sectors))) return std::nullopt;
    out.sectors = std::move(*sectors);
    // Off by half of what it may be, and smaller by the other half: nowhere outside of the body.
    constexpr double kHalf = 0.5 * kTube;
    auto swept = tube(spine, segment.lo, segment.hi, kHalf * radius, (1.0 - kHalf) * radius, span);
    if (!swept) return Failure(std::move(swept).error());
    out.tube = std::move(*swept);
    return out;
}

}  // namespace raymo::blends
