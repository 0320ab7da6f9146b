// What a primitive takes, as data: the language's builtin, its checks, the manual page and the sliders follow from it.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <variant>

#include "raymo/core/result.hpp"
#include "raymo/curves/outline.hpp"
#include "raymo/curves/path.hpp"
#include "raymo/math/vec.hpp"
#include "raymo/meshes/mesh.hpp"
#include "raymo/meshes/sew.hpp"

namespace raymo::solids {

enum class ParamKind : unsigned char {
    length,  ///< number [mm]
    number,  ///< number without unit
    angle,   ///< number [degrees]
    flag,    ///< boolean
    vector,  ///< three numbers
    size,  ///< three lengths, given as one vector, as three numbers in a row, or as one number for all three
    matrix,   ///< 4x4 list of numbers by rows
    contour,  ///< closed curves of the plane
    profile,  ///< curves of the half-plane beside an axis, of which one may be open
    path,     ///< spheres along a curve in space
    mesh,     ///< faces between points
    nets,     ///< nets of 4x4 control points
    choice,   ///< one of `choices`
};

using Matrix4 = std::array<double, 16>;
/// A choice is the number of the word among the choices.
using Argument = std::variant<double, bool, Vec3, Matrix4, curves::OutlinePtr, curves::PathPtr,
                              meshes::MeshPtr, meshes::NetsPtr, std::size_t>;

struct Param {
    std::string_view name;   ///< as written in the language
    std::string_view words;  ///< as spoken of in errors: "radius"
    ParamKind kind = ParamKind::length;
    std::string_view doc;
    /// Numbers (and each component of vectors and sizes) must be > min, or >= min where min_included.
    double min = -std::numeric_limits<double>::infinity();
    bool min_included = false;
    /// Used when the argument is left out; required when this is empty.
    std::optional<Argument> fallback = std::nullopt;
    /// Another name under which twice the value may be given ("d" beside the radius "r"); empty: none.
    std::string_view diameter = {};
    /// The words that may be given for a choice.
    std::span<const std::string_view> choices = {};
};

struct Schema {
    std::string_view name;
    std::string_view doc;
    std::span<const Param> params;
    std::string_view example;  ///< a program that the manual shows and the tests draw
    /// Where its contour is moved by some (x, y), the solid is moved by (x, y, 0), and else the same.
    bool moves_with_contour = false;
};

/// Checks that `arguments` (one for each param, in order, of the alternative its kind asks for) are finite and in range.
/// Error: out_of_range with `argument` set and a label that shows the value.
[[nodiscard]] Result<void> check(const Schema& schema, std::span<const Argument> arguments);

}  // namespace raymo::solids
