// The common points of two surfaces with a common tangent plane are where, on one of them, the distance from the other is 0 and
// stands still. Boxes are halved in which both distances may be 0, which change no more than the place does, with
// normals that may be parallel, which turn no faster than the surfaces bend. From what is left Newton's method goes to where the distance
// stands still: with n_a = +-n_b there, and t two tangents, along which the normals differ at the rates of the relative curvature,
//     t_i.(n_b -+ n_a) + sum_k H_ik x_k = 0,  H_ik = t_i.(dn_b / dt_k -+ dn_a / dt_k).
// Where the surfaces touch along a curve H has a direction without curvature, in which nothing is to be done.
#include "raymo/blends/touching.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "raymo/blends/body.hpp"
#include "raymo/blends/least_squares.hpp"
#include "raymo/blends/segment.hpp"

namespace raymo::blends {
namespace {

/// Of the body's size: gaps that are none,
constexpr double kMet = 0x1p-40;
/// how far from a face its leaf may be told to end,
constexpr double kMargin = 0x1p-34;
/// how far beside the face it is asked what is solid,
constexpr double kBeside = 0x1p-16;
/// and boxes that are not halved any more.
constexpr double kSmallestBox = 0x1p-5;
/// Of what a radius of the body's size is curved: what is curved less is flush.
constexpr double kFlush = 0x1p-20;
constexpr int kMostSteps = 24;
/// From where Newton's method is tried, at most.
constexpr int kMostStarts = 64;

using FacePair = std::pair<std::size_t, std::size_t>;
FacePair pair_of(std::size_t a, std::size_t b) { return {std::min(a, b), std::max(a, b)}; }

class Search {
public:
    Search(const Body& body, std::optional<Edges> only, const std::function<bool(Vec3)>& chosen,
           const Spend& spend)
        : body_(body),
          only_(only),
          chosen_(chosen),
          spend_(spend),
          size_(max_norm(body.box().size())) {}

    /// Where two faces touch.
    std::optional<Vec3> run(const Face& a, const Face& b) {
        const Aabb all =
            overlap(overlap(near_of(a), near_of(b)), grown(body_.box(), kMargin * size_));
        if (all.empty()) return std::nullopt;
        starts_ = 0;
        open_.assign(1, all);
        while (!open_.empty() && starts_ < kMostStarts &&
               go_on(a.surface.work() + b.surface.work())) {
            const Aabb box = open_.back();
            open_.pop_back();
            if (!may_touch(a.surface, b.surface, box)) continue;
            const Vec3 sides = box.size();
            if (max_norm(sides) > kSmallestBox * size_) {
                halve(box, sides);
                continue;
            }
            ++starts_;
            const auto p = settle(a.surface, b.surface, box.centre());
            if (p && counts(a, b, *p)) return p;
        }
        return std::nullopt;
    }

    [[nodiscard]] bool is_stopped() const { return is_stopped_; }

private:
    bool go_on(double work) {
        is_stopped_ = is_stopped_ || (spend_ && !spend_(work));
        return !is_stopped_;
    }

    [[nodiscard]] const Aabb& near_of(const Face& face) const {
        return body_.leaves()[face.leaf].near;
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

    [[nodiscard]] bool may_touch(const Surface& a, const Surface& b, const Aabb& box) const {
        const Vec3 p = box.centre();
        const double way = 0.5 * norm(box.size()) + kMet * size_;
        if (!(std::fabs(a.distance(p)) <= way) || !(std::fabs(b.distance(p)) <= way)) return false;
        const double turn = way / a.least_round(p) + way / b.least_round(p);
        return !(turn < 1.0) || norm(cross(a.normal(p), b.normal(p))) <= turn;
    }

    /// Goes to where the distance from b stands still on a, and is 0.
    std::optional<Vec3> settle(const Surface& a, const Surface& b, Vec3 p) {
        const double far = 8.0 * kSmallestBox * size_;
        const Vec3 start = p;
        // As small as differences of normals allow.
        const double h = 0x1p-17 * size_;
        for (int i = 0; i < kMostSteps; ++i) {
            if (!go_on(4.0 * (a.work() + b.work()))) return std::nullopt;
            const Vec3 n = a.normal(p);
            p = p - n * a.distance(p);
            const double way = dot(n, b.normal(p)) < 0.0 ? -1.0 : 1.0;
            const Vec3 u = unit(cross(n, std::fabs(n.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
            const Vec3 v = cross(n, u);
            const auto apart = [&](Vec3 q) { return b.normal(q) - a.normal(q) * way; };
            const Vec3 here = apart(p);
            const Vec3 along_u = (apart(p + u * h) - apart(p - u * h)) * (0.5 * size_ / h);
            const Vec3 along_v = (apart(p + v * h) - apart(p - v * h)) * (0.5 * size_ / h);
            const double curvature =
                std::max({std::fabs(dot(u, along_u)), std::fabs(dot(u, along_v)),
                          std::fabs(dot(v, along_v))});
            if (!(curvature > kFlush)) return std::nullopt;
            LeastSquares<2> conditions;
            for (const Vec3 t : {u, v})
                conditions.add({dot(t, along_u), dot(t, along_v), -dot(t, here)});
            const auto [x, y] = conditions.solved();
            const Vec3 step = (u * x + v * y) * size_;
            p = p + step;
            if (!is_finite(p) || norm(p - start) > far) return std::nullopt;
            // The gap is wrong by the square of what is left.
            if (norm(step) <= 0x1p-26 * size_) break;
        }
        p = p - a.normal(p) * a.distance(p);
        const bool is_met = std::fabs(b.distance(p)) <= kMet * size_ &&
                            norm(cross(a.normal(p), b.normal(p))) <= kFlush;
        return is_met ? std::optional(p) : std::nullopt;
    }

    /// Whether both faces are there, with a crevice between them or nothing.
    bool counts(const Face& a, const Face& b, Vec3 p) {
        const double margin = kMargin * size_;
        if (!body_.is_on(a, p, margin) || !body_.is_on(b, p, margin)) return false;
        go_on(2.0 * body_.where_work());
        const Vec3 aside = a.surface.normal(p) * (kBeside * size_);
        const solids::Where one = body_.where(p + aside);
        if (one == solids::Where::on || body_.where(p - aside) != one) return false;
        // What lies behind both, as in a third solid, does not show.
        if (body_.where(p) != solids::Where::on) return false;
        if (only_ && (*only_ == Edges::concave) != (one == solids::Where::in)) return false;
        return chosen_(p);
    }

    const Body& body_;
    std::optional<Edges> only_;
    const std::function<bool(Vec3)>& chosen_;
    const Spend& spend_;
    double size_;
    bool is_stopped_ = false;
    int starts_ = 0;
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
            if (first.is_blend || second.is_blend) continue;
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
                    if (search.is_stopped()) return fail(ErrorCode::cancelled, "stopped");
                }
            }
        }
    }
    return std::optional<Touching>();
}

}  // namespace raymo::blends
