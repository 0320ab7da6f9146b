#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "raymo/blends/corner.hpp"
#include "raymo/blends/make.hpp"

namespace raymo::blends {
namespace {

/// The edge of two planes of a corner that are no neighbours, between two of its balls.
std::optional<Segment> bridge_of(const Body& body, const Corner& corner, const InnerCorner& inner,
                                 const InnerCorner::Bridge& bridge) {
    const Corner::Side& a = corner.sides[bridge.planes[0]];
    const Corner::Side& b = corner.sides[bridge.planes[1]];
    const auto meeting = meeting_of(surface_of(body, a), surface_of(body, b));
    if (meeting.edges.size() != 1) return std::nullopt;
    Segment s;
    s.edge = meeting.edges[0];
    s.edge.a.side = a.side;
    s.edge.b.side = b.side;
    s.face_a = a.face;
    s.face_b = b.face;
    s.is_convex = corner.is_convex;
    const auto at = [&](std::size_t i) {
        const Vec3 p = corner.point + inner.vertices[bridge.vertices[i]].at;
        return dot(p - s.edge.origin, s.edge.along);
    };
    s.lo = std::min(at(0), at(1));
    s.hi = std::max(at(0), at(1));
    s.centre = s.point(s.middle());
    return s;
}

/// The point at the distance `d` from three faces, by Newton's method, followed from the corner as d grows.
std::optional<Vec3> meet(const Body& body, Vec3 corner, const std::array<Corner::Side, 3>& sides,
                         double d) {
    constexpr int kSteps = 16;
    Vec3 p = corner;
    for (int step = 1; step <= kSteps; ++step) {
        const double now = d * step / kSteps;
        bool is_found = false;
        for (int i = 0; i < 50 && !is_found; ++i) {
            Mat3 m;
            Vec3 off;
            for (int k = 0; k < 3; ++k) {
                const auto at = static_cast<std::size_t>(k);
                const Surface& s = surface_of(body, sides[at]);
                m.row[at] = s.normal(p) * sides[at].side;
                off[k] = now - s.distance(p) * sides[at].side;
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

/// Between the ball at `c` and the planes through c and two neighbouring contacts each: a pyramid without end but for the
/// planes that touch the ball at the contacts, moved away a little, and as far as the corner is: a hollow wall goes on beyond
/// them. Where it is of three at right angles it is a block. `out`: to the same side of all these planes.
Result<csg::Solid> ball_corner(const std::vector<Vec3>& to_contact, Vec3 c, Vec3 corner, Vec3 out,
                               double radius, SourceSpan span) {
    auto ball = make<solids::Sphere>({radius}, span);
    if (!ball) return ball;
    ball = csg::transform(std::move(*ball), translation(c), span);
    if (!ball) return ball;
    const std::size_t count = to_contact.size();
    double size = radius;
    double least = Aabb::kInf;
    for (const Vec3 p : to_contact) {
        size = std::max(size, dot(p, corner - c));
        least = std::min(least, dot(p, out));
    }
    size += kBeyond * radius;
    const auto is_across = [&](std::size_t i, std::size_t k) {
        return std::fabs(dot(to_contact[i], to_contact[k])) <= 0x1p-46;
    };
    if (count == 3 && is_across(0, 1) && is_across(0, 2) && is_across(1, 2)) {
        const Affine map = frame(to_contact[0], to_contact[1], to_contact[2], c);
        auto block = make<solids::Block>({Vec3{size, size, size}, false}, span);
        if (!block) return block;
        block = csg::transform(std::move(*block), map, span);
        if (!block) return block;
        return csg::boolean(csg::Op::difference, {std::move(*block), std::move(*ball)}, span);
    }
    // Its farthest point is where the planes at three contacts meet. Of more: what is at y = sum l_i p_i, l_i >= 0, with
    // p_i.y <= size has |y|^2 <= sum l_i size <= y.out size / least.
    double reach = size;
    if (count == 3) {
        const Mat3 contacts{{to_contact[0], to_contact[1], to_contact[2]}};
        reach += norm(inverse(contacts) * Vec3{size, size, size});
    } else {
        reach += norm(out) * size / least;
    }
    if (!(least > 0.0 || count == 3) || !std::isfinite(reach))
        return fail(ErrorCode::out_of_range, "no ball of this radius fits the corner");
    // Blocks with a side in each plane, as large as it takes. A half-space has no size, by which a ray that runs along it would
    // be known to do so.
    const auto below = [&](Vec3 n, double level) {
        Vec3 u;
        Vec3 v;
        make_frame(n, u, v);
        auto block = make<solids::Block>({Vec3{reach, reach, reach} * 2.0, true}, span);
        if (!block) return block;
        return csg::transform(std::move(*block), frame(u, v, n, c + n * (level - reach)), span);
    };
    std::vector<csg::Solid> sides;
    Vec3 middle;
    for (const Vec3 p : to_contact) middle = middle + p;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 p = to_contact[i];
        Vec3 n = unit(cross(p, to_contact[(i + 1) % count]));
        if (dot(n, middle) > 0.0) n = -n;
        for (auto side : {below(n, 0.0), below(p, size)}) {
            if (!side) return side;
            sides.push_back(std::move(*side));
        }
    }
    return csg::boolean(csg::Op::difference,
                        {csg::boolean(csg::Op::intersection, std::move(sides), span), *ball}, span);
}

}  // namespace

Fitting fitting_of(const Body& body, const Corner& corner, double radius) {
    if (!is_of_planes(body, corner)) return {};
    const auto inner = inner_of(body, corner, radius);
    if (!inner) return {Fit::none, corner.sides[0].face};
    for (const InnerCorner::Bridge& bridge : inner->bridges) {
        auto segment = bridge_of(body, corner, *inner, bridge);
        if (!segment) return {Fit::none, corner.sides[0].face};
        // From ball to ball: at the ends of an edge less is asked for.
        const double margin = extent_of(body, *segment, radius) / segment->speed();
        segment->lo -= margin;
        segment->hi += margin;
        for (End& end : segment->ends) end.at = segment->middle();
        if (const Fitting fit = fitting_of(body, *segment, radius); fit.fit != Fit::good)
            return fit;
    }
    return {};
}

Result<std::vector<csg::Solid>> solids_of(const Body& body, const Corner& corner, const Form& form,
                                          SourceSpan span) {
    std::vector<csg::Solid> out;
    const csg::MaterialId material =
        body.leaves()[body.faces()[corner.sides[0].face].leaf].material;
    const auto add = [&](Result<csg::Solid> solid) -> Result<void> {
        if (!solid) return Failure(std::move(solid).error());
        out.push_back(material == csg::kNoMaterial ? std::move(*solid)
                                                   : csg::paint(std::move(*solid), material, span));
        return {};
    };
    const auto no_ball = [&] {
        return fail(
            ErrorCode::out_of_range,
            fmt::format("no ball of radius {:g} fits {}", form.radius, name_of(body, corner)),
            "take a smaller radius");
    };
    const double sign = sign_of(corner);
    const std::size_t count = corner.sides.size();
    if (is_of_planes(body, corner)) {
        const auto inner = inner_of(body, corner, form.radius);
        if (!inner) return no_ball();
        for (const InnerCorner::Vertex& vertex : inner->vertices) {
            std::vector<Vec3> to_contact;
            for (const std::size_t i : vertex.planes) {
                const Corner::Side& side = corner.sides[i];
                to_contact.push_back(surface_of(body, side).axis * (sign * side.side));
            }
            if (auto added = add(ball_corner(to_contact, corner.point + vertex.at, corner.point,
                                             -corner.middle, form.radius, span));
                !added) {
                return Failure(std::move(added).error());
            }
        }
        for (const InnerCorner::Bridge& bridge : inner->bridges) {
            const auto segment = bridge_of(body, corner, *inner, bridge);
            if (!segment || !wedge_of(*segment, form.radius)) return no_ball();
            const double more = kBeyond * form.radius;
            if (auto added =
                    add(solid_of(*segment, form, segment->lo - more, segment->hi + more, span));
                !added) {
                return Failure(std::move(added).error());
            }
        }
        return out;
    }
    // One ball, found from three faces.
    const double d = -sign * form.radius;
    const auto centre =
        meet(body, corner.point,
             {corner.sides[0], corner.sides[count / 3], corner.sides[2 * count / 3]}, d);
    if (!centre) return no_ball();
    std::vector<Vec3> to_contact;
    for (const Corner::Side& side : corner.sides) {
        const Surface& s = surface_of(body, side);
        // As good as normals of faces are that are met at once (inner_corner.cpp).
        const double slack = 0x1p-40 * norm(*centre - corner.point) + slack_of(body, corner.point);
        if (count > 3 && !(std::fabs(s.distance(*centre) * side.side - d) <= slack)) {
            return fail(ErrorCode::bad_argument,
                        "no ball touches all faces of " + name_of(body, corner),
                        "blend only two of these edges, chosen with `near` or `where`");
        }
        to_contact.push_back(s.normal(*centre) * (sign * side.side));
    }
    if (auto added = add(ball_corner(to_contact, *centre, corner.point, corner.point - *centre,
                                     form.radius, span));
        !added)
        return Failure(std::move(added).error());
    return out;
}

}  // namespace raymo::blends
