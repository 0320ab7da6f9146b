// Text set in a font, as a contour: one outline a letter, shared by all equal ones.
#pragma once

#include <functional>
#include <string_view>

#include "raymo/curves/contour.hpp"
#include "raymo/drawings/font.hpp"

namespace raymo::drawings {

enum class Align : std::uint8_t { left, centre, right };

struct TextStyle {
    double size = 10.0;  ///< height of capitals [mm], 1e-60 to 1e60
    double spacing =
        1.0;  ///< of the distances between letters, times what the font says; from 0 to 1e6
    double line_spacing = 1.0;  ///< of the distances between lines, the same
    Align align =
        Align::left;  ///< what of each line lies at x = 0: its beginning, its middle or its end
};

struct SetText {
    curves::Contour contour;    ///< null when nothing shows
    double bytes = 0.0;         ///< that were made for it
    double width = 0.0;         ///< of the longest line: how far its pen goes, spaces counted [mm]
    bool is_backwards = false;  ///< has letters of a script that runs from right to left
};

/// Sets lines, parted by U+000A, the first on the base line y = 0. U+0009 is as wide as four spaces; U+000D, the soft
/// hyphen U+00AD and characters that are there to join or part others (U+200B and the like) are left out.
/// Letters are placed one by one, left to right, by their widths and the font's kerning: no ligatures, no joined scripts.
/// `go_on` is asked every thousand characters; when it says no, the result is an error `cancelled`.
/// Errors: out_of_range for the style (`argument` 1: size, 2: spacing, 3: line spacing); bad_argument for a character that
/// the font does not have (`argument` 0) and for a damaged font (`argument` 4). Cost: 0.2 us a letter, and 5 us for each
/// different one.
[[nodiscard]] Result<SetText> typeset(Font& font, std::u32string_view text, const TextStyle& style,
                                      const std::function<bool()>& go_on);

}  // namespace raymo::drawings
