#include "raymo/blends/corner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "raymo/blends/vertex.hpp"
#include "raymo/math/tolerance.hpp"

namespace raymo::blends {
namespace {

/// All edges of one kind that end in one place.
struct Junction {
    Vec3 point;
    bool is_convex = true;
    std::vector<Corner::Edge> edges;
    std::vector<Corner::Side> sides;
    std::vector<std::array<std::size_t, 2>> between;  ///< sides, of each edge
    std::vector<std::size_t> within;                  ///< segments that begin and end here
};

/// The normal of a side, out of the solid.
Vec3 outward(const Body& body, const Corner::Side& side, Vec3 at) {
    return surface_of(body, side).normal(at) * side.side;
}

/// The number of a side, which is appended if it is new. A plane is two where the solid touches it from both sides.
std::size_t number_of(const Body& body, Junction& junction, Corner::Side side) {
    const Vec3 at = junction.point;
    const auto is_same = [&](const Corner::Side& other) {
        return is_same_surface(body, other.face, side.face, at) &&
               dot(outward(body, other, at), outward(body, side, at)) > 0.0;
    };
    const auto found = std::find_if(junction.sides.begin(), junction.sides.end(), is_same);
    if (found != junction.sides.end())
        return static_cast<std::size_t>(found - junction.sides.begin());
    junction.sides.push_back(side);
    return junction.sides.size() - 1;
}

/// Numbers of places, one for each two ends: ends that are the same by way of others are, too. Sectors are looked at 2^-14 of a
/// stretch's length beside it, so edges shorter than some 2^20 times roundings can not be seen. `factor`: how much farther apart ends
/// of one place may be.
std::vector<std::size_t> places_of(const Body& body, const std::vector<Segment>& segments,
                                   double radius, double factor) {
    std::vector<std::size_t> first(2 * segments.size());
    std::vector<std::size_t> order;
    const auto point = [&](std::size_t i) { return segments[i / 2].ends[i % 2].point; };
    double most = 0.0;
    for (std::size_t i = 0; i < first.size(); ++i) {
        first[i] = i;
        if (segments[i / 2].is_closed) continue;
        order.push_back(i);
        most =
            std::max(most, factor * std::max(0x1p-23 * radius, 0x1p20 * slack_of(body, point(i))));
    }
    const auto root = [&](std::size_t i) {
        while (first[i] != i) i = first[i] = first[first[i]];
        return i;
    };
    // Ends of one place are neighbours along x.
    std::sort(order.begin(), order.end(),
              [&](std::size_t i, std::size_t k) { return point(i).x < point(k).x; });
    for (std::size_t i = 0; i < order.size(); ++i) {
        const Vec3 here = point(order[i]);
        const bool is_convex = segments[order[i] / 2].is_convex;
        for (std::size_t k = i; k-- > 0 && here.x - point(order[k]).x <= most;) {
            if (segments[order[k] / 2].is_convex != is_convex) continue;
            const Vec3 there = point(order[k]);
            if (is_same_place(here, there, factor * radius) ||
                norm(here - there) <= factor * 0x1p20 * slack_of(body, here)) {
                first[root(order[i])] = root(order[k]);
            }
        }
    }
    for (std::size_t i = 0; i < first.size(); ++i) first[i] = root(i);
    return first;
}

constexpr Sectors kAll = 0xf;

/// `with_unknown`: also of edges of which it is not known what is beyond them.
std::vector<Junction> junctions_of(const Body& body, const std::vector<Segment>& segments,
                                   const std::vector<std::size_t>& places, bool with_unknown) {
    std::vector<std::size_t> number(places.size(), places.size());
    std::vector<Junction> out;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Segment& s = segments[i / 2];
        if (s.is_closed) continue;
        std::size_t& at = number[places[i]];
        if (at == places.size()) {
            at = out.size();
            out.push_back({s.ends[i % 2].point, s.is_convex, {}, {}, {}, {}});
        }
        Junction& junction = out[at];
        if (places[i] == places[i ^ 1U]) {
            // Shorter than places are told apart by: it leads nowhere.
            junction.within.push_back(i / 2);
        } else if (s.ends[i % 2].beyond == kAll ||
                   (with_unknown && s.ends[i % 2].beyond == kUnknownSectors)) {
            junction.edges.push_back({i / 2, i % 2});
            const std::size_t a = number_of(body, junction, {s.face_a, s.edge.a.side});
            const std::size_t b = number_of(body, junction, {s.face_b, s.edge.b.side});
            junction.between.push_back({a, b});
        }
    }
    return out;
}

/// The rings of sides, each between two edges. False where a side has not two edges.
bool append_rings(const Junction& junction, std::vector<Corner>& out) {
    const std::size_t count = junction.sides.size();
    std::vector<std::vector<std::size_t>> edges_of(count);
    for (std::size_t e = 0; e < junction.edges.size(); ++e) {
        for (const std::size_t side : junction.between[e]) edges_of[side].push_back(e);
    }
    if (std::any_of(edges_of.begin(), edges_of.end(),
                    [](const auto& edges) { return edges.size() != 2; })) {
        return false;
    }
    std::vector<bool> is_done(junction.edges.size());
    for (std::size_t start = 0; start < junction.edges.size(); ++start) {
        if (is_done[start]) continue;
        Corner corner{junction.point, junction.is_convex, {}, {}};
        std::size_t edge = start;
        std::size_t side = junction.between[start][0];
        while (!is_done[edge]) {
            is_done[edge] = true;
            corner.sides.push_back(junction.sides[side]);
            corner.edges.push_back(junction.edges[edge]);
            const auto& between = junction.between[edge];
            side = between[0] == side ? between[1] : between[0];
            edge = edges_of[side][0] == edge ? edges_of[side][1] : edges_of[side][0];
        }
        // Two faces that meet in two curves leave nothing between their wedges.
        if (corner.sides.size() > 2) out.push_back(std::move(corner));
    }
    return true;
}

/// Sides that are one surface seen from both sides count once.
std::vector<Corner::Side> surfaces_of(const Body& body, const Junction& junction) {
    std::vector<Corner::Side> out;
    for (const Corner::Side& side : junction.sides) {
        if (std::none_of(out.begin(), out.end(), [&](const Corner::Side& other) {
                return is_same_surface(body, other.face, side.face, junction.point);
            })) {
            out.push_back(side);
        }
    }
    return out;
}

/// All corners, and what is known of their edges.
struct Rings {
    std::vector<Corner> corners;
    std::vector<std::size_t> within;  ///< segments that begin and end in one of them
    std::vector<Corner::Edge> edges;  ///< of those that are rings
    std::optional<Junction> open;     ///< where more than three faces are none, if anywhere
};
Rings rings_of(const Body& body, const std::vector<Segment>& segments, double radius,
               double factor) {
    Rings out;
    const std::vector<std::size_t> places = places_of(body, segments, radius, factor);
    std::vector<bool> is_known(places.size());
    // Next to edges that are hardly longer than roundings it can not be seen what is beyond others, but where all are
    // there it is known.
    for (const Junction& junction : junctions_of(body, segments, places, true)) {
        if (junction.edges.size() < 3 || !append_rings(junction, out.corners)) continue;
        out.within.insert(out.within.end(), junction.within.begin(), junction.within.end());
        out.edges.insert(out.edges.end(), junction.edges.begin(), junction.edges.end());
        for (const Corner::Edge& edge : junction.edges)
            is_known[places[2 * edge.segment + edge.end]] = true;
    }
    for (Junction& junction : junctions_of(body, segments, places, false)) {
        if (junction.edges.size() < 3) continue;
        const Corner::Edge& edge = junction.edges[0];
        if (is_known[places[2 * edge.segment + edge.end]]) continue;
        Corner corner{junction.point, junction.is_convex, surfaces_of(body, junction), {}};
        if (corner.sides.size() > 3) out.open = std::move(junction);
        // Three faces are a ring however often they meet.
        else if (corner.sides.size() == 3)
            out.corners.push_back(std::move(corner));
    }
    return out;
}

/// Along an edge of a corner, away from it.
Vec3 away(const std::vector<Segment>& segments, const Corner::Edge& edge) {
    const Segment& s = segments[edge.segment];
    return s.tangent(s.ends[edge.end].at) * (edge.end == 0 ? 1.0 : -1.0);
}

/// Looks along the edges of a corner.
void orient(const std::vector<Segment>& segments, Corner& corner) {
    corner.away = away(segments, corner.edges[0]);
    corner.middle = {};
    for (const Corner::Edge& edge : corner.edges)
        corner.middle = corner.middle + away(segments, edge);
    corner.middle = unit(corner.middle);
}

void set_rests(std::vector<Segment>& segments, const Corner& corner, const InnerCorner& inner) {
    for (std::size_t i = 0; i < corner.edges.size(); ++i) {
        const Corner::Edge& edge = corner.edges[i];
        const InnerCorner::Vertex& vertex = inner.vertices[inner.first[i]];
        End& end = segments[edge.segment].ends[edge.end];
        end.rest = dot(corner.point + vertex.at - end.point, away(segments, edge));
        for (const std::size_t plane : vertex.planes) {
            if (plane != i && plane != (i + 1) % corner.sides.size())
                end.rest_face = corner.sides[plane].face;
        }
    }
}

/// Two corners that share an edge, as one: around the one and then around the other. Empty where that is no ring.
std::optional<Corner> joined(const Body& body, const std::vector<Segment>& segments,
                             const Corner& one, Corner other, std::size_t segment) {
    const auto place_of = [&](const Corner& corner) {
        const auto found = std::find_if(corner.edges.begin(), corner.edges.end(),
                                        [&](const auto& e) { return e.segment == segment; });
        return static_cast<std::size_t>(found - corner.edges.begin());
    };
    const auto is_same = [&](const Corner::Side& a, const Corner::Side& b) {
        return is_same_surface(body, a.face, b.face, one.point) &&
               dot(outward(body, a, one.point), outward(body, b, one.point)) > 0.0;
    };
    // Both rings from behind the edge on to before it, and the other one the other way round.
    const auto open_at_edge = [&](Corner& corner) {
        const auto next = static_cast<std::ptrdiff_t>(place_of(corner)) + 1;
        std::rotate(corner.sides.begin(), corner.sides.begin() + next, corner.sides.end());
        std::rotate(corner.edges.begin(), corner.edges.begin() + next, corner.edges.end());
        corner.edges.pop_back();
    };
    Corner out = one;
    open_at_edge(out);
    if (is_same(other.sides[place_of(other)], out.sides.back())) {
        // Edges are between sides i and i + 1.
        std::reverse(other.sides.begin(), other.sides.end());
        std::reverse(other.edges.begin(), other.edges.end());
        std::rotate(other.edges.begin(), other.edges.begin() + 1, other.edges.end());
    }
    open_at_edge(other);
    if (!is_same(other.sides.front(), out.sides.back()) ||
        !is_same(other.sides.back(), out.sides.front())) {
        return std::nullopt;
    }
    out.edges.insert(out.edges.end(), other.edges.begin(), other.edges.end());
    out.sides.insert(out.sides.end(), other.sides.begin() + 1, other.sides.end() - 1);
    for (std::size_t i = 0; i < out.sides.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            if (is_same(out.sides[i], out.sides[k]) ||
                out.edges[i].segment == out.edges[k].segment) {
                return std::nullopt;
            }
        }
    }
    orient(segments, out);
    return out;
}

