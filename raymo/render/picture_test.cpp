// Pictures that can be worked out by hand.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "raymo/render/ray_shader.hpp"
#include "raymo/render/render.hpp"

using namespace raymo;
using namespace raymo::render;
using scene::Material;

namespace {

csg::Solid make(std::string_view name, std::vector<solids::Argument> arguments) {
    const auto entries = solids::inventory();
    for (std::uint32_t i = 0; i < entries.size(); ++i) {
        if (entries[i].schema->name != name) continue;
        // Parameters that are left out take their fallbacks.
        for (std::size_t k = arguments.size(); k < entries[i].schema->params.size(); ++k) {
            arguments.push_back(entries[i].schema->params[k].fallback.value());
        }
        auto solid = csg::primitive(i, arguments);
        REQUIRE(solid.has_value());
        return *solid;
    }
    FAIL("no such primitive");
    return {};
}
csg::Solid moved(const csg::Solid& solid, Vec3 by) {
    auto answer = csg::transform(solid, translation(by));
    REQUIRE(answer.has_value());
    return *answer;
}
csg::Solid block(Vec3 lo, Vec3 hi) { return moved(make("block", {hi - lo}), lo); }
csg::Solid sphere(Vec3 centre, double r) { return moved(make("sphere", {r}), centre); }

/// A scene with one part a solid and what is needed to look at it.
struct Studio {
    scene::Scene scene;
    Look look;
    Options options;

    Studio() {
        look.ambient = {};
        look.background = {};
        options.width = 16;
        options.height = 16;
    }
    void add(const csg::Solid& solid, const Material& material) {
        const auto id = static_cast<csg::MaterialId>(scene.materials.size());
        scene.materials.push_back(material);
        scene.parts.push_back({std::to_string(id), csg::paint(solid, id), {}});
    }
    /// From z = 100 straight down, `height` mm wide.
    void look_down(double height) {
        look.camera.projection = scene::Projection::parallel;
        look.camera.eye = {0, 0, 100};
        look.camera.look_at = {0, 0, 0};
        look.camera.up = {0, 1, 0};
        look.camera.height = height;
    }
    [[nodiscard]] trace::CompiledScene compiled() const {
        auto answer = trace::compile(scene);
        REQUIRE(answer.has_value());
        return std::move(*answer);
    }
    [[nodiscard]] image::Film film() const {
        const trace::CompiledScene ready = compiled();
        Executor executor;
        Progress progress;
        auto answer = render::render(ready, look, options, executor, progress);
        REQUIRE(answer.has_value());
        return std::move(*answer);
    }
};

/// Asks for the light along single rays.
class Eye {
public:
    explicit Eye(const Studio& studio)
        : scene_(studio.compiled()), stage_(scene_, studio.look, studio.options), shader_(stage_) {}
    Colour operator()(Vec3 from, Vec3 to) {
        trace::RayQuery query;
        query.ray = {from, unit(to - from)};
        EyeBatch eyes;
        eyes.count = 1;
        eyes.seed[0] = 1;
        eyes.sample[0] = 0;
        eyes.rays[0].set(0, query);
        Answers answers;
        shader_.answer(eyes, answers);
        return answers.light[0];
    }

private:
    trace::CompiledScene scene_;
    Stage stage_;
    RayShader shader_;
};

scene::Light sun(Vec3 direction, double power = 1.0) {
    scene::Light light;
    light.kind = scene::LightKind::directional;
    light.direction = unit(direction);
    light.power = power;
    return light;
}

Material matte(Colour color) {
    Material material;
    material.color = color;
    material.diffuse = 1.0;
    material.specular = 0.0;
    return material;
}
Material clear(double ior) {
    Material material = matte({0, 0, 0});
    material.transmission = 1.0;
    material.ior = ior;
    return material;
}

/// Where along a..b a quantity passes from above to below `level` (or back), by bisection.
template <class F>
Vec3 border(Vec3 a, Vec3 b, double level, F&& quantity) {
    const bool above = quantity(a) > level;
    REQUIRE((quantity(b) > level) != above);
    for (int i = 0; i < 60; ++i) {
        const Vec3 m = (a + b) * 0.5;
        ((quantity(m) > level) == above ? a : b) = m;
    }
    return (a + b) * 0.5;
}

}  // namespace

