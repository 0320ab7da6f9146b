#include "raymo/scene/scene.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace raymo;
using namespace raymo::scene;

namespace {

/// Place of a point in a picture w x h: the inverse of View::ray for perspective cameras that look
/// straight.
Vec3 seen_at(const Camera& camera, double w, double h, Vec3 p) {
    const Vec3 forward = unit(camera.look_at - camera.eye);
    const Vec3 right = unit(cross(forward, camera.up));
    const Vec3 up = cross(right, forward);
    const Vec3 d = p - camera.eye;
    const double scale = std::max(w, h) / 2.0 / std::tan(camera.angle * std::numbers::pi / 360.0);
    const double z = dot(d, forward);
    return {w / 2 + scale * dot(d, right) / z, h / 2 - scale * dot(d, up) / z, z};
}

}  // namespace

TEST_CASE("materials: copies of a table share it until one of them changes") {
    const auto with_ior = [](double ior) {
        Material m;
        m.ior = ior;
        return m;
    };
    MaterialTable table;
    CHECK(table.empty());
    for (int i = 0; i < 200; ++i) table.push_back(with_ior(i));
    MaterialTable copy = table;
    CHECK(&copy[150] == &table[150]);
    const Material* const first = &table[0];
    copy.edit(150).ior = -1.0;
    copy.push_back(with_ior(200.0));
    const Material* const last = &copy[200];
    table.push_back(with_ior(-200.0));
    for (int i = 0; i < 20; ++i) copy.push_back(with_ior(0.0));
    CHECK(&copy[200] == last);
    table.resize(300);
    CHECK(copy.size() == 221);
    CHECK(table.size() == 300);
    for (std::size_t i = 0; i < 200; ++i) {
        CHECK(table[i].ior == static_cast<double>(i));
        CHECK(copy[i].ior == (i == 150 ? -1.0 : static_cast<double>(i)));
    }
    CHECK(copy[200].ior == 200.0);
    CHECK(table[200].ior == -200.0);
    CHECK(table[299] == Material{});
    CHECK(&table[0] == first);
    CHECK(table.any_of([](const Material& m) { return m.ior == -200.0; }));
    CHECK_FALSE(copy.any_of([](const Material& m) { return m.ior == -200.0; }));
}

TEST_CASE("sRGB: black, white and middle grey") {
    CHECK(from_srgb({0, 1, 0.5}).x == 0.0);
    CHECK(from_srgb({0, 1, 0.5}).y == doctest::Approx(1.0));
    CHECK(from_srgb({0, 1, 0.5}).z == doctest::Approx(0.21404114));
    CHECK(from_srgb({0.04, 0, 0}).x == doctest::Approx(0.04 / 12.92));
}

TEST_CASE(
    "view: the picture's middle looks at the look-at point, its sides are half the angle away") {
    Camera camera;
    camera.eye = {10, -40, 30};
    camera.look_at = {1, 2, 3};
    camera.angle = 40;
    const View view(camera, 800, 600);
    const Vec3 forward = unit(camera.look_at - camera.eye);
    CHECK(norm(view.ray(400, 300).direction - forward) < 1e-14);
    const double half = 20.0 * std::numbers::pi / 180.0;
    CHECK(dot(view.ray(0, 300).direction, forward) == doctest::Approx(std::cos(half)));
    CHECK(dot(view.ray(800, 300).direction, forward) == doctest::Approx(std::cos(half)));
    // x goes to the right, y down.
    CHECK(dot(view.ray(800, 300).direction, cross(forward, Vec3{0, 0, 1})) > 0);
    CHECK(view.ray(400, 0).direction.z > view.ray(400, 600).direction.z);
    // A portrait has its angle over the height.
    const View tall(camera, 600, 800);
    CHECK(dot(tall.ray(300, 0).direction, forward) == doctest::Approx(std::cos(half)));
}

TEST_CASE("view: parallel rays, the larger side being `height` long") {
    Camera camera;
    camera.eye = {0, -10, 0};
    camera.look_at = {0, 0, 0};
    camera.projection = Projection::parallel;
    camera.height = 50;
    const View view(camera, 100, 40);
    const Ray left = view.ray(0, 20);
    const Ray right = view.ray(100, 20);
    CHECK(left.direction == Vec3{0, 1, 0});
    CHECK(norm(right.origin - left.origin) == doctest::Approx(50));
    CHECK(view.ray(50, 0).origin.z == doctest::Approx(10));
}

