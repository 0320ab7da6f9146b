#include "raymo/solids/halfspace/halfspace.hpp"

#include <cmath>
#include <limits>

#include "raymo/solids/lane_kernels.hpp"

namespace raymo::solids {
namespace {
#include "raymo/solids/halfspace/kernel.inl"
}  // namespace

Aabb Halfspace::Kernel::bounds(const Affine& map) const {
    Aabb box = Aabb::everything();
    for (int i = 0; i < 3; ++i) {
        const Vec3 n = map.linear.row[static_cast<std::size_t>(i)];
        if (n.x != 0.0 || n.y != 0.0) continue;
        (n.z > 0.0 ? box.hi : box.lo)[i] = map.offset[i];
    }
    return box;
}

void Halfspace::Kernel::spans(const LocalRay<double>& ray, SpanList& out) const {
    LaneSpans<double, bool, 1> lanes;
    halfspace_spans(ray, lanes);
    append(lanes, out);
}

Vec3 Halfspace::Kernel::normal(Vec3 p, std::uint16_t) const {
    halfspace_normal(p.x, p.y, p.z);
    return p;
}

Where Halfspace::Kernel::where(Vec3 p, Vec3 e) const {
    return p.z > e.z ? Where::out : (p.z < -e.z ? Where::in : Where::on);
}

std::span<const std::string_view> Halfspace::Kernel::faces() const {
    static constexpr std::array<std::string_view, 1> kFaces{"plane"};
    return kFaces;
}

const Schema& Halfspace::schema() {
    static const std::array<Param, 2> kParams{
        Param{.name = "normal",
              .words = "normal",
              .kind = ParamKind::vector,
              .doc = "points out of the solid; of any length but 0"},
        Param{.name = "offset",
              .words = "offset",
              .kind = ParamKind::number,
              .doc = "the solid is all x with normal.x <= offset",
              .fallback = 0.0}};
    static const Schema kSchema{
        "halfspace", "All points on one side of a plane; unbounded, so only an operand of & and -.",
        kParams, "block(20, center: true) & halfspace((1, -1, 1), 13).paint(\"crimson\")"};
    return kSchema;
}

Result<Placed<Halfspace::Kernel>> Halfspace::prepare(std::span<const Argument> arguments) {
    const Vec3 normal = std::get<Vec3>(arguments[0]);
    const double offset = std::get<double>(arguments[1]);
    if (!(max_norm(normal) > 0.0)) {
        Failure failure = fail(ErrorCode::out_of_range, "halfspace: normal must not be (0, 0, 0)",
                               "give the direction that points out of the solid, as in (0, 0, 1)");
        failure.value().label = "this has no direction";
        failure.value().argument = 0;
        return failure;
    }
    const Vec3 n = unit(normal);
    Vec3 s, t;
    make_frame(n, s, t);
    const double depth = offset / norm(normal);
    if (!std::isfinite(depth)) {
        Failure failure = fail(ErrorCode::out_of_range,
                               "halfspace: the plane is too far away to be computed with",
                               "give an offset of the size of the normal times a distance");
        failure.value().argument = 1;
        return failure;
    }
    Affine map;
    for (int i = 0; i < 3; ++i) {
        map.linear.row[static_cast<std::size_t>(i)] = {s[i], t[i], n[i]};
    }
    map.offset = n * depth;
    return Placed<Kernel>{{}, map};
}

std::span<const std::vector<Argument>> Halfspace::examples() {
    static const std::array<std::vector<Argument>, 4> kExamples{{{Vec3{0, 0, 1}, 0.0},
                                                                 {Vec3{1, 1, 1}, 15.0},
                                                                 {Vec3{0, -2, 0}, 3.0},
                                                                 {Vec3{1e-3, 5, -1e3}, -1e5}}};
    return kExamples;
}

}  // namespace raymo::solids
