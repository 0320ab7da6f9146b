// Where a line crosses the swept boundary of a region, gathered piece by piece, and what of the line is inside.
//
// Each crossing is known to lie in an interval of the line; so does each place where the line comes within its error of the
// boundary without crossing it. What overlaps can not be told apart and is taken together: if it changes nothing in the
// end, there is no surface, only a touch. The winding number of the region decides, so that a boundary inside the region (of
// curves that overlap, filled by the non-zero rule) is none.
#pragma once

#include <algorithm>

#include "raymo/core/small_list.hpp"
#include "raymo/curves/region.hpp"
#include "raymo/solids/span.hpp"

namespace raymo::solids {

/// Faces of the walls over a contour follow those of the ends: two for each of its smooth stretches, one for each side.
inline constexpr std::uint32_t kFirstWall = 2;
/// So many stretches have faces of their own; beyond, they are numbered again.
inline constexpr std::uint32_t kMostWalls = (0xffffU - kFirstWall) / 2;

/// Of the right side of the contour; that of the left side follows.
[[nodiscard]] constexpr std::uint16_t right_wall(std::uint32_t run) {
    return static_cast<std::uint16_t>(kFirstWall + 2 * (run % kMostWalls));
}
[[nodiscard]] constexpr std::uint16_t wall_face(std::uint32_t run, bool left) {
    return static_cast<std::uint16_t>(right_wall(run) + (left ? 1U : 0U));
}

struct Crossing {
    double s = 0.0;
    double lo = 0.0;  ///< it lies in [lo, hi]
    double hi = 0.0;
    int turn = 0;  ///< +1: towards the right of the curve, -1: to its left, 0: only near
    std::uint32_t run = 0;
};

class Crossings {
public:
    void add(const Crossing& crossing) { list_.push_back(crossing); }
    void set_degenerate() { degenerate_ = true; }
    [[nodiscard]] bool degenerate() const { return degenerate_; }

    /// Calls span(enter, exit) for the stretches of the line inside the region and touch(lo, hi) where there may be one.
    /// The line comes from the outside where it begins; `backwards`: where it ends.
    template <class OnSpan, class OnTouch>
    void resolve(const curves::Region& region, bool backwards, OnSpan&& span, OnTouch&& touch) {
        std::sort(list_.begin(), list_.end(), [&](const Crossing& a, const Crossing& b) {
            return backwards ? a.hi > b.hi : a.lo < b.lo;
        });
        constexpr double kInf = Aabb::kInf;
        int winding = 0;
        SpanEnd open{backwards ? kInf : -kInf, 0.0, 0};
        bool inside = false;
        for (std::size_t i = 0; i < list_.size();) {
            // All that overlap, directly or by way of others.
            Crossing whole = list_[i];
            // Told by the last of those that turn the way that all together do.
            std::uint32_t run[2] = {whole.run, whole.run};
            std::size_t n = 1;
            while (i + n < list_.size() &&
                   (backwards ? list_[i + n].hi >= whole.lo : list_[i + n].lo <= whole.hi)) {
                const Crossing& other = list_[i + n++];
                whole.lo = std::min(whole.lo, other.lo);
                whole.hi = std::max(whole.hi, other.hi);
                whole.turn += other.turn;
                if (other.turn != 0) run[other.turn > 0 ? 1 : 0] = other.run;
            }
            whole.run = run[whole.turn > 0 ? 1 : 0];
            if (n > 1) whole.s = 0.5 * (whole.lo + whole.hi);
            i += n;
            winding += backwards ? -whole.turn : whole.turn;
            const bool now = region.encloses(winding);
            if (now == inside) {
                // A single crossing within the region is none at all.
                if (n > 1 || whole.turn == 0) touch(whole.lo, whole.hi);
                continue;
            }
            inside = now;
            const bool enters = now != backwards;
            const double error = std::max(whole.s - whole.lo, whole.hi - whole.s);
            const SpanEnd end{whole.s, error, wall_face(whole.run, enters == (whole.turn > 0))};
            if (now) {
                open = end;
            } else if (backwards) {
                span(end, open);
            } else {
                span(open, end);
            }
        }
        if (!inside) return;
        if (backwards) {
            span(SpanEnd{-kInf, 0.0, 0}, open);
        } else {
            span(open, SpanEnd{kInf, 0.0, 0});
        }
    }

private:
    SmallList<Crossing, 16> list_;
    bool degenerate_ = false;
};

}  // namespace raymo::solids
