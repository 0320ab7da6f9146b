#include "raymo/trace/units.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <span>

namespace raymo::trace {
namespace {

/// Leaves of a product that stands in the tree as a whole, at most: more are found sooner by their own boxes.
constexpr std::size_t kMostTogether = 4;

/// Leaves of a product's core that may have several spans.
constexpr int kMostBranching = 2;

/// Leaves of one product, by their number in the order of the model.
struct Product {
    std::uint32_t group;
    std::vector<std::uint32_t> core;                 ///< all of which a place must be in
    std::vector<std::uint32_t> united;               ///< or any of these
    std::vector<std::vector<std::uint32_t>> joined;  ///< or in the product of any of these lists
    std::vector<std::uint32_t> cutters;              ///< and in none of these
    /// There is a union, though all of its leaves may have been left out, as they lie outside of the core.
    bool has_union;
    std::uint32_t root = kNone;  ///< node of the tree of the cutters
};

struct Unit {
    std::uint32_t first;  ///< its leaves are members_[first ...]
    std::uint32_t size;   ///< so many
};

/// In place of a count, while trees are joined: the child is the root of another tree.
constexpr std::uint8_t kTree = 0xff;

BvhNode empty_node() {
    BvhNode node{};
    for (std::size_t a = 0; a < 3; ++a) {
        std::fill(std::begin(node.lo[a]), std::end(node.lo[a]),
                  std::numeric_limits<float>::infinity());
        std::fill(std::begin(node.hi[a]), std::end(node.hi[a]),
                  -std::numeric_limits<float>::infinity());
    }
    return node;
}

bool meet(const Boxf& a, const Boxf& b) {
    for (std::size_t k = 0; k < 3; ++k) {
        if (a.lo[k] > b.hi[k] || b.lo[k] > a.hi[k]) return false;
    }
    return true;
}

class Planter {
public:
    Planter(CompiledSolid& solid, const std::vector<Boxf>& boxes, const CompiledScene::Data& data)
        : solid_(solid), boxes_(boxes), data_(data) {
        for (std::uint32_t type = 0; type < kInstanceType; ++type) kinds_[type] = kind_of(type);
        kinds_[kInstanceType] = LeafKind::single_rays;
    }
    void plant() {
        sort_out();
        const std::vector<BvhNode> top = make_top();
        solid_.nodes = top;
        std::vector<Leaf> planted;
        planted.reserve(solid_.leaves.size());
        solid_.units = plant_units(planted);
        for (Product& product : products_) {
            if (!product.cutters.empty()) product.root = plant_cutters(product, planted);
        }
        solid_.leaves = std::move(planted);
        for (std::size_t n = 0; n < top.size(); ++n) join_top(solid_.nodes[n]);
        for (std::size_t u = 0; u < solid_.leaves.size(); ++u) find_cutters(solid_.leaves[u]);
        mark_alone();
    }

private:
    [[nodiscard]] LeafKind kind(std::uint32_t leaf) const {
        return kinds_[data_.frames[solid_.leaves[leaf].frame].type];
    }
    /// Whether packets can go through all choices of a span of each leaf.
    [[nodiscard]] bool few_spans(const std::vector<std::uint32_t>& leaves) const {
        return all_in_lanes(leaves) &&
               std::count_if(leaves.begin(), leaves.end(), [&](std::uint32_t l) {
                   return kind(l) == LeafKind::spans;
               }) <= kMostBranching;
    }
    /// False for what is called a union here and is part of a difference: b - c in a - (b - c).
    [[nodiscard]] bool none_cuts(const std::vector<std::uint32_t>& leaves) const {
        return std::none_of(leaves.begin(), leaves.end(), [&](std::uint32_t l) {
            return data_.looks[solid_.leaves[l].look].cuts;
        });
    }
    [[nodiscard]] bool all_in_lanes(const std::vector<std::uint32_t>& leaves) const {
        return std::all_of(leaves.begin(), leaves.end(),
                           [&](std::uint32_t l) { return kind(l) != LeafKind::single_rays; });
    }

