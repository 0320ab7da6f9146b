// Blended solids for the tests of this layer, traced, and quadrature along their rays.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include "raymo/blends/blend.hpp"
#include "raymo/query/locate.hpp"
#include "raymo/query/spans.hpp"
#include "raymo/query/test_solids.hpp"

namespace raymo::blends::test {

using query::test::block;
using query::test::cone;
using query::test::cylinder;
using query::test::halfspace;
using query::test::made;
using query::test::mapped;
using query::test::move;
using query::test::sphere;

inline csg::Solid torus(double ring, double tube) { return made("torus", {ring, tube}); }
inline csg::Solid centred_block(double x, double y, double z) {
    return made("block", {Vec3{x, y, z}, true});
}
inline csg::Solid turn(csg::Solid s, Vec3 axis, double degrees) {
    return mapped(std::move(s), rotation(axis, degrees));
}

inline Form ball(double radius) {
    Form form;
    form.radius = radius;
    return form;
}

/// The blended Boolean, in which `edges` edges must have been found.
inline csg::Solid blended(csg::Op op, std::vector<csg::Solid> operands, const Form& form,
                          std::size_t edges) {
    auto out = blends::blended(op, std::move(operands), form);
    if (!out) FAIL(out.error().message);
    CHECK(out->edges == edges);
    return out->solid;
}
inline csg::Solid blended(const csg::Solid& solid, Edges which, const Form& form,
                          std::size_t edges) {
    auto out = blended_edges(solid, which, form);
    if (!out) FAIL(out.error().message);
    CHECK(out->edges == edges);
    return out->solid;
}

/// A solid that answers rays and points.
class Traced {
public:
    explicit Traced(const csg::Solid& solid) : locator_(solid) {
        scene_.parts.push_back({"part", solid, {}});
        auto compiled = trace::compile(scene_);
        REQUIRE(compiled.has_value());
        compiled_.emplace(*std::move(compiled));
        tracer_.emplace(*compiled_);
    }
    const std::vector<query::NamedSpan>& along(Vec3 origin, Vec3 direction) {
        query::named_spans(*compiled_, *tracer_, {origin, direction}, {}, spans_);
        return spans_;
    }
    /// Length of the solid along a line whose direction is a unit vector.
    double chord(Vec3 origin, Vec3 direction) {
        double sum = 0.0;
        for (const query::NamedSpan& span : along(origin, direction))
            sum += span.exit.t - span.enter.t;
        return sum;
    }
    /// The first end along a ray from its origin on, in lengths of the direction.
    double first(Vec3 origin, Vec3 direction) {
        for (const query::NamedSpan& span : along(origin, direction)) {
            if (span.enter.t > 0.0) return span.enter.t;
        }
        return std::numeric_limits<double>::quiet_NaN();
    }
    solids::Where where(Vec3 p) { return locator_.where(p); }

private:
    scene::Scene scene_;
    query::Locator locator_;
    std::optional<trace::CompiledScene> compiled_;
    std::optional<trace::Tracer> tracer_;
    std::vector<query::NamedSpan> spans_;
};

inline constexpr double kPi = std::numbers::pi;
using Function = std::function<double(double)>;

/// The integral of f over [a, b], which may have roots at its ends: tanh-sinh quadrature [Takahasi74]. The nodes nearest to
/// the ends, where f is a root of less than 1e-13, count for less than the digits asked for.
inline double integral(double a, double b, const Function& f) {
    constexpr double kStep = 1.0 / 8.0;
    double sum = 0.0;
    for (int i = -26; i <= 26; ++i) {
        const double t = kStep * i;
        const double q = std::exp(-kPi * std::sinh(std::fabs(t)));
        const double from_end = q / (1.0 + q) * (b - a);
        const double x = t < 0 ? a + from_end : b - from_end;
        if (x > a && x < b) sum += f(x) * std::cosh(t) * q / ((1.0 + q) * (1.0 + q));
    }
    return sum * kPi * kStep * (b - a);
}

inline doctest::Approx near(double x) {
    return doctest::Approx(x).scale(x == 0.0 ? 1.0 : 0.0).epsilon(1e-9);
}

}  // namespace raymo::blends::test
