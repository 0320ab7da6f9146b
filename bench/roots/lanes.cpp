// Eight polynomials side by side, for each instruction set (Highway's foreach_target).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "roots/lanes.cpp"
#include "roots/lanes.hpp"

#include <hwy/foreach_target.h>  // must stand before highway.h
#include <hwy/highway.h>

#include "raymo/curves/bernstein.hpp"
#include "raymo/math/lanes.hpp"
#include "raymo/math/targets.hpp"
#include "raymo/math/tolerance.hpp"

HWY_BEFORE_NAMESPACE();
namespace raymo::bench {
namespace HWY_NAMESPACE {
#include "raymo/math/lanes-inl.hpp"
//
#include "raymo/curves/crossings.inl"

template <int N>
HWY_INLINE LaneCounts count(const double* c, std::size_t polynomials) {
    LaneCounts counts;
    for (std::size_t first = 0; first + 8 <= polynomials; first += 8) {
        const double* block = c + first * (N + 1);
        for (int lane = 0; lane < 8; lane += kLanes) {
            Lanes p[N + 1];
            for (int i = 0; i <= N; ++i) p[i] = load(block + 8 * i + lane);
            const auto told = lane_signs<N, Mask>(p, Lanes(0.0));
            const Lanes u = lane_any(told.one) ? lane_crossing<N>(p, told.one) : Lanes(0.5);
            counts.none += static_cast<std::size_t>(__builtin_popcount(bits(told.none)));
            counts.one += static_cast<std::size_t>(__builtin_popcount(bits(told.one)));
            double place[8];
            store(lane_select(told.one, u, Lanes(0.5)), place);
            for (int i = 0; i < kLanes; ++i) counts.sum += place[i];
        }
    }
    return counts;
}

LaneCounts count3(const double* c, std::size_t polynomials) { return count<3>(c, polynomials); }
LaneCounts count4(const double* c, std::size_t polynomials) { return count<4>(c, polynomials); }

}  // namespace HWY_NAMESPACE
}  // namespace raymo::bench
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace raymo::bench {

HWY_EXPORT(count3);
HWY_EXPORT(count4);

LaneCounts count_in_lanes(int degree, const double* c, std::size_t polynomials) {
    return degree == 3 ? HWY_DYNAMIC_DISPATCH(count3)(c, polynomials)
                       : HWY_DYNAMIC_DISPATCH(count4)(c, polynomials);
}

}  // namespace raymo::bench
#endif
