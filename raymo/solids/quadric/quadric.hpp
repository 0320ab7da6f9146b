// All points with f(x) <= 0, f a polynomial of degree 2: ellipsoids, paraboloids, hyperboloids,
// cones, cylinders over conics, pairs of planes, and their complements.
//
// The user gives the symmetric 4x4 matrix of f(x) = x^T A x + 2 b.x + c. Canonical frame: the
// origin is moved to the centre or vertex, unless that is far away from where the user looks (see
// QuadricShape::frame); lengths are divided by a power of two near the surface's size as it is seen
// from there, and f by one near its largest coefficient. The coefficients are transformed with twice the working
// precision. Principal axes, box and size: shape.hpp; spans: spans.cpp.
// A solid without interior is an error: f >= 0 everywhere, to within the rounding of the
// coefficients. Ref: [Wijk86 2.3].
#pragma once

#include <memory>
#include <optional>

#include "raymo/solids/primitive.hpp"
#include "raymo/solids/quadric/quadratic_form.hpp"

namespace raymo::solids {

struct Quadric {
    class Kernel {
    public:
        Kernel() : Kernel(QuadraticForm{}) {}
        explicit Kernel(const QuadraticForm& form)
            : form_(std::make_shared<const QuadraticForm>(form)) {}
        [[nodiscard]] Aabb bounds(const Affine& map) const;
        void spans(const LocalRay<double>& ray, SpanList& out) const;
        [[nodiscard]] Vec3 normal(Vec3 p, std::uint16_t face) const;
        [[nodiscard]] Where where(Vec3 p, Vec3 e) const;
        [[nodiscard]] std::span<const std::string_view> faces() const;
        [[nodiscard]] std::optional<double> volume()
            const;  ///< of an ellipsoid, in the canonical frame; else none.
        [[nodiscard]] const QuadraticForm& form() const { return *form_; }
        [[nodiscard]] double bytes() const { return sizeof(QuadraticForm); }
        friend bool operator==(const Kernel& a, const Kernel& b) {
            return a.form_ == b.form_ || a.form() == b.form();
        }

    private:
        /// Apart, for it is larger than all that other kernels have.
        std::shared_ptr<const QuadraticForm> form_;
    };

    [[nodiscard]] static const Schema& schema();
    [[nodiscard]] static Result<Placed<Kernel>> prepare(std::span<const Argument> arguments);
    [[nodiscard]] static std::span<const std::vector<Argument>> examples();
};

}  // namespace raymo::solids
