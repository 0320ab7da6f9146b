// Solids for the tests of this layer, written as the language would.
#pragma once

#include <doctest/doctest.h>

#include <string_view>
#include <utility>
#include <vector>

#include "raymo/csg/model.hpp"

namespace raymo::query::test {

inline csg::Solid made(std::string_view name, const std::vector<solids::Argument>& arguments) {
    const auto kinds = solids::inventory();
    for (std::uint32_t i = 0; i < kinds.size(); ++i) {
        if (kinds[i].schema->name != name) continue;
        Result<csg::Solid> solid = csg::primitive(i, arguments);
        REQUIRE(solid.has_value());
        return *std::move(solid);
    }
    FAIL("no such primitive");
    return {};
}
inline csg::Solid sphere(double r) { return made("sphere", {r}); }
inline csg::Solid block(double x, double y, double z) {
    return made("block", {Vec3{x, y, z}, false});
}
inline csg::Solid cylinder(double r, double h) { return made("cylinder", {r, h, false}); }
inline csg::Solid cone(double r1, double r2, double h) { return made("cone", {r1, r2, h, false}); }
inline csg::Solid halfspace(Vec3 normal, double offset) {
    return made("halfspace", {normal, offset});
}

inline csg::Solid mapped(csg::Solid s, const Affine& map) {
    Result<csg::Solid> out = csg::transform(std::move(s), map);
    REQUIRE(out.has_value());
    return *std::move(out);
}
inline csg::Solid move(csg::Solid s, Vec3 by) { return mapped(std::move(s), translation(by)); }
inline csg::Solid mirror(csg::Solid s, Vec3 normal) {
    return mapped(std::move(s), reflection(normal));
}

}  // namespace raymo::query::test

namespace raymo::csg {

inline Solid operator+(const Solid& a, const Solid& b) { return boolean(Op::unite, {a, b}); }
inline Solid operator-(const Solid& a, const Solid& b) { return boolean(Op::difference, {a, b}); }
inline Solid operator&(const Solid& a, const Solid& b) { return boolean(Op::intersection, {a, b}); }

}  // namespace raymo::csg
