#include <doctest/doctest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "apps/raymo/params_file.hpp"
#include "apps/raymo/system/executor.hpp"
#include "apps/raymo/system/files.hpp"
#include "apps/raymo/system/watch.hpp"
#include "raymo/sml/sml.hpp"

namespace raymo::app {
namespace {

namespace fs = std::filesystem;

struct Folder {
    Folder() {
        std::string name = (fs::temp_directory_path() / "raymo-test-XXXXXX").string();
        path = mkdtemp(name.data());
    }
    ~Folder() { fs::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    [[nodiscard]] std::string operator/(const char* name) const { return (path / name).string(); }
    [[nodiscard]] std::ptrdiff_t files() const {
        return std::distance(fs::directory_iterator(path), fs::directory_iterator());
    }
    fs::path path;
};

std::string content(const std::string& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
}

const std::vector<std::uint8_t> kBytes{'a', 'b', 'c'};

TEST_CASE("files: a prepared output is not there until it is committed, and never without") {
    Folder folder;
    Console console(0, 1, 2);
    {
        Outputs outputs(console);
        REQUIRE(outputs.prepare(folder / "a.png", kBytes).has_value());
        CHECK_FALSE(fs::exists(folder / "a.png"));
    }
    CHECK(folder.files() == 0);  // dropped: nothing is left behind
    Outputs outputs(console);
    REQUIRE(outputs.prepare(folder / "a.png", kBytes).has_value());
    REQUIRE(outputs.prepare(folder / "b.png", kBytes).has_value());
    REQUIRE(outputs.commit().has_value());
    CHECK(content(folder / "a.png") == "abc");
    CHECK(content(folder / "b.png") == "abc");
    CHECK(folder.files() == 2);
}

TEST_CASE("files: a link is written through, and a file keeps its permissions") {
    Folder folder;
    Console console(0, 1, 2);
    std::ofstream(folder / "real.png") << "old";
    chmod((folder / "real.png").c_str(), 0640);
    fs::create_symlink("real.png", folder / "link.png");
    Outputs outputs(console);
    REQUIRE(outputs.prepare(folder / "link.png", kBytes).has_value());
    REQUIRE(outputs.commit().has_value());
    CHECK(fs::is_symlink(folder / "link.png"));
    CHECK(content(folder / "real.png") == "abc");
    struct stat info {};
    REQUIRE(stat((folder / "real.png").c_str(), &info) == 0);
    CHECK((info.st_mode & 0777U) == 0640U);
}

TEST_CASE("files: what can not be written is known beforehand") {
    Folder folder;
    CHECK(Outputs::check(folder / "new.png").has_value());
    CHECK(Outputs::check("-").has_value());
    CHECK(Outputs::check("/dev/null").has_value());
    CHECK(Outputs::check(folder.path.string()).error().code == kFileTrouble);
    CHECK(Outputs::check(folder / "none/new.png").error().code == kFileTrouble);
}

TEST_CASE("files: reading what is missing, a folder, or too long") {
    Folder folder;
    const Console console(0, 1, 2);
    CHECK(read_text(folder / "none.raymo", console).error().code == kFileTrouble);
    CHECK(read_text(folder.path.string(), console).error().code == kFileTrouble);
    std::ofstream(folder / "long.raymo") << "x";
    REQUIRE(truncate((folder / "long.raymo").c_str(), static_cast<off_t>(sml::kMaxTextBytes) + 1) ==
            0);
    CHECK(read_text(folder / "long.raymo", console).error().code == kModelWrong);
    CHECK(read_text("/dev/zero", console).error().code == kModelWrong);  // without an end
    // What a model names must be a file: nobody writes into this pipe, ever.
    REQUIRE(mkfifo((folder / "pipe.svg").c_str(), 0600) == 0);
    CHECK(read_regular(folder / "pipe.svg").error().message ==
          "can not read \"" + (folder / "pipe.svg") + "\": it is no file, but a pipe");
    CHECK(read_regular("/dev/zero").error().code == kFileTrouble);
    CHECK(read_regular(folder.path.string()).error().code == kFileTrouble);
}

TEST_CASE("files: names and suffixes") {
    CHECK(with_suffix("models/cup.raymo", ".png") == "cup.png");
    CHECK(with_suffix("cup", ".png") == "cup.png");
    CHECK(with_suffix(".cup", ".png") == ".cup.png");
    CHECK(suffix_of("a.b/cup.PNG") == ".png");
    CHECK(suffix_of("a.b/cup").empty());
}

TEST_CASE("console: lines come one by one, whatever their ends") {
    std::array<int, 2> ends{};
    REQUIRE(pipe(ends.data()) == 0);
    const std::string_view text = "one\r\n\ntwo";
    REQUIRE(write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size()));
    close(ends[1]);
    Console console(ends[0], 1, 2);
    CHECK(*console.read_line() == "one");
    CHECK(*console.read_line() == "");
    CHECK(*console.read_line() == "two");
    CHECK_FALSE(console.read_line()->has_value());
    close(ends[0]);
}

TEST_CASE("executor: every index once, no worker twice at a time") {
    for (const int threads : {1, 2, 5}) {
        const auto executor = make_executor(threads);
        CHECK(executor->workers() == static_cast<std::size_t>(threads));
        std::vector<std::atomic<int>> seen(1000);
        std::vector<std::atomic<int>> busy(executor->workers());
        std::atomic<int> clashes{0};
        executor->for_each(seen.size(), [&](std::size_t index, std::size_t worker) {
            if (busy[worker]++ != 0) ++clashes;
            ++seen[index];
            --busy[worker];
        });
        CHECK(clashes == 0);
        for (const auto& n : seen) REQUIRE(n == 1);
    }
}

TEST_CASE("watch: a deadline cancels; the bar fits its columns") {
    Console console(0, 1, 2);
    const Watch late(console, "x", Watch::Clock::now());
    CHECK(late.cancelled());
    CHECK(late.late());
    const Watch free(console, "x");
    CHECK_FALSE(free.cancelled());
    for (int columns = 1; columns < 200; ++columns) {
        CHECK(progress_line("tracing", 0.5, 65, columns).size() <
              static_cast<std::size_t>(std::max(columns, 2)));
    }
    CHECK(progress_line("tracing", 0.5, 65, 80).find("50 %  1:05 left") != std::string::npos);
    CHECK(progress_line("tracing", 0.0, HUGE_VAL, 80).find("--:-- left") != std::string::npos);
}

TEST_CASE("params: JSON values become expressions") {
    const auto params = params_from_json(
        R"({"h": 90, "label": "a\"$\n", "on": true, "none": null, "p": [1, 2.5, {"x": -1e-3}]})",
        "p.json");
    REQUIRE(params.has_value());
    CHECK(params->at("h") == "90");
    CHECK(params->at("label") == "\"a\\\"\\u{24}\\n\"");
    CHECK(params->at("on") == "true");
    CHECK(params->at("none") == "nothing");
    CHECK(params->at("p") == "[1, 2.5, {x: -0.001}]");
}

TEST_CASE("params: what is no object of values is refused with its place") {
    CHECK(params_from_json("{\n  \"a\": }", "p.json").error().message.starts_with("p.json:2:"));
    CHECK_FALSE(params_from_json("", "p.json").has_value());
    CHECK_FALSE(params_from_json("[1]", "p.json").has_value());
    CHECK_FALSE(params_from_json("{\"a\": {\"b c\": 1}}", "p.json").has_value());
    CHECK_FALSE(params_from_json("{\"a\": 1e999}", "p.json").has_value());
    CHECK_FALSE(params_from_json(std::string(1'000'000, '['), "p.json").has_value());
}

}  // namespace
}  // namespace raymo::app
