#include "raymo/trace/units.hpp"

#include <algorithm>
#include <array>
#include <span>

namespace raymo::trace {
namespace {

/// Leaves of a product that stands in the tree as a whole, at most: more are found sooner by their own boxes.
constexpr std::size_t kMostTogether = 4;

/// Leaves of one product, by their number in the order of the model.
struct Product {
    std::uint32_t group;
    std::vector<std::uint32_t> core;
    std::vector<std::uint32_t> cutters;
};

struct Unit {
    std::uint32_t first;    ///< its leaves are members_[first ...]
    std::uint32_t size;     ///< so many
    std::uint32_t product;  ///< if it is the core of one: which
};

class Planter {
public:
    Planter(CompiledSolid& solid, const std::vector<Boxf>& boxes, const CompiledScene::Data& data)
        : solid_(solid), boxes_(boxes), data_(data) {
        for (std::uint32_t type = 0; type < kInstanceType; ++type) kinds_[type] = kind_of(type);
        kinds_[kInstanceType] = LeafKind::single_rays;
    }
    void plant() {
        sort_out();
        std::vector<Leaf> planted;
        planted.reserve(solid_.leaves.size());
        plant_units(planted);
        for (const Product& product : products_) {
            if (!product.cutters.empty()) plant_cutters(product, planted);
        }
        solid_.leaves = std::move(planted);
        mark_alone();
    }

private:
    [[nodiscard]] LeafKind kind(std::uint32_t leaf) const {
        return kinds_[data_.frames[solid_.leaves[leaf].frame].type];
    }
    [[nodiscard]] bool all_convex(const std::vector<std::uint32_t>& leaves) const {
        return std::all_of(leaves.begin(), leaves.end(),
                           [&](std::uint32_t l) { return kind(l) == LeafKind::one_span; });
    }
    [[nodiscard]] bool all_in_lanes(const std::vector<std::uint32_t>& leaves) const {
        return std::all_of(leaves.begin(), leaves.end(),
                           [&](std::uint32_t l) { return kind(l) != LeafKind::single_rays; });
    }

    /// Makes the units.
    void sort_out() {
        const auto& groups = solid_.groups;
        // A group that is a product of nothing but leaves, right below a part's root.
        std::vector<bool> is_product(groups.size());
        for (std::size_t g = solid_.parts; g < groups.size(); ++g)
            is_product[g] = groups[g].parent < solid_.parts && groups[g].negated;
        for (std::size_t g = solid_.parts; g < groups.size(); ++g)
            is_product[groups[g].parent] = false;

        solid_.simple = true;
        units_.reserve(solid_.leaves.size());
        members_.reserve(solid_.leaves.size());
        unit_boxes_.reserve(solid_.leaves.size());
        std::vector<std::uint32_t> product_of(groups.size(), kNone);
        for (std::uint32_t i = 0; i < solid_.leaves.size(); ++i) {
            const Leaf& leaf = solid_.leaves[i];
            if (!is_product[leaf.parent]) {
                if (leaf.parent >= solid_.parts || kind(i) == LeafKind::single_rays)
                    solid_.simple = false;
                add_unit({&i, 1}, boxes_[i]);
                continue;
            }
            std::uint32_t& number = product_of[leaf.parent];
            if (number == kNone) {
                number = static_cast<std::uint32_t>(products_.size());
                products_.push_back({leaf.parent, {}, {}});
            }
            const bool cuts = !data_.looks[leaf.look].literal_negated;
            (cuts ? products_[number].cutters : products_[number].core).push_back(i);
        }
        for (std::uint32_t p = 0; p < products_.size(); ++p) make_units(p);
    }

