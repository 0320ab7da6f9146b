// The common points of two surfaces with a common tangent plane are where, on one of them, the distance from the other is 0 and
// stands still. Boxes are halved in which both distances may be 0, which change no more than the place does, with
// normals that may be parallel, which turn no faster than the surfaces bend. From what is left Newton's method goes to where the distance
// stands still: with n_a = +-n_b there, and t two tangents, along which the normals differ at the rates of the relative curvature,
//     t_i.(n_b -+ n_a) + sum_k H_ik x_k = 0,  H_ik = t_i.(dn_b / dt_k -+ dn_a / dt_k).
// Where the surfaces touch along a curve H has a direction without curvature, in which nothing is to be done.
// Whether a point that is found is a crevice is asked above, below and all about it.
#include "raymo/blends/touching.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "raymo/blends/body.hpp"
#include "raymo/blends/corner.hpp"
#include "raymo/blends/segment.hpp"

namespace raymo::blends {
namespace {

/// Of the smaller leaf's size: a gap that is none, beside what rounding makes of the place.
constexpr double kMet = 0x1p-40;
/// Of that size: boxes that are not halved any more.
constexpr double kSmallestBox = 0x1p-5;
/// In smallest boxes: how far Newton's method may go from its start.
constexpr double kLongestWay = 8.0;
/// Of that size: the differences by which curvatures are told, and the last step of Newton's method. A gap is off by its square.
constexpr double kDifference = 0x1p-17;
constexpr double kLastStep = 0x1p-26;
/// Relative curvature times that size: what is curved less is flush. Far above what differences of normals are off by.
constexpr double kFlush = 0x1p-20;
/// Of that size: how far above and below a contact it is asked what is solid, and how far about it.
constexpr double kAcross = 0x1p-16;
constexpr double kAbout = 0x1p-7;
/// In slacks: how far off a face a point of its surface may be told to be.
constexpr double kOnFace = 64.0;
/// In slacks: how far apart faces are between which it can be asked what is solid.
constexpr double kParted = 1024.0;
/// In so many directions about a contact it is asked what is solid.
constexpr int kDirections = 8;
/// Of Newton's method, at most.
constexpr int kMostSteps = 24;
/// Places from which it is tried for two faces, at most: along all of a contact that is a curve.
constexpr int kMostStarts = 256;
/// What the search among all faces takes, at most, in units of some 100 ns.
constexpr double kMostWork = 2e6;

using FacePair = std::pair<std::size_t, std::size_t>;
FacePair pair_of(std::size_t a, std::size_t b) { return {std::min(a, b), std::max(a, b)}; }

class Search {
public:
    Search(const Body& body, std::optional<Edges> only, const std::function<bool(Vec3)>& chosen,
           const Spend& spend)
        : body_(body), only_(only), chosen_(chosen), spend_(spend) {}

    /// Where two faces touch.
    std::optional<Vec3> run(const Face& a, const Face& b) {
        const Leaf& first = body_.leaves()[a.leaf];
        const Leaf& second = body_.leaves()[b.leaf];
        const Aabb& within = body_.box();
        size_ = std::min(max_norm(overlap(first.near, within).size()),
                         max_norm(overlap(second.near, within).size()));
        const Aabb all = overlap(overlap(first.near, second.near), grown(within, kAcross * size_));
        if (all.empty()) return std::nullopt;
        int starts = 0;
        open_.assign(1, all);
        while (!open_.empty() && starts < kMostStarts &&
               go_on(a.surface.work() + b.surface.work())) {
            const Aabb box = open_.back();
            open_.pop_back();
            if (!may_touch(a.surface, b.surface, box)) continue;
            const Vec3 sides = box.size();
            if (max_norm(sides) > kSmallestBox * size_) {
                halve(box, sides);
                continue;
            }
            ++starts;
            const auto p = settle(a.surface, b.surface, box.centre());
            if (p && is_crevice(a, b, *p) && chosen_(*p)) return p;
        }
        return std::nullopt;
    }