TEST_CASE("picture: a matte ball is lit by the cosine, pixel by pixel") {
    Studio studio;
    studio.add(sphere({0, 0, 0}, 10), matte({0.8, 0.5, 0.2}));
    studio.look_down(24);
    const Vec3 to_light = unit(Vec3{0.5, -0.3, 0.7});
    studio.look.lights = {sun(-to_light, 1.5)};
    studio.look.ambient = {0.1, 0.2, 0.3};
    studio.look.background = {{0, 0, 1}, {0, 0, 1}};
    studio.options.width = studio.options.height = 48;
    studio.options.samples = 1;
    const image::Film film = studio.film();
    int wrong = 0;
    for (int y = 0; y < 48; ++y) {
        for (int x = 0; x < 48; ++x) {
            const double px = (x + 0.5 - 24) / 2.0;
            const double py = -(y + 0.5 - 24) / 2.0;
            Colour expected{0, 0, 1};
            const double zz = 100 - px * px - py * py;
            if (zz > 0) {
                const Vec3 n = Vec3{px, py, std::sqrt(zz)} * 0.1;
                const double nl = std::max(0.0, dot(n, to_light));
                expected =
                    Colour{0.8, 0.5, 0.2} * (Colour{0.1, 0.2, 0.3} + Colour{1, 1, 1} * (1.5 * nl));
            }
            wrong += !(max_norm(film.at(x, y) - expected) < 1e-5);
        }
    }
    CHECK(wrong == 0);
}

TEST_CASE("picture: a shiny ball follows Torrance and Sparrow, written out") {
    Studio studio;
    Material shiny = matte({0.5, 0.5, 0.5});
    shiny.specular = 0.04;
    shiny.roughness = 0.4;
    studio.add(sphere({0, 0, 0}, 10), shiny);
    const Vec3 l = unit(Vec3{0.4, 0.1, 0.8});
    studio.look.lights = {sun(-l)};
    Eye eye(studio);
    for (const Vec3 p : {Vec3{0, 0, 0}, Vec3{3, 1, 0}, Vec3{6, -2, 0}, Vec3{-4, 4, 0}}) {
        const Vec3 n = Vec3{p.x, p.y, std::sqrt(100 - p.x * p.x - p.y * p.y)} * 0.1;
        const Vec3 v{0, 0, 1};
        const Vec3 h = unit(l + v);
        const double nh = dot(n, h);
        const double nv = dot(n, v);
        const double nl = dot(n, l);
        const double vh = dot(v, h);
        const double beta = 0.4 * std::numbers::pi / 4;
        const double c3 = (std::cos(beta) * std::cos(beta) - 1) /
                          (std::cos(beta) * std::cos(beta) - std::numbers::sqrt2);
        const double bracket = c3 / (nh * nh * (c3 - 1) + 1);
        const double d = bracket * bracket / (std::numbers::pi * c3);
        const double g = std::min({1.0, 2 * nh * nv / vh, 2 * nh * nl / vh});
        const double f = fresnel(vh, 1.5);
        const double facets = f * d * g / (4 * nl * nv);
        const double body =
            0.5 / std::numbers::pi * (1 - fresnel(nl, 1.5)) * (1 - fresnel(nv, 1.5));
        const double expected = std::numbers::pi * nl * (facets + body);
        CHECK(eye({p.x, p.y, 50}, {p.x, p.y, 0}).x == doctest::Approx(expected).epsilon(1e-6));
    }
}

TEST_CASE("picture: the edge of a shadow lies where the light says") {
    Studio studio;
    studio.add(block({-50, -50, -1}, {50, 50, 0}), matte({1, 1, 1}));
    studio.add(block({-5, -5, 8}, {5, 5, 10}), matte({1, 1, 1}));
    studio.look.lights = {sun({1, 0, -2})};
    Eye eye(studio);
    // The lower edge x = -5, z = 8 throws its shadow to x = -5 + 4; the upper edge x = 5, z = 10 to 5 + 5.
    const auto light_at = [&](Vec3 p) { return eye({p.x, -80, 60}, p).x; };
    CHECK(border({-20, 0, 0}, {3, 0, 0}, 0.3, light_at).x == doctest::Approx(-1).epsilon(1e-9));
    CHECK(border({3, 0, 0}, {30, 0, 0}, 0.3, light_at).x == doctest::Approx(10).epsilon(1e-9));
    CHECK(light_at({3, 0, 0}) == 0.0);
    CHECK(light_at({-20, 0, 0}) == doctest::Approx(2 / std::sqrt(5.0)));
}

TEST_CASE("picture: a light behind a surface does not reach it, whatever is in front") {
    Studio studio;
    studio.add(block({-5, -5, -1}, {5, 5, 0}), Material{});
    studio.look.lights = {sun({0, 0, 1}), sun({1, 0, 0})};
    for (scene::Light& light : studio.look.lights) light.shadows = false;
    Eye eye(studio);
    CHECK(eye({1, 1, 9}, {1, 1, 0}) == Colour{0, 0, 0});
}

