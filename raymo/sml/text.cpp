#include "raymo/sml/text.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace raymo::sml {

std::string number_text(double value) {
    if (value == 0.0) return "0";
    std::array<char, 64> text{};
    const double size = std::fabs(value);
    const auto format =
        size >= 1e-6 && size < 1e21 ? std::chars_format::fixed : std::chars_format::general;
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value, format).ptr;
    return {text.data(), end};
}

std::string quoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        switch (c) {
            case '"':
                out += "\\\"";
                break;
            case '\\':
                out += "\\\\";
                break;
            case '\n':
                out += "\\n";
                break;
            case '\t':
                out += "\\t";
                break;
            default:
                out.push_back(c);
        }
    }
    return out + '"';
}

}  // namespace raymo::sml
