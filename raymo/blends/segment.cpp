#include "raymo/blends/segment.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <numbers>

namespace raymo::blends {
namespace {

using solids::Where;

constexpr double kTurn = 2.0 * std::numbers::pi;
/// In steps: how far from an edge it is looked into its sectors, at most.
constexpr double kMostAside = 64.0;

/// Of places that are on neither leaf: not asked for.
constexpr Sectors kFarSectors = 0x40;

/// Faces at which an edge is crossed, by parameter.
struct Mark {
    double at;
    std::size_t face;
};

class Search {
public:
    Search(const Body& body, bool within_operands, double reach)
        : body_(body), within_operands_(within_operands), reach_(reach) {}

    Result<std::vector<Segment>> run(const Spend& spend) {
        const auto& leaves = body_.leaves();
        for (std::size_t p = 0; p < leaves.size(); ++p) {
            for (std::size_t q = p; q < leaves.size(); ++q) {
                if (!within_operands_ && leaves[p].operand == leaves[q].operand) continue;
                if (overlap(overlap(leaves[p].near, leaves[q].near), grown(body_.box(), reach_))
                        .empty()) {
                    continue;
                }
                work_ = 1.0;
                pairs(leaves[p], leaves[q]);
                if (spend && !spend(work_)) return fail(ErrorCode::cancelled, "stopped");
            }
        }
        return std::move(segments_);
    }

private:
    [[nodiscard]] const Leaf& leaf_of(std::size_t face) const {
        return body_.leaves()[body_.faces()[face].leaf];
    }

    void pairs(const Leaf& p, const Leaf& q) {
        for (std::size_t i = p.first_face; i < p.first_face + p.face_count; ++i) {
            const std::size_t first = &p == &q ? i + 1 : q.first_face;
            for (std::size_t k = first; k < q.first_face + q.face_count; ++k) pair(i, k);
        }
    }

    void pair(std::size_t i, std::size_t k) {
        const Leaf& p = leaf_of(i);
        const Leaf& q = leaf_of(k);
        const double margin = 0x1p-20 * reach_;
        const Aabb box = grown(body_.box(), margin);
        const Aabb shared = overlap(overlap(grown(p.box, margin), grown(q.box, margin)), box);
        if (shared.empty()) return;
        const Meeting meeting = meeting_of(body_.faces()[i].surface, body_.faces()[k].surface);
        if (meeting.is_general) {
            // And beyond both leaves, by what an edge may have to be run on.
            for (const SpaceEdgePtr& edge :
                 space_edges(body_.faces()[i].surface, body_.faces()[k].surface,
                             grown(shared, 4.0 * reach_))) {
                along_space(edge, i, k);
            }
        }
        for (const EdgeCurve& edge : meeting.edges) along(edge, i, k, box);
    }

