#include "raymo/solids/sphere/sphere.hpp"

#include <cmath>
#include <numbers>

#include "raymo/solids/lane_kernels.hpp"

namespace raymo::solids {
namespace {
#include "raymo/solids/sphere/kernel.inl"
}  // namespace

Aabb Sphere::Kernel::bounds(const Affine& map) const {
    Vec3 reach;
    for (int i = 0; i < 3; ++i) reach[i] = norm(map.linear.row[static_cast<std::size_t>(i)]);
    return {map.offset - reach, map.offset + reach};
}

void Sphere::Kernel::spans(const LocalRay<double>& ray, SpanList& out) const {
    LaneSpans<double, bool, 1> lanes;
    sphere_spans(ray, lanes);
    append(lanes, out);
}

Where Sphere::Kernel::where(Vec3 p, Vec3 e) const {
    const double slack = 2.0 * dot(abs(p), e) + dot(e, e) + 8.0 * kUnitRoundoff;
    const double f = dot(p, p) - 1.0;
    return f > slack ? Where::out : (f < -slack ? Where::in : Where::on);
}

std::span<const std::string_view> Sphere::Kernel::faces() const {
    static constexpr std::array<std::string_view, 1> kFaces{"surface"};
    return kFaces;
}

double Sphere::Kernel::volume() const { return 4.0 * std::numbers::pi / 3.0; }

const Schema& Sphere::schema() {
    static const std::array<Param, 1> kParams{Param{.name = "r",
                                                    .words = "radius",
                                                    .kind = ParamKind::length,
                                                    .doc = "radius",
                                                    .min = 0.0,
                                                    .diameter = "d"}};
    static const Schema kSchema{"sphere", "A ball about the origin.", kParams,
                                "sphere(10).paint(\"tomato\")"};
    return kSchema;
}

Result<Placed<Sphere::Kernel>> Sphere::prepare(std::span<const Argument> arguments) {
    const double r = std::get<double>(arguments[0]);
    return Placed<Kernel>{{}, scaling({r, r, r})};
}

std::span<const std::vector<Argument>> Sphere::examples() {
    static const std::array<std::vector<Argument>, 3> kExamples{{{1.0}, {1e-6}, {12345.678}}};
    return kExamples;
}

}  // namespace raymo::solids
