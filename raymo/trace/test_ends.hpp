// What the tests of this layer ask along single rays.
#pragma once

#include <doctest/doctest.h>

#include <vector>

#include "raymo/trace/compiled_scene.hpp"
#include "raymo/trace/test_primitive.hpp"
#include "raymo/trace/tracer.hpp"

namespace raymo::trace::test {

inline scene::Scene scene_of(std::vector<csg::Solid> solids) {
    scene::Scene out;
    for (csg::Solid& s : solids) out.parts.push_back({"part", std::move(s), {}});
    return out;
}

/// Ends of the spans of one solid, in order.
inline std::vector<double> ends(const csg::Solid& solid, const Ray& ray) {
    const auto compiled = compile(scene_of({solid}));
    REQUIRE(compiled.has_value());
    Tracer tracer(*compiled);
    std::vector<std::vector<PartSpan>> spans;
    tracer.spans(ray, spans);
    std::vector<double> out;
    for (const PartSpan& span : spans[0]) {
        out.push_back(span.enter.t);
        out.push_back(span.exit.t);
    }
    return out;
}

inline void check_ends(const std::vector<double>& found, const std::vector<double>& expected) {
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
        CHECK(found[i] == doctest::Approx(expected[i]).epsilon(1e-12));
}

}  // namespace raymo::trace::test