    /// Which sectors about a point are solid, by the two natural outward normals there; of the whole body, or of an operand.
    static constexpr std::size_t kBody = ~std::size_t{0};
    [[nodiscard]] Sectors sectors(Vec3 at, Vec3 na, Vec3 nb, double step,
                                  std::size_t operand) const {
        Sectors out = 0;
        for (unsigned sector = 0; sector < 4; ++sector) {
            const double sa = (sector & 2U) != 0 ? -1.0 : 1.0;
            const double sb = (sector & 1U) != 0 ? -1.0 : 1.0;
            const Vec3 w = na * sa + nb * sb;
            // Along the bisector, as far from both as the step; nearer where the sector is narrow, for it may be short, too.
            const double sine = std::fabs(dot(w, na)) / norm(w);
            const double far = std::min(step / sine, kMostAside * step);
            const auto where_at = [&](Vec3 way) {
                const Vec3 p = at + way * far;
                return operand == kBody ? body_.where(p) : body_.where_in_operand(operand, p);
            };
            const Vec3 middle = unit(w);
            Where where = where_at(middle);
            if (where == Where::on) {
                // Leaves may meet flush there, which is no boundary: both sides tell the same then.
                const double turn = 0.25 * std::asin(std::min(sine, 1.0));
                const Vec3 beside = unit(na * sa - nb * sb) * std::sin(turn);
                where = where_at(middle * std::cos(turn) + beside);
                if (where_at(middle * std::cos(turn) - beside) != where) where = Where::on;
            }
            if (where == Where::on) return kUnknownSectors;
            if (where == Where::in) out = static_cast<Sectors>(out | (1U << sector));
        }
        return out;
    }
    /// How far from an edge it is looked at.
    [[nodiscard]] double step_beside(const EdgeCurve& edge, double most) const {
        double step = std::min(most, 0x1p-14 * reach_);
        for (const SectionCurve* c : {&edge.a, &edge.b}) {
            if (!c->is_line)
                step = std::min(step, 0x1p-14 * (c->run ? c->run->grain() : c->radius));
        }
        return edge.is_circle ? std::min(step, 0x1p-14 * edge.at.x) : step;
    }
    [[nodiscard]] Sectors sectors(const EdgeCurve& edge, double t, std::size_t operand = kBody,
                                  double most = Aabb::kInf) const {
        return sectors(edge.point(t), edge.turn(edge.a.outward(edge.at), t),
                       edge.turn(edge.b.outward(edge.at), t), step_beside(edge, most), operand);
    }

    /// Whether the sector that is unlike the others ends at both faces. It may end before one of them, or go on behind it, at
    /// a third face through the same edge.
    [[nodiscard]] bool is_bounded(const Segment& segment, unsigned sector, bool is_solid) const {
        const EdgeCurve& edge = segment.edge;
        const double t = segment.middle();
        const Vec3 at = edge.point(t);
        const double sa = (sector & 2U) != 0 ? -1.0 : 1.0;
        const double sb = (sector & 1U) != 0 ? -1.0 : 1.0;
        const Vec3 a = edge.turn(edge.a.outward(edge.at), t) * sa;
        const Vec3 b = edge.turn(edge.b.outward(edge.at), t) * sb;
        const double sine = norm(cross(a, b));
        if (sine < 0x1p-8) return true;
        const double turn = 0x1p-4 * sine;
        const double far = step_beside(edge, 0x1p-14 * (segment.hi - segment.lo) * edge.speed());
        for (const auto& [face, other] : {std::pair(a, b), std::pair(b, a)}) {
            const Vec3 within = unit(other - face * dot(other, face)) * std::cos(turn);
            for (const double side : {1.0, -1.0}) {
                const Where where =
                    body_.where(at + (within + face * (side * std::sin(turn))) * far);
                if (where == Where::on) continue;
                if ((where == Where::in) != (is_solid == (side > 0.0))) return false;
            }
        }
        return true;
    }
    [[nodiscard]] Sectors sectors(const SpaceEdge& edge, std::size_t i, std::size_t k, double t,
                                  std::size_t operand = kBody) const {
        const Vec3 p = edge.point(t);
        const double step = 0x1p-14 * std::min(reach_, edge.step_at(t));
        return sectors(p, body_.faces()[i].surface.normal(p), body_.faces()[k].surface.normal(p),
                       step, operand);
    }

