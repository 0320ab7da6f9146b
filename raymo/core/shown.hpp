// Numbers in messages.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <string>

namespace raymo {

/// The shortest text that reads back as the same number; without an exponent from 1e-6 up to 1e21.
[[nodiscard]] inline std::string shown(double value) {
    if (std::isnan(value)) return "nan";
    if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
    std::array<char, 64> text{};
    const double size = std::fabs(value);
    const bool is_plain = size == 0.0 || (size >= 1e-6 && size < 1e21);
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value,
                                   is_plain ? std::chars_format::fixed : std::chars_format::general)
                         .ptr;
    return {text.data(), end};
}

}  // namespace raymo
