// Transformations of solids, contours and paths. A transformation of a list of them transforms each.

#include <fmt/core.h>

#include <cmath>
#include <numbers>
#include <optional>

#include "raymo/sml/builtins/box.hpp"
#include "raymo/sml/builtins/image.hpp"
#include "raymo/sml/text.hpp"

namespace raymo::sml {
namespace {

/// Whether the first argument lies in the plane, where two numbers are a vector and one is an angle.
bool is_plane(Call& call) {
    if (!call.has(0)) return false;
    if (call[0].is(Tag::list) && !call[0].items().empty())
        return call[0].items()[0].is(Tag::contour);
    return call[0].is(Tag::contour);
}

/// Three numbers, or two for what lies in the plane; z is kept then.
bool vector_of(Call& call, std::size_t i, Vec3& out) {
    Vec2 p;
    if (is_plane(call) && call.has(i) && is_vector2(call[i], p)) {
        out.x = p.x;
        out.y = p.y;
        return true;
    }
    return call.vector(i, out);
}

// (x, y, z) given as one vector or as numbers, by position or by name. `given` has a bit for each.
bool components(Call& call, std::size_t first, Vec3& out, unsigned& given) {
    given = 0;
    if (call.has(first) && call[first].is(Tag::list)) {
        if (call.has(first + 1) || call.has(first + 2)) {
            return call.fail(first, ErrorCode::bad_argument,
                             "give one vector or numbers, not both");
        }
        given = 7;
        return vector_of(call, first, out);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!call.has(first + axis)) continue;
        if (!call.number(first + axis, out[static_cast<int>(axis)])) return false;
        given |= 1U << axis;
    }
    if (given == 0) {
        return call.fail(ErrorCode::bad_argument, "the amount is missing",
                         fmt::format("it is {}", call.builtin().takes.signature));
    }
    return true;
}

Affine about(const Affine& map, Vec3 point) {
    return translation(point) * map * translation(-point);
}

/// By these angles about x, then y, then z.
Affine turned(Vec3 angles) {
    std::optional<Affine> map;
    for (int axis = 2; axis >= 0; --axis) {
        if (angles[axis] == 0.0) continue;
        Vec3 direction;
        direction[axis] = 1.0;
        const Affine turn = rotation(direction, angles[axis]);
        map = map ? *map * turn : turn;
    }
    return map.value_or(Affine{});
}

bool move(Call& call, Value& out) {
    Vec3 by;
    unsigned given = 0;
    return components(call, 1, by, given) &&
           apply(call, call[0], translation(by), call.has(3) ? 3 : 1, out);
}

bool rotate(Call& call, Value& out) {
    Affine map;
    const bool is_by_axes = call.has(2) || call.has(3) || call.has(4);
    const bool is_about_axis = call.has(5) || call.has(6);
    if (static_cast<int>(call.has(1)) + static_cast<int>(is_by_axes) +
            static_cast<int>(is_about_axis) >
        1) {
        return call.fail(ErrorCode::bad_argument, "give x, y, z or `axis` and `angle`, not both");
    }
    // rotate(contour, angle) needs no axis.
    const bool is_in_plane =
        is_plane(call) && !call.has(5) && ((call.has(1) && call[1].is(Tag::number)) || call.has(6));
    std::size_t blame = call.has(1) ? 1 : (call.has(2) ? 2 : (call.has(3) ? 3 : 4));
    if (is_about_axis && !is_in_plane) {
        Vec3 axis;
        double angle = 0.0;
        if (!call.axis(5, axis) || !call.number(6, angle)) return false;
        map = rotation(unit(axis), angle);
        blame = call.has(5) ? 5 : 6;
    } else if (is_in_plane) {
        double angle = 0.0;
        if (!call.number(call.has(1) ? 1 : 6, angle)) return false;
        map = rotation({0, 0, 1}, angle);
    } else {
        Vec3 angles;
        unsigned given = 0;
        if (call.has(1)) {
            if (call[1].is(Tag::number)) {
                return call.fail(
                    1, ErrorCode::bad_argument, "the axis is missing",
                    fmt::format("name it: rotate(z: {})", number_text(call[1].number())));
            }
            if (!call.vector(1, angles)) return false;
        } else if (!components(call, 2, angles, given)) {
            return false;
        }
        map = turned(angles);
    }
    if (call.has(7)) {
        Vec3 centre;
        if (!vector_of(call, 7, centre)) return false;
        map = about(map, centre);
    }
    return apply(call, call[0], map, blame, out);
}

bool scale(Call& call, Value& out) {
    Vec3 factors{1, 1, 1};
    unsigned given = 0;
    const bool is_uniform = call.has(1) && call[1].is(Tag::number) && !call.has(2) && !call.has(3);
    if (is_uniform) {
        const double s = call[1].number();
        factors = {s, s, s};
    } else if (!components(call, 1, factors, given)) {
        return false;
    }
    for (int axis = 0; axis < 3; ++axis) {
        if (factors[axis] != 0.0) continue;
        const std::size_t argument =
            !is_uniform && call.has(2) ? 1 + static_cast<std::size_t>(axis) : 1;
        return call.fail(argument, ErrorCode::singular, "a factor must not be 0",
                         "1 leaves a size as it is", "this is 0");
    }
    Affine map = scaling(factors);
    if (call.has(4)) {
        Vec3 centre;
        if (!vector_of(call, 4, centre)) return false;
        map = about(map, centre);
    }
    return apply(call, call[0], map, 1, out);
}

bool skew(Call& call, Value& out) {
    struct Pair {
        std::size_t grows, along;
    };
    // In the order of the parameters: xy xz yx yz zx zy.
    static constexpr std::array<Pair, 6> kPairs{{{0, 1}, {0, 2}, {1, 0}, {1, 2}, {2, 0}, {2, 1}}};
    Affine map;
    bool any = false;
    std::size_t blame = 1;
    for (std::size_t i = 0; i < kPairs.size(); ++i) {
        if (!call.has(1 + i)) continue;
        // What lies in the plane can be skewed along x and y only.
        if (!any || kPairs[i].grows == 2) blame = 1 + i;
        double angle = 0.0;
        if (!call.number(1 + i, angle)) return false;
        if (!(std::fabs(angle) < 90.0)) {
            return call.fail(
                1 + i, ErrorCode::out_of_range,
                fmt::format("{} must be between -90 and 90", call.argument_name(1 + i)), {},
                fmt::format("this is {}", number_text(angle)));
        }
        const SinCos sc = sin_cos_degrees(angle);
        map.linear.row[kPairs[i].grows][static_cast<int>(kPairs[i].along)] = sc.sin / sc.cos;
        any = true;
    }
    if (!any)
        return call.fail(ErrorCode::bad_argument, "the angle is missing", "write skew(xy: 20)");
    return apply(call, call[0], map, blame, out);
}

bool mirror(Call& call, Value& out) {
    Vec3 normal;
    if (is_plane(call) && call.has(1) && call[1].is(Tag::list) && call[1].items().size() == 2) {
        if (!vector_of(call, 1, normal)) return false;
        if (normal == Vec3{}) {
            return call.fail(1, ErrorCode::out_of_range, "`normal` must not be (0, 0)",
                             "(1, 0) swaps left and right", "this has no direction");
        }
    } else if (!call.direction(1, normal)) {
        return false;
    }
    Affine map = reflection(normal);
    if (call.has(2)) {
        Vec3 point;
        if (!vector_of(call, 2, point)) return false;
        map = about(map, point);
    }
    return apply(call, call[0], map, 1, out);
}

bool to_affine(Call& call, std::size_t i, Affine& out) {
    if (call.has(i) && call[i].is(Tag::transform)) {
        out = call[i].as<TransformObject>().value;
        return true;
    }
    std::array<double, 16> m{};
    if (!call.matrix(i, false, m)) return false;
    if (m[12] != 0.0 || m[13] != 0.0 || m[14] != 0.0 || m[15] != 1.0) {
        return call.fail(i, ErrorCode::bad_argument, "the last row must be 0, 0, 0, 1",
                         "perspective is no solid's transformation");
    }
    for (std::size_t r = 0; r < 3; ++r) {
        out.linear.row[r] = {m[4 * r], m[4 * r + 1], m[4 * r + 2]};
        out.offset[static_cast<int>(r)] = m[4 * r + 3];
    }
    if (is_invertible(out.linear)) return true;
    return call.fail(i, ErrorCode::singular, "the matrix can not be inverted",
                     "it flattens the solid: its three columns must point in different directions");
}

// transform(m) is a value; transform(s, m) applies one.
bool transform(Call& call, Value& out) {
    Affine map;
    if (!call.has(1)) {
        if (!to_affine(call, 0, map)) return false;
        out = Value::object(new TransformObject(map));
        return true;
    }
    return to_affine(call, 1, map) && apply(call, call[0], map, 1, out);
}

bool center_at(Call& call, Value& out) {
    Aabb box;
    Vec3 point;
    if (!box_of(call, 0, box) || (call.has(1) && !vector_of(call, 1, point))) return false;
    return apply(call, call[0], translation(point - box.centre()), 1, out);
}

// align(s, x: "min", z: "max", to: point or shape)
bool align(Call& call, Value& out) {
    static constexpr auto kSides = std::to_array<std::string_view>({"min", "center", "max"});
    Aabb box;
    if (!box_of(call, 0, box)) return false;
    Aabb target{{0, 0, 0}, {0, 0, 0}};
    if (call.has(4)) {
        Vec3 point;
        if (call[4].is(Tag::solid) || call[4].is(Tag::contour) || call[4].is(Tag::path) ||
            call[4].is(Tag::mesh)) {
            if (!box_of(call, 4, target)) return false;
        } else if (vector_of(call, 4, point)) {
            target = {point, point};
        } else {
            return false;
        }
    }
    Vec3 by;
    bool any = false;
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t argument = 1 + static_cast<std::size_t>(axis);
        if (!call.has(argument)) continue;
        std::size_t side = 0;
        if (!call.choice(argument, kSides, side)) return false;
        const auto place = [&](const Aabb& b) {
            return side == 0 ? b.lo[axis] : (side == 2 ? b.hi[axis] : b.centre()[axis]);
        };
        by[axis] = place(target) - place(box);
        any = true;
    }
    if (!any) {
        return call.fail(ErrorCode::bad_argument, "the side is missing",
                         "write align(x: \"min\", z: \"center\")");
    }
    return apply(call, call[0], translation(by), call.has(3) ? 3 : 0, out);
}

}  // namespace

std::span<const BuiltinRow> transform_rows() {
    static constexpr auto kRows = std::to_array<BuiltinRow>({
        {"move", "s x? y? z?", &move, "Moved by (x, y, z)."},
        {"rotate", "s angles? | x? y? z? axis? angle? about?", &rotate,
         "Turned about x, then y, then z, or about an axis."},
        {"scale", "s x? y? z? | about?", &scale, "Scaled by one factor, or one for each axis."},
        {"skew", "s | xy? xz? yx? yz? zx? zy?", &skew, "Sheared: xy makes x grow by y tan(angle)."},
        {"mirror", "s normal | about?", &mirror, "Mirrored in a plane."},
        {"transform", "s m?", &transform, "By a matrix of 3 or 4 rows of 4 numbers."},
        {"center_at", "s point?", &center_at, "Moved so that its box is centred at a point."},
        {"align", "s | x? y? z? to?", &align, "Moved so that a side of its box meets another."},
    });
    return kRows;
}

}  // namespace raymo::sml