    void along(const EdgeCurve& edge, std::size_t i, std::size_t k, const Aabb& box) {
        const Vec2 na = edge.a.outward(edge.at);
        const Vec2 nb = edge.b.outward(edge.at);
        if (std::fabs(cross(na, nb)) < kSmooth) return;
        double lo = 0.0;
        double hi = kTurn;
        if (!edge.is_circle && !clip(edge, box, lo, hi)) return;
        marks_.clear();
        std::vector<double> crossings;
        const Aabb reach = box_of(edge, lo, hi);
        for (std::size_t f = 0; f < body_.faces().size(); ++f) {
            if (f == i || f == k || overlap(leaf_of(f).near, reach).empty()) continue;
            crossings.clear();
            work_ += 4.0;
            append_crossings(edge, edge.at, body_.faces()[f].surface, lo, hi, crossings);
            // A surface goes on beyond the face, where nothing of it is met.
            for (const double at : crossings) {
                if (body_.is_on(body_.faces()[f], edge.point(at), 0x1p-20 * reach_))
                    marks_.push_back({at, f});
            }
        }
        std::sort(marks_.begin(), marks_.end(),
                  [](const Mark& a, const Mark& b) { return a.at < b.at; });
        // Stretches between marks, each with its sectors; marks closer than their own errors are one.
        const double tiny = 0x1p-30 * reach_ / edge.speed();
        struct Stretch {
            double lo, hi;
            Sectors sectors;
        };
        std::vector<Stretch> stretches;
        double from = lo;
        const auto add = [&](double to) {
            if (!(to - from > tiny)) return;
            // In a short stretch surfaces that go apart slowly are not far apart yet.
            const double step = 0x1p-14 * (to - from) * edge.speed();
            const Sectors now = sectors(edge, 0.5 * (from + to), kBody, step);
            if (!stretches.empty() && stretches.back().sectors == now) {
                stretches.back().hi = to;
            } else {
                stretches.push_back({from, to, now});
            }
            from = to;
        };
        if (!is_edge_somewhere(edge, i, k, lo, hi)) return;
        for (const Mark& mark : marks_) add(mark.at);
        add(hi);
        if (stretches.empty()) return;
        const std::size_t n = stretches.size();
        if (edge.is_circle) {
            if (n == 1) {
                Segment segment;
                segment.is_closed = true;
                segment.lo = 0.0;
                segment.hi = kTurn;
                segment.edge = edge;
                if (orient(stretches[0].sectors, i, k, segment)) keep(std::move(segment));
                return;
            }
            if (stretches.front().sectors == stretches.back().sectors) {
                stretches.front().lo = stretches.back().lo - kTurn;
                stretches.pop_back();
            }
        }
        const std::size_t m = stretches.size();
        for (std::size_t s = 0; s < m; ++s) {
            Segment segment;
            segment.lo = stretches[s].lo;
            segment.hi = stretches[s].hi;
            segment.edge = edge;
            if (!orient(stretches[s].sectors, i, k, segment)) continue;
            const bool ring = edge.is_circle;
            const Sectors before =
                s > 0 ? stretches[s - 1].sectors : (ring ? stretches[m - 1].sectors : Sectors{0});
            const Sectors after =
                s + 1 < m ? stretches[s + 1].sectors : (ring ? stretches[0].sectors : Sectors{0});
            set_end(segment, 0, segment.lo, before, tiny);
            set_end(segment, 1, segment.hi, after, tiny);
            keep(std::move(segment));
        }
    }

    /// Whether both faces' leaves have their boundaries in the middle of one of the stretches: most pairs have not.
    bool is_edge_somewhere(const EdgeCurve& edge, std::size_t i, std::size_t k, double lo,
                           double hi) {
        double from = lo;
        for (std::size_t m = 0; m <= marks_.size(); ++m) {
            const double to = m < marks_.size() ? marks_[m].at : hi;
            const Vec3 p = edge.point(0.5 * (from + to));
            work_ += 1.0;
            if (body_.is_on(body_.faces()[i], p) && body_.is_on(body_.faces()[k], p)) {
                work_ += static_cast<double>(marks_.size() * body_.leaves().size());
                return true;
            }
            from = to;
        }
        return false;
    }

    static Aabb box_of(const EdgeCurve& edge, double lo, double hi) {
        Aabb box;
        if (!edge.is_circle) {
            box.include(edge.point(lo));
            box.include(edge.point(hi));
            return box;
        }
        box.include(edge.place({0.0, edge.at.y}, 0.0));
        return grown(box, edge.at.x);
    }

