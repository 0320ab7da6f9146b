#include "raymo/trace/base_ray.hpp"

#include "raymo/math/tolerance.hpp"

namespace raymo::trace {
namespace {

/// a + b = sum + rest, exactly [Knuth97 4.2.2].
struct Sum {
    double sum, rest;
};
Sum two_sum(double a, double b) {
    const double s = a + b;
    const double bb = s - a;
    return {s, (a - (s - bb)) + (b - bb)};
}

}  // namespace

/// An origin far away is moved to the point of the line nearest to the solid, in doubled precision,
/// so that the distance costs no accuracy.
BaseRay base_ray(const CompiledSolid& solid, const RayQuery& query) {
    BaseRay out;
    const Vec3 direction = query.ray.direction;
    const double unit_scale = binary_inverse(max_norm(direction));
    out.t_per_s = unit_scale / solid.scale;
    Vec3 low;
    for (int a = 0; a < 3; ++a) {
        const Sum s = two_sum(query.ray.origin[a], -solid.centre[a]);
        out.o[a] = s.sum * solid.scale;
        low[a] = s.rest * solid.scale;
        out.d[a] = direction[a] * unit_scale;
    }
    const double far = max_norm(out.o);
    out.error = 4.0 * kUnitRoundoff * std::min(far, kFarOrigin);
    out.start_error = query.start_error * solid.scale;
    if (far > kFarOrigin) {
        out.shift = -dot(out.o, out.d) / dot(out.d, out.d);
        for (int a = 0; a < 3; ++a) {
            const double product = out.shift * out.d[a];
            const double rest = std::fma(out.shift, out.d[a], -product);
            const Sum s = two_sum(out.o[a], product);
            out.o[a] = s.sum + (s.rest + (rest + low[a]));
        }
        out.error += 8.0 * kUnitRoundoff * (max_norm(out.o) + kUnitRoundoff * far);
    }
    return out;
}

BaseRay moved_aside(BaseRay ray, double step, int attempt, bool on_surface) {
    Vec3 s, t;
    make_frame(unit(ray.d), s, t);
    const double angle = 0.7390851332 + 2.39996322973 * attempt;
    const double length = step * static_cast<double>(1 << (2 * attempt));
    const Vec3 by = s * (length * std::cos(angle)) + t * (length * std::sin(angle));
    ray.o += by;
    ray.moved += by;
    ray.step += length;
    if (on_surface) ray.start_error += length;
    return ray;
}

}  // namespace raymo::trace
