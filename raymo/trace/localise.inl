// A ray in a leaf's frame, for one ray or several (see math/lanes.hpp). Included once per instruction set.

/// The ray in a leaf's frame, moved to the point nearest to the leaf's centre: t of the context = s + shift.
template <class R>
struct Local {
    LocalRay<R> ray;
    R shift;
    R place_error;  ///< of the ray and the leaf, in the context's frame
};

template <class R>
RAYMO_INLINE Local<R> localise(const Frame& frame, const Leaf& leaf, R ox, R oy, R oz, R dx, R dy,
                               R dz, R error) {
    const auto row = [&](int i, R x, R y, R z) {
        const Vec3& m = frame.to_local.row[static_cast<std::size_t>(i)];
        return R(m.x) * x + R(m.y) * y + R(m.z) * z;
    };
    Local<R> out;
    LocalRay<R>& ray = out.ray;
    const R rx = ox - R(leaf.centre.x);
    const R ry = oy - R(leaf.centre.y);
    const R rz = oz - R(leaf.centre.z);
    R px, py, pz;
    if (frame.diagonal) {
        px = R(frame.to_local.row[0].x) * rx;
        py = R(frame.to_local.row[1].y) * ry;
        pz = R(frame.to_local.row[2].z) * rz;
        ray.dx = R(frame.to_local.row[0].x) * dx;
        ray.dy = R(frame.to_local.row[1].y) * dy;
        ray.dz = R(frame.to_local.row[2].z) * dz;
    } else {
        px = row(0, rx, ry, rz);
        py = row(1, rx, ry, rz);
        pz = row(2, rx, ry, rz);
        ray.dx = row(0, dx, dy, dz);
        ray.dy = row(1, dx, dy, dz);
        ray.dz = row(2, dx, dy, dz);
    }
    ray.dd = ray.dx * ray.dx + ray.dy * ray.dy + ray.dz * ray.dz;
    out.shift = (R(0.0) - (px * ray.dx + py * ray.dy + pz * ray.dz)) / ray.dd;
    ray.ox = px + out.shift * ray.dx;
    ray.oy = py + out.shift * ray.dy;
    ray.oz = pz + out.shift * ray.dz;
    out.place_error = error + R(static_cast<double>(leaf.displacement)) +
                      R(kPointError) * (lane_abs(rx) + lane_abs(ry) + lane_abs(rz));
    ray.ex = R(frame.error.x) + R(frame.row_length.x) * out.place_error;
    ray.ey = R(frame.error.y) + R(frame.row_length.y) * out.place_error;
    ray.ez = R(frame.error.z) + R(frame.row_length.z) * out.place_error;
    ray.from = R(solids::kFromTheBeginning);
    return out;
}