    /// The part of a line within a box.
    static bool clip(const EdgeCurve& edge, const Aabb& box, double& lo, double& hi) {
        lo = -Aabb::kInf;
        hi = Aabb::kInf;
        const Vec3 p = edge.point(0.0);
        for (int axis = 0; axis < 3; ++axis) {
            const double d = edge.along[axis];
            const double a = box.lo[axis] - p[axis];
            const double b = box.hi[axis] - p[axis];
            if (d == 0.0) {
                if (a > 0.0 || b < 0.0) return false;
                continue;
            }
            lo = std::max(lo, std::min(a / d, b / d));
            hi = std::min(hi, std::max(a / d, b / d));
        }
        return lo < hi;
    }

    /// Whether at every place one of the two operands has the same edge by itself, as where their faces are flush. The places
    /// are none where two alike operands would have their seam.
    [[nodiscard]] bool is_old(const Segment& segment, Sectors now, std::size_t i,
                              std::size_t k) const {
        for (const double part : {0.137, 0.371, 0.629, 0.863}) {
            const double t = segment.lo + part * (segment.hi - segment.lo);
            bool is_own = false;
            for (const std::size_t face : {i, k}) {
                const std::size_t operand = leaf_of(face).operand;
                is_own |= (segment.space ? sectors(*segment.space, i, k, t, operand)
                                         : sectors(segment.edge, t, operand)) == now;
            }
            if (!is_own) return false;
        }
        return true;
    }

    /// Turns the sides of a stretch's curves. False when it is no edge to blend.
    bool orient(Sectors sectors, std::size_t i, std::size_t k, Segment& segment) const {
        if (sectors == kUnknownSectors || sectors == kFarSectors) return false;
        // Another face in the same surface may be the one that bounds the solid here.
        const Vec3 middle = segment.point(segment.middle());
        if (!body_.is_on(body_.faces()[i], middle) || !body_.is_on(body_.faces()[k], middle))
            return false;
        const int solid = std::popcount(static_cast<unsigned>(sectors));
        if (solid != 1 && solid != 3) return false;
        if (!within_operands_ && is_old(segment, sectors, i, k)) return false;
        segment.is_convex = solid == 1;
        const unsigned odd = segment.is_convex ? sectors : (~sectors & 0xfU);
        const auto sector = static_cast<unsigned>(std::countr_zero(odd));
        if (!segment.space && !is_bounded(segment, sector, segment.is_convex)) return false;
        segment.face_a = i;
        segment.face_b = k;
        // The odd sector is the inner one of a convex edge, the outer one of a concave edge.
        const unsigned inner = segment.is_convex ? 1U : 0U;
        segment.edge.a.side = ((sector >> 1U) & 1U) == inner ? 1.0 : -1.0;
        segment.edge.b.side = (sector & 1U) == inner ? 1.0 : -1.0;
        return true;
    }

    void set_end(Segment& segment, std::size_t which, double at, Sectors beyond, double tiny) {
        End& end = segment.ends[which];
        end.at = at;
        end.point = segment.point(at);
        for (const Mark& mark : marks_) {
            double d = std::fabs(mark.at - at);
            if (!segment.space && segment.edge.is_circle) d = std::min(d, std::fabs(d - kTurn));
            if (d <= 4.0 * tiny) end.faces.push_back(mark.face);
        }
        if (beyond == kUnknownSectors || beyond == kFarSectors) {
            end.beyond = kUnknownSectors;
            return;
        }
        // By the turned sides, and for a convex edge of the complement.
        for (unsigned sector = 0; sector < 4; ++sector) {
            unsigned natural = sector;
            if (segment.edge.a.side < 0.0) natural ^= 2U;
            if (segment.edge.b.side < 0.0) natural ^= 1U;
            if (segment.is_convex) natural ^= 3U;
            const bool solid = ((beyond >> natural) & 1U) != 0;
            if (solid != segment.is_convex) {
                end.beyond = static_cast<Sectors>(end.beyond | (1U << sector));
            }
        }
    }

