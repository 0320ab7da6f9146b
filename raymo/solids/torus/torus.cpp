#include "raymo/solids/torus/torus.hpp"

#include <cmath>
#include <numbers>

#include "raymo/solids/lane_kernels.hpp"

namespace raymo::solids {
namespace {
#include "raymo/solids/torus/kernel.inl"
//
#include "raymo/solids/torus/normal.inl"

/// Half the angle over which the generating circle lies outside the axis.
double half_turn(double a, double b) { return a >= b ? std::numbers::pi : std::acos(-a / b); }

}  // namespace

Aabb Torus::Kernel::bounds(const Affine& map) const {
    Vec3 reach;
    for (int i = 0; i < 3; ++i) {
        const Vec3 n = map.linear.row[static_cast<std::size_t>(i)];
        reach[i] = a_ * std::hypot(n.x, n.y) + b_ * norm(n);
    }
    return {map.offset - reach, map.offset + reach};
}

void Torus::Kernel::spans(const LocalRay<double>& ray, SpanList& out) const {
    LaneSpans<double, bool, 2> lanes;
    torus_spans(a_, b_, ray, lanes);
    append(lanes, out);
}

Vec3 Torus::Kernel::normal(Vec3 p, std::uint16_t) const {
    torus_normal(a_, p.x, p.y, p.z);
    return p;
}

Where Torus::Kernel::where(Vec3 p, Vec3 e) const {
    const double from_circle = std::hypot(std::hypot(p.x, p.y) - a_, p.z);
    const double slack = norm(e) + 8.0 * kUnitRoundoff * (1.0 + max_norm(p));
    const double f = from_circle - b_;
    return f > slack ? Where::out : (f < -slack ? Where::in : Where::on);
}

std::span<const std::string_view> Torus::Kernel::faces() const {
    static constexpr std::array<std::string_view, 1> kFaces{"surface"};
    return kFaces;
}

double Torus::Kernel::volume() const {
    const double w = half_turn(a_, b_);
    const double s = a_ >= b_ ? 0.0 : std::sin(w);
    const double c = std::cos(w);
    return 2.0 * std::numbers::pi * b_ *
           (a_ * a_ * s + a_ * b_ * (w + s * c) + b_ * b_ * (s - s * s * s / 3.0));
}

double Torus::Kernel::area() const {
    const double w = half_turn(a_, b_);
    const double s = a_ >= b_ ? 0.0 : std::sin(w);
    return 4.0 * std::numbers::pi * b_ * (a_ * w + b_ * s);
}

const Schema& Torus::schema() {
    static const std::array<Param, 2> kParams{
        Param{.name = "R",
              .words = "ring radius",
              .kind = ParamKind::length,
              .doc = "from the axis to the middle of the tube",
              .min = 0.0,
              .diameter = "D"},
        Param{.name = "r",
              .words = "tube radius",
              .kind = ParamKind::length,
              .doc = "of the tube; larger than R it gives the filled spindle",
              .min = 0.0,
              .diameter = "d"}};
    static const Schema kSchema{"torus", "A ring about the z axis.", kParams,
                                "torus(R: 20, r: 6).paint(\"mediumpurple\")"};
    return kSchema;
}

Result<Placed<Torus::Kernel>> Torus::prepare(std::span<const Argument> arguments) {
    const double ring = std::get<double>(arguments[0]);
    const double tube = std::get<double>(arguments[1]);
    const double size = ring + tube;
    if (!std::isfinite(size) || !(tube / size > 1e-300)) {
        Failure failure =
            fail(ErrorCode::out_of_range,
                 "torus: its radii are too large or too different to be computed with",
                 "give radii of similar size");
        failure.value().argument = 1;
        return failure;
    }
    return Placed<Kernel>{Kernel(ring / size, tube / size), scaling({size, size, size})};
}

std::span<const std::vector<Argument>> Torus::examples() {
    static const std::array<std::vector<Argument>, 6> kExamples{
        {{20.0, 5.0}, {1.0, 1.0}, {1.0, 2.0}, {1e-3, 5.0}, {1000.0, 1.0}, {1.0, 0.999999}}};
    return kExamples;
}

}  // namespace raymo::solids
