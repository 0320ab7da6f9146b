// Fonts by their names, as fontconfig knows them.
#pragma once

#include <string>

#include "raymo/core/result.hpp"
#include "raymo/sml/sml.hpp"

namespace raymo::app {

/// The font that a name asks for, as fontconfig writes names: a family, and behind colons what tells it from others of its
/// family ("DejaVu Sans", "DejaVu Sans:bold", "DejaVu Serif:style=Book"). Nothing else stands in for it.
/// Error: io, when there is no such font; the hint names one that is there, or what to install.
[[nodiscard]] Result<sml::FontFile> find_font(const std::string& name);

}  // namespace raymo::app
