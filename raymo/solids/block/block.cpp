#include "raymo/solids/block/block.hpp"

#include <cmath>

#include "raymo/solids/lane_kernels.hpp"

namespace raymo::solids {
namespace {
#include "raymo/solids/interval.inl"
//
#include "raymo/solids/block/kernel.inl"
}  // namespace

Aabb Block::Kernel::bounds(const Affine& map) const {
    return transformed(map, {{-1, -1, -1}, {1, 1, 1}});
}

void Block::Kernel::spans(const LocalRay<double>& ray, SpanList& out) const {
    LaneSpans<double, bool, 1> lanes;
    block_spans(ray, lanes);
    append(lanes, out);
}

Vec3 Block::Kernel::normal(Vec3 p, std::uint16_t face) const {
    block_normal<double>(face, p.x, p.y, p.z);
    return p;
}

Where Block::Kernel::where(Vec3 p, Vec3 e) const {
    Where where = Where::in;
    for (int axis = 0; axis < 3; ++axis) {
        const double depth = 1.0 - std::fabs(p[axis]);
        const double slack = e[axis] + 2.0 * kUnitRoundoff;
        if (depth < -slack) return Where::out;
        if (depth <= slack) where = Where::on;
    }
    return where;
}

std::span<const std::string_view> Block::Kernel::faces() const {
    static constexpr std::array<std::string_view, 6> kFaces{"left", "right",  "front",
                                                            "back", "bottom", "top"};
    return kFaces;
}

double Block::Kernel::volume() const { return 8.0; }
double Block::Kernel::area() const { return 24.0; }

const Schema& Block::schema() {
    static const std::array<Param, 2> kParams{
        Param{.name = "size",
              .words = "size",
              .kind = ParamKind::size,
              .doc = "lengths of the edges along x, y and z; one number makes a cube",
              .min = 0.0},
        Param{.name = "center",
              .words = "center",
              .kind = ParamKind::flag,
              .doc = "true: centred on the origin; false: one corner at the origin",
              .fallback = false}};
    static const Schema kSchema{"block",
                                "A block with edges along the axes and one corner at the origin.",
                                kParams, "block(30, 20, 10).paint(\"steelblue\")"};
    return kSchema;
}

Result<Placed<Block::Kernel>> Block::prepare(std::span<const Argument> arguments) {
    const Vec3 half = std::get<Vec3>(arguments[0]) * 0.5;
    Affine map = scaling(half);
    if (!std::get<bool>(arguments[1])) map.offset = half;
    return Placed<Kernel>{{}, map};
}

std::span<const std::vector<Argument>> Block::examples() {
    static const std::array<std::vector<Argument>, 4> kExamples{{{Vec3{30, 20, 10}, false},
                                                                 {Vec3{1, 1, 1}, true},
                                                                 {Vec3{1e3, 1e-3, 7}, false},
                                                                 {Vec3{1e-6, 1e-6, 2e-6}, true}}};
    return kExamples;
}

}  // namespace raymo::solids
