// Prints docs/manual/solids.md from the schemas of the inventory.
#include <array>
#include <charconv>
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

std::string_view kind_words(ParamKind kind) {
    switch (kind) {
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
    }
    return {};
}

std::string range_words(const Param& param) {
    if (param.kind == ParamKind::flag || std::isinf(param.min)) return "";
    return (param.min_included ? "at least " : "greater than ") + shown(param.min);
}

std::string fallback_words(const Param& param) {
    if (!param.fallback) return "required";
    if (const bool* flag = std::get_if<bool>(&*param.fallback)) return *flag ? "`true`" : "`false`";
    if (const double* number = std::get_if<double>(&*param.fallback))
        return "`" + shown(*number) + "`";
    if (const Vec3* v = std::get_if<Vec3>(&*param.fallback)) {
        return "`(" + shown((*v)[0]) + ", " + shown((*v)[1]) + ", " + shown((*v)[2]) + ")`";
    }
    return "a matrix";
}

std::string signature(const solids::Schema& schema) {
    std::string out(schema.name);
    std::string_view separator = "(";
    for (const Param& param : schema.params) {
        out += separator;
        out += param.name;
        if (param.fallback) {
            const std::string value = fallback_words(param);
            out += ": " + value.substr(1, value.size() - 2);
        }
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
        if (!param.diameter.empty()) std::cout << "; `" << param.diameter << "` gives twice this";
        std::cout << " | " << kind_words(param.kind) << " | " << range_words(param) << " | "
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