TEST_CASE("picture: a slab of glass shifts what is behind it by Snell's law") {
    Studio studio;
    const double n = 1.5;
    const double thickness = 4.0;
    studio.add(block({-100, -100, 0}, {100, 100, thickness}), clear(n));
    studio.add(block({-100, -100, -20}, {0, 100, -10}), matte({1, 1, 1}));
    studio.look.ambient = {1, 1, 1};
    Eye eye(studio);
    for (const double degrees : {10.0, 45.0, 70.0}) {
        const double a = degrees * std::numbers::pi / 180;
        const Vec3 d{std::sin(a), 0, -std::cos(a)};
        // Parallel rays that would meet z = -10 at (x, 0) without the glass.
        const auto seen = [&](Vec3 p) { return eye(p - d * 60, p).x; };
        const double b = std::asin(std::sin(a) / n);
        const double shift = thickness * (std::tan(a) - std::tan(b));
        const Vec3 edge = border({-30, 0, -10}, {30, 0, -10}, 0.4, seen);
        CHECK(edge.x == doctest::Approx(shift).epsilon(1e-9));
        // Two faces, and the light that is thrown to and fro between them: (1 - F)^2 / (1 - F^2).
        const double f = fresnel(std::cos(a), n);
        CHECK(seen({-20, 0, -10}) == doctest::Approx((1 - f) / (1 + f)).epsilon(0.02));
    }
}

TEST_CASE("picture: what abuts is one medium after the other, without air between") {
    Studio studio;
    studio.add(block({-50, -50, 0}, {50, 50, 4}), clear(1.5));
    studio.add(block({-50, -50, -6}, {50, 50, 0}), clear(1.33));
    studio.add(block({-100, -100, -20}, {0, 100, -16}), matte({1, 1, 1}));
    studio.look.ambient = {1, 1, 1};
    Eye eye(studio);
    const double a = 1.0;
    const Vec3 d{std::sin(a), 0, -std::cos(a)};
    const double glass = std::asin(std::sin(a) / 1.5);
    const double water = std::asin(std::sin(a) / 1.33);
    const double shift = 10 * std::tan(a) - 4 * std::tan(glass) - 6 * std::tan(water);
    const auto seen = [&](Vec3 p) { return eye(p - d * 60, p).x; };
    CHECK(border({-20, 0, -16}, {20, 0, -16}, 0.4, seen).x == doctest::Approx(shift).epsilon(1e-9));
}

TEST_CASE("picture: the same glass in two abutting parts is one glass") {
    Studio studio;
    studio.add(block({-50, -50, 0}, {50, 50, 4}), clear(1.5));
    studio.add(block({-50, -50, -6}, {50, 50, 0}), clear(1.5));
    studio.look.background = {{1, 1, 1}, {1, 1, 1}};
    studio.look.ambient = {1, 1, 1};
    Eye eye(studio);
    CHECK(eye({3, 4, 50}, {1, 2, 0}).x == doctest::Approx(1.0));
}

TEST_CASE("picture: light falls exponentially inside") {
    Studio studio;
    Material dyed = clear(1.0);
    dyed.absorption = {0.5, 0.1, 0};
    studio.add(block({-9, -9, 0}, {9, 9, 3}), dyed);
    studio.look.background = {{1, 1, 1}, {1, 1, 1}};
    Eye eye(studio);
    const Colour c = eye({0, 0, 10}, {0, 0, 0});
    CHECK(c.x == doctest::Approx(std::exp(-1.5)));
    CHECK(c.y == doctest::Approx(std::exp(-0.3)));
    CHECK(c.z == doctest::Approx(1.0));
}

TEST_CASE("picture: coloured glass throws a coloured shadow") {
    Studio studio;
    Material dyed = clear(1.0);
    dyed.absorption = {0.5, 0, 0.2};
    studio.add(block({-9, -9, 0}, {9, 9, 3}), dyed);
    studio.add(block({-30, -30, -9}, {30, 30, -5}), matte({1, 1, 1}));
    studio.look.lights = {sun({0, 0, -1})};
    Eye eye(studio);
    const Colour c = eye({0, -40, -4}, {0, 0, -5});
    CHECK(c.x == doctest::Approx(std::exp(-1.5)));
    CHECK(c.y == doctest::Approx(1.0));
    CHECK(c.z == doctest::Approx(std::exp(-0.6)));
    CHECK(eye({20, -40, -4}, {20, 0, -5}).x == doctest::Approx(1.0));
}

