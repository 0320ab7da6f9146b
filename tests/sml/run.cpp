// Runs the language's test programs: each says in comments what it expects.
//
//     print(1 + 1)          // expect: 2
//     sphere(-1)            // expect error: sphere: radius must be greater than 0 // at: 8 // label: this is -1
//     x                     // expect warning: a number stands alone: it does nothing
//
// An error or warning stands on the line of its comment (`expect error 3:` on line 3); `at` is its column, `label`, `hint` and `call` (a line:column
// of "called from", with the function's name) are checked where they are given. Printed lines are compared in order.
// In lines of their own: `// expect parts: a, b`, `// expect materials: 2`, `// given: name=expression`,
// `// limit: solids=10` (also depth, seconds, bytes). A program may import files from below its own folder.
//
//     raymo_sml_programs FOLDER       runs all programs below a folder
//     raymo_sml_programs --show FILE  prints what a program says
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include "raymo/csg/model.hpp"
#include "raymo/sml/sml.hpp"

namespace {

namespace fs = std::filesystem;
using namespace raymo;

std::string read(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

struct Expected {
    std::size_t line = 0;
    sml::Severity severity = sml::Severity::error;
    std::string message;
    std::map<std::string, std::vector<std::string>> more;  // at, label, hint, call
};

struct Program {
    std::string text;
    std::vector<std::string> printed;
    std::vector<Expected> diagnostics;
    std::string parts, materials;
    bool has_parts = false;
    std::map<std::string, std::string> given, limits;
};

std::string trimmed(std::string text) {
    while (!text.empty() && (text.back() == ' ' || text.back() == '\r')) text.pop_back();
    text.erase(0, std::min(text.find_first_not_of(' '), text.size()));
    return text;
}

void read_comment(Program& program, std::size_t line, const std::string& comment) {
    // Directives are parted by " // ".
    std::vector<std::string> pieces;
    std::size_t from = 0;
    while (true) {
        const std::size_t next = comment.find(" // ", from);
        pieces.push_back(trimmed(comment.substr(from, next - from)));
        if (next == std::string::npos) break;
        from = next + 4;
    }
    bool in_diagnostic = false;
    for (const std::string& piece : pieces) {
        const std::size_t colon = piece.find(':');
        if (colon == std::string::npos) continue;
        const std::string key = piece.substr(0, colon);
        const std::string value = trimmed(piece.substr(colon + 1));
        const std::size_t equals = value.find('=');
        if (key == "expect") {
            program.printed.push_back(value);
        } else if (key.starts_with("expect error") || key.starts_with("expect warning")) {
            const bool is_error = key.starts_with("expect error");
            const std::string other_line = trimmed(key.substr(is_error ? 12 : 14));
            program.diagnostics.push_back({other_line.empty() ? line : std::stoul(other_line),
                                           is_error ? sml::Severity::error : sml::Severity::warning,
                                           value,
                                           {}});
            in_diagnostic = true;
        } else if (key == "expect parts") {
            program.parts = value;
            program.has_parts = true;
        } else if (key == "expect materials") {
            program.materials = value;
        } else if (key == "given" && equals != std::string::npos) {
            program.given[value.substr(0, equals)] = value.substr(equals + 1);
        } else if (key == "limit" && equals != std::string::npos) {
            program.limits[value.substr(0, equals)] = value.substr(equals + 1);
        } else if (in_diagnostic &&
                   (key == "at" || key == "label" || key == "hint" || key == "call")) {
            program.diagnostics.back().more[key].push_back(value);
        }
    }
}

Program parse(std::string text) {
    Program program;
    std::istringstream lines(text);
    std::string line;
    for (std::size_t number = 1; std::getline(lines, line); ++number) {
        for (const char* mark : {"// expect", "// given:", "// limit:"}) {
            const std::size_t at = line.find(mark);
            if (at == std::string::npos) continue;
            read_comment(program, number, line.substr(at + 3));
            break;
        }
    }
    program.text = std::move(text);
    return program;
}

struct Place {
    std::size_t line = 0;
    std::size_t column = 0;
};

Place place_of(const sml::SourceMap& sources, SourceSpan where) {
    if (!where.known()) return {};
    const std::string& text = sources[where.file].text;
    Place place{1, 1};
    for (std::size_t i = 0; i < where.begin && i < text.size(); ++i) {
        if (text[i] == '\n') {
            ++place.line;
            place.column = 1;
        } else if ((static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) {
            ++place.column;
        }
    }
    return place;
}

struct Run {
    sml::Outcome outcome;
    std::vector<std::string> printed;
};

// Spheres only are asked about, so a bounding box says where a point is: enough to test the plumbing of `contains`.
Run run(const fs::path& path, const Program& program) {
    Run result;
    sml::Host host;
    host.params = program.given;
    host.print = [&](std::string_view line) { result.printed.emplace_back(line); };
    host.seconds = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
    host.load = [&](const std::string& from, const std::string& name,
                    std::string& resolved) -> Result<std::string> {
        const fs::path found = fs::path(from).parent_path() / name;
        if (!fs::is_regular_file(found)) {
            return fail(ErrorCode::io, "the file `" + name + "` is not there");
        }
        resolved = found.lexically_normal().string();
        return read(found);
    };
    // The fonts that every machine has which can build this.
    host.font = [](const std::string& name) -> Result<sml::FontFile> {
        const std::map<std::string, std::string> files{{"DejaVu Sans", "DejaVuSans.ttf"},
                                                       {"DejaVu Sans:bold", "DejaVuSans-Bold.ttf"}};
        const auto found = files.find(name);
        if (found == files.end()) return fail(ErrorCode::io, "there is no font \"" + name + "\"");
        return sml::FontFile{read("/usr/share/fonts/truetype/dejavu/" + found->second), 0};
    };
    host.answers.contains = [](const csg::Solid& s, Vec3 p) -> Result<bool> {
        return csg::bounds(s).contains(p);
    };
    host.answers.is_empty = [](const csg::Solid& s) -> Result<bool> {
        return csg::bounds(s).empty();
    };
    host.answers.hits = [](const csg::Solid& s,
                           const Ray& ray) -> Result<std::vector<sml::HitInterval>> {
        // Along x through the middle of a box.
        const Aabb box = csg::bounds(s);
        const double enter = box.lo.x - ray.origin.x;
        const double exit = box.hi.x - ray.origin.x;
        return std::vector<sml::HitInterval>{
            {enter, exit, ray.at(enter), ray.at(exit), {-1, 0, 0}, {1, 0, 0}}};
    };
    for (const auto& [name, value] : program.limits) {
        const double number = std::stod(value);
        if (name == "solids") host.limits.solids = number;
        if (name == "depth") host.limits.call_depth = static_cast<int>(number);
        if (name == "seconds") host.limits.seconds = number;
        if (name == "bytes") host.limits.bytes = number;
    }
    result.outcome = sml::evaluate(path.string(), program.text, host);
    return result;
}

// What is wrong, a line each; empty: as expected.
std::vector<std::string> differences(const fs::path& path) {
    const Program program = parse(read(path));
    const Run result = run(path, program);
    std::vector<std::string> out;
    const std::size_t lines = std::max(program.printed.size(), result.printed.size());
    for (std::size_t i = 0; i < lines; ++i) {
        const std::string want =
            i < program.printed.size() ? program.printed[i] : "(no more lines)";
        const std::string got = i < result.printed.size() ? result.printed[i] : "(no more lines)";
        if (want != got) out.push_back("printed: expected \"" + want + "\", got \"" + got + "\"");
    }
    const auto& diagnostics = result.outcome.diagnostics;
    const std::size_t count = std::max(program.diagnostics.size(), diagnostics.size());
    bool expects_error = false;
    for (std::size_t i = 0; i < count; ++i) {
        if (i >= diagnostics.size()) {
            out.push_back("missing: " + program.diagnostics[i].message);
            expects_error |= program.diagnostics[i].severity == sml::Severity::error;
            continue;
        }
        const Error& error = diagnostics[i].error;
        const Place place = place_of(result.outcome.sources, error.where);
        if (i >= program.diagnostics.size()) {
            out.push_back("not expected: " + sml::format(diagnostics[i], result.outcome.sources));
            continue;
        }
        const Expected& want = program.diagnostics[i];
        expects_error |= want.severity == sml::Severity::error;
        const auto compare = [&](const std::string& what, const std::string& wanted,
                                 const std::string& got) {
            if (wanted != got)
                out.push_back(what + ": expected \"" + wanted + "\", got \"" + got + "\"");
        };
        // Files are called as seen from the program's folder, wherever that is.
        std::string message = error.message;
        const std::string folder = path.parent_path().string() + "/";
        if (const std::size_t at = message.find(folder); at != std::string::npos)
            message.erase(at, folder.size());
        compare("message", want.message, message);
        if (want.severity != diagnostics[i].severity)
            out.push_back("severity differs: " + want.message);
        // An error in another file (an import, a parameter from outside) has no line here.
        const bool in_main = error.where.known() && error.where.file == 0;
        if (in_main) compare("line", std::to_string(want.line), std::to_string(place.line));
        const auto each = [&](const char* key, const std::string& got) {
            const auto found = want.more.find(key);
            if (found != want.more.end()) compare(key, found->second.front(), got);
        };
        each("at", std::to_string(place.column));
        each("label", error.label);
        each("hint", error.hint);
        if (const auto calls = want.more.find("call"); calls != want.more.end()) {
            for (std::size_t k = 0; k < calls->second.size(); ++k) {
                std::string got = "(none)";
                if (k < diagnostics[i].calls.size()) {
                    const auto& call = diagnostics[i].calls[k];
                    const Place at = place_of(result.outcome.sources, call.where);
                    got = std::to_string(at.line) + ":" + std::to_string(at.column) + " " +
                          call.function;
                }
                compare("call", calls->second[k], got);
            }
        }
    }
    if (result.outcome.ok == expects_error) out.push_back("ok is wrong");
    if (program.has_parts) {
        std::string parts;
        for (const auto& part : result.outcome.scene.parts)
            parts += (parts.empty() ? "" : ", ") + part.name;
        if (parts != program.parts)
            out.push_back("parts: expected " + program.parts + ", got " + parts);
    }
    if (!program.materials.empty() &&
        program.materials != std::to_string(result.outcome.scene.materials.size())) {
        out.push_back("materials: got " + std::to_string(result.outcome.scene.materials.size()));
    }
    return out;
}

void show(const fs::path& path) {
    const Run result = run(path, parse(read(path)));
    for (const std::string& line : result.printed) std::cout << line << '\n';
    for (const auto& d : result.outcome.diagnostics)
        std::cout << sml::format(d, result.outcome.sources);
    std::cout << (result.outcome.ok ? "ok" : "failed") << ", parts:";
    for (const auto& part : result.outcome.scene.parts) {
        if (result.outcome.scene.parts.size() <= 20) std::cout << ' ' << part.name;
    }
    std::cout << '\n';
}

}  // namespace

int main(int argc, char** argv) {
    if (argc == 3 && std::string(argv[1]) == "--show") {
        show(argv[2]);
        return 0;
    }
    if (argc != 2) {
        std::cerr << "usage: raymo_sml_programs FOLDER | --show FILE\n";
        return 2;
    }
    std::vector<fs::path> programs;
    for (const auto& entry : fs::recursive_directory_iterator(argv[1])) {
        // Files below a folder `files` are there to be imported.
        const bool is_program = entry.path().extension() == ".raymo" &&
                                entry.path().parent_path().filename() != "files";
        if (is_program) programs.push_back(entry.path());
    }
    std::sort(programs.begin(), programs.end());
    std::size_t failed = 0;
    std::size_t errors = 0;
    for (const fs::path& path : programs) {
        errors += parse(read(path)).text.find("// expect error") != std::string::npos ? 1U : 0U;
        const auto wrong = differences(path);
        if (wrong.empty()) continue;
        ++failed;
        std::cout << path.string() << '\n';
        for (const std::string& line : wrong) std::cout << "    " << line << '\n';
    }
    std::cout << programs.size() << " programs (" << errors << " of errors), " << failed
              << " failed\n";
    return failed == 0 && !programs.empty() ? 0 : 1;
}
