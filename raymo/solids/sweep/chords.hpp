// Where a line is inside swept spheres, piece by piece; derivation in chords.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "raymo/core/small_list.hpp"
#include "raymo/solids/span.hpp"
#include "raymo/solids/sweep/swept_spheres.hpp"

namespace raymo::solids {

/// One end of a chord, in lengths along the line: most likely at t, for certain between `outer` and `inner`.
struct ChordEnd {
    double t, outer, inner;
    std::uint16_t face;
};

/// An interval of the line. All of [lo.inner, hi.inner] is inside for certain; where that is empty, nothing is.
struct Chord {
    ChordEnd lo, hi;
    [[nodiscard]] bool certain() const { return lo.inner <= hi.inner; }
};

/// The union of chords, found one by one.
class ChordUnion {
public:
    /// Chords that share a place that is inside for certain become one. Empty ones are left out.
    void add(Chord chord);
    /// Whether all of [lo, hi] is known to be inside.
    [[nodiscard]] bool covers(double lo, double hi) const;
    /// Whether what is inside for certain, in one interval with `chord`, reaches as far as sign t = reach.
    [[nodiscard]] bool covers_side(const Chord& chord, double sign, double reach) const;
    /// The spans, and what is told beside them. `unit`: lengths in one s; `limit`: the largest error that is not degenerate.
    void finish(double unit, double limit, SpanList& out);

private:
    SmallList<Chord, 12> certain_;
    SmallList<Chord, 12> maybe_;
};

/// A line in lengths, and a frame about it.
struct SweepLine {
    Vec3 o;
    Vec3 along, side, up;
    double error;  ///< of a place on it, of a centre and of a radius, together
};

/// Adds where the line is inside a piece.
void add_chords(const SweepLine& line, const SweptSpheres& spheres, const SweptPiece& piece,
                ChordUnion& found);

}  // namespace raymo::solids
