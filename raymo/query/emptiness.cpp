#include "raymo/query/emptiness.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <span>
#include <string_view>
#include <unordered_set>

#include "raymo/query/locate.hpp"
#include "raymo/trace/tracer.hpp"

namespace raymo::query {
namespace {

constexpr std::size_t kMaxZones = 2048;
constexpr std::size_t kMaxCells = 8192;        // cells looked at
constexpr std::size_t kRayBudget = 100'000;    // rays of the last step, at least one grid a zone
constexpr int kFinest = 16;                    // rays across a zone
constexpr std::uint64_t kZoneSteps = 200'000;  // nodes opened to find the zones
constexpr std::uint64_t kLocatorSteps = 4'000'000;  // nodes met by the proof with cells
constexpr std::uint64_t kRaySteps = 40'000'000;     // boxes and leaves met by rays

/// A box in the world in which something can matter for the solid, and that thing when it is one
/// leaf.
struct Zone {
    Aabb box;
    const csg::LeafNode* leaf = nullptr;
    Affine to_world;  ///< from the frame in which the leaf was written
};

/// Zones that together hold all of the solid. A union with more operands than there is room for
/// stays one zone, and so does what is left when kZoneSteps are gone.
class Zones {
public:
    Zones(const Graph& graph, Aabb region) : graph_(graph), region_(region) {}

    std::vector<Zone> of(std::uint32_t root) {
        push({root, {}, region_});
        for (std::uint64_t steps = 0; !open_.empty(); ++steps) {
            const Item item = open_.back();
            open_.pop_back();
            const Graph::Node& node = graph_[item.node];
            if (node.kind == csg::NodeKind::leaf) {
                found_.push_back({item.zone, &csg::as_leaf(*node.source), item.to_world});
            } else if (steps > kZoneSteps ||
                       found_.size() + open_.size() + node.count > kMaxZones) {
                found_.push_back({item.zone, nullptr, {}});
            } else if (node.kind == csg::NodeKind::transform) {
                const Affine& map = csg::as_transform(*node.source).map;
                push({node.first, item.to_world * map, item.zone});
            } else {
                open_boolean(node, item);
            }
        }
        return std::move(found_);
    }

private:
    struct Item {
        std::uint32_t node;
        Affine to_world;
        Aabb zone;
    };

    void push(Item item) {
        const Aabb& box = graph_[item.node].box;
        if (box.empty()) return;
        item.zone = overlap(item.zone, transformed(item.to_world, box));
        if (!item.zone.empty()) open_.push_back(item);
    }
    void open_boolean(const Graph::Node& node, const Item& item) {
        Aabb zone = item.zone;
        const std::uint32_t deciding = node.op == csg::Op::unite          ? 0
                                       : node.op == csg::Op::intersection ? node.count
                                                                          : 1;
        for (std::uint32_t i = 0; i < deciding; ++i) {
            const Aabb& box = graph_[graph_.operand(node.first + i)].box;
            if (box.empty()) return;
            zone = overlap(zone, transformed(item.to_world, box));
        }
        if (zone.empty()) return;
        for (std::uint32_t i = 0; i < node.count; ++i) {
            push({graph_.operand(node.first + i), item.to_world, zone});
        }
    }

    const Graph& graph_;
    Aabb region_;
    std::vector<Item> open_;
    std::vector<Zone> found_;
};

/// Rays that start outside of the whole model.
class Prober {
public:
    explicit Prober(const trace::CompiledScene& scene) : scene_(scene), tracer_(scene) {}

    /// True when one of n x n rays in each of three skew directions through the box meets the
    /// solid.
    bool meets(const Aabb& box, int n) {
        return grid(
            box, n, [](Vec3 p) { return p; }, Vec3{0.00321, 0.00782, -0.00533});
    }

    /// The same along the axes of the leaf's canonical frame and through its own box there, so that
    /// rays run along a needle and in a sheet, whichever way it is turned. Sides at infinity count
    /// as 1 from the middle.
    bool meets_along(const csg::LeafNode& leaf, const Affine& to_world, int n) {
        Aabb box = std::visit([](const auto& k) { return k.bounds(Affine{}); }, leaf.solid.kernel);
        for (int axis = 0; axis < 3; ++axis) {
            if (!std::isfinite(box.lo[axis])) box.lo[axis] = std::min(-1.0, box.hi[axis] - 1.0);
            if (!std::isfinite(box.hi[axis])) box.hi[axis] = std::max(1.0, box.lo[axis] + 1.0);
        }
        const Affine map = to_world * leaf.solid.to_object;
        // No turn in the world: the shape may be much thinner than that.
        return grid(box, n, map, {});
    }

