#include "raymo/query/spans.hpp"

#include <doctest/doctest.h>

#include <optional>

#include "raymo/query/test_solids.hpp"

namespace raymo::query {
namespace {

using namespace test;

struct Traced {
    explicit Traced(scene::Scene s) : scene(std::move(s)) {
        Result<trace::CompiledScene> c = trace::compile(scene);
        REQUIRE(c.has_value());
        compiled.emplace(*std::move(c));
        tracer.emplace(*compiled);
    }
    std::vector<NamedSpan> along(const Ray& ray, SpanOptions options = {}) {
        std::vector<NamedSpan> out;
        named_spans(*compiled, *tracer, ray, options, out);
        return out;
    }
    scene::Scene scene;
    std::optional<trace::CompiledScene> compiled;
    std::optional<trace::Tracer> tracer;
};

scene::Scene ball_and_red_block() {
    scene::Scene scene;
    scene.materials.resize(1);
    scene.materials.edit(0).name = "red";
    scene.parts.push_back({"ball", sphere(1), {}});
    scene.parts.push_back({"brick", csg::paint(move(block(2, 2, 2), {5, -1, -1}), 0), {}});
    return scene;
}

TEST_CASE("spans: names, places and normals of what a ray meets") {
    Traced traced(ball_and_red_block());
    const auto spans = traced.along({{-4, 0, 0}, {1, 0, 0}});
    REQUIRE(spans.size() == 2);
    CHECK(spans[0].part == 0);
    CHECK(spans[0].enter.t == doctest::Approx(3));
    CHECK(spans[0].exit.t == doctest::Approx(5));
    CHECK(spans[0].enter.normal.x == doctest::Approx(-1));
    CHECK(spans[0].exit.normal.x == doctest::Approx(1));
    CHECK(spans[0].enter.material == "default");
    CHECK(spans[0].enter.leaf.primitive == "sphere");
    CHECK(spans[0].enter.face == "surface");
    CHECK(spans[1].part == 1);
    CHECK(spans[1].enter.material == "red");
    CHECK(spans[1].enter.leaf.primitive == "block");
    CHECK(spans[1].exit.point.x == doctest::Approx(7));
}

TEST_CASE("spans: the whole line, or what lies before the eye") {
    Traced traced(ball_and_red_block());
    CHECK(traced.along({{6, 0, 0}, {1, 0, 0}}).size() == 2);
    SpanOptions forward;
    forward.from_origin = true;
    const auto spans = traced.along({{6, 0, 0}, {1, 0, 0}}, forward);
    REQUIRE(spans.size() == 1);
    CHECK(spans[0].enter.t == 0.0);
    CHECK_FALSE(spans[0].enter.on_surface);
    CHECK(spans[0].enter.point == Vec3{6, 0, 0});
    CHECK(spans[0].exit.on_surface);
}

TEST_CASE("spans: one part only, and t in lengths of the direction") {
    Traced traced(ball_and_red_block());
    SpanOptions only;
    only.part = 1;
    const auto spans = traced.along({{0, 0, 0}, {2, 0, 0}}, only);
    REQUIRE(spans.size() == 1);
    CHECK(spans[0].enter.t == doctest::Approx(2.5));
}

}  // namespace
}  // namespace raymo::query
