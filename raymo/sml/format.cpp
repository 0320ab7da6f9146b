// How a diagnostic is shown.

#include <fmt/core.h>

#include <algorithm>

#include "raymo/sml/lexer.hpp"
#include "raymo/sml/program.hpp"

namespace raymo::sml {
namespace {

constexpr std::size_t kWidest = 160;    ///< code points of a line that are shown
constexpr std::size_t kCallsAtTop = 6;  ///< of a long chain of calls
constexpr std::size_t kCallsAtBottom = 3;

struct Position {
    std::size_t line = 1;
    std::size_t column = 1;      ///< code points from 1
    std::size_t line_begin = 0;  ///< byte
    std::size_t line_end = 0;
};

bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

std::size_t code_points(std::string_view text) {
    return static_cast<std::size_t>(
        std::count_if(text.begin(), text.end(), [](char c) { return !is_continuation(c); }));
}

Position position_of(std::string_view text, std::size_t offset) {
    offset = std::min(offset, text.size());
    Position p;
    p.line = 1 + static_cast<std::size_t>(
                     std::count(text.begin(), text.begin() + static_cast<long>(offset), '\n'));
    const std::size_t newline = offset == 0 ? std::string_view::npos : text.rfind('\n', offset - 1);
    p.line_begin = newline == std::string_view::npos ? 0 : newline + 1;
    p.line_end = std::min(text.find('\n', offset), text.size());
    if (p.line_end > p.line_begin && text[p.line_end - 1] == '\r') --p.line_end;
    if (p.line_begin == 0 && text.starts_with("\xEF\xBB\xBF") && offset >= 3) p.line_begin = 3;
    p.column = 1 + code_points(text.substr(p.line_begin, offset - p.line_begin));
    return p;
}

std::string place(SourceSpan where, const SourceMap& sources) {
    const SourceFile& file = sources[where.file];
    const Position p = position_of(file.text, where.begin);
    return fmt::format("{}:{}:{}", file.path, p.line, p.column);
}

// What could move the cursor of a terminal is not passed on.
std::string harmless(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size();) {
        std::uint32_t length = 1;
        const char32_t c = code_point(text, i, length);
        const bool is_control = (c < 0x20 && c != '\t') || (c >= 0x7F && c < 0xA0) ||
                                (c >= 0x202A && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069);
        if (is_control) {
            out += "\xEF\xBF\xBD";
        } else {
            out += text.substr(i, length);
        }
        i += length;
    }
    return out;
}

struct Colours {
    std::string_view bold, error, warning, gutter, hint, off;
};
constexpr Colours kPlain{"", "", "", "", "", ""};
constexpr Colours kAnsi{"\x1b[1m",    "\x1b[1;31m", "\x1b[1;33m",
                        "\x1b[1;34m", "\x1b[1;36m", "\x1b[0m"};

// The line of text and the caret below it.
void show_line(std::string& out, const Diagnostic& d, std::string_view text, const Position& p,
               const Colours& paint) {
    const SourceSpan where = d.error.where;
    const std::size_t begin = std::min<std::size_t>(where.begin, text.size());
    std::size_t line_begin = p.line_begin;
    std::size_t line_end = std::max(p.line_end, line_begin);
    std::string_view before_mark;
    std::string_view behind_mark;
    if (code_points(text.substr(line_begin, line_end - line_begin)) > kWidest) {
        // A window around the caret.
        std::size_t from = begin > line_begin + kWidest / 2 ? begin - kWidest / 2 : line_begin;
        while (from > line_begin && is_continuation(text[from])) --from;
        std::size_t to = std::min(line_end, from + kWidest);
        while (to < line_end && is_continuation(text[to])) ++to;
        if (from > line_begin) before_mark = "...";
        if (to < line_end) behind_mark = "...";
        line_begin = from;
        line_end = to;
    }
    const std::string number = fmt::format("{}", p.line);
    const std::string_view lead = text.substr(line_begin, std::max(begin, line_begin) - line_begin);
    const std::size_t end = std::clamp<std::size_t>(where.end, begin, std::max(line_end, begin));
    const std::size_t carets =
        std::max<std::size_t>(1, code_points(text.substr(begin, end - begin)));
    out += fmt::format("{} {} |{} {}{}{}\n", paint.gutter, number, paint.off, before_mark,
                       harmless(text.substr(line_begin, line_end - line_begin)), behind_mark);
    std::string padding(before_mark.size(), ' ');
    for (const char c : lead) {
        if (!is_continuation(c)) padding += c == '\t' ? '\t' : ' ';
    }
    const std::string_view severity = d.severity == Severity::error ? paint.error : paint.warning;
    out += fmt::format("{} {} |{} {}{}{}{}{}{}\n", paint.gutter, std::string(number.size(), ' '),
                       paint.off, padding, severity, std::string(carets, '^'),
                       d.error.label.empty() ? "" : " ", harmless(d.error.label), paint.off);
}

}  // namespace

std::string format(const Diagnostic& d, const SourceMap& sources, bool color) {
    const Colours& paint = color ? kAnsi : kPlain;
    std::string out;
    const bool is_error = d.severity == Severity::error;
    out += fmt::format("{}{}:{} {}{}{}\n", is_error ? paint.error : paint.warning,
                       is_error ? "error" : "warning", paint.off, paint.bold,
                       harmless(d.error.message), paint.off);
    const SourceSpan where = d.error.where;
    if (where.known() && where.file < sources.size()) {
        const std::string_view text = sources[where.file].text;
        const Position p = position_of(text, where.begin);
        const std::size_t width = fmt::format("{}", p.line).size();
        out += fmt::format("{}{}-->{} {}:{}:{}\n", paint.gutter, std::string(width + 1, ' '),
                           paint.off, sources[where.file].path, p.line, p.column);
        show_line(out, d, text, p, paint);
    }
    if (!d.error.hint.empty()) {
        out += fmt::format("{}hint:{} {}\n", paint.hint, paint.off, harmless(d.error.hint));
    }
    for (std::size_t i = 0; i < d.calls.size(); ++i) {
        if (d.calls.size() > kCallsAtTop + kCallsAtBottom + 1 && i == kCallsAtTop) {
            const std::size_t hidden = d.calls.size() - kCallsAtTop - kCallsAtBottom;
            out += fmt::format("... {} more calls\n", hidden);
            i += hidden;
        }
        const CallSite& call = d.calls[i];
        if (!call.where.known() || call.where.file >= sources.size()) continue;
        out += fmt::format("called from {} in {}()\n", place(call.where, sources), call.function);
    }
    return out;
}

}  // namespace raymo::sml
