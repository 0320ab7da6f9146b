#include "raymo/solids/cone/cone.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "raymo/solids/lane_kernels.hpp"

namespace raymo::solids {
namespace {
#include "raymo/solids/interval.inl"
//
#include "raymo/solids/cone/kernel.inl"
}  // namespace

Aabb Cone::Kernel::bounds(const Affine& map) const {
    Aabb box;
    for (int i = 0; i < 3; ++i) {
        const Vec3 n = map.linear.row[static_cast<std::size_t>(i)];
        const double wide = std::hypot(n.x, n.y);
        const double narrow = ratio_ * wide;
        box.lo[i] = map.offset[i] - std::max(n.z + wide, -n.z + narrow);
        box.hi[i] = map.offset[i] + std::max(-n.z + wide, n.z + narrow);
    }
    return box;
}

void Cone::Kernel::spans(const LocalRay<double>& ray, SpanList& out) const {
    LaneSpans<double, bool, 1> lanes;
    cone_spans(ratio_, ray, lanes);
    append(lanes, out);
}

Vec3 Cone::Kernel::normal(Vec3 p, std::uint16_t face) const {
    cone_normal<double>(ratio_, face, p.x, p.y, p.z);
    return p;
}

Where Cone::Kernel::where(Vec3 p, Vec3 e) const {
    const double g = 0.5 * (1.0 - ratio_);
    const double q = 0.5 * (1.0 + ratio_) - g * p.z;
    const double f = std::hypot(p.x, p.y) - q;
    const double slack =
        std::hypot(e.x, e.y) + g * e.z +
        8.0 * kUnitRoundoff * (1.0 + std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z));
    const double depth_z = 1.0 - std::fabs(p.z);
    const double slack_z = e.z + 2.0 * kUnitRoundoff;
    if (depth_z < -slack_z || f > slack) return Where::out;
    return depth_z > slack_z && f < -slack ? Where::in : Where::on;
}

std::span<const std::string_view> Cone::Kernel::faces() const {
    static constexpr std::array<std::string_view, 3> kFaces{"side", "bottom", "top"};
    static constexpr std::array<std::string_view, 3> kTurned{"side", "top", "bottom"};
    return turned_ ? kTurned : kFaces;
}

double Cone::Kernel::volume() const {
    return 2.0 * std::numbers::pi / 3.0 * (1.0 + ratio_ + ratio_ * ratio_);
}

double Cone::Kernel::area() const {
    return std::numbers::pi *
           ((1.0 + ratio_) * std::hypot(1.0 - ratio_, 2.0) + 1.0 + ratio_ * ratio_);
}

const Schema& Cone::schema() {
    static const std::array<Param, 4> kParams{
        Param{.name = "r1",
              .words = "bottom radius",
              .kind = ParamKind::length,
              .doc = "radius at the bottom; may be 0",
              .min = 0.0,
              .min_included = true,
              .diameter = "d1"},
        Param{.name = "r2",
              .words = "top radius",
              .kind = ParamKind::length,
              .doc = "radius at the top; may be 0",
              .min = 0.0,
              .min_included = true,
              .diameter = "d2"},
        Param{
            .name = "h", .words = "height", .kind = ParamKind::length, .doc = "height", .min = 0.0},
        Param{.name = "center",
              .words = "center",
              .kind = ParamKind::flag,
              .doc = "true: centred on the origin; false: standing on the plane z = 0",
              .fallback = false}};
    static const Schema kSchema{
        "cone", "A cone or cone frustum about the z axis, standing on the plane z = 0.", kParams,
        "cone(r1: 10, r2: 4, h: 15).paint(\"seagreen\")"};
    return kSchema;
}

Result<Placed<Cone::Kernel>> Cone::prepare(std::span<const Argument> arguments) {
    const double r1 = std::get<double>(arguments[0]);
    const double r2 = std::get<double>(arguments[1]);
    const double half = 0.5 * std::get<double>(arguments[2]);
    const bool turned = r2 > r1;
    const double wide = std::max(r1, r2);
    if (!(wide > 0.0)) {
        Failure failure =
            fail(ErrorCode::out_of_range, "cone: one of its radii must be greater than 0",
                 "give a positive bottom radius");
        failure.value().label = "both radii are 0";
        failure.value().argument = 0;
        return failure;
    }
    Affine map = scaling(turned ? Vec3{wide, -wide, -half} : Vec3{wide, wide, half});
    if (!std::get<bool>(arguments[3])) map.offset.z = half;
    return Placed<Kernel>{Kernel(std::min(r1, r2) / wide, turned), map};
}

std::span<const std::vector<Argument>> Cone::examples() {
    static const std::array<std::vector<Argument>, 6> kExamples{{{10.0, 4.0, 15.0, false},
                                                                 {1.0, 0.0, 1.0, false},
                                                                 {0.0, 3.0, 5.0, true},
                                                                 {2.0, 2.0, 3.0, false},
                                                                 {1.0, 1e-9, 1e3, false},
                                                                 {1e3, 999.999, 1e-3, true}}};
    return kExamples;
}

}  // namespace raymo::solids
