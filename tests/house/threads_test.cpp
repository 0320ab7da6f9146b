// Pictures on several threads. The threads are made here, so that the thread sanitizer sees all of
// their synchronisation, which it does not in Debian's oneTBB.
#include <doctest/doctest.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

#include "raymo/render/render.hpp"
#include "raymo/sml/sml.hpp"
#include "raymo/trace/compiled_scene.hpp"

namespace raymo {
namespace {

constexpr const char* kModel = R"(
    let holes = grid(cylinder(4, 20, center: true), 4, 4, 1, 15).move(-22, -22)
    part plate = (block(60, 60, 8, center: true) - holes).paint("steelblue")
    part ball = (sphere(14) - block(14)).move(z: 20).paint(material(color: "white", transmission: 0.9, ior: 1.5))
    part ring = torus(24, 3).move(z: 12).paint(material(color: "gold", mirror: 0.5))
    light(position: (80, -60, 120))
)";

/// Workers that take the next index as soon as they are free, as in the app.
class Threads final : public Executor {
public:
    explicit Threads(std::size_t workers) : workers_(workers) {}
    [[nodiscard]] std::size_t workers() const override { return workers_; }
    void for_each(std::size_t count,
                  const std::function<void(std::size_t, std::size_t)>& task) override {
        std::atomic<std::size_t> next{0};
        std::vector<std::jthread> threads;
        for (std::size_t worker = 0; worker < workers_; ++worker) {
            threads.emplace_back([&, worker] {
                for (std::size_t i = next++; i < count; i = next++) task(i, worker);
            });
        }
    }

private:
    std::size_t workers_;
};

image::Film picture(Executor& executor) {
    const sml::Outcome outcome = sml::evaluate("threads.raymo", kModel, {});
    for (const sml::Diagnostic& d : outcome.diagnostics) {
        MESSAGE(sml::format(d, outcome.sources));
    }
    REQUIRE(outcome.ok);
    const auto compiled = trace::compile(outcome.scene);
    REQUIRE(compiled.has_value());
    render::Options options;
    options.width = 120;
    options.height = 90;
    Progress progress;
    const render::Look look = render::look_of(outcome.scene, compiled->bounds(), 4.0 / 3.0);
    auto film = render::render(*compiled, look, options, executor, progress);
    REQUIRE(film.has_value());
    return *film;
}

}  // namespace

TEST_CASE("threads: a picture is the same, bit for bit, for any number of them") {
    Executor one;
    const image::Film expected = picture(one);
    for (const std::size_t workers : {std::size_t{2}, std::size_t{7}}) {
        CAPTURE(workers);
        Threads threads(workers);
        CHECK(picture(threads).rgb == expected.rgb);
    }
}

}  // namespace raymo
