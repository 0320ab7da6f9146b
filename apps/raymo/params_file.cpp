// The only file that knows nlohmann's JSON, which costs seconds to compile.
#include "apps/raymo/params_file.hpp"

#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>

#include "apps/raymo/text.hpp"

namespace raymo::app {
namespace {

using Json = nlohmann::json;

constexpr int kDeepest = 64;

std::string sml_string(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            out += '\\';
            out += c;
        } else if (c == '\n') {
            out += "\\n";
        } else if (c == '\t') {
            out += "\\t";
        } else if (c == '$' || static_cast<unsigned char>(c) < 0x20) {
            constexpr std::string_view kHex = "0123456789abcdef";
            out += std::string("\\u{") + kHex[static_cast<unsigned char>(c) >> 4] +
                   kHex[static_cast<unsigned char>(c) & 15] + "}";
        } else {
            out += c;
        }
    }
    return out + "\"";
}

bool is_name(const std::string& text) {
    if (text.empty() || std::isdigit(static_cast<unsigned char>(text[0]))) return false;
    return std::all_of(text.begin(), text.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_' ||
               static_cast<unsigned char>(c) >= 0x80;
    });
}

/// Nested at most kDeepest deep, which parsing made sure of.
Attempt<std::string> expression(const Json& value, const std::string& name) {
    if (value.is_null()) return "nothing";
    if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
    if (value.is_number()) return number(value.get<double>());
    if (value.is_string()) return sml_string(value.get<std::string>());
    std::string out = value.is_array() ? "[" : "{";
    for (const auto& [key, item] : value.items()) {
        Attempt<std::string> text = expression(item, name);
        if (!text) return text;
        if (out.size() > 1) out += ", ";
        if (value.is_object()) {
            if (!is_name(key)) {
                return trouble(kCommandWrong,
                               name + ": " + in_quotes(key) + " can not be the name of a field");
            }
            out += key + ": ";
        }
        out += *text;
    }
    return out + (value.is_array() ? "]" : "}");
}

/// The parser of nlohmann is recursive only in what it builds, not in what it reads; the depth is checked first.
bool too_deep(const std::string& text) {
    int depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\') ++i;
            if (c == '"') in_string = false;
        } else if (c == '"') {
            in_string = true;
        } else if (c == '[' || c == '{') {
            if (++depth > kDeepest) return true;
        } else if (c == ']' || c == '}') {
            --depth;
        }
    }
    return false;
}

}  // namespace

Attempt<std::map<std::string, std::string>> params_from_json(const std::string& text,
                                                             const std::string& name) {
    if (too_deep(text)) return trouble(kCommandWrong, name + ": nested more than 64 deep");
    Json json;
    try {
        json = Json::parse(text);
    } catch (const Json::parse_error& e) {
        const std::size_t at = std::min<std::size_t>(e.byte == 0 ? 0 : e.byte - 1, text.size());
        const auto line =
            1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
        const std::size_t start = text.rfind('\n', at == 0 ? 0 : at - 1);
        const std::size_t column =
            at - (start == std::string::npos || start >= at ? 0 : start + 1) + 1;
        return trouble(kCommandWrong, name + ":" + std::to_string(line) + ":" +
                                          std::to_string(column) + ": this is not JSON");
    } catch (const Json::exception& e) {
        return trouble(kCommandWrong, name + ": " + e.what());
    }
    if (!json.is_object()) {
        return trouble(kCommandWrong, name + ": an object of names and values is needed",
                       "as {\"height\": 90, \"label\": \"A\"}");
    }
    std::map<std::string, std::string> out;
    for (const auto& [key, value] : json.items()) {
        Attempt<std::string> e = expression(value, name);
        if (!e) return tl::unexpected<Trouble>(e.error());
        out[key] = *std::move(e);
    }
    return out;
}

}  // namespace raymo::app