    /// True once the rays have met more boxes and leaves than the question is worth.
    [[nodiscard]] bool exhausted() const {
        return tracer_.counts().boxes + tracer_.counts().leaves > kRaySteps;
    }

private:
    /// Rays from one side of a box to the opposite one, not quite parallel to its edges. `to_world`
    /// takes points of the box to the world; `turn` is added to directions of size 1 there.
    template <class Map>
    bool grid(const Aabb& box, int n, const Map& to_world, Vec3 turn) {
        const Vec3 size = box.size();
        for (int axis = 0; axis < 3; ++axis) {
            const int b = (axis + 1) % 3;
            const int c = (axis + 2) % 3;
            for (int i = 0; i < n; ++i) {
                for (int j = 0; j < n; ++j) {
                    Vec3 from = box.lo;
                    Vec3 to = box.lo;
                    to[axis] += size[axis];
                    const double u = (static_cast<double>(i) + 0.4637) / n;
                    const double v = (static_cast<double>(j) + 0.5381) / n;
                    from[b] += size[b] * u;
                    from[c] += size[c] * v;
                    to[b] += size[b] * (u + 0.0713 * (0.5 - u));
                    to[c] += size[c] * (v + 0.0291 * (0.5 - v));
                    if (exhausted()) return false;
                    if (shoot(to_world(from), to_world(to), turn)) return true;
                }
            }
        }
        return false;
    }

    bool shoot(Vec3 from, Vec3 to, Vec3 turn) {
        Vec3 d = to - from;
        if (!(max_norm(d) > 0.0) || !is_finite(d)) return false;
        d = unit(d + turn * max_norm(d));
        const Aabb& all = scene_.bounds();
        const double back = 2.0 * (max_norm(all.size()) + max_norm(from - all.centre()));
        trace::RayQuery query;
        query.ray = {from - d * back, d};
        trace::Hit hit;
        return tracer_.first_hit(query, hit);
    }

