#include "raymo/query/locate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "raymo/math/tolerance.hpp"

namespace raymo::query {
namespace {

constexpr std::size_t kGeneric = 32;          // directions that fit no model
constexpr std::uint64_t kPollEvery = 0x4000;  // nodes between two looks at the user's wish to stop
constexpr std::size_t kLeafDirections = 8;    // leaves whose own directions are tried

Where complement(Where w) { return static_cast<Where>(2 - static_cast<int>(w)); }

/// Directions spread evenly over the sphere (a spiral with the golden angle), turned so that none
/// is along an axis, in a coordinate plane or opposite to another.
const std::array<Vec3, kGeneric>& generic_directions() {
    static const auto kDirections = [] {
        std::array<Vec3, kGeneric> out;
        const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
        const Affine turn = rotation(unit(Vec3{0.321, 0.782, -0.533}), 37.719);
        for (std::size_t i = 0; i < kGeneric; ++i) {
            const double z =
                1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(kGeneric);
            const double r = std::sqrt(1.0 - z * z);
            const double a = golden * static_cast<double>(i);
            out[i] = turn(Vec3{r * std::cos(a), r * std::sin(a), z});
        }
        return out;
    }();
    return kDirections;
}

/// Point and error bound taken through the inverse of a map. With q = L^-1 (p - b):
///   the offset's entries carry kInputError, so do those of L, which moves q as |L||q| kInputError
///   would move p; forming p - b, the product, and L^-1 itself round, which kPointError covers with
///   r = |L^-1||p - b| >= |q|.
void into(const Affine& map, const Mat3& inv, Vec3& p, Vec3& error) {
    const Vec3 d = p - map.offset;
    const Mat3 size = abs(inv);
    const Vec3 r = size * abs(d);
    const Vec3 before = error + abs(map.offset) * kInputError + abs(d) * kUnitRoundoff +
                        (abs(map.linear) * r) * (kInputError + kPointError);
    error = size * before;
    p = inv * d;
}

/// The same of a direction.
void into(const Mat3& linear, const Mat3& inv, Vec3& d, Vec3& error) {
    const Mat3 size = abs(inv);
    const Vec3 r = size * abs(d);
    error = size * (error + (abs(linear) * r) * (kInputError + kPointError));
    d = inv * d;
}

/// A point on the boundary of a leaf to within `e`, and a direction `d`, known to within `d_error`.
struct Beside {
    Vec3 q, e;
    Vec3 d, d_error;
};

/// State of a leaf just beside the point q, on the side to which d points. A plane goes on far from the origin of its frame,
/// where lines are not judged well.
Where beside_leaf(const solids::Halfspace::Kernel&, const Beside& at, solids::SpanList&) {
    if (std::fabs(at.d.z) <= at.d_error.z) return Where::on;
    return at.d.z > 0.0 ? Where::out : Where::in;
}
template <class K>
Where beside_leaf(const K& kernel, const Beside& at, solids::SpanList& spans) {
    const auto& [q, e, d, d_error] = at;
    const double dd = dot(d, d);
    const double s_q = dot(q, d) / dd;  // q = o + s_q d
    const Vec3 o = q - d * s_q;
    spans.clear();
    kernel.spans(solids::LocalRay<double>{o.x, o.y, o.z, d.x, d.y, d.z, e.x, e.y, e.z, dd,
                                          solids::kFromTheBeginning},
                 spans);
    if (spans.degenerate()) return Where::on;
    const double own = 4.0 * (max_norm(e) / std::sqrt(dd) + kPointError * std::fabs(s_q));
    for (std::size_t i = 0; i < spans.size(); ++i) {
        const solids::Span& span = spans[i];
        if (span.enter.s <= s_q + own + 2.0 * span.enter.error &&
            span.exit.s > s_q + own + 2.0 * span.exit.error) {
            return Where::in;
        }
    }
    return Where::out;
}

}  // namespace

Locator::Locator(const csg::Solid& solid) : keep_{solid} {
    roots_.push_back(graph_.add(solid));
    all_ = roots_[0];
}

Locator::Locator(const scene::Scene& scene) {
    for (const scene::Part& part : scene.parts) {
        keep_.push_back(part.solid);
        roots_.push_back(graph_.add(part.solid));
    }
    all_ = roots_.size() == 1 ? roots_[0] : graph_.unite(roots_);
}

Where Locator::where_all(Vec3 p, Vec3 reach) {
    return evaluate(all_, {p, reach, {}, {}, {}}, false);
}

Where Locator::locate(std::uint32_t root, Vec3 p) {
    const Place start{p, {}, {}, {}, {}};
    const Where first = evaluate(root, start, false);
    if (first != Where::on || leaves_on_ == 1) return first;

    bool any_in = false;
    bool any_out = false;
    // True when both sides have been seen.
    const auto look = [&](Vec3 direction) {
        Place place = start;
        place.direction = direction;
        const Where side = evaluate(root, place, true);
        any_in |= side == Where::in;
        any_out |= side == Where::out;
        return any_in && any_out;
    };
    const std::vector<Vec3> towards = towards_;
    for (const Vec3 centre : towards) {
        Vec3 s;
        Vec3 t;
        make_frame(centre, s, t);
        for (const Vec3 d : {centre, s, t}) {
            if (look(d) || look(-d)) return Where::on;
        }
    }
    for (const Vec3 d : generic_directions()) {
        if (look(d)) return Where::on;
    }
    if (any_in) return Where::in;
    return any_out ? Where::out : Where::on;
}

bool Locator::next_operand(Frame& frame, std::uint32_t& operand) {
    const Graph::Node& node = graph_[frame.node];
    const bool gathered =
        node.tree != Graph::kNone && (node.op == csg::Op::unite || frame.next > 0);
    if (!gathered) {
        if (frame.next == node.count) return false;
        operand = graph_.operand(node.first + frame.next++);
        return true;
    }
    const std::uint32_t skipped = node.op == csg::Op::unite ? 0 : 1;
    if (frame.next == skipped) {
        frame.nearby = nearby_.size();
        graph_.near(node, frame.place.p, frame.place.error, nearby_);
    }
    const std::size_t at = frame.nearby + (frame.next - skipped);
    if (at >= nearby_.size()) return false;
    operand = nearby_[at];
    ++frame.next;
    return true;
}

/// One more node; false when no more may be met.
bool Locator::spend() {
    if (steps_left_ == 0) return false;
    --steps_left_;
    if (steps_left_ % kPollEvery == 0 && progress_ != nullptr && progress_->cancelled()) {
        steps_left_ = 0;
    }
    return steps_left_ > 0;
}

Where Locator::evaluate(std::uint32_t root, const Place& start, bool beside) {
    frames_.clear();
    nearby_.clear();
    leaves_on_ = 0;
    if (!beside) towards_.clear();
    std::uint32_t index = root;
    Place place = start;
    while (true) {
        // Down to a leaf, a decided box or a boolean.
        Where value = Where::out;
        bool decided = false;
        while (!decided) {
            if (!spend()) return Where::on;
            const Graph::Node& node = graph_[index];
            if (!touches(node.box, place.p, place.error)) {
                decided = true;
            } else if (node.kind == csg::NodeKind::leaf) {
                value = leaf(csg::as_leaf(*node.source), place, beside);
                decided = true;
            } else if (node.kind == csg::NodeKind::transform) {
                const Affine& map = csg::as_transform(*node.source).map;
                const Mat3& inv = graph_.inverse(node.map);
                into(map, inv, place.p, place.error);
                if (beside) into(map.linear, inv, place.direction, place.direction_error);
                place.outward = place.outward * map.linear;
                index = node.first;
            } else {
                const Where neutral = node.op == csg::Op::unite ? Where::out : Where::in;
                frames_.push_back({index, 0, nearby_.size(), neutral, place});
                if (next_operand(frames_.back(), index)) continue;
                frames_.pop_back();
                value = neutral;
                decided = true;
            }
        }
        // Up until a boolean still needs an operand.
        while (true) {
            if (frames_.empty()) return value;
            Frame& frame = frames_.back();
            const csg::Op op = graph_[frame.node].op;
            bool settled = false;
            if (op == csg::Op::unite) {
                frame.value = std::max(frame.value, value);
                settled = frame.value == Where::in;
            } else {
                const bool taken_away = op == csg::Op::difference && frame.next > 1;
                frame.value = std::min(frame.value, taken_away ? complement(value) : value);
                settled = frame.value == Where::out;
            }
            if (!settled && next_operand(frame, index)) {
                place = frame.place;
                break;
            }
            value = frame.value;
            nearby_.resize(std::min(nearby_.size(), frame.nearby));
            frames_.pop_back();
        }
    }
}

Where Locator::leaf(const csg::LeafNode& node, const Place& outer, bool beside) {
    const Affine& map = node.solid.to_object;
    const Mat3 inv = inverse(map.linear);
    Place place = outer;
    into(map, inv, place.p, place.error);
    const Where w =
        std::visit([&](const auto& k) { return k.where(place.p, place.error); }, node.solid.kernel);
    if (w != Where::on) return w;
    ++leaves_on_;
    if (!beside) {
        const Vec3 towards = (place.outward * map.linear) * -place.p;
        if (towards_.size() < kLeafDirections && max_norm(towards) > 0.0 && is_finite(towards)) {
            towards_.push_back(unit(towards));
        }
        return w;
    }
    into(map.linear, inv, place.direction, place.direction_error);
    const Beside at{place.p, place.error, place.direction, place.direction_error};
    solids::SpanList spans;
    return std::visit([&](const auto& k) { return beside_leaf(k, at, spans); }, node.solid.kernel);
}

}  // namespace raymo::query