/// Tells all segments where balls rest, and joins corners whose edges are used up.
void roll(const Body& body, std::vector<Segment>& segments, std::vector<Corner>& corners,
          double radius) {
    constexpr std::size_t kNone = ~std::size_t{0};
    std::vector<std::array<std::size_t, 2>> corner_of(segments.size(), {kNone, kNone});
    const auto settle = [&](std::size_t i, const InnerCorner& inner) {
        set_rests(segments, corners[i], inner);
        for (const Corner::Edge& edge : corners[i].edges) corner_of[edge.segment][edge.end] = i;
    };
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (!is_of_planes(body, corners[i])) continue;
        if (const auto inner = inner_of(body, corners[i], radius)) settle(i, *inner);
    }
    // What is used up most of all comes first; after that others may be free, or be used up in turn.
    for (bool is_changed = true; is_changed;) {
        is_changed = false;
        std::vector<std::size_t> used;
        for (std::size_t i = 0; i < segments.size(); ++i) {
            const auto [a, b] = corner_of[i];
            if (!segments[i].is_used_up && a != kNone && b != kNone && segments[i].rolled() < 0.0)
                used.push_back(i);
        }
        std::sort(used.begin(), used.end(), [&](std::size_t i, std::size_t k) {
            const double d = segments[i].rolled() - segments[k].rolled();
            return d != 0.0 ? d < 0.0 : i < k;
        });
        for (const std::size_t i : used) {
            const auto [a, b] = corner_of[i];
            if (a == b || !(segments[i].rolled() < 0.0)) continue;
            auto corner = joined(body, segments, corners[a], corners[b], i);
            if (!corner) continue;
            const auto inner = inner_of(body, *corner, radius);
            if (!inner) continue;
            segments[i].is_used_up = true;
            corners[a] = *std::move(corner);
            corners[b].sides.clear();
            settle(a, *inner);
            is_changed = true;
        }
    }
    std::erase_if(corners, [](const Corner& corner) { return corner.sides.empty(); });
}

}  // namespace

