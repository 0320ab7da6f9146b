// Numbers, JSON and names as text.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "raymo/math/vec.hpp"

namespace raymo::app {

/// The shortest text that reads back as the same double: "0.1", "1e-07", "inf".
[[nodiscard]] std::string number(double value);
/// The same, as JSON has it: null for what is not finite.
[[nodiscard]] std::string json_number(double value);
/// "[1,2,3]".
[[nodiscard]] std::string json_vector(Vec3 v);
/// In quotes, with escapes; bytes that are not UTF-8 become U+FFFD.
[[nodiscard]] std::string json_string(std::string_view text);

/// A finite number that fills all of `text` ("1", "-2.5e3", "+1"), or nothing.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);
/// A whole number >= 0 that fills all of `text`, or nothing.
[[nodiscard]] std::optional<std::uint64_t> parse_whole(std::string_view text);
/// "1,2,3", or nothing.
[[nodiscard]] std::optional<Vec3> parse_vector(std::string_view text);

/// "did you mean `render`?", or empty when no known name is near (by edits: a third of the
/// letters).
[[nodiscard]] std::string did_you_mean(std::string_view written,
                                       std::span<const std::string> known);

/// The text in quotes for a message: at most 60 characters, control characters as escapes.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// 1234567 as "1.2 MB".
[[nodiscard]] std::string file_size(double bytes);

}  // namespace raymo::app