    void add_unit(std::span<const std::uint32_t> leaves, const Boxf& box,
                  std::uint32_t product = kNone) {
        units_.push_back({static_cast<std::uint32_t>(members_.size()),
                          static_cast<std::uint32_t>(leaves.size()), product});
        members_.insert(members_.end(), leaves.begin(), leaves.end());
        unit_boxes_.push_back(box);
    }
    void make_units(std::uint32_t number) {
        Product& product = products_[number];
        std::vector<std::uint32_t> all = product.core;
        all.insert(all.end(), product.cutters.begin(), product.cutters.end());
        const bool core_fits =
            !product.core.empty() && product.core.size() <= kMostInUnit && all_convex(product.core);
        if (core_fits && all.size() <= kMostTogether && all_convex(all)) {
            product.cutters.clear();
            add_unit(all, box_of(all));
        } else if (core_fits && all_in_lanes(all)) {
            add_unit(product.core, box_of(all), number);
        } else {
            product.cutters.clear();
            solid_.simple = false;
            for (const std::uint32_t& leaf : all) add_unit({&leaf, 1}, boxes_[leaf]);
        }
    }
    [[nodiscard]] Boxf box_of(const std::vector<std::uint32_t>& leaves) const {
        Boxf box = boxes_[leaves.front()];
        for (const std::uint32_t leaf : leaves) box = hull(box, boxes_[leaf]);
        return box;
    }

    void plant_units(std::vector<Leaf>& planted) {
        const Bvh tree = build_bvh(unit_boxes_);
        std::vector<std::uint32_t> place;  // of each unit's first leaf, in the order of the tree
        place.reserve(units_.size() + 1);
        for (const std::uint32_t u : tree.order) {
            const Unit& unit = units_[u];
            const auto first = static_cast<std::uint32_t>(planted.size());
            place.push_back(first);
            for (std::uint32_t k = 0; k < unit.size; ++k) {
                planted.push_back(solid_.leaves[members_[unit.first + k]]);
                planted.back().unit =
                    k == 0 ? static_cast<std::uint8_t>(unit.size) : std::uint8_t{0};
            }
            if (unit.product != kNone) solid_.groups[products_[unit.product].group].core = first;
        }
        place.push_back(static_cast<std::uint32_t>(planted.size()));
        append(tree, [&](std::uint32_t unit) { return place[unit]; });
    }

    void plant_cutters(const Product& product, std::vector<Leaf>& planted) {
        std::vector<Boxf> boxes;
        boxes.reserve(product.cutters.size());
        for (const std::uint32_t leaf : product.cutters) boxes.push_back(boxes_[leaf]);
        const Bvh tree = build_bvh(boxes);
        const auto first = static_cast<std::uint32_t>(planted.size());
        for (const std::uint32_t i : tree.order)
            planted.push_back(solid_.leaves[product.cutters[i]]);
        planted[solid_.groups[product.group].core].cutters =
            static_cast<std::uint32_t>(solid_.nodes.size());
        append(tree, [first](std::uint32_t leaf) { return first + leaf; });
    }

    /// Adds a tree to the nodes. place(i): the leaf where range number i begins.
    template <class Place>
    void append(const Bvh& tree, Place&& place) {
        const auto base = static_cast<std::uint32_t>(solid_.nodes.size());
        for (BvhNode node : tree.nodes) {
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
            solid_.nodes.push_back(node);
        }
    }

    void mark_alone() {
        std::vector<std::uint32_t> members(solid_.parts);  // right below each part's root
        for (const Leaf& leaf : solid_.leaves) {
            if (leaf.parent < solid_.parts) ++members[leaf.parent];
        }
        for (const Group& group : solid_.groups) {
            if (group.parent < solid_.parts) ++members[group.parent];
        }
        for (Leaf& leaf : solid_.leaves)
            leaf.alone = leaf.parent < solid_.parts && members[leaf.parent] == 1;
    }

    CompiledSolid& solid_;
    const std::vector<Boxf>& boxes_;
    const CompiledScene::Data& data_;
    std::array<LeafKind, kInstanceType + 1> kinds_;
    std::vector<Unit> units_;
    std::vector<std::uint32_t> members_;  ///< leaves of the units, in the order of the model
    std::vector<Boxf> unit_boxes_;
    std::vector<Product> products_;
};

}  // namespace

void plant_trees(CompiledSolid& solid, const std::vector<Boxf>& boxes,
                 const CompiledScene::Data& data) {
    Planter(solid, boxes, data).plant();
}

}  // namespace raymo::trace
