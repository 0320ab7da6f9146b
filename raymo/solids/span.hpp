// What a kernel answers along a ray, in the leaf's own frame.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "raymo/math/vec.hpp"

namespace raymo::solids {

/// Where a point is with respect to a solid.
enum class Where : std::uint8_t { out, on, in };

/// A ray in a leaf's own frame: x(s) = o + s d, where o is the ray's point nearest to the frame's origin.
/// `e` bounds, component by component, how far the computed point may lie from the true one, for |s| |d| <= 1.75, that is
/// anywhere within the leaf (it also holds the leaf's own placement error, and what is left of o.d: |o.d| <= |e| |d|).
/// Beyond, the bound grows in proportion to |s|. R is double, or a vector type with one ray a lane (math/lanes.hpp).
template <class R>
struct LocalRay {
    R ox, oy, oz;
    R dx, dy, dz;
    R ex, ey, ez;
    R dd;  ///< d.d
    /// Of crossings that lie before this nothing needs to be told but whether the ray is inside behind them: a span may begin
    /// anywhere else before it instead. Kernels may make use of it.
    R from;
};

/// For LocalRay::from, where all crossings are asked for.
inline constexpr double kFromTheBeginning = -std::numeric_limits<double>::infinity();

/// One end of a span. `error` bounds |computed s - true s|; it grows as the crossing becomes grazing.
struct SpanEnd {
    double s = 0.0;
    double error = 0.0;
    std::uint16_t face = 0;
};

/// An interval of s inside the solid; may reach from -infinity or to +infinity (error 0 there).
struct Span {
    SpanEnd enter;
    SpanEnd exit;
};

/// Spans of one leaf along one ray: ascending, disjoint. A span thinner than the sum of its ends' errors is left out, as
/// nothing; but where it may be is told (a touch), since the same surface, computed in another frame, may show a span
/// there.
class SpanList {
public:
    void clear() {
        count_ = 0;
        spill_.clear();
        degenerate_ = false;
        touched_ = false;
    }
    void push(const Span& span) {
        if (count_ < inline_.size()) {
            inline_[count_] = span;
        } else {
            spill_.push_back(span);
        }
        ++count_;
    }
    /// The ray runs in the boundary to within rounding: the spans are not certain (see kDegenerate).
    void set_degenerate() { degenerate_ = true; }
    [[nodiscard]] bool degenerate() const { return degenerate_; }
    /// The ray may be inside somewhere in [lo, hi], but nowhere for certain. At most one touch is kept.
    void set_touch(double lo, double hi) {
        touch_lo_ = lo;
        touch_hi_ = hi;
        touched_ = true;
    }
    [[nodiscard]] bool touched() const { return touched_; }
    [[nodiscard]] double touch_lo() const { return touch_lo_; }
    [[nodiscard]] double touch_hi() const { return touch_hi_; }
    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] const Span& operator[](std::size_t i) const {
        return i < inline_.size() ? inline_[i] : spill_[i - inline_.size()];
    }
    /// Lets span i begin elsewhere.
    void begin(std::size_t i, const SpanEnd& at) {
        (i < inline_.size() ? inline_[i] : spill_[i - inline_.size()]).enter = at;
    }

private:
    std::array<Span, 4> inline_;
    std::vector<Span> spill_;
    std::size_t count_ = 0;
    bool degenerate_ = false;
    bool touched_ = false;
    double touch_lo_ = 0.0;
    double touch_hi_ = 0.0;
};

/// Spans that the kernels of swept contours give at most, several rays at once; rays with more are left over.
inline constexpr int kSweptSpans = 4;

/// Up to N spans of as many rays as R has lanes. `valid[i]` says for which lanes span i exists; `face` is a small whole
/// number kept in R. M is R's mask type (bool for double).
template <class R, class M, int N>
struct LaneSpans {
    M valid[N];
    M degenerate;
    M touched;  ///< see SpanList::set_touch
    R touch_lo, touch_hi;
    R enter[N], exit[N];
    R enter_error[N], exit_error[N];
    R enter_face[N], exit_face[N];
};

}  // namespace raymo::solids