TEST_CASE("view: rays through the lens meet in the sharp plane") {
    for (const Projection projection : {Projection::perspective, Projection::parallel}) {
        Camera camera;
        camera.eye = {0, -10, 0};
        camera.look_at = {0, 0, 0};
        camera.projection = projection;
        camera.aperture = 2;
        camera.focus = 7;
        const View view(camera, 100, 100);
        const Ray middle = view.ray(20, 70);
        const Vec3 sharp = middle.at((-3 - middle.origin.y) / middle.direction.y);
        for (const double u : {0.0, 0.3, 0.5, 1.0}) {
            for (const double v : {0.0, 0.5, 0.8}) {
                const Ray ray = view.ray(20, 70, u, v);
                CHECK(norm(ray.direction) == doctest::Approx(1));
                CHECK(norm(ray.at((-3 - ray.origin.y) / ray.direction.y) - sharp) < 1e-12);
                CHECK(norm(ray.origin - middle.origin) < 1.0 + 1e-12);
            }
        }
    }
}

TEST_CASE("view: a camera without direction or with up along its sight still gives rays") {
    Camera camera;
    camera.eye = camera.look_at = {1, 1, 1};
    CHECK(norm(View(camera, 10, 10).ray(3, 4).direction) == doctest::Approx(1));
    camera.eye = {0, 0, 9};
    camera.look_at = {0, 0, 0};
    camera.up = {0, 0, 1};
    CHECK(norm(View(camera, 10, 10).ray(3, 4).direction) == doctest::Approx(1));
    camera.up = {};
    CHECK(norm(View(camera, 10, 10).ray(3, 4).direction) == doctest::Approx(1));
}

TEST_CASE("fitted camera: holds all corners and touches its margin") {
    for (const Aabb& box : {Aabb{{0, 0, 0}, {10, 20, 30}}, Aabb{{-1e6, 5, 5}, {-1e6 + 1e-3, 6, 6}},
                            Aabb{{-50, -50, -1}, {50, 50, 0}}, Aabb{{3, 3, 3}, {3.01, 3.01, 8}}}) {
        for (const double aspect : {0.5, 1.0, 16.0 / 9.0}) {
            for (const double elevation : {-90.0, -20.0, 28.0, 89.0, 90.0}) {
                const Camera camera = fitted_camera(box, aspect, 35.0, elevation);
                const double h = 1000.0;
                const double w = h * aspect;
                double closest = 1e9;
                for (int i = 0; i < 8; ++i) {
                    const Vec3 p = seen_at(
                        camera, w, h,
                        {(i & 1) != 0 ? box.hi.x : box.lo.x, (i & 2) != 0 ? box.hi.y : box.lo.y,
                         (i & 4) != 0 ? box.hi.z : box.lo.z});
                    CHECK(p.z > 0);
                    const double margin = std::min({p.x, w - p.x, p.y, h - p.y});
                    closest = std::min(closest, margin / std::max(w, h));
                    CHECK(margin > 0);
                }
                CAPTURE(aspect);
                CAPTURE(elevation);
                // The margin is 6 % of the side that limits, which is at most the larger one.
                CHECK(closest > 0.02);
                CHECK(closest < 0.0601);
            }
        }
    }
}

TEST_CASE("fitted camera: boxes that are no boxes still give a camera") {
    for (const Aabb& box : {Aabb{}, Aabb::everything(), Aabb{{2, 2, 2}, {2, 2, 2}}}) {
        const Camera camera = fitted_camera(box, 1.5);
        CHECK(is_finite(camera.eye));
        CHECK(norm(camera.eye - camera.look_at) > 0);
    }
}

TEST_CASE("default rig: a shadowing key, from the camera's side of the model") {
    const Aabb box{{0, 0, 0}, {10, 10, 10}};
    const Camera camera = fitted_camera(box, 1.0);
    const auto lights = default_lights(box, camera);
    REQUIRE(lights.size() == 3);
    CHECK(lights[0].shadows);
    const Vec3 to_eye = unit(camera.eye - box.centre());
    const Vec3 to_key =
        unit(lights[0].position + (lights[0].edge_u + lights[0].edge_v) * 0.5 - box.centre());
    CHECK(dot(to_eye, to_key) > 0.2);
    CHECK(to_key.z > 0.5);
    CHECK(dot(to_eye, lights[2].direction) > 0);  // the rim light comes from behind
    for (const Light& light : lights) {
        CHECK(is_finite(light.position));
        CHECK(norm(light.direction) == doctest::Approx(1));
    }
    // Looking straight down has no sideways "up".
    for (const Light& light : default_lights(box, fitted_camera(box, 1.0, 0.0, 90.0))) {
        CHECK(is_finite(light.direction));
    }
}