    /// The outward normal of a face by the turned side.
    [[nodiscard]] Vec3 outward(const Segment& s, std::size_t which, Vec3 at) const {
        const Surface& surface = body_.faces()[which == 0 ? s.face_a : s.face_b].surface;
        return surface.normal(at) * (which == 0 ? s.edge.a : s.edge.b).side;
    }

    /// Unless there is one already: of faces that lie in the same surface.
    void keep(Segment segment) {
        const Vec3 here = segment.point(segment.middle());
        segment.centre = here;
        work_ += 0.1 * static_cast<double>(segments_.size());
        const Vec3 n = outward(segment, 0, here);
        for (const Segment& other : segments_) {
            if (other.is_convex != segment.is_convex || !other.space != !segment.space) continue;
            if (segment.space ? !runs_through(other, here)
                              : !(norm(other.centre - here) <= 0x1p-30 * (reach_ + norm(here)))) {
                continue;
            }
            if (norm(n - outward(other, 0, here)) < kSmooth ||
                norm(n - outward(other, 1, here)) < kSmooth) {
                return;
            }
        }
        segments_.push_back(std::move(segment));
    }

    /// Whether a stretch along a curve in space holds a point: the same curve may have been followed from elsewhere.
    static bool runs_through(const Segment& segment, Vec3 p) {
        const auto t = segment.space->parameter_of(p);
        if (!t) return false;
        if (segment.is_closed) return true;
        const double turn = segment.space->is_closed() ? segment.space->last() : 0.0;
        for (const double at : {*t - turn, *t, *t + turn}) {
            if (at >= segment.lo && at <= segment.hi) return true;
        }
        return false;
    }