const Surface& surface_of(const Body& body, const Corner::Side& side) {
    return body.faces()[side.face].surface;
}

double slack_of(const Body& body, Vec3 at) {
    const double size = max_norm(at) + max_norm(max(abs(body.box().lo), abs(body.box().hi)));
    return kPointError * size;
}

std::string place_text(Vec3 at, double grain) {
    const auto shown = [&](double x) { return std::fabs(x) <= grain ? 0.0 : x; };
    return fmt::format("({:g}, {:g}, {:g})", shown(at.x), shown(at.y), shown(at.z));
}

double sign_of(const Corner& corner) { return corner.is_convex ? 1.0 : -1.0; }

bool is_of_planes(const Body& body, const Corner& corner) {
    return !corner.edges.empty() &&
           std::all_of(corner.sides.begin(), corner.sides.end(), [&](const Corner::Side& side) {
               return surface_of(body, side).kind == SurfaceKind::plane;
           });
}
std::optional<InnerCorner> inner_of(const Body& body, const Corner& corner, double radius) {
    std::vector<CornerPlane> planes;
    for (const Corner::Side& side : corner.sides) {
        const Surface& s = surface_of(body, side);
        const double sign = sign_of(corner) * side.side;
        planes.push_back({s.axis * sign, -sign * s.distance(corner.point)});
    }
    return inner_corner(planes, corner.away, radius, slack_of(body, corner.point));
}

