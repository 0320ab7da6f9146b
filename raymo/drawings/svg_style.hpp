// Which shapes of a drawing are filled, and by which rule: as attributes, in `style`, or by a style sheet [SVG11 6].
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "raymo/drawings/svg_path.hpp"

namespace raymo::drawings {

/// What is said of one element; what is not said comes from the element around it, except `display`.
struct Style {
    std::optional<bool> is_filled;    ///< fill
    std::optional<bool> is_even_odd;  ///< fill-rule
    std::optional<bool> is_visible;   ///< visibility
    std::optional<bool> is_shown;     ///< display
    /// What CSS can say of where a shape lies and how large it is is said: transform, width, r and the like. It is not followed.
    bool is_placed = false;

    /// Takes an attribute; one that is not of these four is nothing. Values are in letters of either case.
    void set(std::string_view name, std::string_view value);
    /// Takes "fill: none; stroke: red", in letters of either case, with comments.
    void set_all(std::string_view declarations);
    /// Whether anything is said.
    [[nodiscard]] bool is_empty() const {
        return !is_filled && !is_even_odd && !is_visible && !is_shown && !is_placed;
    }
    /// What `other` says goes before what is said here, unless that is important and the other is not.
    void override_by(const Style& other);

private:
    void say(std::string_view name, std::string_view value, bool is_important);

    std::array<bool, 4> is_important_{};  ///< by the order of the properties
};

/// Rules with selectors of one element: `path`, `.logo`, `#front`, `path.logo.red`, `*`, and lists of them. Others, those with
/// blanks, brackets or colons in them, and rules of @media and the like, are left out.
class StyleSheet {
public:
    /// False when `go_on`, which is told the bytes that the rules take, says no.
    [[nodiscard]] bool add(std::string_view text, const GoOn& go_on);
    [[nodiscard]] std::size_t size() const { return rules_.size(); }
    [[nodiscard]] double bytes() const { return bytes_; }
    /// Selectors that are left out though what they say would matter.
    [[nodiscard]] std::size_t left_out() const { return left_out_; }
    /// What it says of an element; `classes` are parted by blanks.
    [[nodiscard]] Style of(std::string_view tag, std::string_view id,
                           std::string_view classes) const;

private:
    struct Rule {
        std::string tag, id;
        std::vector<std::string> classes;
        int rank = 0;  ///< of the selector: the higher goes before
        Style style;
    };
    [[nodiscard]] bool add_rules(std::string_view selectors, const Style& style, const GoOn& go_on);

    std::vector<Rule> rules_;
    std::size_t left_out_ = 0;
    double bytes_ = 0.0;
    std::uint32_t steps_ = 0;
};

}  // namespace raymo::drawings
