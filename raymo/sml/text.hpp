// How numbers and strings are shown.
#pragma once

#include <string>
#include <string_view>

namespace raymo::sml {

/// The shortest decimal that reads back to the same double: 0.1, 1000000, 1e+20.
[[nodiscard]] std::string number_text(double value);
/// In quotes, with escapes.
[[nodiscard]] std::string quoted(std::string_view text);

}  // namespace raymo::sml
