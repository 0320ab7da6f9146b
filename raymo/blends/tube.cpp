#include "raymo/blends/tube.hpp"

#include <algorithm>
#include <cmath>

#include "raymo/blends/make.hpp"
#include "raymo/blends/sector.hpp"
#include "raymo/blends/vertex.hpp"

namespace raymo::blends {
namespace {

/// How far the ball's path may be off, as part of the radius.
constexpr double kTube = 0x1p-30;
constexpr int kMostHalvings = 12;
constexpr std::size_t kMostSpans = 16384;
/// How far the tube goes on beyond the wedge, as part of the radius: its ends cut nothing.
constexpr double kSpare = 0x1p-4;

curves::PathSpan path_span(const Cubic& c, double radius) {
    curves::PathSpan out;
    for (std::size_t i = 0; i < 4; ++i) {
        out.x[i] = c[i].x;
        out.y[i] = c[i].y;
        out.z[i] = c[i].z;
        out.r[i] = radius;
    }
    return out;
}

/// The cubic through both ends and two places of the path between, those at which the best approximation of a quartic that
/// meets the ends has no error either: at (1 -+ tan 22.5 deg) / 2. What is left is a sixth of what tangents at the ends leave.
std::optional<Cubic> through_path(const Spine& spine, const Station& from, const Station& to) {
    constexpr double kNear = 0.5 - 0.5 * 0.41421356237309503;
    const Cubic guess = path_between(from, to);
    const auto p = spine.between(from, to, value_at(guess, kNear));
    const auto q = spine.between(from, to, value_at(guess, 1.0 - kNear));
    if (!p || !q) return std::nullopt;
    // What both inner control points have to move by: their weights at p are those at q the other way round.
    const Vec3 off_p = p->centre - value_at(guess, kNear);
    const Vec3 off_q = q->centre - value_at(guess, 1.0 - kNear);
    constexpr double kFar = 1.0 - kNear;
    constexpr double kMore = 3.0 * kFar * kFar * kNear;
    constexpr double kLess = 3.0 * kFar * kNear * kNear;
    constexpr double kDet = kMore * kMore - kLess * kLess;
    return Cubic{guess[0], guess[1] + (off_p * kMore - off_q * kLess) / kDet,
                 guess[2] + (off_q * kMore - off_p * kLess) / kDet, guess[3]};
}

/// Appends the path from place to place, in cubics that are as long as the tolerance allows.
bool append_path(const Spine& spine, const Station& first, const Station& last,
                 curves::Path& path) {
    struct Piece {
        Station from, to;
        int halvings;
    };
    const double tolerance = std::max(kTube * spine.radius(), spine.rounding());
    std::vector<Piece> open{{first, last, 0}};
    while (!open.empty()) {
        const Piece piece = open.back();
        open.pop_back();
        if (dot(piece.from.tangent, piece.to.tangent) > 0.5) {
            if (const auto cubic = through_path(spine, piece.from, piece.to)) {
                double off = 0.0;
                for (const double u : {0.125, 0.5, 0.875}) {
                    off = std::max(off, spine.off(value_at(*cubic, u)));
                }
                if (off <= tolerance) {
                    path.spans.push_back(path_span(*cubic, spine.radius()));
                    continue;
                }
            }
        }
        if (piece.halvings == kMostHalvings || path.spans.size() >= kMostSpans) return false;
        const auto middle = spine.at(0.5 * (piece.from.t + piece.to.t));
        if (!middle) return false;
        open.push_back({*middle, piece.to, piece.halvings + 1});
        open.push_back({piece.from, *middle, piece.halvings + 1});
    }
    return true;
}

Failure lost() {
    return fail(ErrorCode::out_of_range, "no ball of this radius rolls along the whole edge");
}

/// The tube that the ball sweeps from parameter lo to hi, and a little beyond.
Result<csg::Solid> tube(const Spine& spine, double lo, double hi, SourceSpan span) {
    const auto places = coarse_stations(spine, lo, hi);
    if (places.empty()) return lost();
    curves::Path path;
    path.closed = spine.segment().is_closed;
    const double spare = kSpare * spine.radius();
    const auto beyond = [&](double from, double to) {
        const auto p = spine.at(from);
        const auto q = spine.at(to);
        // Where it is lost there it ends with the wedge.
        return !p || !q || append_path(spine, *p, *q, path);
    };
    if (!path.closed && !beyond(lo - spare, lo)) path.spans.clear();
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
        if (!append_path(spine, places[i], places[i + 1], path)) return lost();
    }
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
    auto ball = tube(spine, lo, hi, span);
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
