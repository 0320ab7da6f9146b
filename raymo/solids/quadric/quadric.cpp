#include "raymo/solids/quadric/quadric.hpp"

#include <cmath>
#include <numbers>

#include "raymo/math/tolerance.hpp"
#include "raymo/solids/quadric/shape.hpp"

namespace raymo::solids {

Aabb Quadric::Kernel::bounds(const Affine& map) const {
    const QuadricShape shape = analyse(form());
    Aabb box;
    for (int i = 0; i < 3; ++i) {
        const Vec3 n = map.linear.row[static_cast<std::size_t>(i)];
        box.lo[i] = map.offset[i] - shape.support(-n);
        box.hi[i] = map.offset[i] + shape.support(n);
    }
    return box;
}

Vec3 Quadric::Kernel::normal(Vec3 p, std::uint16_t) const {
    const Vec3 n = form().half_gradient(p);
    return max_norm(n) > 0.0 ? n : Vec3{0.0, 0.0, 1.0};  // the tip of a cone has no normal
}

Where Quadric::Kernel::where(Vec3 p, Vec3 e) const {
    const double f = form()(p);
    const double slack = 2.0 * dot(abs(form().half_gradient(p)), e) + dot(e, abs(form().a) * e) +
                         8.0 * kUnitRoundoff * form().magnitude(p);
    return f > slack ? Where::out : (f < -slack ? Where::in : Where::on);
}

std::span<const std::string_view> Quadric::Kernel::faces() const {
    static constexpr std::array<std::string_view, 1> kFaces{"surface"};
    return kFaces;
}

std::optional<double> Quadric::Kernel::volume() const {
    const QuadricShape shape = analyse(form());
    double product = 1.0;
    for (const double v : shape.value) {
        if (!(v > 0.0)) return std::nullopt;
        product *= -shape.level / v;
    }
    return 4.0 * std::numbers::pi / 3.0 * std::sqrt(std::max(0.0, product));
}

const Schema& Quadric::schema() {
    static const std::array<Param, 1> kParams{
        Param{.name = "m",
              .words = "matrix",
              .kind = ParamKind::matrix,
              .doc = "symmetric 4x4 matrix, a list of four rows; the solid is all p with (p, 1) m "
                     "(p, 1) <= 0"}};
    static const Schema kSchema{
        "quadric", "All points where a polynomial of degree 2 is not positive; may be unbounded.",
        kParams,
        "let waist = quadric([[4, 0, 0, 0], [0, 4, 0, 0], [0, 0, -1, 0], [0, 0, 0, -100]])\n"
        "(waist & block(24, 24, 40, center: true)).paint(\"cadetblue\")"};
    return kSchema;
}

namespace {

Failure wrong_matrix(std::string message, std::string hint) {
    Failure failure = fail(ErrorCode::bad_argument, std::move(message), std::move(hint));
    failure.value().argument = 0;
    return failure;
}

}  // namespace

Result<Placed<Quadric::Kernel>> Quadric::prepare(std::span<const Argument> arguments) {
    const Matrix4& m = std::get<Matrix4>(arguments[0]);
    const auto at = [&](std::size_t i, std::size_t j) { return m[4 * i + j]; };
    // Entries may differ by the rounding of the expressions that made them.
    for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const double size = std::max(std::fabs(at(i, j)), std::fabs(at(j, i)));
            if (std::fabs(at(i, j) - at(j, i)) <= 0x1p-40 * size) continue;
            return wrong_matrix("quadric: matrix must be symmetric",
                                "make row " + std::to_string(i + 1) + ", column " +
                                    std::to_string(j + 1) + " equal to row " +
                                    std::to_string(j + 1) + ", column " + std::to_string(i + 1));
        }
    }
    const auto mean = [&](std::size_t i, std::size_t j) { return 0.5 * at(i, j) + 0.5 * at(j, i); };
    QuadraticForm form;
    for (std::size_t i = 0; i < 3; ++i) {
        form.a.row[i] = {mean(i, 0), mean(i, 1), mean(i, 2)};
        form.b[static_cast<int>(i)] = mean(i, 3);
    }
    form.c = at(3, 3);
    form = moved(form, {}, 1.0);  // coefficients of size 1
    const QuadricShape shape = analyse(form);
    if (!shape.has_interior()) {
        return wrong_matrix("quadric: no point has a value below 0, so there is no solid",
                            "change the sign of the matrix, or of its last entry");
    }
    const auto [origin, size] = shape.frame(form);
    if (!is_finite(origin)) {
        return wrong_matrix("quadric: entries differ too much in size to be computed with",
                            "give the matrix in other units");
    }
    const double scale = std::ldexp(1.0, std::ilogb(size));
    Affine map = scaling({scale, scale, scale});
    map.offset = origin;
    return Placed<Kernel>{Kernel(moved(form, origin, scale)), map};
}

std::span<const std::vector<Argument>> Quadric::examples() {
    static const std::array<std::vector<Argument>, 11> kExamples{{
        // ellipsoid, also off centre and turned
        {Matrix4{1, 0, 0, 0, 0, 4, 0, 0, 0, 0, 9, 0, 0, 0, 0, -36}},
        {Matrix4{3, 1, 0, -7, 1, 2, 0.5, 4, 0, 0.5, 1, -2, -7, 4, -2, 1}},
        // cylinder and cone along z
        {Matrix4{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, -4}},
        {Matrix4{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0}},
        // hyperboloids of one sheet and of two, and the complement of a ball
        {Matrix4{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1}},
        {Matrix4{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1}},
        {Matrix4{-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 9}},
        // paraboloids, of revolution and hyperbolic
        {Matrix4{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, -2, 0, 0, -2, 5}},
        {Matrix4{1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0}},
        // a slab and a half-space
        {Matrix4{1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1}},
        {Matrix4{0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3, 1, 2, 3, -4}},
    }};
    return kExamples;
}

}  // namespace raymo::solids