    /// What each group is: a product of leaves right below a part's root, the union that one starts from, a product of leaves
    /// in such a union, or none of these.
    void find_products() {
        const auto& groups = solid_.groups;
        std::vector<std::uint32_t> below(groups.size());  // groups right below each
        for (std::size_t g = solid_.parts; g < groups.size(); ++g) ++below[groups[g].parent];
        product_of_.assign(groups.size(), kNone);
        const auto is_top = [&](std::uint32_t g) {
            return g >= solid_.parts && groups[g].parent < solid_.parts && groups[g].negated;
        };
        std::vector<std::uint32_t> deeper(groups.size());  // groups right below those
        for (std::size_t g = solid_.parts; g < groups.size(); ++g) {
            if (groups[g].parent >= solid_.parts) deeper[groups[g].parent] += below[g];
        }
        joined_of_.assign(groups.size(), kNone);
        for (std::uint32_t g = solid_.parts; g < groups.size(); ++g) {
            const std::uint32_t top = groups[g].parent;
            const bool is_union =
                is_top(top) && below[top] == 1 && deeper[g] == 0 && groups[g].negated;
            const bool is_product = is_top(g) && below[g] == 0;
            if (!is_union && !is_product) continue;
            product_of_[g] = static_cast<std::uint32_t>(products_.size());
            if (is_union) product_of_[top] = product_of_[g];
            products_.push_back({is_union ? top : g, {}, {}, {}, {}, is_union});
        }
        for (std::uint32_t g = solid_.parts; g < groups.size(); ++g) {
            const std::uint32_t above = groups[g].parent;
            if (above < solid_.parts || product_of_[above] == kNone || product_of_[g] != kNone)
                continue;
            Product& product = products_[product_of_[above]];
            if (above == product.group || !groups[g].negated) continue;
            product_of_[g] = product_of_[above];
            joined_of_[g] = static_cast<std::uint32_t>(product.joined.size());
            product.joined.emplace_back();
        }
    }

    /// Makes the units.
    void sort_out() {
        find_products();
        solid_.simple = true;
        units_.reserve(solid_.leaves.size());
        members_.reserve(solid_.leaves.size());
        unit_boxes_.reserve(solid_.leaves.size());
        for (std::uint32_t i = 0; i < solid_.leaves.size(); ++i) {
            const Leaf& leaf = solid_.leaves[i];
            const std::uint32_t number = product_of_[leaf.parent];
            if (number == kNone) {
                if (leaf.parent >= solid_.parts || kind(i) == LeafKind::single_rays)
                    solid_.simple = false;
                add_unit({&i, 1}, boxes_[i]);
                continue;
            }
            Product& product = products_[number];
            if (joined_of_[leaf.parent] != kNone) {
                product.joined[joined_of_[leaf.parent]].push_back(i);
            } else if (leaf.parent != product.group) {
                product.united.push_back(i);
            } else {
                (data_.looks[leaf.look].cuts ? product.cutters : product.core).push_back(i);
            }
        }
        for (Product& product : products_) make_units(product);
    }

