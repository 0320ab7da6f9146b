// What a compiled scene is made of. Private to trace/.
//
// Each compiled solid lives in its own normalised frame: centred on its box and scaled by a power
// of two (exactly), so that it is about as large as the unit ball. Its leaves lie in a tree of
// boxes; a leaf is a canonical kernel, a matrix into the kernel's frame (a Frame, shared by all
// leaves that differ only in place) and a centre.
//
// Booleans are kept as one kind of group: the OR of literals, where a literal is a leaf or group,
// or its negation. By De Morgan a & b = not (not a or not b), and a - b = not (not a or b), so a
// group needs one counter: how many of its literals are true. A leaf that is entered or left
// changes its parent's counter by one; only a counter that leaves or reaches zero changes the
// group's value and is passed on. Chains of one operation become one group.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <vector>

#include "raymo/trace/bvh.hpp"
#include "raymo/trace/compiled_scene.hpp"

namespace raymo::trace {

inline constexpr std::uint32_t kNone = 0xffffffffU;

/// Kernel types are numbered as in solids::AnyKernel; this number means an instance of another
/// compiled solid.
inline constexpr std::uint32_t kInstanceType = static_cast<std::uint32_t>(solids::Inventory::kSize);

/// From the normalised frame of a compiled solid to the canonical frame of a leaf (or to the
/// normalised frame of an instanced solid).
struct Frame {
    Mat3 to_local;
    Vec3 row_length;         ///< lengths of the rows of to_local
    Vec3 error;              ///< of to_local itself, over the leaf, in the leaf's frame
    bool diagonal;           ///< to_local has nothing beside its diagonal
    bool in_blocks = false;  ///< its kernel answers packets in blocks (blocks.hpp)
    double reach;        ///< the leaf lies within this of its centre, in its frame; may be infinite
    double stretch;      ///< by how much to_local lengthens at most, in lengths of its longest row
    std::uint32_t type;  ///< kernel type, or kInstanceType
    std::uint32_t index;  ///< which kernel of that type, or which compiled solid
};

struct Leaf {
    Vec3 centre;         ///< in the normalised frame
    float displacement;  ///< how far the true leaf may lie from this one, in the normalised frame
    std::uint32_t frame;
    std::uint32_t parent;  ///< group
    std::uint32_t look;
    std::uint32_t order;  ///< place in the model, left to right
    std::uint32_t cutters =
        kNone;              ///< first leaf of a core: the node that is the root of its cutters
    std::uint8_t unit = 1;  ///< first leaf of a unit: how many leaves the unit has; 0: a later one
    bool alone = false;     ///< the only leaf of its part
    /// And transparent, with a box that meets that of no other: who is inside meets its own surface first.
    bool apart = false;
};

/// How the kernels of a type are computed for several rays at once.
enum class LeafKind : std::uint8_t {
    one_span,     ///< side by side; convex
    spans,        ///< side by side; several spans
    single_rays,  ///< one ray after the other, and instances
};
[[nodiscard]] LeafKind kind_of(std::uint32_t type);

/// Leaves of a unit (units.hpp), at most.
inline constexpr std::uint8_t kMostInUnit = 8;

/// What many leaves share.
struct Look {
    csg::MaterialId material = csg::kNoMaterial;
    std::uint32_t primitive = 0;  ///< index into the inventory
    SourceSpan span;
    bool literal_negated = false;  ///< in the leaf's parent group
    bool cuts = false;             ///< the leaf is taken away: its outside is the solid's inside
    bool borrows = false;          ///< a cutter without material: its faces look like what they cut

    friend bool operator==(const Look&, const Look&) = default;
};

struct Group {
    std::uint32_t parent = kNone;  ///< group; kNone: this is the root of part number `own index`
    std::int32_t initial = 0;      ///< literals that are true where all leaves are out
    bool negated = false;          ///< as a literal of the parent
    bool taken_away = false;       ///< an odd number of negations from the root
    std::uint32_t core = kNone;    ///< a leaf of the product's core, if it has a tree of cutters
};

/// One solid (or, for the base of the scene, all parts side by side) made ready for rays.
struct CompiledSolid {
    std::uint32_t parts = 1;  ///< groups[0 .. parts) are the roots of the parts
    std::vector<Group> groups;
    std::vector<Leaf> leaves;    ///< in the order of the tree of boxes
    std::vector<BvhNode> nodes;  ///< nodes[0] is the root of all
    std::uint32_t units = 0;     ///< root of the tree of units, without cutters
    Vec3 centre;                 ///< model frame -> normalised frame: (x - centre) * scale
    double scale = 1.0;
    Aabb bounds;          ///< of the leaves, each within its active zone, in the model frame
    bool simple = false;  ///< every part is a union of units that packets can compute
    std::uint32_t first_leaf = 0;  ///< leaves of all solids are numbered on from here
};

template <class... Ks>
std::tuple<std::vector<Ks>...> kernel_tables_of(const std::variant<Ks...>*);
using KernelTables = decltype(kernel_tables_of(static_cast<const solids::AnyKernel*>(nullptr)));

struct CompiledScene::Data {
    std::vector<CompiledSolid> solids;  ///< solids[0] is the base
    std::vector<Frame> frames;
    KernelTables kernels;
    std::vector<Look> looks;
    scene::MaterialTable materials;
    scene::Material default_material;
    double leaf_count = 0.0;
    bool has_transparency = false;
    bool has_absorption = false;

    [[nodiscard]] bool is_transparent(csg::MaterialId m) const {
        return m < materials.size() && materials[m].transmission > 0.0;
    }
};

}  // namespace raymo::trace
