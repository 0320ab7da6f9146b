// Points and rays are answered by different means (Kleene logic over the graph, sorted crossings in the compiled scene), so
// where they agree on random solids both are likely to be right.
#include <doctest/doctest.h>

#include <random>

#include "raymo/query/emptiness.hpp"
#include "raymo/query/locate.hpp"
#include "raymo/query/test_solids.hpp"
#include "raymo/trace/tracer.hpp"

namespace raymo::query {
namespace {

using namespace test;

class RandomSolids {
public:
    explicit RandomSolids(std::uint64_t seed) : random_(seed) {}

    double number(double lo, double hi) {
        return std::uniform_real_distribution<double>(lo, hi)(random_);
    }
    int whole(int lo, int hi) { return std::uniform_int_distribution<int>(lo, hi)(random_); }
    Vec3 point(double reach) {
        return {number(-reach, reach), number(-reach, reach), number(-reach, reach)};
    }

    /// Sizes and places on a coarse grid, so that faces are flush and surfaces touch as often as not.
    csg::Solid leaf() {
        const double a = whole(1, 3);
        const double b = whole(1, 3);
        csg::Solid s;
        switch (whole(0, 4)) {
            case 0:
                s = sphere(a);
                break;
            case 1:
                s = cylinder(a, b);
                break;
            case 2:
                s = cone(a, b - 1, 2);
                break;
            case 3:
                s = made("torus", {a + 1.0, 0.5 * b});
                break;
            default:
                s = block(a, b, a);
        }
        if (whole(0, 3) == 0) s = mapped(s, rotation({0, 0, 1}, 90.0 * whole(0, 3)));
        if (whole(0, 5) == 0) s = mapped(s, rotation(unit(point(1)), number(0, 360)));
        return move(s, {1.0 * whole(-2, 2), 1.0 * whole(-2, 2), 1.0 * whole(-2, 2)});
    }
    csg::Solid tree(int depth) {
        if (depth == 0) return leaf();
        std::vector<csg::Solid> operands;
        for (int i = whole(2, 3); i > 0; --i) operands.push_back(tree(whole(0, depth - 1)));
        if (whole(0, 4) == 0) operands.push_back(operands[0]);  // shared
        return csg::boolean(static_cast<csg::Op>(whole(0, 2)), std::move(operands));
    }

private:
    std::mt19937_64 random_;
};

TEST_CASE("query: points between the crossings of a ray are where its spans say") {
    RandomSolids random(20'260);
    int asked = 0;
    int found = 0;
    for (int model = 0; model < 600; ++model) {
        CAPTURE(model);
        scene::Scene scene;
        scene.parts.push_back({"", random.tree(3), {}});
        const Result<trace::CompiledScene> compiled = trace::compile(scene);
        REQUIRE(compiled.has_value());
        trace::Tracer tracer(*compiled);
        Locator locator(scene);
        bool any = false;
        for (int i = 0; i < 30; ++i) {
            const Vec3 from = random.point(6);
            const Ray ray{from, random.point(3) - from};
            std::vector<std::vector<trace::PartSpan>> parts;
            tracer.spans(ray, parts);
            // The middles of the spans are in, the middles of the gaps are out.
            double last = -3.0;
            const auto check = [&](double lo, double hi, Where expected) {
                if (hi - lo < 1e-9) return;
                const double t = lo + (hi - lo) * random.number(0.1, 0.9);
                const Where where = locator.where(ray.at(t));
                CAPTURE(t);
                CAPTURE(i);
                CHECK(where == expected);
                ++asked;
            };
            for (const trace::PartSpan& s : parts.at(0)) {
                any = true;
                ++found;
                check(last, s.enter.t, Where::out);
                check(s.enter.t, s.exit.t, Where::in);
                const double e = s.enter.point_error;
                CHECK(locator.where_all(s.enter.point, {e, e, e}) == Where::on);
                last = s.exit.t;
            }
            check(last, std::max(last, 0.0) + 3.0, Where::out);
        }
        const Result<bool> empty = is_empty(scene, *compiled);
        REQUIRE(empty.has_value());
        if (any) CHECK_FALSE(*empty);
    }
    CHECK(asked > 20'000);
    CHECK(found > 3'000);
}

}  // namespace
}  // namespace raymo::query
