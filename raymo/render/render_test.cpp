#include "raymo/render/render.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <numeric>

#include "raymo/render/ray_shader.hpp"

using namespace raymo;
using namespace raymo::render;

namespace {

csg::Solid ball(Vec3 centre, double r) {
    const auto entries = solids::inventory();
    for (std::uint32_t i = 0; i < entries.size(); ++i) {
        if (entries[i].schema->name != "sphere") continue;
        const solids::Argument radius = r;
        auto solid = csg::primitive(i, {&radius, 1});
        REQUIRE(solid.has_value());
        auto placed = csg::transform(*solid, translation(centre));
        REQUIRE(placed.has_value());
        return *placed;
    }
    FAIL("no sphere");
    return {};
}

scene::Scene balls() {
    scene::Scene scene;
    scene::Material glass;
    glass.transmission = 0.9;
    glass.diffuse = 0.1;
    scene::Material mirror;
    mirror.mirror = 0.6;
    scene.materials = {glass, mirror};
    scene.parts = {{"a", ball({0, 0, 0}, 10), {}},
                   {"b", csg::paint(ball({14, -3, 2}, 6), 0), {}},
                   {"c", csg::paint(ball({-12, 3, 9}, 5), 1), {}}};
    return scene;
}

/// A heap of glass balls over a body: neighbouring rays to the light pass different numbers of surfaces.
scene::Scene heap() {
    scene::Scene scene;
    scene::Material glass;
    glass.transmission = 0.8;
    glass.absorption = {0.01, 0.03, 0.05};
    scene.materials = {glass};
    scene.parts = {{"body", ball({0, 0, -30}, 25), {}}};
    for (int i = 0; i < 9; ++i) {
        const Vec3 place{5.0 * (i % 3) - 5.0, 4.0 * (i / 3) - 4.0, 4.0 + 7.0 * (i % 4)};
        scene.parts.push_back({"glass", csg::paint(ball(place, 2.0 + 0.5 * (i % 2)), 0), {}});
    }
    scene::Light lamp;
    lamp.position = {10, -15, 90};
    scene.lights = {lamp};
    return scene;
}

/// Hands out tasks in a scattered order, and to several workers in turn.
class Scattered : public Executor {
public:
    [[nodiscard]] std::size_t workers() const override { return 3; }
    void for_each(std::size_t count,
                  const std::function<void(std::size_t, std::size_t)>& task) override {
        std::size_t step = count / 2 + 1;
        while (std::gcd(step, count) != 1) ++step;
        for (std::size_t i = 0; i < count; ++i) task((i * step + 5) % count, i % 3);
    }
};

struct Watch : Progress {
    mutable int polls = 0;
    int stop_after = 1 << 30;
    double last = 0.0;
    bool steady = true;
    void report(double fraction) override {
        steady = steady && fraction >= last && fraction <= 1.0;
        last = fraction;
    }
    [[nodiscard]] bool cancelled() const override { return ++polls > stop_after; }
};

Options small(Quality quality, int samples = 0) {
    Options options;
    options.width = 93;
    options.height = 70;
    options.quality = quality;
    options.samples = samples;
    return options;
}

}  // namespace

TEST_CASE("render: the same picture, bit for bit, in any order and with any number of workers") {
    for (const scene::Scene& scene : {balls(), heap()}) {
        const auto compiled = trace::compile(scene);
        REQUIRE(compiled.has_value());
        Look look = look_of(scene, compiled->bounds(), 93.0 / 70);
        for (const bool lens : {false, true}) {
            look.camera.aperture = lens ? 2.0 : 0.0;
            for (const Options& options : {small(Quality::final), small(Quality::final, 3),
                                           small(Quality::preview), small(Quality::draft)}) {
                Executor one;
                Scattered many;
                Progress progress;
                const auto a = render::render(*compiled, look, options, one, progress);
                const auto b = render::render(*compiled, look, options, many, progress);
                REQUIRE(a.has_value());
                REQUIRE(b.has_value());
                CHECK(a->rgb == b->rgb);
                for (const float x : a->rgb) REQUIRE(std::isfinite(x));
            }
        }
    }
}

TEST_CASE("render: a film of codes shows what a film of light would") {
    const scene::Scene scene = balls();
    const auto compiled = trace::compile(scene);
    REQUIRE(compiled.has_value());
    Look look = look_of(scene, compiled->bounds(), 93.0 / 70);
    Executor executor;
    Progress progress;
    for (const double aperture : {0.0, 2.0}) {
        look.camera.aperture = aperture;
        for (Options options :
             {small(Quality::final), small(Quality::final, 1), small(Quality::final, 3),
              small(Quality::preview), small(Quality::preview, 1), small(Quality::draft)}) {
            const auto light = render::render(*compiled, look, options, executor, progress);
            options.kept = image::Kept::codes;
            const auto codes = render::render(*compiled, look, options, executor, progress);
            REQUIRE(light.has_value());
            REQUIRE(codes.has_value());
            // Pixels that are compared with others are kept as light in any case.
            const bool compared =
                options.samples == 0 && (options.quality != Quality::final || aperture == 0.0);
            CHECK(codes->codes.empty() == compared);
            if (compared) {
                CHECK(codes->rgb == light->rgb);
            } else {
                const auto expected = image::to_srgb8(*light);
                CHECK(std::equal(codes->codes.begin(), codes->codes.end(), expected.begin(),
                                 expected.end()));
            }
        }
    }
}

TEST_CASE("render: another seed moves the samples, the same one does not") {
    const scene::Scene scene = balls();
    const auto compiled = trace::compile(scene);
    REQUIRE(compiled.has_value());
    const Look look = look_of(scene, compiled->bounds(), 93.0 / 70);
    Executor executor;
    Progress progress;
    Options options = small(Quality::final, 2);
    const auto a = render::render(*compiled, look, options, executor, progress);
    options.seed = 2;
    const auto b = render::render(*compiled, look, options, executor, progress);
    CHECK(a->rgb != b->rgb);
}

