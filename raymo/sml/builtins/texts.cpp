// Strings and output.

#include <fmt/core.h>

#include <array>
#include <charconv>
#include <cmath>

#include "raymo/sml/builtins/call.hpp"
#include "raymo/sml/text.hpp"

namespace raymo::sml {
namespace {

bool shown(Call& call, std::string& out) {
    for (std::size_t i = 0; i < call.rest().size(); ++i) {
        if (i > 0) out += ' ';
        if (!call.evaluator().show(call.rest()[i], call.node(), out)) return false;
    }
    return true;
}

bool print(Call& call, Value& out) {
    std::string line;
    if (!shown(call, line)) return false;
    if (call.evaluator().host().print) call.evaluator().host().print(line);
    out = Value::nothing();
    return true;
}

bool to_text(Call& call, Value& out) {
    std::string text;
    if (!call.evaluator().show(call[0], call.node(), text)) return false;
    out = Value::string(std::move(text));
    return true;
}

struct Field {
    std::size_t width = 0;
    int digits = -1;
};

// "", ":8", ":.3" or ":8.3" between braces.
bool parse_field(std::string_view text, Field& out) {
    if (text.empty()) return true;
    if (text.front() != ':') return false;
    const char* at = text.data() + 1;
    const char* const end = text.data() + text.size();
    if (at != end && *at != '.') {
        const auto parsed = std::from_chars(at, end, out.width);
        if (parsed.ec != std::errc() || out.width > 1000) return false;
        at = parsed.ptr;
    }
    if (at != end && *at == '.') {
        const auto parsed = std::from_chars(at + 1, end, out.digits);
        if (parsed.ec != std::errc() || out.digits < 0 || out.digits > 30) return false;
        at = parsed.ptr;
    }
    return at == end;
}

bool put(Call& call, const Field& field, std::size_t argument, const Value& value,
         std::string& out) {
    std::string text;
    if (field.digits >= 0) {
        double number = 0.0;
        if (!call.number(argument, number)) return false;
        text = fmt::format("{:.{}f}", number, field.digits);
        if (text.find_first_not_of("-0.") == std::string::npos && text[0] == '-') text.erase(0, 1);
    } else if (!call.evaluator().show(value, call.node(), text)) {
        return false;
    }
    if (text.size() < field.width) out.append(field.width - text.size(), ' ');
    out += text;
    return true;
}

// format("{} of {:.2}", a, b): {} as print shows it, {:8} to a width, {:.2} with digits behind the point, {{ and }}.
bool format_text(Call& call, Value& out) {
    std::string pattern;
    if (!call.text(0, pattern)) return false;
    std::string text;
    std::size_t next = 0;
    for (std::size_t i = 0; i < pattern.size(); ++i) {
        const char c = pattern[i];
        if ((c == '{' || c == '}') && i + 1 < pattern.size() && pattern[i + 1] == c) {
            text += c;
            ++i;
            continue;
        }
        if (c == '}') {
            return call.fail(0, ErrorCode::bad_argument, "a `}` closes nothing",
                             "write }} for the character");
        }
        if (c != '{') {
            text += c;
            continue;
        }
        const std::size_t close = pattern.find('}', i);
        Field field;
        if (close == std::string::npos ||
            !parse_field(std::string_view(pattern).substr(i + 1, close - i - 1), field)) {
            return call.fail(0, ErrorCode::bad_argument,
                             "a field is {}, {:width} or {:width.digits}",
                             "write {{ for the character");
        }
        if (next >= call.rest().size()) {
            return call.fail(ErrorCode::bad_argument, "there are more fields than values",
                             "give a value for each {}");
        }
        if (!put(call, field, call.rest_begin() + next, call.rest()[next], text)) return false;
        ++next;
        i = close;
    }
    if (next < call.rest().size()) {
        return call.fail(call.rest_begin() + next, ErrorCode::bad_argument,
                         "there are more values than fields", "write {} where it belongs");
    }
    out = Value::string(std::move(text));
    return true;
}

}  // namespace

std::span<const BuiltinRow> text_rows() {
    static constexpr auto kRows = std::to_array<BuiltinRow>({
        {"print", "values*", &print, "Shows its arguments on a line."},
        {"str", "value", &to_text, "A value as print shows it."},
        {"format", "pattern values*", &format_text, "Values put into the {} of a pattern."},
    });
    return kRows;
}

}  // namespace raymo::sml