    void add_unit(std::span<const std::uint32_t> leaves, const Boxf& box) {
        units_.push_back({static_cast<std::uint32_t>(members_.size()),
                          static_cast<std::uint32_t>(leaves.size())});
        members_.insert(members_.end(), leaves.begin(), leaves.end());
        unit_boxes_.push_back(box);
    }
    void make_units(Product& product) {
        std::vector<std::uint32_t> all = product.core;
        all.insert(all.end(), product.cutters.begin(), product.cutters.end());
        const bool can_be_cut = all_in_lanes(product.cutters) && !product.cutters.empty();
        // To ask several curved ones costs more than to look at their boxes.
        const auto costly = std::count_if(
            product.cutters.begin(), product.cutters.end(),
            [&](std::uint32_t l) { return data_.frames[solid_.leaves[l].frame].in_blocks; });
        const std::size_t most = product.cutters.empty() ? kMostInUnit
                                 : costly > 1            ? 0
                                                         : kMostTogether;
        if (!product.has_union && !product.core.empty() && all.size() <= most &&
            few_spans(product.core) && all_in_lanes(product.cutters)) {
            product.cutters.clear();
            add_unit(all, box_of(all));
        } else if (!product.has_union && !product.core.empty() &&
                   product.core.size() <= kMostInUnit && few_spans(product.core) && can_be_cut) {
            add_unit(product.core, box_of(product.core));
        } else if (has_leaves(product) && product.core.empty() && none_cuts(product.united) &&
                   all_in_lanes(product.united) && all_stand_together(product.joined) &&
                   can_be_cut && lend_alike(product)) {
            // (a + b) - c = (a - c) + (b - c).
            for (const std::uint32_t& leaf : product.united) add_unit({&leaf, 1}, boxes_[leaf]);
            for (const auto& leaves : product.joined) {
                if (!leaves.empty()) add_unit(leaves, box_of(leaves));
            }
        } else {
            product.cutters.clear();
            solid_.simple = false;
            all.insert(all.end(), product.united.begin(), product.united.end());
            for (const auto& leaves : product.joined)
                all.insert(all.end(), leaves.begin(), leaves.end());
            for (const std::uint32_t& leaf : all) add_unit({&leaf, 1}, boxes_[leaf]);
        }
    }
    [[nodiscard]] static bool has_leaves(const Product& product) {
        return !product.united.empty() ||
               std::any_of(product.joined.begin(), product.joined.end(),
                           [](const auto& leaves) { return !leaves.empty(); });
    }
    /// Whether each list is a product that can stand in the tree as a whole; its core comes first then.
    [[nodiscard]] bool all_stand_together(std::vector<std::vector<std::uint32_t>>& joined) const {
        return std::all_of(joined.begin(), joined.end(), [&](std::vector<std::uint32_t>& leaves) {
            const auto end_of_core = std::stable_partition(
                leaves.begin(), leaves.end(),
                [&](std::uint32_t l) { return !data_.looks[solid_.leaves[l].look].cuts; });
            const std::vector<std::uint32_t> core(leaves.begin(), end_of_core);
            return leaves.empty() || (!core.empty() && leaves.size() <= kMostTogether &&
                                      few_spans(core) && all_in_lanes(leaves));
        });
    }
    /// Whether a cutter that shows the material of what it cuts shows the same wherever it cuts.
    [[nodiscard]] bool lend_alike(const Product& product) const {
        const auto look = [&](std::uint32_t leaf) -> const Look& {
            return data_.looks[solid_.leaves[leaf].look];
        };
        std::vector<std::uint32_t> all = product.united;
        for (const auto& leaves : product.joined)
            all.insert(all.end(), leaves.begin(), leaves.end());
        const csg::MaterialId material = look(all.front()).material;
        return std::all_of(all.begin(), all.end(),
                           [&](std::uint32_t l) { return look(l).material == material; }) ||
               std::none_of(product.cutters.begin(), product.cutters.end(),
                            [&](std::uint32_t l) { return look(l).borrows; });
    }
    [[nodiscard]] Boxf box_of(const std::vector<std::uint32_t>& leaves) const {
        Boxf box = boxes_[leaves.front()];
        for (const std::uint32_t leaf : leaves) box = hull(box, boxes_[leaf]);
        return box;
    }

