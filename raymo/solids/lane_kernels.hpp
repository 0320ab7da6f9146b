// How a lane kernel's answer becomes a span list (the one-ray case).
#pragma once

#include "raymo/math/lanes.hpp"
#include "raymo/math/tolerance.hpp"
#include "raymo/solids/span.hpp"

namespace raymo::solids {

/// `count`: how many of them are in use.
template <int N>
inline void append(const LaneSpans<double, bool, N>& lanes, int count, SpanList& out) {
    for (int i = 0; i < count; ++i) {
        if (!lanes.valid[i]) continue;
        out.push(
            {{lanes.enter[i], lanes.enter_error[i],
              static_cast<std::uint16_t>(lanes.enter_face[i])},
             {lanes.exit[i], lanes.exit_error[i], static_cast<std::uint16_t>(lanes.exit_face[i])}});
    }
}
template <int N>
inline void append(const LaneSpans<double, bool, N>& lanes, SpanList& out) {
    if (lanes.degenerate) out.set_degenerate();
    if (lanes.touched) out.set_touch(lanes.touch_lo, lanes.touch_hi);
    append(lanes, N, out);
}

}  // namespace raymo::solids
