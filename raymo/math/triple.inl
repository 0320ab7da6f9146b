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
