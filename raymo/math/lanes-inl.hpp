// The types in which kernels compute several rays at once; compiled once per instruction set,
// inside HWY_NAMESPACE. See math/lanes.hpp for the operations and for the same in one ray.

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, 8>;
inline constexpr int kLanes = static_cast<int>(HWY_MIN(8, HWY_LANES(double)));

using raymo::lane_abs;
using raymo::lane_and;
using raymo::lane_any;
using raymo::lane_copysign;
using raymo::lane_fma;
using raymo::lane_max;
using raymo::lane_min;
using raymo::lane_not;
using raymo::lane_or;
using raymo::lane_select;
using raymo::lane_sqrt;

struct Mask {
    hn::Mask<D> m;
};
struct Lanes {
    hn::Vec<D> v;

    Lanes() = default;
    HWY_INLINE explicit Lanes(double x) : v(hn::Set(D(), x)) {}
    HWY_INLINE explicit Lanes(hn::Vec<D> x) : v(x) {}
};

HWY_INLINE Lanes operator+(Lanes a, Lanes b) { return Lanes(hn::Add(a.v, b.v)); }
HWY_INLINE Lanes operator-(Lanes a, Lanes b) { return Lanes(hn::Sub(a.v, b.v)); }
HWY_INLINE Lanes operator*(Lanes a, Lanes b) { return Lanes(hn::Mul(a.v, b.v)); }
HWY_INLINE Lanes operator/(Lanes a, Lanes b) { return Lanes(hn::Div(a.v, b.v)); }
HWY_INLINE Mask operator<(Lanes a, Lanes b) { return {hn::Lt(a.v, b.v)}; }
HWY_INLINE Mask operator>(Lanes a, Lanes b) { return {hn::Gt(a.v, b.v)}; }
HWY_INLINE Mask operator<=(Lanes a, Lanes b) { return {hn::Le(a.v, b.v)}; }
HWY_INLINE Mask operator>=(Lanes a, Lanes b) { return {hn::Ge(a.v, b.v)}; }
HWY_INLINE Mask operator==(Lanes a, Lanes b) { return {hn::Eq(a.v, b.v)}; }
HWY_INLINE Lanes lane_sqrt(Lanes a) { return Lanes(hn::Sqrt(a.v)); }
HWY_INLINE Lanes lane_abs(Lanes a) { return Lanes(hn::Abs(a.v)); }
HWY_INLINE Lanes lane_fma(Lanes a, Lanes b, Lanes c) {
#if HWY_NATIVE_FMA
    return Lanes(hn::MulAdd(a.v, b.v, c.v));
#else
    double x[8], y[8], z[8];
    hn::StoreU(a.v, D(), x);
    hn::StoreU(b.v, D(), y);
    hn::StoreU(c.v, D(), z);
    for (int i = 0; i < kLanes; ++i) x[i] = raymo::lane_fma(x[i], y[i], z[i]);
    return Lanes(hn::LoadU(D(), x));
#endif
}
HWY_INLINE Lanes lane_select(Mask mask, Lanes yes, Lanes no) {
    return Lanes(hn::IfThenElse(mask.m, yes.v, no.v));
}
// The second operand where they tie and where one is NaN, on every machine. That is what x86's own instructions give.
#if HWY_ARCH_X86 && HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR
HWY_INLINE Lanes lane_min(Lanes a, Lanes b) { return Lanes(hn::Min(a.v, b.v)); }
HWY_INLINE Lanes lane_max(Lanes a, Lanes b) { return Lanes(hn::Max(a.v, b.v)); }
#else
HWY_INLINE Lanes lane_min(Lanes a, Lanes b) { return lane_select(a < b, a, b); }
HWY_INLINE Lanes lane_max(Lanes a, Lanes b) { return lane_select(a > b, a, b); }
#endif
HWY_INLINE Lanes lane_copysign(Lanes size, Lanes sign) {
    return Lanes(hn::CopySign(size.v, sign.v));
}
HWY_INLINE Mask lane_and(Mask a, Mask b) { return {hn::And(a.m, b.m)}; }
HWY_INLINE Mask lane_or(Mask a, Mask b) { return {hn::Or(a.m, b.m)}; }
HWY_INLINE Mask lane_not(Mask a) { return {hn::Not(a.m)}; }
HWY_INLINE bool lane_any(Mask a) { return !hn::AllFalse(D(), a.m); }

HWY_INLINE Lanes load(const double* p) { return Lanes(hn::LoadU(D(), p)); }
HWY_INLINE void store(Lanes a, double* p) { hn::StoreU(a.v, D(), p); }
/// To floats, each rounded to nearest.
HWY_INLINE void store_floats(Lanes a, float* out) {
    const hn::Rebind<float, D> half;
    hn::StoreU(hn::DemoteTo(half, a.v), half, out);
}

/// One bit a lane.
HWY_INLINE std::uint32_t bits(Mask a) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(D(), a.m, bytes);
    return bytes[0];
}
/// And back; bits beyond the lanes do not count.
HWY_INLINE Mask mask_of(std::uint32_t lanes) {
    const std::uint8_t bytes[8] = {static_cast<std::uint8_t>(lanes)};
    return {hn::LoadMaskBits(D(), bytes)};
}
