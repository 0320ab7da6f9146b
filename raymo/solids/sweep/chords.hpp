// Where a line is inside swept spheres, piece by piece; derivation in chords.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

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

/// A list without allocations as long as it is short.
template <class T, std::size_t N>
class ShortList {
public:
    [[nodiscard]] std::size_t size() const { return count_; }
    [[nodiscard]] T& operator[](std::size_t i) { return i < N ? few_[i] : more_[i - N]; }
    [[nodiscard]] const T& operator[](std::size_t i) const {
        return i < N ? few_[i] : more_[i - N];
    }
    void push(const T& value) {
        if (count_ < N) {
            few_[count_] = value;
        } else {
            more_.push_back(value);
        }
        ++count_;
    }
    /// The last takes its place.
    void remove(std::size_t i) {
        (*this)[i] = (*this)[count_ - 1];
        resize(count_ - 1);
    }
    void resize(std::size_t count) {
        count_ = count;
        more_.resize(count > N ? count - N : 0);
    }
    template <class Less>
    void sort(const Less& less) {
        if (count_ <= N) {
            for (std::size_t i = 1; i < count_; ++i) {
                for (std::size_t k = i; k > 0 && less(few_[k], few_[k - 1]); --k)
                    std::swap(few_[k], few_[k - 1]);
            }
            return;
        }
        std::vector<T> all(few_.begin(), few_.end());
        all.insert(all.end(), more_.begin(), more_.end());
        std::sort(all.begin(), all.end(), less);
        std::copy_n(all.begin(), N, few_.begin());
        std::copy(all.begin() + N, all.end(), more_.begin());
    }

private:
    std::array<T, N> few_;
    std::vector<T> more_;
    std::size_t count_ = 0;
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
    ShortList<Chord, 12> certain_;
    ShortList<Chord, 12> maybe_;
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
