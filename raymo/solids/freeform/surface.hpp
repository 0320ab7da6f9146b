// A closed surface of bicubic patches as rays meet it: cut into nearly flat leaves under a tree of boxes.
#pragma once

#include <cstdint>
#include <vector>

#include "raymo/meshes/shell.hpp"
#include "raymo/solids/freeform/patch.hpp"
#include "raymo/solids/slabs.hpp"

namespace raymo::solids {

/// A part of a patch. With x, y in [-1/2, 1/2] across it,
///     S = middle + x du + y dv + r,  |r| <= |x| spread_u + |y| spread_v,
/// and everywhere in it the derivatives by x and y are within spread_u of du and within spread_v of dv.
struct FreeformLeaf {
    Vec3 middle, du, dv;
    double spread_u = 0.0, spread_v = 0.0;
    double reach = 0.0;  ///< no place of it is further from the middle
    PatchPart part = kWholePatch;
    std::uint32_t patch = 0;
};

struct FreeformNode {
    /// In `child`: what follows is the number of a leaf, not of a node.
    static constexpr std::uint32_t kLeaf = 0x80000000U;

    EightBoxes boxes;
    std::uint32_t child[EightBoxes::kWidth] = {};
};

/// Immutable once built, and shared by the copies of a kernel. The control points are within the cube from -1 to 1.
struct FreeformSurface {
    meshes::Shell shell;

    // What follows from it.
    std::vector<Patch> patches;
    std::vector<FreeformLeaf> leaves;
    std::vector<FreeformNode> nodes;  ///< the first is the root
    std::vector<std::uint32_t>
        first_leaf;  ///< of each patch: its leaves stand together; and their count

    void finish();
    [[nodiscard]] double bytes() const;
};

/// Faces are numbered 2 n for patch p, n = p mod kPatchNumbers, and 2 n + 1 where the surface winds around the solid the
/// other way, so that the solid is before the patch. Patches of the same number are told apart by where they are.
inline constexpr std::uint16_t kInsideOut = 1;
inline constexpr std::uint32_t kPatchNumbers = 0x8000;
/// Patches of a surface, at most: some 300 MB.
inline constexpr std::size_t kMostPatches = 0x40000;

/// Nodes of a tree that wait for a line, at most: 7 of each level. There are at most 2^22 leaves, and all levels but the last
/// are full.
inline constexpr std::size_t kMostFreeformWaiting = std::size_t{8} * 9;

/// Error of a place on a patch, seen across a line, when all coordinates are below 1.75: 20 roundings of the sums of
/// weights and points, one of the difference to the line's place, 5 of its product with a vector of the frame, for three
/// coordinates; and 4 for the angles of the frame.
inline constexpr double kFreeformOwnError = 0x1p-47;

}  // namespace raymo::solids