    [[nodiscard]] bool is_cancelled() const { return is_cancelled_; }
    [[nodiscard]] bool is_cut_short() const { return work_ > kMostWork; }

private:
    bool go_on(double work) {
        work_ += work;
        is_cancelled_ = is_cancelled_ || (spend_ && !spend_(work));
        return !is_cancelled_ && !is_cut_short();
    }

    void halve(const Aabb& box, Vec3 sides) {
        int axis = 0;
        for (int i = 1; i < 3; ++i) {
            if (sides[i] > sides[axis]) axis = i;
        }
        const double middle = box.centre()[axis];
        Aabb one = box;
        Aabb other = box;
        one.hi[axis] = other.lo[axis] = middle;
        open_.push_back(one);
        open_.push_back(other);
    }

    /// What may be off about a distance of 0.
    [[nodiscard]] double slack(Vec3 p) const { return kMet * size_ + slack_of(body_, p); }

    [[nodiscard]] bool may_touch(const Surface& a, const Surface& b, const Aabb& box) const {
        const Vec3 p = box.centre();
        const double way = 0.5 * norm(box.size()) + slack(p);
        const double from_a = a.distance(p);
        const double from_b = b.distance(p);
        if (!(std::fabs(from_a) <= way) || !(std::fabs(from_b) <= way)) return false;
        const double turn = way / a.least_round(p) + way / b.least_round(p);
        if (!(turn < 1.0)) return true;
        const Vec3 n = a.normal(p);
        const double sine = norm(cross(n, b.normal(p)));
        if (sine > turn) return false;
        // On a the distance from b changes no faster than the normals differ, up to twice as far away.
        return std::fabs(b.distance(p - n * from_a)) <= 2.0 * way * (sine + 4.0 * turn) + slack(p);
    }

    /// Goes to where the distance from b stands still on a, and is 0.
    std::optional<Vec3> settle(const Surface& a, const Surface& b, Vec3 p) {
        const Vec3 start = p;
        const double h = kDifference * size_;
        for (int i = 0; i < kMostSteps; ++i) {
            if (!go_on(4.0 * (a.work() + b.work()))) return std::nullopt;
            const Vec3 n = a.normal(p);
            p = p - n * a.distance(p);
            const double way = dot(n, b.normal(p)) < 0.0 ? -1.0 : 1.0;
            Vec3 u, v;
            make_frame(n, u, v);
            const auto apart = [&](Vec3 q) { return b.normal(q) - a.normal(q) * way; };
            const Vec3 here = apart(p);
            const Vec3 along_u = (apart(p + u * h) - apart(p - u * h)) * (0.5 * size_ / h);
            const Vec3 along_v = (apart(p + v * h) - apart(p - v * h)) * (0.5 * size_ / h);
            // The principal directions of the relative curvature, and what is to be done along each.
            const double uu = dot(u, along_u);
            const double vv = dot(v, along_v);
            const double uv = 0.5 * (dot(u, along_v) + dot(v, along_u));
            const double turn = 0.5 * std::atan2(2.0 * uv, uu - vv);
            const double mean = 0.5 * (uu + vv);
            const double deviation = std::hypot(0.5 * (uu - vv), uv);
            const Vec3 first = u * std::cos(turn) + v * std::sin(turn);
            bool is_flush = true;
            Vec3 step;
            for (const auto& [axis, bend] : {std::pair(first, mean + deviation),
                                             std::pair(cross(n, first), mean - deviation)}) {
                if (!(std::fabs(bend) > kFlush)) continue;
                is_flush = false;
                // Beside a contact that is a curve the valley along it bends a little, too.
                step += axis *
                        (std::clamp(-dot(axis, here) / bend, -kSmallestBox, kSmallestBox) * size_);
            }
            if (is_flush) return std::nullopt;
            p = p + step;
            if (!is_finite(p) || norm(p - start) > kLongestWay * kSmallestBox * size_)
                return std::nullopt;
            if (norm(step) <= kLastStep * size_) break;
        }
        p = p - a.normal(p) * a.distance(p);
        const bool is_met = std::fabs(b.distance(p)) <= slack(p) &&
                            norm(cross(a.normal(p), b.normal(p))) <= kSmooth;
        return is_met ? std::optional(p) : std::nullopt;
    }

