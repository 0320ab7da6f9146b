// What pieces of a polynomial tell of its roots, joined (roots.cpp).
#pragma once

#include "raymo/curves/roots.hpp"
#include "raymo/math/lanes.hpp"

namespace raymo::curves {

/// A place on [0, 1] and what is known there.
struct End {
    double u;
    bool known;
    bool negative;
};

/// Joins what pieces tell, in ascending order, into roots.
template <int N>
class Teller {
public:
    explicit Teller(RootList<N>& out) : out_(out) { out_.count = 0; }

    RAYMO_INLINE void crossing(double u, const End& from, const End& to) {
        put({u, from.u, to.u, true, from.negative});
    }

    /// Between `from` and `to`, of which not both need be known, p is near zero in [lo, hi] only; u: the crossing, if any.
    void blur(const End& from, const End& to, double lo, double hi, double u) {
        if (!open_) {
            open_ = true;
            start_ = from;
            lo_ = lo;
            has_u_ = false;
        }
        if (from.negative != to.negative && !has_u_) {
            has_u_ = true;
            u_ = u;
        }
        if (!to.known) {
            hi_ = hi;
            return;
        }
        open_ = false;
        if (start_.negative != to.negative) {
            crossing(has_u_ ? u_ : 0.5 * (lo_ + hi), start_, to);
        } else {
            touch(lo_, hi);
        }
    }

private:
    void put(const Root& root) { out_.root[static_cast<std::size_t>(out_.count++)] = root; }

    void touch(double lo, double hi) {
        if (out_.count > 0) {
            Root& last = out_.root[static_cast<std::size_t>(out_.count - 1)];
            if (!last.crosses && last.hi >= lo) {
                last.hi = hi;
                last.u = 0.5 * (last.lo + hi);
                return;
            }
        }
        if (touches_ == N + 2) return;
        ++touches_;
        put({0.5 * (lo + hi), lo, hi, false, false});
    }

    RootList<N>& out_;
    int touches_ = 0;
    bool open_ = false;
    End start_{};
    double lo_ = 0.0, hi_ = 0.0;
    bool has_u_ = false;
    double u_ = 0.0;
};

}  // namespace raymo::curves
