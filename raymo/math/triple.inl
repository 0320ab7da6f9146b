// Vectors and colours of one ray or several (see lanes.hpp). Included once per instruction set.

template <class R>
struct Triple {
    R x, y, z;
};
template <class R>
RAYMO_INLINE Triple<R> operator+(Triple<R> a, Triple<R> b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class R>
RAYMO_INLINE Triple<R> operator-(Triple<R> a, Triple<R> b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class R>
RAYMO_INLINE Triple<R> operator*(Triple<R> a, Triple<R> b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class R>
RAYMO_INLINE Triple<R> operator*(Triple<R> a, R b) {
    return {a.x * b, a.y * b, a.z * b};
}
template <class R>
RAYMO_INLINE R dot(Triple<R> a, Triple<R> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class R>
RAYMO_INLINE Triple<R> cross(Triple<R> a, Triple<R> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// a b - c d, wrong by at most 1.5 units in its last place, whatever cancels [Jeannerod13].
template <class R>
RAYMO_INLINE R difference_of_products(R a, R b, R c, R d) {
    const R cd = c * d;
    return lane_fma(a, b, R(0.0) - cd) + lane_fma(R(0.0) - c, d, cd);
}
template <class R>
RAYMO_INLINE Triple<R> accurate_cross(Triple<R> a, Triple<R> b) {
    return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
            difference_of_products(a.x, b.y, a.y, b.x)};
}
template <class R>
RAYMO_INLINE Triple<R> abs(Triple<R> a) {
    return {lane_abs(a.x), lane_abs(a.y), lane_abs(a.z)};
}
template <class R>
RAYMO_INLINE R max_norm(Triple<R> a) {
    return lane_max(lane_abs(a.x), lane_max(lane_abs(a.y), lane_abs(a.z)));
}
/// make_frame (math/vec.hpp) for several directions.
template <class R>
RAYMO_INLINE void lane_frame(const Triple<R>& along, Triple<R>& side, Triple<R>& up) {
    const R one(1.0);
    const R sign = lane_copysign(one, along.z);
    const R a = R(-1.0) / (sign + along.z);
    const R b = along.x * along.y * a;
    side = {one + sign * along.x * along.x * a, sign * b, R(-1.0) * (sign * along.x)};
    up = {b, sign + along.y * along.y * a, R(-1.0) * along.y};
}
