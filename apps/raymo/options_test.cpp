#include "apps/raymo/options.hpp"

#include <doctest/doctest.h>

namespace raymo::app {
namespace {

Attempt<Options> options(const std::string& command, const Args& args) {
    const Attempt<Parsed> parsed = parse_arguments(command, args);
    if (!parsed) return tl::unexpected<Trouble>(parsed.error());
    return read_options(command, parsed->raw);
}

/// The message that the arguments are refused with; empty when they are taken.
std::string refusal(const Args& args, const std::string& command = "render") {
    const Attempt<Options> o = options(command, args);
    if (o) return {};
    CHECK(o.error().code == kCommandWrong);
    return o.error().message + " | " + o.error().hint;
}

bool says(const std::string& text, std::string_view part) {
    return text.find(part) != std::string::npos;
}

TEST_CASE("options: everything at once") {
    const Attempt<Options> o = options("render", {"--eye",
                                                  "-1,2,-3",
                                                  "cup.raymo",
                                                  "-o",
                                                  "a.png",
                                                  "-Dh=2*3",
                                                  "-D",
                                                  "s=\"x=y\"",
                                                  "-o",
                                                  "-",
                                                  "--size",
                                                  "640X480",
                                                  "--look-at=0,0,1",
                                                  "--angle",
                                                  "30",
                                                  "--projection",
                                                  "parallel",
                                                  "--quality",
                                                  "draft",
                                                  "--samples",
                                                  "4",
                                                  "--seed",
                                                  "9",
                                                  "--threads",
                                                  "3",
                                                  "--quiet",
                                                  "--color",
                                                  "never",
                                                  "--time-limit",
                                                  "2.5",
                                                  "--memory-limit",
                                                  "1"});
    REQUIRE(o.has_value());
    CHECK(o->file == "cup.raymo");
    CHECK(o->outputs == std::vector<std::string>{"a.png", "-"});
    CHECK(o->params.at("h") == "2*3");
    CHECK(o->params.at("s") == "\"x=y\"");
    CHECK(o->width == 640);
    CHECK(o->height == 480);
    CHECK(o->camera.eye == Vec3{-1, 2, -3});
    CHECK(o->camera.projection == scene::Projection::parallel);
    CHECK(o->quality == render::Quality::draft);
    CHECK(o->samples == 4);
    CHECK(o->seed == 9);
    CHECK(o->threads == 3);
    CHECK(o->quiet);
    CHECK(o->color == ColorWhen::never);
    CHECK(o->time_limit == 2.5);
    CHECK(o->memory_limit == 1024.0 * 1024.0 * 1024.0);
}

TEST_CASE("options: --stats stands alone or takes json, and never the file") {
    CHECK(options("render", {"--stats", "cup.raymo"})->stats == StatsForm::text);
    CHECK(options("render", {"--stats", "cup.raymo"})->file == "cup.raymo");
    CHECK(options("render", {"cup.raymo", "--stats", "json"})->stats == StatsForm::json);
    CHECK(options("render", {"cup.raymo", "--stats=json"})->stats == StatsForm::json);
    CHECK(options("render", {"cup.raymo", "--stats"})->stats == StatsForm::text);
    CHECK(options("render", {"cup.raymo"})->stats == StatsForm::none);
}

TEST_CASE("options: unknown ones are told with what was meant") {
    CHECK(says(refusal({"cup.raymo", "--qualty", "draft"}), "did you mean `--quality`?"));
    CHECK(says(refusal({"cup.raymo", "--siz=3x3"}), "did you mean `--size`?"));
    CHECK(says(refusal({"cup.raymo", "--from-origin"}), "raymo rays"));
    CHECK(says(refusal({"cup.raymo", "-q"}), "unknown option"));
    CHECK(says(refusal({"cup.raymo", "-o", "x.png"}, "check"), "has no option"));
}

TEST_CASE("options: missing values and files") {
    CHECK(says(refusal({"cup.raymo", "-o"}), "needs a value"));
    CHECK(says(refusal({"cup.raymo", "-o", "--size", "3x3"}), "found the option --size"));
    CHECK(says(refusal({"cup.raymo", "--size"}), "--size needs a value"));
    CHECK(says(refusal({"cup.raymo", "--size="}), "needs a value"));
    CHECK(says(refusal({}), "no FILE"));
    CHECK(says(refusal({"a.raymo", "b.raymo"}), "one FILE"));
    CHECK(says(refusal({"a.raymo", "-D", "h"}), "NAME=VALUE"));
    CHECK(says(refusal({"a.raymo", "-D", "=3"}), "NAME=VALUE"));
    CHECK(says(refusal({"a.raymo", "-D", "h="}), "NAME=VALUE"));
}

TEST_CASE("options: sizes that are none, and sizes that are too many") {
    for (const char* size :
         {"0x0", "0x5", "5x0", "5", "x", "5x", "x5", "-1x5", "5x5x5", "1.5x2", "axb", "5 x 5"}) {
        CAPTURE(size);
        CHECK(says(refusal({"a.raymo", "--size", size}), "as 800x600"));
    }
    for (const char* size :
         {"32769x1", "32768x32768", "99999999999999999999x1", "4294967297x4294967297"}) {
        CAPTURE(size);
        CHECK_FALSE(refusal({"a.raymo", "--size", size}).empty());
    }
    CHECK(refusal({"a.raymo", "--size", "1x1"}).empty());
    CHECK(refusal({"a.raymo", "--size", "32768x4096"}).empty());
}

TEST_CASE("options: numbers out of their ranges") {
    const std::vector<std::pair<std::string, std::string>> bad{
        {"--angle", "0"},         {"--angle", "180"},
        {"--angle", "nan"},       {"--eye", "1,2"},
        {"--eye", "1,2,inf"},     {"--el", "91"},
        {"--samples", "0"},       {"--samples", "4097"},
        {"--samples", "many"},    {"--threads", "0"},
        {"--threads", "-2"},      {"--threads", "99999"},
        {"--seed", "-1"},         {"--quality", "best"},
        {"--color", "sometimes"}, {"--projection", "fisheye"},
        {"--time-limit", "0"},    {"--time-limit", "-1"},
        {"--memory-limit", "0"},  {"--memory-limit", "x"},
        {"--stats=xml", ""},      {"--call-depth", "0"},
        {"--solid-limit", "0"}};
    for (const auto& [name, value] : bad) {
        CAPTURE(name);
        CAPTURE(value);
        const Args args = value.empty() ? Args{"a.raymo", name} : Args{"a.raymo", name, value};
        const std::string message = refusal(args);
        CHECK(says(message, name.substr(0, name.find('='))));
    }
}

TEST_CASE("options: a camera is placed once") {
    CHECK(says(refusal({"a.raymo", "--az", "3", "--eye", "1,2,3"}), "--eye"));
    CHECK(says(refusal({"a.raymo", "--fit", "--view", "front"}), "--view"));
    CHECK(options("render", {"a.raymo", "--el", "10"})->camera.fit);
}

TEST_CASE("options: help tells the options of its command") {
    const Attempt<Parsed> parsed = parse_arguments("rays", {"--help"});
    REQUIRE(parsed.has_value());
    REQUIRE(parsed->help.has_value());
    CHECK(says(*parsed->help, "--from-origin"));
    CHECK(says(*parsed->help, "Examples:"));
    CHECK_FALSE(says(*parsed->help, "--clash"));
}

}  // namespace
}  // namespace raymo::app
