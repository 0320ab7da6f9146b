// The elements of an SVG file that matter to contours, in a flat table.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "raymo/core/result.hpp"
#include "raymo/drawings/svg_path.hpp"
#include "raymo/drawings/svg_style.hpp"
#include "raymo/drawings/svg_values.hpp"

namespace raymo::drawings {

enum class SvgTag : std::uint8_t {
    group,   ///< g, a
    choice,  ///< switch: shows the first of what is in it that may show
    svg,     ///< the drawing itself, or one within it
    symbol,  ///< shows only where it is used
    hidden,  ///< defs, clipPath, marker and the like: what is in it shows only where it is used
    use,
    path,  ///< also polygon and polyline
    rectangle,
    circle,
    ellipse,
    text,
    image,
};

inline constexpr std::uint32_t kNoElement = 0xffffffffU;

struct SvgElement {
    SvgTag tag = SvgTag::group;
    std::uint32_t parent = kNoElement;
    std::uint32_t first_child = kNoElement;
    std::uint32_t next_sibling = kNoElement;
    std::size_t at = 0;  ///< byte of the file at which it begins
    /// Shows only to readers of some language, or of something that SVG has not: never the choice of a `switch`.
    bool is_conditional = false;
    Style style;
    Affine2 transform;
    /// By the order of the names of its tag in svg_document.cpp: x y width height rx ry, cx cy r, cx cy rx ry.
    std::array<std::optional<Length>, 6> lengths;
    std::optional<ViewBox> view_box;
    Aspect aspect;
    std::string href;                                ///< of `use`: the id, without "#"
    std::shared_ptr<const curves::Outline> outline;  ///< of a path, where it is drawn
};

/// Where a byte of a text stands: both from 1; columns count characters.
struct TextPlace {
    std::size_t line = 1;
    std::size_t column = 1;
};
[[nodiscard]] TextPlace place_in(std::string_view text, std::size_t at);

struct SvgDocument {
    std::string name;                  ///< for messages
    std::string text;                  ///< the file
    std::vector<SvgElement> elements;  ///< [0] is the root; parents come before their children
    std::unordered_map<std::string, std::uint32_t> ids;
    std::size_t left_out_rules = 0;  ///< of its style sheets: see StyleSheet::left_out()

    /// "`name`, line 3, column 7: `what`".
    [[nodiscard]] Failure wrong(std::size_t at, std::string what, std::string hint = {},
                                ErrorCode code = ErrorCode::bad_argument) const;
};

/// Reads a file, which may be anything. Entities are expanded as far as they lie in the file, and a hundredfold at most.
/// Errors: bad_argument with place and value in the file, where it is no SVG or a value of an element is malformed; limit where
/// elements are nested more than 10,000 deep; cancelled when `go_on`, which is told the bytes so far, says no.
[[nodiscard]] Result<SvgDocument> read_svg(std::string name, std::string text, const GoOn& go_on);

}  // namespace raymo::drawings