TEST_CASE("picture: total reflection turns a glass block's inside into a mirror") {
    Studio studio;
    studio.add(block({-10, -10, -10}, {10, 10, 10}), clear(1.5));
    // In by the top, and at the side beyond the critical angle: out by the bottom, with x mirrored there.
    studio.add(block({0, -60, -40}, {60, 60, -30}), matte({1, 0, 0}));
    studio.add(block({-60, -60, -40}, {0, 60, -30}), matte({0, 1, 0}));
    studio.look.ambient = {1, 1, 1};
    Eye eye(studio);
    // sin 40 / 1.5 gives 25.4 degrees from the vertical inside, 64.6 degrees at the side x = 10; critical are 41.8.
    const double a = 40 * std::numbers::pi / 180;
    const Vec3 d{std::sin(a), 0, -std::cos(a)};
    const Vec3 p{8, 0, 10};
    const double b = std::asin(std::sin(a) / 1.5);
    const double bottom = 20 - (8 + 20 * std::tan(b));
    CHECK(bottom < 10);
    const double end = bottom - 20 * std::tan(a);
    REQUIRE(end < 0);
    const Colour c = eye(p - d * 20, p);
    CHECK(c.y > 0.8);
    CHECK(c.x < 0.15);
}

TEST_CASE("picture: mirrors show things where geometry puts their images") {
    Studio studio;
    Material mirror = matte({0, 0, 0});
    mirror.mirror = 1.0;
    studio.add(block({-50, -50, -1}, {50, 50, 0}), mirror);
    studio.add(sphere({10, 0, 20}, 3), matte({1, 0, 0}));
    studio.look.ambient = {1, 1, 1};
    Eye eye(studio);
    const Vec3 from{-20, 5, 30};
    const Vec3 image{10, 0, -20};  // the ball's, behind the mirror
    CHECK(eye(from, image) == Colour{1, 0, 0});
    // Its outline is that of a ball of the same radius there.
    const Vec3 sight = unit(image - from);
    const double distance = norm(image - from);
    const double half = std::asin(3 / distance);
    const Vec3 aside = unit(cross(sight, Vec3{0, 0, 1}));
    const auto seen = [&](Vec3 p) { return eye(from, p).x; };
    const Vec3 edge = border(image, image + aside * 20, 0.5, seen);
    CHECK(dot(edge - image, aside) == doctest::Approx(distance * std::tan(half)).epsilon(1e-6));
}

TEST_CASE("picture: in an all-white world nothing is brighter than white, and glass is invisible") {
    for (int kind = 0; kind < 5; ++kind) {
        Material m = matte({1, 1, 1});
        if (kind == 1) m.mirror = 0.4;
        if (kind == 2) m = clear(1.5);
        if (kind == 3) m.transmission = 0.5, m.specular = 0.5, m.mirror = 0.2;
        if (kind == 4) m.metal = 1.0, m.specular = 1.0;
        Studio studio;
        studio.add(sphere({0, 0, 0}, 10), m);
        studio.add(block({-3, -3, 5}, {12, 3, 9}), m);
        studio.look_down(30);
        studio.look.ambient = {1, 1, 1};
        studio.look.background = {{1, 1, 1}, {1, 1, 1}};
        studio.options.samples = 1;
        const image::Film film = studio.film();
        CAPTURE(kind);
        for (int y = 0; y < 16; ++y) {
            for (int x = 0; x < 16; ++x) {
                CHECK(film.at(x, y).y <= 1.0 + 1e-5);
                if (kind == 0 || kind == 2) CHECK(film.at(x, y).y == doctest::Approx(1.0));
            }
        }
    }
}

TEST_CASE("picture: a transparent block 1e-9 above a plane shows no black pixel") {
    for (const double gap : {1e-9, 0.0, -1e-9}) {
        Studio studio;
        Material glass = clear(1.5);
        glass.specular = 0.04;
        studio.add(block({-20, -20, -5}, {20, 20, 0}), matte({0.8, 0.8, 0.8}));
        studio.add(block({-8, -8, gap}, {8, 8, 6}), glass);
        studio.look.camera.eye = {30, -40, 30};
        studio.look.camera.look_at = {0, 0, 0};
        studio.look.camera.angle = 25;
        studio.look.lights = {sun({0.3, 0.5, -1})};
        studio.look.ambient = {0.1, 0.1, 0.1};
        studio.look.background = {{0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}};
        studio.options.width = studio.options.height = 96;
        studio.options.samples = 1;
        const image::Film film = studio.film();
        CAPTURE(gap);
        double darkest = 1.0;
        for (int y = 0; y < 96; ++y) {
            for (int x = 0; x < 96; ++x) darkest = std::min(darkest, film.at(x, y).y);
        }
        CHECK(darkest > 0.05);
    }
}