std::string name_of(const Body& body, const Corner& corner) {
    constexpr std::size_t kMost = 4;
    std::string names;
    const std::size_t count = corner.sides.size();
    const std::size_t told = count > kMost ? kMost - 1 : count;
    for (std::size_t i = 0; i < told; ++i) {
        if (i > 0) names += i + 1 == count ? " and " : ", ";
        names += body.name_of(body.faces()[corner.sides[i].face]);
    }
    if (told < count) names += fmt::format(" and {} others", count - told);
    return fmt::format("the corner at {}, where {} meet",
                       place_text(corner.point, slack_of(body, corner.point)), names);
}

Result<std::vector<Corner>> find_corners(const Body& body, std::vector<Segment>& segments,
                                         Profile profile, double radius) {
    for (Segment& segment : segments) {
        segment.is_used_up = false;
        for (End& end : segment.ends) {
            end.rest = 0.0;
            end.rest_face.reset();
        }
    }
    // Of several corners that are close to each other some may be one place, and others not: then all are tried as one. Corners
    // of planes may be one or not wherever they are, so this is no matter of how close they are.
    constexpr double kFarthest = 0x1p10;
    Rings rings = rings_of(body, segments, radius, 1.0);
    for (double factor = 4.0; rings.open && factor <= kFarthest; factor *= 4.0) {
        Rings again = rings_of(body, segments, radius, factor);
        if (!again.open) rings = std::move(again);
    }
    if (rings.open && profile == Profile::ball) {
        const Corner corner{
            rings.open->point, rings.open->is_convex, surfaces_of(body, *rings.open), {}};
        return fail(ErrorCode::bad_argument,
                    fmt::format("balls can not be rolled along {} edges of {}: only along all "
                                "of them, when they are of one kind, or along two",
                                rings.open->edges.size(), name_of(body, corner)),
                    "choose other edges with `near` or `where`");
    }
    for (const std::size_t i : rings.within) segments[i].is_used_up = true;
    for (const Corner::Edge& edge : rings.edges)
        segments[edge.segment].ends[edge.end].beyond = kAll;
    std::vector<Corner> out = std::move(rings.corners);
    for (Corner& corner : out) {
        if (!corner.edges.empty()) orient(segments, corner);
    }
    roll(body, segments, out, radius);
    return out;
}

}  // namespace raymo::blends