    /// Stretches of a curve in space: between its nodes nothing begins and ends unseen but what is shorter than a step.
    void along_space(const SpaceEdgePtr& edge, std::size_t i, std::size_t k) {
        const std::size_t n = edge->steps();
        const auto middle = [&](std::size_t s) {
            return 0.5 * (edge->node(s) + edge->node(s + 1));
        };
        // Most of a curve is on neither leaf; sectors are asked for where it is, and one step beyond.
        work_ += static_cast<double>(n) * 2.0;
        std::vector<bool> is_on(n);
        for (std::size_t s = 0; s < n; ++s) {
            const Vec3 p = edge->point(middle(s));
            const double margin = 0x1p-20 * reach_;
            is_on[s] = body_.is_on(body_.faces()[i], p, margin) &&
                       body_.is_on(body_.faces()[k], p, margin);
        }
        std::vector<Sectors> at(n, kFarSectors);
        for (std::size_t s = 0; s < n; ++s) {
            if (!is_on[s] && !is_on[(s + 1) % n] && !is_on[(s + n - 1) % n]) continue;
            at[s] = sectors(*edge, i, k, middle(s));
            work_ += static_cast<double>(body_.leaves().size());
        }
        const auto change = std::adjacent_find(at.begin(), at.end(), std::not_equal_to<>());
        if (change == at.end() && edge->is_closed()) {
            Segment segment;
            segment.space = edge;
            segment.is_closed = true;
            segment.hi = edge->last();
            if (orient(at[0], i, k, segment)) keep(std::move(segment));
            return;
        }
        // Closed ones are begun at a change.
        const std::size_t first =
            edge->is_closed() ? static_cast<std::size_t>(change - at.begin()) + 1 : 0;
        std::size_t from = 0;
        while (from < n) {
            std::size_t to = from + 1;
            while (to < n && at[(first + to) % n] == at[(first + from) % n]) ++to;
            const Sectors now = at[(first + from) % n];
            Segment segment;
            segment.space = edge;
            const bool open = !edge->is_closed();
            const Sectors before = open && from == 0 ? Sectors{0} : at[(first + from + n - 1) % n];
            const Sectors after = open && to == n ? Sectors{0} : at[(first + to) % n];
            // The step before the first one of a closed curve is its last.
            const std::size_t begin = first + from + (open ? 0 : n);
            const std::size_t end = first + to + (open ? 0 : n);
            const double turn = open ? 0.0 : edge->last();
            segment.lo = open && from == 0
                             ? 0.0
                             : between(*edge, i, k, middle(begin), middle(begin - 1), now) - turn;
            segment.hi = open && to == n
                             ? edge->last()
                             : between(*edge, i, k, middle(end - 1), middle(end), now) - turn;
            if (orient(now, i, k, segment)) {
                marks_.clear();
                segment.lo = mark_end(*edge, i, k, segment.lo);
                segment.hi = mark_end(*edge, i, k, segment.hi);
                set_end(segment, 0, segment.lo, before, 0x1p-10 * edge->step_at(segment.lo));
                set_end(segment, 1, segment.hi, after, 0x1p-10 * edge->step_at(segment.hi));
                keep(std::move(segment));
            }
            from = to;
        }
    }
    /// The end of a stretch to the last bits, with the faces there as marks. Sectors are asked for beside the curve, where an
    /// oblique face is met earlier or later than on it.
    double mark_end(const SpaceEdge& edge, std::size_t i, std::size_t k, double about) {
        const double slack = 0x1p-3 * edge.step_at(about);
        const Vec3 p = edge.point(about);
        double end = about;
        double off = Aabb::kInf;
        const auto is_candidate = [&](std::size_t f) {
            return f != i && f != k && std::fabs(body_.faces()[f].surface.distance(p)) <= slack &&
                   body_.is_on(body_.faces()[f], p, slack);
        };
        for (std::size_t f = 0; f < body_.faces().size(); ++f) {
            if (!is_candidate(f)) continue;
            const Surface& surface = body_.faces()[f].surface;
            const auto distance = [&](double t) { return surface.distance(edge.point(t)); };
            double inner = about - slack;
            double outer = about + slack;
            if (!edge.is_closed()) {
                inner = std::max(inner, 0.0);
                outer = std::min(outer, edge.last());
            }
            const bool before = distance(inner) < 0.0;
            if ((distance(outer) < 0.0) == before) continue;
            for (int step = 0; step < 60; ++step) {
                const double middle = 0.5 * (inner + outer);
                ((distance(middle) < 0.0) == before ? inner : outer) = middle;
            }
            // A surface goes on beyond the face.
            if (std::fabs(inner - about) < off &&
                body_.is_on(body_.faces()[f], edge.point(inner), 0x1p-20 * reach_)) {
                off = std::fabs(inner - about);
                end = inner;
            }
        }
        const Vec3 at = edge.point(end);
        for (std::size_t f = 0; f < body_.faces().size(); ++f) {
            if (f == i || f == k) continue;
            const double d = std::fabs(body_.faces()[f].surface.distance(at));
            if (d <= 0x1p-24 * edge.step_at(end)) marks_.push_back({end, f});
        }
        return end;
    }

    /// Where the sectors, which are `now` at `inner`, cease to be so on the way to `outer`.
    double between(const SpaceEdge& edge, std::size_t i, std::size_t k, double inner, double outer,
                   Sectors now) const {
        for (int step = 0; step < 40; ++step) {
            const double middle = 0.5 * (inner + outer);
            (sectors(edge, i, k, middle) == now ? inner : outer) = middle;
        }
        return inner;
    }

    const Body& body_;
    bool within_operands_;
    double reach_;
    double work_ = 0.0;  ///< since it was last told
    std::vector<Mark> marks_;
    std::vector<Segment> segments_;
};

}  // namespace

double Segment::period() const { return space ? space->last() : kTurn; }

Result<std::vector<Segment>> find_segments(const Body& body, bool within_operands, double reach,
                                           const Spend& spend) {
    return Search(body, within_operands, reach).run(spend);
}

}  // namespace raymo::blends
