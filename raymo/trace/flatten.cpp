// A solid's graph is walked once, left to right, along every path (but not into instances), with
// the composed transformation and the error bound of that composition. Three passes over the list
// of items follow:
//
//   boxes up     union: hull; intersection: overlap; difference: its first operand's box
//   clips down   an item matters only within the clip of its parent, which for an intersection or
//   difference is the
//                overlap of what must contain the point: the item's active zone [Rossignac89]
//   groups down  union, intersection and difference become ORs of literals (see data.hpp)
//
// A leaf whose clip is empty can not change anything and is left out: it counts as `out` for good.

#include "raymo/trace/flatten.hpp"

#include <cmath>

#include "raymo/core/assert.hpp"
#include "raymo/trace/frames.hpp"
#include "raymo/trace/lookahead.hpp"
#include "raymo/trace/placement.hpp"
#include "raymo/trace/units.hpp"

namespace raymo::trace {

namespace {

enum class Kind : std::uint8_t { leaf, unite, intersect, subtract };

/// An instance pays from this many leaves on; deeper nesting than kMaxDepth is flattened.
constexpr double kShareLeaves = 64.0;
constexpr int kMaxDepth = 40;
/// In the place of a compiled solid: it reaches to infinity, so only its surroundings can cut it to size.
constexpr std::uint32_t kUnbounded = kNone - 1;

}  // namespace

struct Flattener::Item {
    Aabb box;              ///< of the item, later its clip
    std::uint32_t parent;  ///< item; kNone for the root of a part
    std::uint32_t link;    ///< leaf: index into pending leaves; else: group, once made
    Kind kind;
    bool subtracted = false;        ///< a later operand of a difference
    bool literals_negated = false;  ///< of its operands, once grouped
};

struct Flattener::Pending {
    Leaf leaf;            ///< centre in the model frame until normalised
    double displacement;  ///< of the leaf, in the model frame; without its tilt where it is endless
    bool endless;         ///< the leaf alone reaches to infinity
    Vec3 tilt;  ///< displacement per distance from the centre of an endless leaf, along the axes
    csg::MaterialId material;
    SourceSpan span;
    std::uint32_t primitive;
    std::uint32_t item;
};

struct Flattener::Work {
    std::vector<Item> items;
    std::vector<Pending> pending;
    std::vector<Boxf> boxes;  ///< of the leaves that are kept
};

struct Flattener::Visit {
    const csg::Solid* solid;
    std::size_t next = 0;  ///< operand to visit next
    Placement place;
    csg::MaterialId material;
    std::uint32_t item;  ///< item of the boolean itself; for a leaf its parent
    bool subtracted = false;
};

Result<std::uint32_t> Flattener::compile(std::span<const csg::Solid> parts, int depth) {
    Work work;
    if (auto done = expand(work, parts, depth); !done) return Failure(std::move(done).error());
    combine_boxes(work);
    if (auto done = check_bounded(work); !done) return Failure(std::move(done).error());

    CompiledSolid out;
    out.parts = static_cast<std::uint32_t>(parts.size());
    make_groups(work, out);
    normalise(work, out);
    if (out.leaves.empty() && depth > 0) return kNone;
    // The tree may have their room.
    work.items = {};
    work.pending = {};

    plant_trees(out, work.boxes, data_);
    data_.solids.push_back(std::move(out));
    return static_cast<std::uint32_t>(data_.solids.size() - 1);
}

Result<void> Flattener::expand(Work& work, std::span<const csg::Solid> parts, int depth) {
    std::vector<Visit> stack;
    Lookahead lookahead;
    std::uint32_t steps = 0;

    // Goes down from `at` through transformations and paint to a leaf, an instance or a boolean.
    const auto descend = [&](Visit at) -> Result<void> {
        bool shared = false;
        while (true) {
            const csg::Node& node = at.solid->node();
            shared = shared || node.references.load(std::memory_order_relaxed) > 1;
            if (node.kind == csg::NodeKind::transform) {
                const auto& t = csg::as_transform(node);
                at.place = at.place.then_inner(t.map);
                at.solid = &t.child;
            } else if (node.kind == csg::NodeKind::paint) {
                const auto& p = csg::as_paint(node);
                at.material = p.material;
                at.solid = &p.child;
            } else {
                break;
            }
        }
        const csg::Node& node = at.solid->node();
        if (node.kind == csg::NodeKind::leaf) {
            return add_leaf(work, csg::as_leaf(node), at);
        }
        // What a lone part consists of would only be wrapped once more.
        const bool whole = parts.size() == 1 && at.item == 0;
        if (share_ && !whole && depth < kMaxDepth && node.leaf_count >= kShareLeaves && shared) {
            auto added = add_instance(work, at, depth);
            if (!added) return Failure(std::move(added).error());
            if (*added) return {};
        }
        Item item{};
        item.parent = at.item;
        item.subtracted = at.subtracted;
        item.kind = node.op == csg::Op::unite          ? Kind::unite
                    : node.op == csg::Op::intersection ? Kind::intersect
                                                       : Kind::subtract;
        at.item = static_cast<std::uint32_t>(work.items.size());
        work.items.push_back(item);
        stack.push_back(std::move(at));
        return {};
    };

    if (!share_) {
        double leaves = 0.0;
        for (const csg::Solid& part : parts) leaves += part.node().leaf_count;
        // Every path is walked: there will be so many leaves, and mostly not half as many Booleans.
        const auto count = static_cast<std::size_t>(leaves);
        work.pending.reserve(count);
        work.items.reserve(count + count / 2 + parts.size());
        tables_.frames().reserve(count);
    }
    for (const csg::Solid& part : parts) {
        // Every part gets a union of its own as root, so that its group stands at the part's
        // number.
        const auto root = static_cast<std::uint32_t>(work.items.size());
        work.items.push_back({Aabb{}, kNone, 0, Kind::unite});
        if (auto done = descend({&part, 0, {}, csg::kNoMaterial, root, false}); !done) return done;
        while (!stack.empty()) {
            Visit& top = stack.back();
            const auto& boolean = csg::as_boolean(top.solid->node());
            if (top.next == boolean.operands.size()) {
                stack.pop_back();
                continue;
            }
            if ((++steps & 0xffffU) == 0 && progress_ != nullptr && progress_->cancelled()) {
                return fail(ErrorCode::cancelled, "interrupted");
            }
            lookahead.step(boolean.operands, top.next);
            const bool subtracted = boolean.op == csg::Op::difference && top.next > 0;
            const csg::Solid& operand = boolean.operands[top.next++];
            if (auto done = descend({&operand, 0, top.place, top.material, top.item, subtracted});
                !done) {
                return done;
            }
        }
    }
    return {};
}

namespace {

/// Whether a leaf can be computed with there: squares of its sizes neither overflow nor vanish.
bool is_placeable(Vec3 offset) { return is_finite(offset) && max_norm(offset) <= 1e90; }
bool is_placeable(const Mat3& linear) {
    if (!is_invertible(linear)) return false;
    for (int j = 0; j < 3; ++j) {
        const Vec3 column = linear.column(j);
        const double longest = max_norm(column);
        if (longest >= 1e-89 && longest <= 1e89) continue;  // no need for the exact length
        const double size = norm(column);
        if (!(size >= 1e-90 && size <= 1e90)) return false;
    }
    return true;
}

float float_above(double v) {
    const auto f = static_cast<float>(v);
    return static_cast<double>(f) >= v ? f
                                       : std::nextafter(f, std::numeric_limits<float>::infinity());
}

/// Of a leaf or an instance in its own place. What is endless has no size of its own, so that its tilt is counted over the
/// whole model.
double displacement_of(const Placement& place, bool endless) {
    const Vec3 tilt = endless ? Vec3{} : place.linear_error * Vec3{1, 1, 1};
    return norm(tilt + place.offset_error);
}

}  // namespace

Result<void> Flattener::add_leaf(Work& work, const csg::LeafNode& node, const Visit& at) {
    const Placement place = at.place.then_inner(node.solid.to_object);
    const auto type = static_cast<std::uint32_t>(node.solid.kernel.index());
    const std::uint32_t kernel = tables_.kernel(node.solid.kernel);
    // Leaves of a pattern differ in place alone.
    const bool is_known =
        type == last_.type && kernel == last_.kernel && place.map.linear == last_.linear;
    if (!is_placeable(place.map.offset) || !(is_known || is_placeable(place.map.linear))) {
        const std::string_view name = solids::inventory()[node.primitive].schema->name;
        return Failure(
            Error{ErrorCode::singular,
                  std::string(name) + ": its transformations together leave no usable size",
                  "this becomes too small, too large or flat", "keep sizes between 1e-90 and 1e90",
                  -1, node.span});
    }
    Item item{};
    item.box = std::visit([&](const auto& k) { return k.bounds(place.map); }, node.solid.kernel);
    Pending pending{};
    pending.endless = !item.box.bounded();
    if (type == kHalfspace) {
        const HalfSpace half = half_space(at.place, node.solid.to_object.linear.column(2), kernel);
        pending.leaf.frame = tables_.frame(half.frame);
        pending.tilt = half.tilt;
        pending.displacement = dot(abs(half.frame.to_local.row[2]), place.offset_error);
    } else {
        if (!is_known) {
            Frame frame = frame_of(place.map, type, kernel);
            if (pending.endless) frame.reach = std::numeric_limits<double>::infinity();
            last_ = {type, kernel, place.map.linear, frame.row_length, tables_.frame(frame)};
        }
        pending.leaf.frame = last_.frame;
        pending.displacement = displacement_of(place, pending.endless);
        if (pending.endless) {
            const double tilt = norm(place.linear_error * last_.row_length) + 16.0 * kUnitRoundoff;
            pending.tilt = {tilt, tilt, tilt};
        }
    }
    pending.primitive = node.primitive;
    enlist(work, at, item, pending, place, node.span);
    return {};
}

/// Puts a leaf or an instance, of which `item` has the box, on the lists.
void Flattener::enlist(Work& work, const Visit& at, Item item, Pending pending,
                       const Placement& place, SourceSpan span) {
    pending.leaf.centre = place.map.offset;
    pending.material = at.material;
    pending.span = span;
    pending.item = static_cast<std::uint32_t>(work.items.size());
    item.parent = at.item;
    item.link = static_cast<std::uint32_t>(work.pending.size());
    item.kind = Kind::leaf;
    item.subtracted = at.subtracted;
    work.items.push_back(item);
    work.pending.push_back(pending);
}

Result<bool> Flattener::add_instance(Work& work, const Visit& at, int depth) {
    const csg::Node& node = at.solid->node();
    std::uint32_t index = kNone;
    if (const auto known = compiled_.find(&node); known != compiled_.end()) {
        index = known->second;
        if (index == kUnbounded) return false;
    } else {
        Flattener inner(data_, share_, progress_);
        inner.compiled_ = std::move(compiled_);
        auto made = inner.compile(std::span(at.solid, 1), depth + 1);
        compiled_ = std::move(inner.compiled_);
        if (!made) {
            // A solid without end may still be cut to size by its surroundings, which only
            // flattening sees.
            if (made.error().code == ErrorCode::unbounded) {
                compiled_.emplace(&node, kUnbounded);
                return false;
            }
            return Failure(std::move(made).error());
        }
        index = *made;
        compiled_.emplace(&node, index);
    }
    if (index == kNone) {
        // Empty: an item without leaves, false for good.
        Item item{};
        item.parent = at.item;
        item.subtracted = at.subtracted;
        item.kind = Kind::unite;
        work.items.push_back(item);
        return true;
    }
    const CompiledSolid& solid = data_.solids[index];
    const Placement place = at.place.then_inner(
        {Mat3::diagonal(1.0 / solid.scale, 1.0 / solid.scale, 1.0 / solid.scale), solid.centre});
    Item item{};
    item.box = transformed(at.place.map, solid.bounds);
    Pending pending{};
    pending.leaf.frame = tables_.frame(frame_of(place.map, kInstanceType, index));
    pending.displacement = displacement_of(place, false);
    enlist(work, at, item, pending, place, node.span);
    return true;
}

void Flattener::combine_boxes(Work& work) const {
    std::vector<Item>& items = work.items;
    for (Item& item : items) {
        if (item.kind == Kind::intersect || item.kind == Kind::subtract)
            item.box = Aabb::everything();
    }
    for (std::size_t i = items.size(); i-- > 0;) {
        const Item& item = items[i];
        if (item.parent == kNone || item.subtracted) continue;
        Item& parent = items[item.parent];
        parent.box = parent.kind == Kind::unite
                         ? (item.box.empty() ? parent.box : hull(parent.box, item.box))
                         : overlap(parent.box, item.box);
    }
    for (Item& item : items) {
        if (item.parent != kNone) item.box = overlap(item.box, items[item.parent].box);
    }
}

Result<void> Flattener::check_bounded(const Work& work) const {
    for (const Item& item : work.items) {
        if (item.kind != Kind::leaf || item.box.empty() || item.box.bounded()) continue;
        const Pending& leaf = work.pending[item.link];
        const std::string_view name = solids::inventory()[leaf.primitive].schema->name;
        return Failure(
            Error{ErrorCode::unbounded, std::string(name) + ": the solid reaches to infinity",
                  "this has no end",
                  "intersect it with a block, or subtract it from a solid of finite size", -1,
                  leaf.span});
    }
    return {};
}

void Flattener::make_groups(Work& work, CompiledSolid& out) {
    for (Item& item : work.items) {
        if (item.parent == kNone) {
            item.link = static_cast<std::uint32_t>(out.groups.size());
            out.groups.push_back({});
        }
    }
    for (Item& item : work.items) {
        if (item.parent == kNone) continue;
        const Item& parent = work.items[item.parent];
        const std::uint32_t group = parent.link;
        const bool negated = parent.literals_negated != item.subtracted;
        if (item.kind == Kind::leaf) {
            Pending& pending = work.pending[item.link];
            if (negated) ++out.groups[group].initial;
            pending.leaf.parent = group;
            Look look;
            look.material = pending.material;
            look.primitive = pending.primitive;
            look.span = pending.span;
            look.literal_negated = negated;
            look.cuts = out.groups[group].taken_away != negated;
            look.borrows = look.cuts && look.material == csg::kNoMaterial;
            pending.leaf.look = tables_.look(look);
            continue;
        }
        // As an OR of literals: a union of its operands, the others of their operands' negations,
        // negated as a whole.
        const bool is_or = item.kind == Kind::unite;
        item.literals_negated = !is_or;
        if (is_or != negated) {
            item.link = group;  // the literal is itself an OR: its literals join the parent's
            continue;
        }
        item.link = static_cast<std::uint32_t>(out.groups.size());
        out.groups.push_back({group, 0, true, !out.groups[group].taken_away});
    }
    for (std::size_t g = out.groups.size(); g-- > out.parts;) {
        const Group& group = out.groups[g];
        if ((group.initial > 0) != group.negated) ++out.groups[group.parent].initial;
    }
}

void Flattener::normalise(Work& work, CompiledSolid& out) {
    for (const Item& item : work.items) {
        if (item.kind == Kind::leaf && !item.box.empty()) out.bounds = hull(out.bounds, item.box);
    }
    if (out.bounds.empty()) return;
    out.centre = out.bounds.centre();
    const double radius = norm(out.bounds.size()) * 0.5;
    out.scale = radius > 0.0 ? std::ldexp(1.0, -std::ilogb(radius) - 1) : 1.0;

    const auto first_frame = static_cast<std::uint32_t>(data_.frames.size());
    for (Frame& frame : tables_.frames()) {
        if (frame.type == kHalfspace) continue;  // has this size already
        for (Vec3& row : frame.to_local.row) row *= 1.0 / out.scale;
        frame.row_length *= 1.0 / out.scale;
    }
    if (data_.frames.empty()) {
        data_.frames = std::move(tables_.frames());
    } else {
        data_.frames.insert(data_.frames.end(), tables_.frames().begin(), tables_.frames().end());
    }
    out.leaves.reserve(work.pending.size());
    work.boxes.reserve(work.pending.size());
    const double far = norm(out.centre);
    std::uint32_t order = 0;
    for (Pending& pending : work.pending) {
        const Aabb& clip = work.items[pending.item].box;
        ++order;
        if (clip.empty()) continue;
        Leaf leaf = pending.leaf;
        const Vec3 apart = leaf.centre - out.centre;
        const bool is_half_space = data_.frames[first_frame + leaf.frame].type == kHalfspace;
        double displacement = pending.displacement;
        // Rounding of the subtraction, which a half-space has in its tilt.
        if (!is_half_space) displacement += 2.0 * kUnitRoundoff * (norm(leaf.centre) + far);
        // An endless leaf errs by its tilt over the whole model.
        displacement += dot(pending.tilt, abs(apart) + Vec3{radius, radius, radius});
        displacement *= out.scale;
        leaf.frame += first_frame;
        leaf.centre = apart * out.scale;
        if (is_half_space) place_half_space(data_.frames[leaf.frame], leaf.centre, displacement);
        leaf.displacement = float_above(std::min(displacement, kLost));
        leaf.order = order;
        const Aabb box{(clip.lo - out.centre) * out.scale, (clip.hi - out.centre) * out.scale};
        // The float test of a ray errs by less than 2^-18 for origins within 8 of the centre; a
        // crossing may be uncertain by kDegenerate of the leaf's size and must not precede its box.
        const double margin =
            0x1p-18 + 2.0 * kDegenerate * max_norm(box.size()) + leaf.displacement;
        work.boxes.push_back(outward(box, margin));
        out.leaves.push_back(leaf);
    }
}

}  // namespace raymo::trace