    /// The nodes above the tree of the units and those of the cutters, by which single rays find both. As children they have
    /// the numbers of the trees: 0 for the units, 1 + p for product p.
    [[nodiscard]] std::vector<BvhNode> make_top() const {
        std::vector<Boxf> boxes;
        std::vector<std::uint32_t> trees;
        for (std::uint32_t p = 0; p < products_.size(); ++p) {
            if (products_[p].cutters.empty()) continue;
            boxes.push_back(box_of(products_[p].cutters));
            trees.push_back(1 + p);
        }
        if (boxes.empty()) return {};
        Boxf all = unit_boxes_.front();
        for (const Boxf& box : unit_boxes_) all = hull(all, box);
        boxes.push_back(all);
        trees.push_back(0);
        Bvh bvh = build_bvh(boxes);
        const std::size_t count = bvh.nodes.size();
        for (std::size_t n = 0; n < count; ++n) {
            for (int c = 0; c < BvhNode::kWidth; ++c) {
                const std::uint8_t size = bvh.nodes[n].count[c];
                if (size == 0) continue;
                const std::uint32_t first = bvh.nodes[n].ref[c];
                bvh.nodes[n].count[c] = kTree;
                bvh.nodes[n].ref[c] = trees[bvh.order[first]];
                if (size == 1) continue;
                // A range of several: a node of their own.
                BvhNode node = empty_node();
                for (std::uint8_t k = 0; k < size; ++k) {
                    const std::uint32_t item = bvh.order[first + k];
                    for (std::size_t a = 0; a < 3; ++a) {
                        node.lo[a][k] = boxes[item].lo[a];
                        node.hi[a][k] = boxes[item].hi[a];
                    }
                    node.count[k] = kTree;
                    node.ref[k] = trees[item];
                }
                bvh.nodes[n].count[c] = 0;
                bvh.nodes[n].ref[c] = static_cast<std::uint32_t>(bvh.nodes.size());
                bvh.nodes.push_back(node);
            }
        }
        return std::move(bvh.nodes);
    }
    /// Puts the roots of the trees in the place of their numbers.
    void join_top(BvhNode& node) const {
        for (int c = 0; c < BvhNode::kWidth; ++c) {
            if (node.count[c] != kTree) continue;
            node.count[c] = 0;
            node.ref[c] = node.ref[c] == 0 ? solid_.units : products_[node.ref[c] - 1].root;
        }
    }

    std::uint32_t plant_units(std::vector<Leaf>& planted) {
        Bvh tree = build_bvh(unit_boxes_);
        std::vector<std::uint32_t> place;  // of each unit's first leaf, in the order of the tree
        place.reserve(units_.size() + 1);
        for (const std::uint32_t u : tree.order) {
            const Unit& unit = units_[u];
            place.push_back(static_cast<std::uint32_t>(planted.size()));
            for (std::uint32_t k = 0; k < unit.size; ++k) {
                planted.push_back(solid_.leaves[members_[unit.first + k]]);
                planted.back().unit =
                    k == 0 ? static_cast<std::uint8_t>(unit.size) : std::uint8_t{0};
            }
        }
        place.push_back(static_cast<std::uint32_t>(planted.size()));
        for (std::size_t i = 0; i < tree.order.size(); ++i) {
            Leaf& leaf = planted[place[i]];
            leaf.apart = leaf.unit == 1 && data_.has_transparency &&
                         data_.is_transparent(data_.looks[leaf.look].material) &&
                         stands_apart(tree, tree.order[i]);
        }
        return append(std::move(tree), [&](std::uint32_t unit) { return place[unit]; });
    }
    /// Whether the box of a unit meets that of no other.
    [[nodiscard]] bool stands_apart(const Bvh& tree, std::uint32_t unit) const {
        const Boxf& box = unit_boxes_[unit];
        std::vector<std::uint32_t> open{0};
        while (!open.empty()) {
            const BvhNode& node = tree.nodes[open.back()];
            open.pop_back();
            for (std::size_t c = 0; c < BvhNode::kWidth; ++c) {
                if (!meet(box, {{node.lo[0][c], node.lo[1][c], node.lo[2][c]},
                                {node.hi[0][c], node.hi[1][c], node.hi[2][c]}}))
                    continue;
                if (node.count[c] == 0) open.push_back(node.ref[c]);
                for (std::uint32_t k = 0; k < node.count[c]; ++k) {
                    const std::uint32_t other = tree.order[node.ref[c] + k];
                    if (other != unit && meet(box, unit_boxes_[other])) return false;
                }
            }
        }
        return true;
    }

