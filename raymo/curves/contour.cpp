#include "raymo/curves/contour.hpp"

#include <algorithm>
#include <unordered_map>

#include "raymo/core/assert.hpp"
#include "raymo/curves/roots.hpp"

namespace raymo::curves {
namespace {

/// What malloc adds to a block.
constexpr double kBlock = 16.0;

/// Box of the control points; endless when one is not finite.
Box2 hull_of(const Outline& outline) {
    Box2 box;
    for (const Curve& curve : outline.curves) {
        for (const Span2& span : curve.spans) {
            for (std::size_t i = 0; i < 4; ++i) {
                const Vec2 p = span.point(i);
                if (!is_finite(p)) return {{-Aabb::kInf, -Aabb::kInf}, {Aabb::kInf, Aabb::kInf}};
                box.include(p);
            }
        }
    }
    return box;
}

Box2 moved(const Box2& box, Vec2 by) { return {box.lo + by, box.hi + by}; }

/// What `of` says of an outline, asked once for each outline.
template <class T>
class PerOutline {
public:
    explicit PerOutline(T (*of)(const Outline&)) : of_(of) {}
    const T& operator()(const OutlinePtr& outline) {
        const auto [found, is_new] = known_.try_emplace(outline.get());
        if (is_new) found->second = of_(*outline);
        return found->second;
    }

private:
    T (*of_)(const Outline&);
    std::unordered_map<const Outline*, T> known_;
};

Outline mapped(const Outline& outline, const Affine2& map) {
    Outline image = outline;
    for (Curve& curve : image.curves) {
        for (Span2& span : curve.spans) span = mapped(span, map);
    }
    return image;
}

bool is_same_image(const ContourNode& a, const ContourNode& b) {
    if (a.at == b.at) return a.outline == b.outline || *a.outline == *b.outline;
    return *placed_outline(a) == *placed_outline(b);
}

/// Widens lo..hi by the values of p / w on [0, 1]: those at the ends, and where the derivative's numerator p' w - p w' is 0.
void include_values(const Bernstein<3>& p, const Bernstein<3>& w, double& lo, double& hi) {
    const auto include = [&](double at) {
        lo = std::min(lo, at);
        hi = std::max(hi, at);
    };
    include(p[0] / w[0]);
    include(p[3] / w[3]);
    // The curve lies in the hull of its control points.
    const auto [least, most] = std::minmax({p[1] / w[1], p[2] / w[2]});
    if (least >= lo && most <= hi) return;
    const auto slope = sum_of(product(derivative(p), w), product(p, derivative(w)), -1.0);
    RootList<5> roots;
    find_roots<5>(slope, 0.0, roots);
    for (const Root& root : roots) include(value_at(p, root.u) / value_at(w, root.u));
}

struct PairHash {
    std::size_t operator()(const std::pair<const ContourNode*, const ContourNode*>& p) const {
        const auto a = reinterpret_cast<std::uintptr_t>(p.first);
        const auto b = reinterpret_cast<std::uintptr_t>(p.second);
        return (a * 0x9E3779B97F4A7C15ULL) ^ (b * 0xC2B2AE3D27D4EB4FULL >> 7);
    }
};

}  // namespace

ContourNode::~ContourNode() {
    for (Contour& operand : operands) let_go(std::move(operand), [](const ContourNode&) {});
}

Contour contour_of(OutlinePtr outline, Vec2 at) {
    auto node = std::make_shared<ContourNode>();
    node->outline = std::move(outline);
    node->at = at;
    return node;
}

Contour contour_of(Outline outline) {
    return contour_of(std::make_shared<const Outline>(std::move(outline)), Vec2{});
}

OutlinePtr placed_outline(const ContourNode& node) {
    RAYMO_ASSERT(node.op == ContourOp::outline);
    if (node.at == Vec2{}) return node.outline;
    return std::make_shared<const Outline>(
        mapped(*node.outline, {1.0, 0.0, node.at.x, 0.0, 1.0, node.at.y}));
}

Contour contour_of(Curve curve) {
    Outline outline;
    outline.curves.push_back(std::move(curve));
    return contour_of(std::move(outline));
}

Contour combined(ContourOp op, std::vector<Contour> operands) {
    RAYMO_ASSERT(op != ContourOp::outline && !operands.empty());
    if (operands.size() == 1) return std::move(operands[0]);
    auto node = std::make_shared<ContourNode>();
    node->op = op;
    node->operands = std::move(operands);
    return node;
}

Contour mapped(const Contour& contour, const Affine2& map) {
    std::unordered_map<const ContourNode*, Contour> images;
    std::unordered_map<const Outline*, OutlinePtr> outlines;
    const Affine2 turn{map.xx, map.xy, 0.0, map.yx, map.yy, 0.0};
    visit(contour, [&](const ContourNode& node) {
        if (node.op == ContourOp::outline) {
            OutlinePtr image = node.outline;
            if (!is_move(map)) {
                OutlinePtr& known = outlines[node.outline.get()];
                if (known == nullptr)
                    known = std::make_shared<const Outline>(mapped(*node.outline, turn));
                image = known;
            }
            images[&node] = contour_of(std::move(image), map(node.at));
            return;
        }
        std::vector<Contour> operands;
        operands.reserve(node.operands.size());
        for (const Contour& operand : node.operands) operands.push_back(images[operand.get()]);
        images[&node] = combined(node.op, std::move(operands));
    });
    return images[contour.get()];
}

double extent_of(const Contour& contour) {
    double size = 0.0;
    PerOutline<Box2> hull(&hull_of);
    visit(contour, [&](const ContourNode& node) {
        if (node.op != ContourOp::outline) return;
        const Box2 box = moved(hull(node.outline), node.at);
        if (box.empty()) return;
        const double far = std::max(max_norm(box.lo), max_norm(box.hi));
        size = far <= size ? size : (far > size ? far : Aabb::kInf);
    });
    return size;
}

Box2 box_of(const Outline& outline) {
    Box2 box;
    for (const Curve& curve : outline.curves) {
        for (const Span2& span : curve.spans) {
            include_values(span.x, span.w, box.lo.x, box.hi.x);
            include_values(span.y, span.w, box.lo.y, box.hi.y);
        }
    }
    return box;
}

Box2 box_of(const Contour& contour) {
    std::unordered_map<const ContourNode*, Box2> boxes;
    PerOutline<Box2> box_at_origin(&box_of);
    visit(contour, [&](const ContourNode& node) {
        if (node.op == ContourOp::outline) {
            boxes[&node] = moved(box_at_origin(node.outline), node.at);
            return;
        }
        Box2 box = boxes[node.operands[0].get()];
        for (std::size_t i = 1; i < node.operands.size(); ++i) {
            const Box2& other = boxes[node.operands[i].get()];
            if (node.op == ContourOp::unite) box.include(other);
            if (node.op != ContourOp::intersection) continue;
            box.lo = {std::max(box.lo.x, other.lo.x), std::max(box.lo.y, other.lo.y)};
            box.hi = {std::min(box.hi.x, other.hi.x), std::min(box.hi.y, other.hi.y)};
        }
        boxes[&node] = box.empty() ? Box2{} : box;
    });
    return boxes[contour.get()];
}

bool is_open(const Contour& contour) {
    bool open = false;
    visit(contour, [&](const ContourNode& node) {
        if (node.op != ContourOp::outline) return;
        for (const Curve& curve : node.outline->curves) open = open || !curve.closed;
    });
    return open;
}

bool is_equal(const Contour& a, const Contour& b) {
    using Pair = std::pair<const ContourNode*, const ContourNode*>;
    std::unordered_set<Pair, PairHash> seen;  // equal, unless a difference is found
    std::vector<Pair> open{{a.get(), b.get()}};
    while (!open.empty()) {
        const auto [x, y] = open.back();
        open.pop_back();
        if (x == y || !seen.insert({x, y}).second) continue;
        if (x->op != y->op || x->operands.size() != y->operands.size()) return false;
        if (x->op == ContourOp::outline) {
            if (!is_same_image(*x, *y)) return false;
            continue;
        }
        for (std::size_t i = 0; i < x->operands.size(); ++i)
            open.emplace_back(x->operands[i].get(), y->operands[i].get());
    }
    return true;
}

double bytes_of(const Outline& outline) {
    double bytes = sizeof(Outline) + 2.0 * kBlock;
    for (const Curve& curve : outline.curves) {
        bytes +=
            sizeof(Curve) + kBlock + static_cast<double>(curve.spans.capacity() * sizeof(Span2));
    }
    return bytes;
}

double bytes_of(const ContourNode& node) {
    return sizeof(ContourNode) + 2.0 * kBlock +
           static_cast<double>(node.operands.capacity() * sizeof(Contour));
}

double bytes_of(const Contour& contour) {
    double bytes = 0.0;
    std::unordered_set<const Outline*> outlines;
    visit(contour, [&](const ContourNode& node) {
        bytes += bytes_of(node);
        if (node.outline != nullptr && outlines.insert(node.outline.get()).second)
            bytes += bytes_of(*node.outline);
    });
    return bytes;
}

double bytes_of_image(const Contour& contour, const Affine2& map) {
    if (!is_move(map)) return bytes_of(contour);
    double bytes = 0.0;
    visit(contour, [&](const ContourNode& node) { bytes += bytes_of(node); });
    return bytes;
}

}  // namespace raymo::curves
