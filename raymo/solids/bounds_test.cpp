// Boxes, volumes and faces of every solid, also under maps that are not similarities.
#include <doctest/doctest.h>

#include <cmath>
#include <set>

#include "raymo/solids/conformance.hpp"

namespace raymo::solids {
namespace {

using conformance::Random;

Affine random_map(Random& random) {
    Affine map;
    do {
        for (Vec3& row : map.linear.row) row = random.in_cube(1);
    } while (std::fabs(determinant(map.linear)) < 0.05);
    map.offset = random.in_cube(3);
    return map;
}

/// The largest value of n.x found on the solid by climbing from any point of it along lines; infinite when one of
/// them does not end.
template <class K>
double climb(const K& kernel, Vec3 n, Random& random) {
    Vec3 best;
    double height = -std::numeric_limits<double>::infinity();
    for (int i = 0; i < 8000; ++i) {
        // Steps of all sizes, for there are thin solids.
        Vec3 o = best + random.in_cube(std::ldexp(1.5, std::isinf(height) ? 0 : -random.below(14)));
        const Vec3 d = random.direction();
        const double shift = -dot(o, d);
        o += d * shift;
        const double e = 0x1p-50;
        SpanList spans;
        kernel.spans({o.x, o.y, o.z, d.x, d.y, d.z, e, e, e, dot(d, d), kFromTheBeginning}, spans);
        for (std::size_t k = 0; k < spans.size(); ++k) {
            for (const double s : {spans[k].enter.s, spans[k].exit.s}) {
                if (std::isinf(s) && dot(n, d) * s > 0.0) return s * dot(n, d);
                const Vec3 p = o + d * s;
                if (std::isinf(s) || !(dot(n, p) > height)) continue;
                height = dot(n, p);
                best = p;
            }
        }
    }
    return height;
}

TEST_CASE("every solid: its box under any map holds all its points, and fits") {
    Inventory::for_each([]<class P>() {
        CAPTURE(P::schema().name);
        Random random(3);
        for (const auto& example : P::examples()) {
            const auto kernel = P::prepare(example)->kernel;
            for (int trial = 0; trial < 3; ++trial) {
                const Affine map = trial == 0 ? Affine{} : random_map(random);
                const Aabb box = kernel.bounds(map);
                REQUIRE_FALSE(box.empty());
                for (int axis = 0; axis < 3; ++axis) {
                    const Vec3 n = map.linear.row[static_cast<std::size_t>(axis)];
                    CAPTURE(axis);
                    CAPTURE(trial);
                    const double highest = map.offset[axis] + climb(kernel, n, random);
                    const double lowest = map.offset[axis] - climb(kernel, -n, random);
                    CHECK(highest <= box.hi[axis] + 1e-13 * std::fabs(box.hi[axis]) + 1e-13);
                    CHECK(lowest >= box.lo[axis] - 1e-13 * std::fabs(box.lo[axis]) - 1e-13);
                    if (!std::isinf(box.hi[axis])) CHECK(highest > box.hi[axis] - 0.01);
                    if (!std::isinf(box.lo[axis])) CHECK(lowest < box.lo[axis] + 0.01);
                    if (std::isinf(box.hi[axis])) CHECK(highest > 3.0);
                    if (std::isinf(box.lo[axis])) CHECK(lowest < -3.0);
                }
            }
        }
    });
}

/// Volume by parallel rays through the box's shadow, one in each cell of a grid, and its standard error.
template <class K>
double bundle_volume(const K& kernel, Vec3 direction, int cells, Random& random) {
    Vec3 s, t;
    make_frame(direction, s, t);
    const double r = 1.8;  // every bounded canonical solid lies in this ball
    double sum = 0.0;
    for (int i = 0; i < cells; ++i) {
        for (int j = 0; j < cells; ++j) {
            const double x = r * (2.0 * (i + random.uniform(0, 1)) / cells - 1.0);
            const double y = r * (2.0 * (j + random.uniform(0, 1)) / cells - 1.0);
            const Vec3 o = s * x + t * y;
            const double e = 0x1p-50;
            SpanList spans;
            kernel.spans({o.x, o.y, o.z, direction.x, direction.y, direction.z, e, e, e,
                          dot(direction, direction), kFromTheBeginning},
                         spans);
            for (std::size_t k = 0; k < spans.size(); ++k)
                sum += spans[k].exit.s - spans[k].enter.s;
        }
    }
    return sum * 4.0 * r * r / (static_cast<double>(cells) * cells);
}

template <class K>
std::optional<double> closed_volume(const K& kernel) {
    if constexpr (requires { kernel.volume(); }) {
        return kernel.volume();
    } else {
        return std::nullopt;
    }
}

TEST_CASE("every bounded solid: volume by ray bundles is the closed form") {
    int checked = 0;
    Inventory::for_each([&]<class P>() {
        CAPTURE(P::schema().name);
        Random random(4);
        for (const auto& example : P::examples()) {
            const auto kernel = P::prepare(example)->kernel;
            const std::optional<double> exact = closed_volume(kernel);
            if (!exact) continue;
            for (int k = 0; k < 3; ++k) {
                const Vec3 d = k == 0 ? Vec3{0, 0, 1} : random.direction();
                // Jittered sampling of a piecewise smooth thickness: error falls as cells^(-3/2).
                CHECK(bundle_volume(kernel, d, 300, random) ==
                      doctest::Approx(*exact).epsilon(*exact < 0.05 ? 0.05 : 0.003));
                ++checked;
            }
        }
    });
    CHECK(checked >= 60);
}

TEST_CASE("area is the derivative of volume under growth, or a known value") {
    CHECK(Block::Kernel().area() == 24.0);
    CHECK(Sphere::Kernel().volume() == doctest::Approx(4.18879020478639));
    // Growing a torus' tube: dV/db = A.
    for (const double b : {0.1, 0.4, 0.9, 2.0, 30.0}) {
        const double step = 1e-6;
        const double slope =
            (Torus::Kernel(0.6, b + step).volume() - Torus::Kernel(0.6, b - step).volume()) /
            (2 * step);
        CHECK(Torus::Kernel(0.6, b).area() == doctest::Approx(slope).epsilon(1e-6));
    }
    CHECK(Torus::Kernel(1e-12, 1.0).volume() == doctest::Approx(Sphere::Kernel().volume()));
    CHECK(Cone::Kernel(1.0, false).area() == doctest::Approx(Cylinder::Kernel().area()));
    CHECK(Cone::Kernel(1.0, false).volume() == doctest::Approx(Cylinder::Kernel().volume()));
}

TEST_CASE("every solid: each of its faces is met by some ray, and has a name of its own") {
    Inventory::for_each([]<class P>() {
        CAPTURE(P::schema().name);
        const auto kernel = P::prepare(P::examples()[0])->kernel;
        std::set<std::string_view> names(kernel.faces().begin(), kernel.faces().end());
        CHECK(names.size() == kernel.faces().size());
        Random random(5);
        std::set<std::string_view> met;
        const auto name = [&](std::uint16_t face) {
            return kernel.faces()[std::min<std::size_t>(face, kernel.faces().size() - 1)];
        };
        for (int i = 0; i < 2000; ++i) {
            const auto probe = conformance::make_probe(kernel, random);
            SpanList spans;
            kernel.spans(probe.ray, spans);
            for (std::size_t k = 0; k < spans.size(); ++k) {
                if (!std::isinf(spans[k].enter.s)) met.insert(name(spans[k].enter.face));
                if (!std::isinf(spans[k].exit.s)) met.insert(name(spans[k].exit.face));
            }
        }
        CHECK(met.size() == kernel.faces().size());
    });
}

}  // namespace
}  // namespace raymo::solids
