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
            break;
    }
    return s;
}

}  // namespace

Result<csg::Solid> tube_wedge(const Body& body, const Segment& segment, double radius, double lo,
                              double hi, SourceSpan span) {
    const Spine spine(body, segment, radius);
    auto sector = sector_solid(spine, lo, hi, span);
    if (!sector) return sector;
    auto ball = tube(spine, lo, hi, kTube * radius, radius, span);
    if (!ball) return ball;
    const Aabb box = csg::bounds(*sector);
    std::vector<csg::Solid> kept{std::move(*sector)};
    std::vector<csg::Solid> lost{std::move(*ball)};
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
    lost.insert(lost.begin(), kept.size() == 1
                                  ? kept[0]
                                  : csg::boolean(csg::Op::intersection, std::move(kept), span));
    return csg::boolean(csg::Op::difference, std::move(lost), span);
}

}  // namespace raymo::blends
