// Where a line meets patches; derivation in search.cpp.
#pragma once

#include <cstdint>

#include "raymo/core/small_list.hpp"
#include "raymo/math/vec2.hpp"
#include "raymo/solids/freeform/surface.hpp"

namespace raymo::solids {

/// A line in lengths, and a frame about it. The true line may be off by `error` anywhere near the surface, and so may be
/// what is computed of the patches.
struct FreeformLine {
    Vec3 o;
    Vec3 along, side, up;
    double error = 0.0;
};

/// A crossing that is certain: every line that is within the error crosses the patch once here, within `reach` of s.
struct FreeformHit {
    double s;
    double reach;
    double u, v;
    double blur_u, blur_v;  ///< the true u and v are within these
    std::uint32_t patch;
    int turn;  ///< +1: inwards, -1: outwards
};

/// All other crossings of lines within the error lie in such intervals.
struct FreeformDoubt {
    double lo, hi;
    bool is_border;  ///< the given line itself crosses in the middle, at a border of a patch
};

struct FreeformFound {
    SmallList<FreeformHit, 12> hits;
    SmallList<FreeformDoubt, 12> doubts;

    /// Leaves may share a crossing at their borders: it is one.
    void add(const FreeformHit& hit);
    /// Those that overlap become one, but at borders.
    void doubt(const FreeformDoubt& doubt);
};

/// Vectors between two directions less than half a turn apart, or within `radius` of one of both.
struct FreeformCone {
    Vec2 lo, hi;
    double radius = 0.0;
};

/// Second derivatives on [0, 1]^2, taken so much larger, bound those beyond it by 1/8.
inline constexpr double kBeyondPatch = 1.25 * 1.25 * 1.25 * 1.25;
inline constexpr int kMostFreeformSteps = 12;  ///< of Newton's

/// Looks for the crossing of a line with a part of a patch that it can cross only once: all derivatives by u, times all by
/// v, turn the same way.
class FreeformSearch {
public:
    FreeformSearch(const FreeformSurface& surface, const FreeformLine& line, FreeformFound& found)
        : surface_(surface), line_(line), found_(found) {}

    void run();
    /// The crossings with one leaf.
    void meet(const FreeformLeaf& leaf);

private:
    enum class Answer { done, unclear };
    [[nodiscard]] Vec2 across(Vec3 v) const { return {dot(v, line_.side), dot(v, line_.up)}; }
    [[nodiscard]] Answer solve(std::uint32_t patch, const PatchPart& part, const FreeformCone& du,
                               const FreeformCone& dv, double u, double v);
    /// By halving the part until it is missed, or can be met only once, or is as small as the error.
    void search(std::uint32_t patch, const PatchPart& part);

    const FreeformSurface& surface_;
    const FreeformLine& line_;
    FreeformFound& found_;
};

}  // namespace raymo::solids
