#include "raymo/render/lamps.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace raymo;
using namespace raymo::render;
using scene::Light;
using scene::LightKind;

TEST_CASE("point lamps shine from their place without falling off") {
    Light light;
    light.position = {0, 0, 10};
    light.power = 2.0;
    light.color = {1, 0.5, 0};
    const Lamp lamp(light, false);
    Arrival near;
    Arrival far;
    REQUIRE(lamp.arrive({0, 0, 9}, {}, near));
    REQUIRE(lamp.arrive({0, 0, -90}, {}, far));
    CHECK(near.direction == Vec3{0, 0, 1});
    CHECK(far.distance == doctest::Approx(100));
    CHECK(near.power == far.power);
    CHECK(near.power == Vec3{2, 1, 0});
    CHECK_FALSE(lamp.arrive({0, 0, 10}, {}, near));
}

TEST_CASE("directional lamps shine against their direction from infinity") {
    Light light;
    light.kind = LightKind::directional;
    light.direction = {0, 0, -2};
    Arrival a;
    REQUIRE(Lamp(light, false).arrive({5, 6, 7}, {}, a));
    CHECK(a.direction == Vec3{0, 0, 1});
    CHECK(std::isinf(a.distance));
}

TEST_CASE("spots are full within the cone, fade over the blur, and end") {
    Light light;
    light.kind = LightKind::spot;
    light.position = {0, 0, 1};
    light.cone_angle = 20;
    light.blur = 10;
    const Lamp lamp(light, false);
    const auto at = [&](double degrees) {
        Arrival a;
        const double r = std::tan(degrees * std::numbers::pi / 180.0);
        return lamp.arrive({r, 0, 0}, {}, a) ? a.power.x : 0.0;
    };
    CHECK(at(0) == doctest::Approx(1));
    CHECK(at(19.9) == doctest::Approx(1));
    CHECK(at(25) < 0.7);
    CHECK(at(25) > 0.3);
    CHECK(at(29.99) < 0.001);
    CHECK(at(31) == 0.0);
}

TEST_CASE("area lamps shine from all of their parallelogram, or from its middle") {
    Light light;
    light.kind = LightKind::area;
    light.position = {-1, -1, 5};
    light.edge_u = {2, 0, 0};
    light.edge_v = {0, 2, 0};
    light.samples = 9;
    const Lamp lamp(light, false);
    CHECK(lamp.is_area());
    CHECK(lamp.samples == 9);
    Arrival a;
    REQUIRE(lamp.arrive({-1, -1, 0}, {0, 0}, a));
    CHECK(a.direction == Vec3{0, 0, 1});
    const Lamp quick(light, true);
    CHECK_FALSE(quick.is_area());
    REQUIRE(quick.arrive({0, 0, 0}, {0.5, 0.5}, a));
    CHECK(a.direction == Vec3{0, 0, 1});
}

TEST_CASE("lamps without power are left out") {
    Light dark;
    dark.power = 0;
    CHECK(prepared({dark, Light{}, dark}, false).size() == 1);
}