TEST_CASE("render: rays answer the same alone and in batches, but for the order of sums") {
    for (const scene::Scene& scene : {balls(), heap()}) {
        const auto compiled = trace::compile(scene);
        REQUIRE(compiled.has_value());
        const Look look = look_of(scene, compiled->bounds(), 1.0);
        const Stage stage(*compiled, look, Options{});
        RayShader together(stage);
        RayShader alone(stage);
        const scene::View view(look.camera, 60, 60);
        Answers all;
        Answers one;
        for (int y = 0; y < 60; y += 2) {
            EyeBatch batch;
            batch.count = 59;
            EyeBatch single;
            single.count = 1;
            for (std::size_t i = 0; i < 64; ++i) {
                trace::RayQuery query;
                query.ray = view.ray(std::min<double>(static_cast<double>(i), 58), y);
                batch.rays[i / kRays].set(static_cast<int>(i % kRays), query);
                batch.seed[i] = 17 + i;
                batch.sample[i] = 0;
            }
            together.answer(batch, all);
            for (std::size_t i = 0; i < batch.count; ++i) {
                for (int lane = 0; lane < kRays; ++lane)
                    single.rays[0].set(lane,
                                       batch.rays[i / kRays].query(static_cast<int>(i % kRays)));
                single.seed[0] = batch.seed[i];
                single.sample[0] = 0;
                alone.answer(single, one);
                REQUIRE(max_norm(one.light[0] - all.light[i]) < 1e-14);
                REQUIRE(one.signature[0] == all.signature[i]);
            }
        }
    }
}

TEST_CASE("render: progress rises to 1, and stopping stops") {
    const scene::Scene scene = balls();
    const auto compiled = trace::compile(scene);
    REQUIRE(compiled.has_value());
    const Look look = look_of(scene, compiled->bounds(), 93.0 / 70);
    for (const Quality quality : {Quality::draft, Quality::preview, Quality::final}) {
        Executor executor;
        Watch watch;
        CHECK(render::render(*compiled, look, small(quality), executor, watch).has_value());
        CHECK(watch.steady);
        CHECK(watch.last == doctest::Approx(1.0));

        Watch impatient;
        impatient.stop_after = 3;
        const auto stopped = render::render(*compiled, look, small(quality), executor, impatient);
        REQUIRE_FALSE(stopped.has_value());
        CHECK(stopped.error().code == ErrorCode::cancelled);
    }
}

TEST_CASE("render: previews agree with the final picture where they trace") {
    const scene::Scene scene = balls();
    const auto compiled = trace::compile(scene);
    REQUIRE(compiled.has_value());
    Look look = look_of(scene, compiled->bounds(), 93.0 / 70);
    scene::Light lamp;
    lamp.position = {50, -100, 80};
    look.lights = {lamp};
    Executor executor;
    Progress progress;
    const auto whole =
        render::render(*compiled, look, small(Quality::final, 1), executor, progress);
    const auto preview =
        render::render(*compiled, look, small(Quality::preview), executor, progress);
    int equal = 0;
    double worst = 0.0;
    double sum = 0.0;
    for (int y = 0; y < 70; ++y) {
        for (int x = 0; x < 93; ++x) {
            const double d = max_norm(whole->at(x, y) - preview->at(x, y));
            if (x % 8 == 0 && y % 8 == 0) worst = std::max(worst, d);
            equal += d == 0.0;
            sum += d;
        }
    }
    CHECK(worst == 0.0);
    CHECK(equal > 93 * 70 / 64);
    CHECK(sum / (93 * 70) < 0.01);
}

TEST_CASE("render: sizes that are no size, and empty models") {
    scene::Scene scene = balls();
    const auto compiled = trace::compile(scene);
    REQUIRE(compiled.has_value());
    const Look look = look_of(scene, compiled->bounds(), 1.0);
    Executor executor;
    Progress progress;
    Options options;
    options.width = 0;
    CHECK(render::render(*compiled, look, options, executor, progress).error().code ==
          ErrorCode::out_of_range);
    options.width = options.height = 1 << 20;
    CHECK(render::render(*compiled, look, options, executor, progress).error().code ==
          ErrorCode::limit);

    for (const int side : {1, 2, 5}) {
        options.width = side;
        options.height = 1;
        for (const Quality quality : {Quality::draft, Quality::preview, Quality::final}) {
            options.quality = quality;
            CHECK(render::render(*compiled, look, options, executor, progress).has_value());
        }
    }
}

TEST_CASE("look: a scene's own camera, lights, ambient and background come first") {
    scene::Scene scene = balls();
    const Aabb box{{-10, -10, -10}, {10, 10, 10}};
    CHECK(look_of(scene, box, 1.0).lights.size() == 3);
    CHECK(look_of(scene, box, 1.0).ambient == scene::default_ambient());
    scene.lights.resize(1);
    scene.ambient = scene::Colour{0.5, 0, 0};
    scene.background = scene::Background{{1, 0, 0}, {0, 1, 0}};
    scene.cameras.resize(2);
    scene.cameras[0].camera.angle = 11;
    scene.cameras[1].camera.angle = 12;
    const Look look = look_of(scene, box, 1.0, 1);
    CHECK(look.lights.size() == 1);
    CHECK(look.ambient == scene::Colour{0.5, 0, 0});
    CHECK(look.background == *scene.background);
    CHECK(look.camera.angle == 12);
    CHECK(look_of(scene, box, 1.0).camera.angle == 11);
}
