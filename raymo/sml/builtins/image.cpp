#include "raymo/sml/builtins/image.hpp"

#include <fmt/core.h>

#include <cmath>

#include "raymo/curves/build_path.hpp"
#include "raymo/math/tolerance.hpp"

namespace raymo::sml {
namespace {

// The contour's image. Its plane must stay where it is; `blame` is the argument that says so when it does not.
bool apply_to_contour(Call& call, const curves::Contour& contour, const Affine& map,
                      std::size_t blame, Value& out) {
    const auto& row = map.linear.row;
    if (row[2].x != 0.0 || row[2].y != 0.0 || map.offset.z != 0.0) {
        return call.fail(blame, ErrorCode::bad_argument, "a contour stays in its plane, z = 0",
                         "make a solid of it first, and " + call.name() + " that");
    }
    const Affine2 plane{row[0].x, row[0].y, map.offset.x, row[1].x, row[1].y, map.offset.y};
    if (!is_invertible(
            Mat3{{Vec3{plane.xx, plane.xy, 0}, Vec3{plane.yx, plane.yy, 0}, Vec3{0, 0, 1}}})) {
        return call.fail(blame, ErrorCode::singular, "it makes the contour flat",
                         "no scale may be 0, and the axes must keep different directions");
    }
    const double bytes = curves::bytes_of_image(contour, plane);
    if (!call.evaluator().room(bytes, call.node())) return false;
    curves::Contour image = curves::mapped(contour, plane);
    if (!(curves::extent_of(image) <= curves::kLargestCoordinate)) {
        return call.fail(blame, ErrorCode::out_of_range,
                         "the contour becomes too large to be computed with",
                         "stay within 1e90 of the origin");
    }
    return call.evaluator().made(std::move(image), bytes, call.node(), out);
}

// The path's image. Its spheres must stay spheres.
bool apply_to_path(Call& call, const curves::Path& path, const Affine& map, std::size_t blame,
                   Value& out) {
    // L^T L = factor^2 I but for the rounding of what L was made of: some 4 roundings for each entry of a rotation, 3 more for
    // each product of two. That leaves room for some twenty in a row, and a sphere round to 3e-14.
    constexpr double kRounding = 256.0 * kUnitRoundoff;
    std::array<Vec3, 3> column{map.linear.column(0), map.linear.column(1), map.linear.column(2)};
    const double size =
        std::max(max_norm(column[0]), std::max(max_norm(column[1]), max_norm(column[2])));
    const bool is_usable = is_invertible(map.linear) && is_finite(map.offset);
    double factor = 0.0;
    bool is_similar = is_usable;
    if (is_usable) {
        for (Vec3& c : column) c = c / size;
        const double square =
            (dot(column[0], column[0]) + dot(column[1], column[1]) + dot(column[2], column[2])) /
            3.0;
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = i; j < 3; ++j) {
                const double wanted = i == j ? square : 0.0;
                is_similar = is_similar &&
                             std::fabs(dot(column[i], column[j]) - wanted) <= kRounding * square;
            }
        }
        factor = std::sqrt(square) * size;
    }
    if (!is_usable) {
        return call.fail(blame, ErrorCode::singular, "it makes the path flat",
                         "no scale may be 0, and the axes must keep different directions");
    }
    if (!is_similar) {
        return call.fail(
            blame, ErrorCode::bad_argument,
            "the spheres of a path must stay spheres: scale all axes alike",
            "to distort it, " + call.name() + " the solid: sweep(path)." + call.name() + "(...)");
    }
    if (!call.evaluator().room(curves::bytes_of(path), call.node())) return false;
    curves::Path image = curves::mapped(path, map, factor);
    if (!(curves::extent_of(image) <= curves::kLargestCoordinate)) {
        return call.fail(blame, ErrorCode::out_of_range,
                         "the path becomes too large to be computed with",
                         "stay within 1e90 of the origin");
    }
    return call.evaluator().made(std::make_shared<const curves::Path>(std::move(image)),
                                 call.node(), out);
}

bool apply_to_mesh(Call& call, const meshes::Mesh& mesh, const Affine& map, std::size_t blame,
                   Value& out) {
    if (!is_invertible(map.linear) || !is_finite(map.offset)) {
        return call.fail(blame, ErrorCode::singular, "it makes the mesh flat",
                         "no scale may be 0, and the axes must keep different directions");
    }
    if (!call.evaluator().room(meshes::bytes_of(mesh), call.node())) return false;
    meshes::Mesh image = meshes::mapped(mesh, map);
    if (!(meshes::extent_of(image) <= meshes::kLargestPoint)) {
        return call.fail(blame, ErrorCode::out_of_range,
                         "the mesh becomes too large to be computed with",
                         "stay within 1e90 of the origin");
    }
    return call.evaluator().made(std::move(image), call.node(), out);
}

bool is_shape(const Value& value) {
    return value.is(Tag::solid) || value.is(Tag::contour) || value.is(Tag::path) ||
           value.is(Tag::mesh);
}

bool apply_to_shape(Call& call, const Value& shape, const Affine& map, std::size_t blame,
                    Value& out) {
    if (shape.is(Tag::contour))
        return apply_to_contour(call, shape.as<ContourObject>().value, map, blame, out);
    if (shape.is(Tag::path))
        return apply_to_path(call, *shape.as<PathObject>().value, map, blame, out);
    if (shape.is(Tag::mesh))
        return apply_to_mesh(call, *shape.as<MeshObject>().value, map, blame, out);
    return call.result(csg::transform(shape.solid(), map, call.span()), out);
}

}  // namespace

bool apply(Call& call, Value& shape, const Affine& map, std::size_t blame, Value& out) {
    if (shape.is(Tag::solid)) {
        const csg::Node* const before = &shape.solid().node();
        Result<csg::Solid> image = csg::transform(shape.take_solid(), map, call.span());
        if (!image || &image->node() != before) return call.result(std::move(image), out);
        // Moved within its own node, which is counted.
        out = Value::solid(*std::move(image));
        return call.evaluator().step(call.node());
    }
    if (is_shape(shape)) {
        const Value keep = shape;
        return apply_to_shape(call, keep, map, blame, out);
    }
    if (shape.is(Tag::transform)) {  // first the one, then the other
        out = Value::object(new TransformObject(map * shape.as<TransformObject>().value));
        return true;
    }
    if (shape.is(Tag::list) && !shape.items().empty() && is_shape(shape.items()[0])) {
        std::vector<Value> items(shape.items().size());
        for (std::size_t i = 0; i < items.size(); ++i) {
            const Value& item = shape.items()[i];
            if (!is_shape(item)) {
                return call.fail(0, ErrorCode::bad_argument, "every element must be a solid", {},
                                 fmt::format("this list has {} in it", kind_text(item)));
            }
            if (!apply_to_shape(call, item, map, blame, items[i])) return false;
        }
        out = Value::list(std::move(items));
        return true;
    }
    return call.wrong_kind(0, "a solid, a contour, a path or a mesh",
                           "write solid." + call.name() + "(...)");
}

}  // namespace raymo::sml
