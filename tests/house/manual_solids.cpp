// The manual's pages on solids: what the schemas of the inventory declare stands in them between two markers.
//
//   manual_solids write FOLDER    prints that part of solids.md and solids/NAME.md anew, in FOLDER; makes pages that are missing
//   manual_solids check FOLDER    exit code 1 where a page says something else, is missing, or is about no primitive
//
// What stands before and behind the markers is written by hand and left alone.
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "raymo/solids/inventory.hpp"

namespace {

using namespace raymo;
using solids::Param;
using solids::ParamKind;

std::string shown(double value) {
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

/// The words of a choice as the language writes them.
std::string choice_words(const Param& param) {
    std::string out;
    for (const std::string_view word : param.choices) {
        if (!out.empty()) out += word == param.choices.back() ? " or " : ", ";
        out += "`\"" + std::string(word) + "\"`";
    }
    return out;
}

std::string kind_words(const Param& param) {
    switch (param.kind) {
        case ParamKind::length:
            return "length [mm]";
        case ParamKind::number:
            return "number";
        case ParamKind::angle:
            return "angle [degrees]";
        case ParamKind::flag:
            return "`true` or `false`";
        case ParamKind::vector:
            return "vector of three numbers";
        case ParamKind::size:
            return "three lengths [mm]: one vector, three numbers in a row, or one number for all "
                   "three";
        case ParamKind::matrix:
            return "4x4 list of numbers, by rows";
        case ParamKind::contour:
            return "contour";
        case ParamKind::profile:
            return "contour, or an open curve that is closed along the axis";
        case ParamKind::path:
            return "path";
        case ParamKind::mesh:
            return "mesh";
        case ParamKind::nets:
            return "list of nets, each of four rows of four points";
        case ParamKind::choice:
            return choice_words(param);
    }
    return {};
}

std::string range_words(const Param& param) {
    if (param.kind == ParamKind::flag || std::isinf(param.min)) return "";
    return (param.min_included ? "at least " : "greater than ") + shown(param.min);
}

/// The value that a parameter has when it is left out, as the language writes it.
std::string fallback(const Param& param) {
    const solids::Argument& value = *param.fallback;
    if (const std::size_t* choice = std::get_if<std::size_t>(&value))
        return "\"" + std::string(param.choices[*choice]) + "\"";
    if (const bool* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
    if (const double* number = std::get_if<double>(&value)) return shown(*number);
    std::string out = "(";
    if (const Vec3* v = std::get_if<Vec3>(&value)) {
        for (int axis = 0; axis < 3; ++axis) out += (axis > 0 ? ", " : "") + shown((*v)[axis]);
    } else if (const auto* m = std::get_if<solids::Matrix4>(&value)) {
        for (std::size_t i = 0; i < m->size(); ++i) out += (i > 0 ? ", " : "") + shown((*m)[i]);
    }
    return out + ")";
}

std::string fallback_words(const Param& param) {
    std::string out = "required";
    if (param.fallback) {
        out = "`";
        out += fallback(param);
        out += "`";
    }
    return out;
}

std::string signature(const solids::Schema& schema) {
    std::string out(schema.name);
    std::string_view separator = "(";
    for (const Param& param : schema.params) {
        out += separator;
        out += param.name;
        if (param.fallback) out += ": " + fallback(param);
        separator = ", ";
    }
    return out + ")";
}

std::string faces(const solids::Entry& entry) {
    const auto solid = entry.make(entry.examples().front());
    if (!solid) return {};
    std::string out;
    std::visit(
        [&](const auto& kernel) {
            for (const std::string_view face : kernel.faces()) {
                out += (out.empty() ? "`" : ", `") + std::string(face) + "`";
            }
        },
        solid->kernel);
    return out;
}

constexpr std::string_view kBegin = "<!-- From the schemas, by `make docs`: -->\n";
constexpr std::string_view kEnd = "<!-- Below this line everything is written by hand. -->\n";

struct Page {
    std::filesystem::path file;
    std::string part;  ///< what stands between the markers
};

Page page_of(const std::filesystem::path& folder, const solids::Entry& entry) {
    const solids::Schema& schema = *entry.schema;
    const std::string name(schema.name);
    std::ostringstream out;
    out << "# " << name << "\n\n"
        << schema.doc << "\n\n![" << name << "](../pictures/" << name << ".png)\n\n"
        << "```raymo\n"
        << schema.example << "\n```\n\n## Arguments\n\n`" << signature(schema) << "`\n\n"
        << "| argument | meaning | kind | must be | default |\n|---|---|---|---|---|\n";
    for (const Param& param : schema.params) {
        out << "| `" << param.name << "` | " << param.doc;
        if (!param.diameter.empty()) out << "; or `" << param.diameter << "`, twice that";
        out << " | " << kind_words(param) << " | " << range_words(param) << " | "
            << fallback_words(param) << " |\n";
    }
    out << "\nFaces: " << faces(entry) << ".\n\n";
    return {folder / "solids" / (name + ".md"), out.str()};
}

Page index(const std::filesystem::path& folder) {
    std::ostringstream out;
    out << "# Solids\n\n| | |\n|---|---|\n";
    for (const solids::Entry& entry : solids::inventory()) {
        const std::string name(entry.schema->name);
        out << "| [![" << name << "](pictures/" << name << ".png)](solids/" << name << ".md) | **["
            << name << "](solids/" << name << ".md)** " << entry.schema->doc << " `"
            << signature(*entry.schema) << "` |\n";
    }
    out << '\n';
    return {folder / "solids.md", out.str()};
}

std::optional<std::string> read(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) return std::nullopt;
    return std::string(std::istreambuf_iterator<char>(in), {});
}

/// The text with `part` between its markers; none where it has no markers.
std::optional<std::string> joined(const std::string& text, const std::string& part) {
    const std::size_t begin = text.find(kBegin);
    const std::size_t end = text.find(kEnd);
    if (begin == std::string::npos || end == std::string::npos || end < begin) return std::nullopt;
    return text.substr(0, begin + kBegin.size()) + part + text.substr(end);
}

/// Brings a page up to date, or only tells whether it is.
bool settle(const Page& page, bool may_write) {
    const auto complain = [&](const char* what) {
        std::cerr << page.file.string() << ": " << what << '\n';
        return false;
    };
    const std::optional<std::string> text = read(page.file);
    if (!text && !may_write) return complain("is missing: run `make docs`");
    const std::optional<std::string> wanted =
        joined(text.value_or(std::string(kBegin) + std::string(kEnd)), page.part);
    if (!wanted) return complain("has lost the markers of what follows from the schemas");
    if (text == wanted) return true;
    if (!may_write) return complain("does not follow the schemas any more: run `make docs`");
    std::filesystem::create_directories(page.file.parent_path());
    std::ofstream out(page.file, std::ios::binary);
    out << *wanted;
    out.close();
    return out ? true : complain("can not be written");
}

}  // namespace

int main(int count, char** words) {
    const std::string_view task = count == 3 ? words[1] : "";
    if (task != "write" && task != "check") {
        std::cerr << "usage: manual_solids write|check FOLDER\n";
        return 2;
    }
    const std::filesystem::path folder = words[2];
    std::vector<Page> pages{index(folder)};
    for (const solids::Entry& entry : solids::inventory()) pages.push_back(page_of(folder, entry));
    bool good = true;
    for (const Page& page : pages) good = settle(page, task == "write") && good;
    std::error_code none;
    for (const auto& found : std::filesystem::directory_iterator(folder / "solids", none)) {
        bool known = false;
        for (const Page& page : pages) known = known || page.file == found.path();
        if (known) continue;
        std::cerr << found.path().string() << ": there is no such primitive\n";
        good = false;
    }
    return good ? 0 : 1;
}
