// The union of the chords of all pieces.
//
// Chords that share a place that is inside for certain are one. What is left between two of them may be a gap or not, where
// the outer bounds overlap: such a gap, thinner than its errors, is closed, and told as a touch, since the same surface,
// computed in another frame, may show it; so may a chord of which nothing is certain.
#include <algorithm>
#include <cmath>

#include "raymo/solids/sweep/chords.hpp"

namespace raymo::solids {
namespace {

/// The hull of both: each end where the outer one is.
Chord united(const Chord& a, const Chord& b) {
    Chord out;
    out.lo = b.lo.t < a.lo.t ? b.lo : a.lo;
    out.hi = b.hi.t > a.hi.t ? b.hi : a.hi;
    out.lo.outer = std::min(a.lo.outer, b.lo.outer);
    out.lo.inner = std::min(a.lo.inner, b.lo.inner);
    out.hi.outer = std::max(a.hi.outer, b.hi.outer);
    out.hi.inner = std::max(a.hi.inner, b.hi.inner);
    return out;
}

/// What is told beside the spans: one touch, or that nothing is certain.
class Beside {
public:
    explicit Beside(double limit) : limit_(limit) {}
    void touch(double lo, double hi) {
        if (hi - lo > limit_) degenerate_ = true;
        if (!touched_) {
            lo_ = lo;
            hi_ = hi;
            touched_ = true;
            return;
        }
        if (lo > hi_ || hi < lo_) degenerate_ = true;
        lo_ = std::min(lo, lo_);
        hi_ = std::max(hi, hi_);
    }
    void uncertain() { degenerate_ = true; }
    void tell(double unit, SpanList& out) const {
        if (touched_) out.set_touch(lo_ / unit, hi_ / unit);
        if (degenerate_) out.set_degenerate();
    }

private:
    double limit_;
    double lo_ = 0.0;
    double hi_ = 0.0;
    bool touched_ = false;
    bool degenerate_ = false;
};

}  // namespace

void ChordUnion::add(Chord chord) {
    if (chord.lo.outer > chord.hi.outer) return;
    if (!chord.certain()) {
        maybe_.push_back(chord);
        return;
    }
    for (std::size_t i = 0; i < certain_.size();) {
        const Chord& other = certain_[i];
        if (chord.lo.inner <= other.hi.inner && other.lo.inner <= chord.hi.inner) {
            chord = united(chord, other);
            certain_.remove(i);
            i = 0;
        } else {
            ++i;
        }
    }
    certain_.push_back(chord);
}

bool ChordUnion::covers(double lo, double hi) const {
    for (std::size_t i = 0; i < certain_.size(); ++i) {
        if (certain_[i].lo.inner <= lo && hi <= certain_[i].hi.inner) return true;
    }
    return false;
}

bool ChordUnion::covers_side(const Chord& chord, double sign, double reach) const {
    for (std::size_t i = 0; i < certain_.size(); ++i) {
        const Chord& c = certain_[i];
        if (chord.lo.inner > c.hi.inner || c.lo.inner > chord.hi.inner) continue;
        if (sign * (sign > 0.0 ? c.hi.inner : c.lo.inner) >= reach) return true;
    }
    return false;
}

void ChordUnion::finish(double unit, double limit, SpanList& out) {
    const auto before = [](const Chord& a, const Chord& b) { return a.lo.t < b.lo.t; };
    Beside beside(limit);
    // Those of which nothing is certain move the bounds of those that they meet.
    for (std::size_t i = 0; i < maybe_.size(); ++i) {
        const Chord& m = maybe_[i];
        if (covers(m.lo.outer, m.hi.outer)) continue;
        bool met = false;
        for (std::size_t k = 0; k < certain_.size(); ++k) {
            Chord& c = certain_[k];
            if (m.hi.outer < c.lo.outer || m.lo.outer > c.hi.outer) continue;
            c.lo.outer = std::min(c.lo.outer, m.lo.outer);
            c.hi.outer = std::max(c.hi.outer, m.hi.outer);
            met = true;
        }
        if (!met) beside.touch(m.lo.outer, m.hi.outer);
    }
    std::sort(certain_.begin(), certain_.end(), before);
    // Gaps that may be none are closed.
    std::size_t count = 0;
    for (std::size_t i = 0; i < certain_.size(); ++i) {
        const Chord next = certain_[i];
        if (count > 0 && next.lo.outer <= certain_[count - 1].hi.outer) {
            Chord& last = certain_[count - 1];
            if (next.lo.inner > last.hi.inner) beside.touch(last.hi.inner, next.lo.inner);
            last = united(last, next);
        } else {
            certain_[count++] = next;
        }
    }
    certain_.shrink(count);
    for (std::size_t i = 0; i < certain_.size(); ++i) {
        const Chord& c = certain_[i];
        const double enter_error = std::max(c.lo.t - c.lo.outer, c.lo.inner - c.lo.t);
        const double exit_error = std::max(c.hi.outer - c.hi.t, c.hi.t - c.hi.inner);
        if (!(std::max(enter_error, exit_error) <= limit)) beside.uncertain();
        if (c.hi.t - c.lo.t > enter_error + exit_error) {
            out.push({{c.lo.t / unit, enter_error / unit, c.lo.face},
                      {c.hi.t / unit, exit_error / unit, c.hi.face}});
        } else {
            beside.touch(c.lo.outer, c.hi.outer);
        }
    }
    beside.tell(unit, out);
}

}  // namespace raymo::solids
