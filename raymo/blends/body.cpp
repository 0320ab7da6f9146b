#include "raymo/blends/body.hpp"

#include <algorithm>

#include "raymo/math/tolerance.hpp"

namespace raymo::blends {
namespace {

using solids::Where;

/// Of a point of the body, in a leaf's frame. The body's frame is that in which the user wrote the blend, so the leaf's map
/// and the point carry a few roundings each: in every component of the size of the largest, since turned frames mix them.
Where where_in(const Leaf& leaf, Vec3 p, double margin = 0.0) {
    if (!grown(leaf.near, margin).contains(p)) return Where::out;
    const Vec3 q = leaf.inverse(p);
    const double size = max_norm(p) + max_norm(leaf.map.offset);
    const Vec3 reach{size, size, size};
    const Vec3 e = (abs(leaf.inverse.linear) * reach + abs(q)) * kPointError +
                   abs(leaf.inverse.linear) * Vec3{margin, margin, margin};
    return std::visit([&](const auto& kernel) { return kernel.where(q, e); },
                      csg::as_leaf(leaf.solid.node()).solid.kernel);
}

Where complement(Where w) { return static_cast<Where>(2 - static_cast<int>(w)); }

}  // namespace

Result<void> Body::add(const csg::Solid& solid, std::size_t operand) {
    struct Visit {
        csg::Solid solid;
        Affine map;
        csg::MaterialId material;
        std::size_t next = 0;
    };
    std::vector<Visit> open;
    open.push_back({solid, Affine{}, csg::kNoMaterial});
    while (!open.empty()) {
        const csg::Solid current = open.back().solid;
        const csg::Node& node = current.node();
        const Affine map = open.back().map;
        const csg::MaterialId material = open.back().material;
        switch (node.kind) {
            case csg::NodeKind::leaf: {
                if (leaves_.size() == kMostLeaves) {
                    return fail(ErrorCode::limit, "these solids have too many parts to be blended",
                                "blend fewer of them at a time; 1024 parts are the most");
                }
                Leaf leaf;
                leaf.solid = current;
                leaf.map = map * csg::as_leaf(node).solid.to_object;
                leaf.inverse = inverse(leaf.map);
                leaf.material = material;
                leaf.operand = operand;
                // What blends are made of has the span of the blend itself.
                leaf.is_blend = node.span.known() &&
                                std::any_of(open.begin(), open.end(), [&](const Visit& above) {
                                    return above.solid.node().kind == csg::NodeKind::boolean &&
                                           above.solid.node().span == node.span;
                                });
                leaf.box = std::visit([&](const auto& kernel) { return kernel.bounds(leaf.map); },
                                      csg::as_leaf(node).solid.kernel);
                // A point this far outside is out whatever its error.
                leaf.near = grown(leaf.box, 0x1p-20 * max_norm(leaf.box.size()));
                add_faces(leaf, static_cast<std::uint32_t>(leaves_.size()), faces_);
                steps_.push_back(
                    {true, csg::Op::unite, static_cast<std::uint32_t>(leaves_.size())});
                leaves_.push_back(std::move(leaf));
                open.pop_back();
                break;
            }
            case csg::NodeKind::transform:
                open.pop_back();
                open.push_back(
                    {csg::as_transform(node).child, map * csg::as_transform(node).map, material});
                break;
            case csg::NodeKind::paint:
                // The innermost paint wins.
                open.pop_back();
                open.push_back({csg::as_paint(node).child, map, csg::as_paint(node).material});
                break;
            case csg::NodeKind::boolean: {
                const auto& operands = csg::as_boolean(node).operands;
                if (open.back().next < operands.size()) {
                    const csg::Solid& next = operands[open.back().next++];
                    open.push_back({next, map, material});
                } else {
                    steps_.push_back({false, node.op, static_cast<std::uint32_t>(operands.size())});
                    open.pop_back();
                }
                break;
            }
        }
    }
    return {};
}

Result<Body> Body::make(csg::Op op, const std::vector<csg::Solid>& operands) {
    Body body;
    for (std::size_t i = 0; i < operands.size(); ++i) {
        if (auto added = body.add(operands[i], i); !added) return Failure(std::move(added).error());
        body.ends_.push_back(body.steps_.size());
        const Aabb box = csg::bounds(operands[i]);
        if (i == 0) {
            body.box_ = box;
        } else if (op == csg::Op::unite) {
            body.box_ = hull(body.box_, box);
        } else if (op == csg::Op::intersection) {
            body.box_ = overlap(body.box_, box);
        }
    }
    body.steps_.push_back({false, op, static_cast<std::uint32_t>(operands.size())});
    return body;
}

template <class InLeaf>
Where Body::combined(std::size_t begin, std::size_t end, InLeaf&& in_leaf) const {
    std::vector<Where> values;
    for (std::size_t i = begin; i < end; ++i) {
        const Step& step = steps_[i];
        if (step.is_leaf) {
            values.push_back(in_leaf(step.count));
            continue;
        }
        const auto first = values.end() - static_cast<std::ptrdiff_t>(step.count);
        Where value = *first;
        for (auto at = first + 1; at != values.end(); ++at) {
            value = step.op == csg::Op::unite          ? std::max(value, *at)
                    : step.op == csg::Op::intersection ? std::min(value, *at)
                                                       : std::min(value, complement(*at));
        }
        values.erase(first, values.end());
        values.push_back(value);
    }
    return values.front();
}

Where Body::where(Vec3 p, std::size_t begin, std::size_t end) const {
    return combined(begin, end, [&](std::uint32_t leaf) { return where_in(leaves_[leaf], p); });
}

Where Body::where(const std::vector<Where>& in_leaves) const {
    return combined(0, steps_.size(), [&](std::uint32_t leaf) { return in_leaves[leaf]; });
}

bool Body::is_on(const Face& face, Vec3 p, double margin) const {
    return where_in(leaves_[face.leaf], p, margin) == Where::on;
}

std::string Body::name_of(const Face& face) const {
    const Leaf& leaf = leaves_[face.leaf];
    return leaf.is_blend ? name_of(leaf) : "the " + std::string(face.name) + " of " + name_of(leaf);
}

std::string Body::name_of(const Leaf& leaf) const {
    if (leaf.is_blend) return "an earlier blend";
    const auto row = csg::as_leaf(leaf.solid.node()).primitive;
    return "the " + std::string(solids::inventory()[row].schema->name);
}

}  // namespace raymo::blends
