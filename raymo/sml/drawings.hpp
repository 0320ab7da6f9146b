// The fonts and drawings that a program names: each is read once in a run.
#pragma once

#include <map>
#include <string>
#include <utility>

#include "raymo/drawings/font.hpp"
#include "raymo/drawings/svg.hpp"
#include "raymo/sml/sml.hpp"

namespace raymo::sml {

class Drawings {
public:
    explicit Drawings(const Host& host) : host_(host) {}

    /// The font that the file `from` calls `name`: a family, or a font file relative to that file.
    /// Error: as the host says, or of Font::open().
    [[nodiscard]] Result<drawings::FontPtr> font(const std::string& from, const std::string& name);
    /// The drawing in the file that the file `from` calls `path`. Error: as the host says, or of Drawing::read().
    [[nodiscard]] Result<drawings::DrawingPtr> drawing(const std::string& from,
                                                       const std::string& path,
                                                       const drawings::GoOn& go_on);

    /// What is in the file that the file `from` calls `path`. Error: as the host says.
    [[nodiscard]] Result<std::string> text(const std::string& from, const std::string& path) const;

private:
    /// Where a name is relative to, and the name.
    using Key = std::pair<std::string, std::string>;

    const Host& host_;
    std::map<Key, drawings::FontPtr> fonts_;
    std::map<std::string, drawings::FontPtr> font_files_;
    std::map<Key, drawings::DrawingPtr> drawings_;
    std::map<std::string, drawings::DrawingPtr> drawing_files_;
};

/// The font where none is named.
inline constexpr std::string_view kDefaultFont = "DejaVu Sans";

/// Whether a name of a font is that of a file: "fonts/Cup.ttf".
[[nodiscard]] bool is_font_file(std::string_view name);

}  // namespace raymo::sml