    /// Whether both faces are all about p and what is between them is unlike what is above and below: a crevice of the solid, or a
    /// wall that ends in nothing.
    bool is_crevice(const Face& a, const Face& b, Vec3 p) {
        if (!go_on((2.0 + kDirections) * body_.where_work())) return false;
        const Vec3 n = a.surface.normal(p);
        const solids::Where one = body_.where(p + n * (kAcross * size_));
        if (one == solids::Where::on || body_.where(p - n * (kAcross * size_)) != one) return false;
        if (only_ && (*only_ == Edges::concave) != (one == solids::Where::in)) return false;
        Vec3 u, v;
        make_frame(n, u, v);
        bool is_open = false;
        for (int i = 0; i < kDirections; ++i) {
            const double turn = 2.0 * std::numbers::pi * (i + 0.5) / kDirections;
            const Vec3 q = p + (u * std::cos(turn) + v * std::sin(turn)) * (kAbout * size_);
            const Vec3 on_a = q - a.surface.normal(q) * a.surface.distance(q);
            const Vec3 on_b = q - b.surface.normal(q) * b.surface.distance(q);
            // A face's surface goes on beyond it, as another's may do that belongs to the same solid.
            const double margin = kOnFace * slack(q);
            if (!body_.is_on(a, on_a, margin) || !body_.is_on(b, on_b, margin)) return false;
            // Along a contact that is a curve the faces do not part.
            if (norm(on_a - on_b) <= kParted * slack(q)) continue;
            const solids::Where between = body_.where((on_a + on_b) * 0.5);
            if (between == one || between == solids::Where::on) return false;
            is_open = true;
        }
        return is_open;
    }

    const Body& body_;
    std::optional<Edges> only_;
    const std::function<bool(Vec3)>& chosen_;
    const Spend& spend_;
    double size_ = 1.0;  ///< of the smaller leaf of those looked at
    double work_ = 0.0;
    bool is_cancelled_ = false;
    std::vector<Aabb> open_;
};

}  // namespace

Result<std::optional<Touching>> find_touching(const Body& body, bool within_operands,
                                              std::optional<Edges> only,
                                              const std::vector<Segment>& edges,
                                              const std::function<bool(Vec3)>& chosen,
                                              const Spend& spend) {
    std::vector<FacePair> joined;
    joined.reserve(edges.size());
    for (const Segment& edge : edges) joined.push_back(pair_of(edge.face_a, edge.face_b));
    std::sort(joined.begin(), joined.end());

    Search search(body, only, chosen, spend);
    const std::vector<Leaf>& leaves = body.leaves();
    for (std::size_t l = 0; l < leaves.size(); ++l) {
        for (std::size_t k = l + 1; k < leaves.size(); ++k) {
            const Leaf& first = leaves[l];
            const Leaf& second = leaves[k];
            if (!within_operands && first.operand == second.operand) continue;
            // What was blended is next to its blend as it should be.
            if (within_operands && (first.is_blend || second.is_blend)) continue;
            if (overlap(first.near, second.near).empty()) continue;
            for (std::size_t i = first.first_face; i < first.first_face + first.face_count; ++i) {
                for (std::size_t j = second.first_face; j < second.first_face + second.face_count;
                     ++j) {
                    const Face& a = body.faces()[i];
                    const Face& b = body.faces()[j];
                    if (a.surface.kind == SurfaceKind::plane &&
                        b.surface.kind == SurfaceKind::plane)
                        continue;
                    if (std::binary_search(joined.begin(), joined.end(), pair_of(i, j))) continue;
                    if (const auto p = search.run(a, b)) return std::optional(Touching{i, j, *p});
                    if (search.is_cancelled()) return fail(ErrorCode::cancelled, "stopped");
                    if (search.is_cut_short()) return std::optional<Touching>();
                }
            }
        }
    }
    return std::optional<Touching>();
}

}  // namespace raymo::blends
