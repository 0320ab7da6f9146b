// Prints docs/manual/solids.md from the schemas of the inventory.
#include <array>
#include <charconv>
#include <cmath>
#include <iostream>
#include <string>

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

void print(const solids::Entry& entry) {
    const solids::Schema& schema = *entry.schema;
    std::cout << "\n## " << schema.name << "\n\n"
              << schema.doc << "\n\n`" << signature(schema) << "`\n\n"
              << "| argument | meaning | kind | must be | default |\n|---|---|---|---|---|\n";
    for (const Param& param : schema.params) {
        std::cout << "| `" << param.name << "` | " << param.doc;
        if (!param.diameter.empty()) std::cout << "; or `" << param.diameter << "`, twice that";
        std::cout << " | " << kind_words(param) << " | " << range_words(param) << " | "
                  << fallback_words(param) << " |\n";
    }
    std::cout << "\nFaces: " << faces(entry) << ".\n\n```raymo\n" << schema.example << "\n```\n";
}

}  // namespace

int main() {
    std::cout << "# Solids\n\n"
                 "The primitives of the language, as their schemas declare them; `make docs` "
                 "prints this page.\n"
                 "Arguments are given by position or by name: `sphere(10)`, `sphere(r: 10)`. A "
                 "value outside its range "
                 "is an error\nthat shows the value. Every solid is a closed set of points, and "
                 "the names of its faces "
                 "appear in the answers of\n`raymo rays`.\n";
    for (const solids::Entry& entry : solids::inventory()) print(entry);
}