    std::uint32_t plant_cutters(const Product& product, std::vector<Leaf>& planted) {
        std::vector<Boxf> boxes;
        boxes.reserve(product.cutters.size());
        for (const std::uint32_t leaf : product.cutters) boxes.push_back(boxes_[leaf]);
        Bvh tree = build_bvh(boxes);
        const auto first = static_cast<std::uint32_t>(planted.size());
        for (const std::uint32_t i : tree.order)
            planted.push_back(solid_.leaves[product.cutters[i]]);
        return append(std::move(tree), [first](std::uint32_t leaf) { return first + leaf; });
    }

    /// Tells the first leaf of a unit where the cutters of its product are, and the product where its core is.
    void find_cutters(Leaf& leaf) {
        const std::uint32_t number = product_of_[leaf.parent];
        if (number == kNone || leaf.unit == 0) return;
        const Product& product = products_[number];
        if (product.root == kNone || data_.looks[leaf.look].cuts) return;
        leaf.cutters = product.root;
        solid_.groups[product.group].core =
            static_cast<std::uint32_t>(&leaf - solid_.leaves.data());
    }

    /// Adds a tree to the nodes, and returns its root. place(i): the leaf where range number i begins.
    template <class Place>
    std::uint32_t append(Bvh tree, Place&& place) {
        const auto base = static_cast<std::uint32_t>(solid_.nodes.size());
        for (BvhNode& node : tree.nodes) {
            for (int c = 0; c < BvhNode::kWidth; ++c) {
                if (node.count[c] == 0) {
                    node.ref[c] += base;
                    continue;
                }
                const std::uint32_t begin = place(node.ref[c]);
                const std::uint32_t end = place(node.ref[c] + node.count[c]);
                node.ref[c] = begin;
                node.count[c] = static_cast<std::uint8_t>(end - begin);
            }
        }
        if (base == 0) {
            solid_.nodes = std::move(tree.nodes);
        } else {
            solid_.nodes.insert(solid_.nodes.end(), tree.nodes.begin(), tree.nodes.end());
        }
        return base;
    }

    void mark_alone() {
        std::vector<std::uint32_t> members(solid_.parts);  // right below each part's root
        for (const Leaf& leaf : solid_.leaves) {
            if (leaf.parent < solid_.parts) ++members[leaf.parent];
        }
        for (const Group& group : solid_.groups) {
            if (group.parent < solid_.parts) ++members[group.parent];
        }
        for (Leaf& leaf : solid_.leaves) {
            leaf.alone = leaf.parent < solid_.parts && members[leaf.parent] == 1;
            leaf.apart = leaf.apart && leaf.alone;
        }
    }

    CompiledSolid& solid_;
    const std::vector<Boxf>& boxes_;
    const CompiledScene::Data& data_;
    std::array<LeafKind, kInstanceType + 1> kinds_;
    std::vector<Unit> units_;
    std::vector<std::uint32_t> members_;  ///< leaves of the units, in the order of the model
    std::vector<Boxf> unit_boxes_;
    std::vector<Product> products_;
    std::vector<std::uint32_t> product_of_;  ///< by group: number of the product, or kNone
    std::vector<std::uint32_t> joined_of_;   ///< by group: which of the product's lists, or kNone
};

}  // namespace

void plant_trees(CompiledSolid& solid, const std::vector<Boxf>& boxes,
                 const CompiledScene::Data& data) {
    Planter(solid, boxes, data).plant();
}

}  // namespace raymo::trace
