#include "apps/raymo/camera.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

namespace raymo::app {
namespace {

const Aabb kBox{{-10, -10, -10}, {10, 10, 10}};

scene::Scene two_views() {
    scene::Scene scene;
    scene.cameras.push_back({"front", {}});
    scene.cameras.push_back({"side", {}});
    scene.cameras[1].camera.eye = {500, 0, 0};
    return scene;
}

TEST_CASE("camera: a view by its name, the first without one") {
    CHECK(wished_camera(two_views(), {}, kBox, 1)->eye == scene::Camera{}.eye);
    CameraWish side;
    side.view = "side";
    CHECK(wished_camera(two_views(), side, kBox, 1)->eye == Vec3{500, 0, 0});
    CameraWish wrong;
    wrong.view = "sied";
    const auto none = wished_camera(two_views(), wrong, kBox, 1);
    REQUIRE_FALSE(none.has_value());
    CHECK(none.error().code == kCommandWrong);
    CHECK(none.error().hint == "did you mean `side`?");
}

TEST_CASE("camera: what is set replaces what the model says, and nothing else") {
    CameraWish wish;
    wish.eye = Vec3{0, -99, 0};
    const auto camera = wished_camera(two_views(), wish, kBox, 1);
    REQUIRE(camera.has_value());
    CHECK(camera->eye == Vec3{0, -99, 0});
    CHECK(camera->look_at == scene::Camera{}.look_at);
    CHECK(camera->angle == scene::Camera{}.angle);
}

TEST_CASE("camera: azimuth and elevation say where it stands") {
    CameraWish wish;
    wish.fit = true;
    wish.azimuth = 0.0;
    wish.elevation = 0.0;
    const auto camera = wished_camera(two_views(), wish, kBox, 1);
    REQUIRE(camera.has_value());
    CHECK(camera->eye.x > 10);
    CHECK(std::fabs(camera->eye.y) < 1e-9);
    CHECK(std::fabs(camera->eye.z) < 1e-9);
}

TEST_CASE("camera: a fitted camera with a narrow angle stands farther away") {
    CameraWish wish;
    wish.fit = true;
    const auto wide = wished_camera({}, wish, kBox, 1);
    wish.angle = 5.0;
    const auto narrow = wished_camera({}, wish, kBox, 1);
    REQUIRE(wide.has_value());
    REQUIRE(narrow.has_value());
    const auto fills = [](const scene::Camera& c) {
        return norm(c.eye - c.look_at) * std::sin(c.angle * std::numbers::pi / 360);
    };
    CHECK(fills(*narrow) == doctest::Approx(fills(*wide)));
}

TEST_CASE("camera: straight down has an up of its own; a wish that can not be kept is refused") {
    CameraWish down;
    down.eye = Vec3{0, 0, 100};
    down.look_at = Vec3{0, 0, 0};
    const auto camera = wished_camera({}, down, kBox, 1);
    REQUIRE(camera.has_value());
    CHECK(camera->up == Vec3{0, 1, 0});
    down.up = Vec3{0, 0, 1};
    CHECK_FALSE(wished_camera({}, down, kBox, 1).has_value());
    CameraWish nowhere;
    nowhere.eye = Vec3{1, 2, 3};
    nowhere.look_at = Vec3{1, 2, 3};
    CHECK_FALSE(wished_camera({}, nowhere, kBox, 1).has_value());
}

TEST_CASE("camera: the parallel view of a perspective one keeps the size of what is looked at") {
    CameraWish wish;
    wish.projection = scene::Projection::parallel;
    const auto camera = wished_camera({}, wish, kBox, 1);
    REQUIRE(camera.has_value());
    CHECK(camera->projection == scene::Projection::parallel);
    CHECK(camera->height > 20);
    CHECK(camera->height < 60);
}

}  // namespace
}  // namespace raymo::app