    const trace::CompiledScene& scene_;
    trace::Tracer tracer_;
};

/// A box without extent in some direction holds no solid: what is closed and regularised has inner points.
bool has_room(const Aabb& box) {
    return box.lo.x < box.hi.x && box.lo.y < box.hi.y && box.lo.z < box.hi.z;
}

/// Box of one leaf that adds to the solid: the first one, going down by first operands.
Aabb first_leaf(const csg::Solid& solid) {
    const csg::Node* node = &solid.node();
    Affine map;
    while (node->kind != csg::NodeKind::leaf) {
        if (node->kind == csg::NodeKind::transform) {
            map = map * csg::as_transform(*node).map;
            node = &csg::as_transform(*node).child.node();
        } else if (node->kind == csg::NodeKind::paint) {
            node = &csg::as_paint(*node).child.node();
        } else {
            node = &csg::as_boolean(*node).operands[0].node();
        }
    }
    const solids::AnySolid& leaf = csg::as_leaf(*node).solid;
    return std::visit([&](const auto& k) { return k.bounds(map * leaf.to_object); }, leaf.kernel);
}

/// True when some leaf is a part of the solid as it is, through unions, maps and paint only: every
/// primitive has inner points. Cost: each shared Boolean once, up to the first such leaf.
bool holds_whole_leaf(const csg::Solid& solid) {
    std::vector<std::span<const csg::Solid>> open{{&solid, 1}};  // operands to be looked at
    std::unordered_set<const csg::Node*> seen;
    while (!open.empty()) {
        if (open.back().empty()) {
            open.pop_back();
            continue;
        }
        const csg::Node* node = &open.back().front().node();
        open.back() = open.back().subspan(1);
        while (node->kind == csg::NodeKind::transform || node->kind == csg::NodeKind::paint) {
            node = node->kind == csg::NodeKind::paint ? &csg::as_paint(*node).child.node()
                                                      : &csg::as_transform(*node).child.node();
        }
        if (node->kind == csg::NodeKind::leaf) return true;
        const std::vector<csg::Solid>& operands = csg::as_boolean(*node).operands;
        if (node->op != csg::Op::unite && operands.size() > 1) continue;
        if (seen.insert(node).second) open.emplace_back(operands);
    }
    return false;
}

bool stopped(Progress* progress) { return progress != nullptr && progress->cancelled(); }
Failure cancelled() { return fail(ErrorCode::cancelled, "interrupted"); }

/// `open`: cells are left. `unknown`: the work allowed was done before that could be said.
enum class Verdict : std::uint8_t { empty, present, open, unknown };

/// Halves zones, largest cells first; leaves in `cells` what is not decided.
Verdict halve(Locator& locator, std::vector<Aabb>& cells, Progress* progress) {
    const auto smaller = [](const Aabb& a, const Aabb& b) {
        return max_norm(a.size()) < max_norm(b.size());
    };
    std::priority_queue<Aabb, std::vector<Aabb>, decltype(smaller)> open(smaller, std::move(cells));
    cells.clear();
    for (std::size_t looked = 0; !open.empty() && looked < kMaxCells && !stopped(progress);
         ++looked) {
        const Aabb cell = open.top();
        open.pop();
        const Where w = locator.where_all(cell.centre(), cell.size() * 0.5);
        if (locator.exhausted()) return Verdict::unknown;
        if (w == Where::in && has_room(cell)) return Verdict::present;
        if (w == Where::out) continue;
        const Vec3 size = cell.size();
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
        const double half = cell.centre()[axis];
        if (!(cell.lo[axis] < half && half < cell.hi[axis])) {
            cells.push_back(cell);
            continue;
        }
        Aabb low = cell;
        Aabb high = cell;
        low.hi[axis] = half;
        high.lo[axis] = half;
        open.push(low);
        open.push(high);
    }
    for (; !open.empty(); open.pop()) cells.push_back(open.top());
    return cells.empty() ? Verdict::empty : Verdict::open;
}

Result<bool> search(Locator& locator, const trace::CompiledScene& compiled, Progress* progress) {
    Prober prober(compiled);
    if (prober.meets(compiled.bounds(), 4)) return false;

    const std::vector<Zone> zones = Zones(locator.graph(), compiled.bounds()).of(locator.root());
    std::vector<Aabb> cells;
    for (const Zone& zone : zones) cells.push_back(zone.box);
    locator.allow(kLocatorSteps, progress);
    const Verdict verdict = halve(locator, cells, progress);
    if (stopped(progress)) return cancelled();
    if (verdict == Verdict::empty) return true;
    if (verdict != Verdict::open) return false;

    std::size_t rays = 0;
    for (int n = 1; n <= kFinest && rays <= kRayBudget; n *= 2) {
        for (const Zone& zone : zones) {
            if (stopped(progress)) return cancelled();
            if (prober.meets(zone.box, n)) return false;
            if (zone.leaf != nullptr && prober.meets_along(*zone.leaf, zone.to_world, n)) {
                return false;
            }
            rays += 6 * static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
        }
    }
    for (const Aabb& cell : cells) {
        if (stopped(progress)) return cancelled();
        if (prober.meets(cell, 1)) return false;
    }
    return !prober.exhausted();
}

/// A block about the origin, as large as the finite things in an unbounded solid call for.
Result<csg::Solid> clip(const csg::Solid& solid) {
    double size = 1.0;
    std::vector<const csg::Node*> open{&solid.node()};
    const auto include = [&size](const Vec3& v) {
        if (is_finite(v)) size = std::max(size, max_norm(v));
    };
    for (std::size_t seen = 0; !open.empty() && seen < 100'000; ++seen) {
        const csg::Node& node = *open.back();
        open.pop_back();
        if (node.kind == csg::NodeKind::leaf) {
            const solids::AnySolid& leaf = csg::as_leaf(node).solid;
            const Aabb box =
                std::visit([&](const auto& k) { return k.bounds(leaf.to_object); }, leaf.kernel);
            include(box.lo);
            include(box.hi);
            include(leaf.to_object.offset);
        } else if (node.kind == csg::NodeKind::transform) {
            include(csg::as_transform(node).map.offset);
            open.push_back(&csg::as_transform(node).child.node());
        } else if (node.kind == csg::NodeKind::paint) {
            open.push_back(&csg::as_paint(node).child.node());
        } else {
            for (const csg::Solid& s : csg::as_boolean(node).operands) open.push_back(&s.node());
        }
    }
    const double half = 1000.0 * size;
    const auto kinds = solids::inventory();
    for (std::uint32_t i = 0; i < kinds.size(); ++i) {
        if (kinds[i].schema->name != std::string_view("sphere")) continue;
        const solids::Argument radius = half;
        Result<csg::Solid> ball = csg::primitive(i, std::span(&radius, 1));
        if (!ball) return ball;
        return csg::boolean(csg::Op::intersection, {solid, *std::move(ball)});
    }
    return solid;
}

}  // namespace

Result<bool> is_empty(const csg::Solid& solid, Progress* progress) {
    if (holds_whole_leaf(solid)) return false;
    const Aabb box = csg::bounds(solid);
    if (box.empty()) return true;
    csg::Solid finite = solid;
    if (!box.bounded()) {
        Result<csg::Solid> clipped = clip(solid);
        if (!clipped) return fail(clipped.error());
        finite = *std::move(clipped);
    }
    scene::Scene scene;
    scene.parts.push_back({"", finite, {}});
    const Result<trace::CompiledScene> compiled = trace::compile(scene, progress);
    if (!compiled) return fail(compiled.error());
    if (!has_room(compiled->bounds())) return true;
    Locator locator(finite);
    return search(locator, *compiled, progress);
}

Result<bool> is_empty(const scene::Scene& scene, const trace::CompiledScene& compiled,
                      Progress* progress) {
    for (const scene::Part& part : scene.parts) {
        if (holds_whole_leaf(part.solid)) return false;
    }
    if (!has_room(compiled.bounds())) return true;
    Prober prober(compiled);
    for (std::size_t i = 0; i < std::min<std::size_t>(scene.parts.size(), 8); ++i) {
        const Aabb box = overlap(first_leaf(scene.parts[i].solid), compiled.bounds());
        if (has_room(box) && prober.meets(box, 2)) return false;
    }
    Locator locator(scene);
    return search(locator, compiled, progress);
}

}  // namespace raymo::query
