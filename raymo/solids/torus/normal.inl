// Normal of the torus in the place of a point of its surface: the way from the nearest point of the circle of radius a,
// (x - a x / q, y - a y / q, z) with q^2 = x^2 + y^2. At the poles of a spindle, where q = 0, that is the axis.
template <class R>
RAYMO_INLINE void torus_normal(double a, R& x, R& y, R& z) {
    const R q = lane_sqrt(x * x + y * y);
    const auto off_axis = q > R(0.0);
    const R k = (q - R(a)) / lane_max(q, R(0x1p-1000));
    const R nx = lane_select(off_axis, k * x, R(0.0));
    const R ny = lane_select(off_axis, k * y, R(0.0));
    const R nz = lane_select(off_axis, z, lane_copysign(R(1.0), z));
    const auto none =
        lane_not(lane_max(lane_abs(nx), lane_max(lane_abs(ny), lane_abs(nz))) > R(0.0));
    x = nx;
    y = ny;
    z = lane_select(none, R(1.0), nz);
}
