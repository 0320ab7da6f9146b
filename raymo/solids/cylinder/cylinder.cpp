#include "raymo/solids/cylinder/cylinder.hpp"

#include <cmath>
#include <numbers>

#include "raymo/solids/lane_kernels.hpp"

namespace raymo::solids {
namespace {
#include "raymo/solids/interval.inl"
//
#include "raymo/solids/cylinder/kernel.inl"
}  // namespace

Aabb Cylinder::Kernel::bounds(const Affine& map) const {
    Vec3 reach;
    for (int i = 0; i < 3; ++i) {
        const Vec3 n = map.linear.row[static_cast<std::size_t>(i)];
        reach[i] = std::hypot(n.x, n.y) + std::fabs(n.z);
    }
    return {map.offset - reach, map.offset + reach};
}

void Cylinder::Kernel::spans(const LocalRay<double>& ray, SpanList& out) const {
    LaneSpans<double, bool, 1> lanes;
    cylinder_spans(ray, lanes);
    append(lanes, out);
}

Vec3 Cylinder::Kernel::normal(Vec3 p, std::uint16_t face) const {
    cylinder_normal<double>(face, p.x, p.y, p.z);
    return p;
}

Where Cylinder::Kernel::where(Vec3 p, Vec3 e) const {
    const double depth_z = 1.0 - std::fabs(p.z);
    const double slack_z = e.z + 2.0 * kUnitRoundoff;
    const double f = p.x * p.x + p.y * p.y - 1.0;
    const double slack = 2.0 * (std::fabs(p.x) * e.x + std::fabs(p.y) * e.y) + e.x * e.x +
                         e.y * e.y + 4.0 * kUnitRoundoff * (f + 2.0);
    if (depth_z < -slack_z || f > slack) return Where::out;
    return depth_z > slack_z && f < -slack ? Where::in : Where::on;
}

std::span<const std::string_view> Cylinder::Kernel::faces() const {
    static constexpr std::array<std::string_view, 3> kFaces{"side", "bottom", "top"};
    return kFaces;
}

double Cylinder::Kernel::volume() const { return 2.0 * std::numbers::pi; }
double Cylinder::Kernel::area() const { return 6.0 * std::numbers::pi; }

const Schema& Cylinder::schema() {
    static const std::array<Param, 3> kParams{
        Param{.name = "r",
              .words = "radius",
              .kind = ParamKind::length,
              .doc = "radius",
              .min = 0.0,
              .diameter = "d"},
        Param{
            .name = "h", .words = "height", .kind = ParamKind::length, .doc = "height", .min = 0.0},
        Param{.name = "center",
              .words = "center",
              .kind = ParamKind::flag,
              .doc = "true: centred on the origin; false: standing on the plane z = 0",
              .fallback = false}};
    static const Schema kSchema{"cylinder",
                                "A cylinder about the z axis, standing on the plane z = 0.",
                                kParams, "cylinder(r: 5, h: 20).paint(\"goldenrod\")"};
    return kSchema;
}

Result<Placed<Cylinder::Kernel>> Cylinder::prepare(std::span<const Argument> arguments) {
    const double r = std::get<double>(arguments[0]);
    const double half = 0.5 * std::get<double>(arguments[1]);
    Affine map = scaling({r, r, half});
    if (!std::get<bool>(arguments[2])) map.offset.z = half;
    return Placed<Kernel>{{}, map};
}

std::span<const std::vector<Argument>> Cylinder::examples() {
    static const std::array<std::vector<Argument>, 4> kExamples{
        {{5.0, 20.0, false}, {1.0, 2.0, true}, {1e-3, 1e3, false}, {1e4, 1e-2, true}}};
    return kExamples;
}

}  // namespace raymo::solids
