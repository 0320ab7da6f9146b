#include "raymo/drawings/svg_style.hpp"

#include <algorithm>

namespace raymo::drawings {
namespace {

constexpr std::string_view kSpaces = " \t\n\r\f";

std::string_view trimmed(std::string_view text) {
    const std::size_t begin = text.find_first_not_of(kSpaces);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin, text.find_last_not_of(kSpaces) + 1 - begin);
}

/// Cuts off what stands before the next `mark`, and the mark.
std::string_view cut(std::string_view& text, char mark) {
    const std::size_t at = std::min(text.find(mark), text.size());
    const std::string_view out = text.substr(0, at);
    text.remove_prefix(std::min(at + 1, text.size()));
    return out;
}

std::string without_comments(std::string_view text) {
    std::string out;
    while (!text.empty()) {
        const std::size_t begin = std::min(text.find("/*"), text.size());
        out += text.substr(0, begin);
        const std::size_t end = text.find("*/", std::min(begin + 2, text.size()));
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 2);
    }
    return out;
}

bool has_class(std::string_view classes, std::string_view name) {
    while (!classes.empty()) {
        const std::size_t end = std::min(classes.find_first_of(kSpaces), classes.size());
        if (classes.substr(0, end) == name) return true;
        classes.remove_prefix(std::min(end + 1, classes.size()));
    }
    return false;
}

}  // namespace

void Style::set(std::string_view name, std::string_view value) {
    std::string_view rest = value;
    value = trimmed(cut(rest, '!'));  // "none !important"
    if (value.empty() || value == "inherit") return;
    if (name == "fill") is_filled = value != "none" && value != "transparent";
    if (name == "fill-rule") is_even_odd = value == "evenodd";
    if (name == "visibility") is_visible = value == "visible";
    if (name == "display") is_shown = value != "none";
}

void Style::set_all(std::string_view declarations) {
    while (!declarations.empty()) {
        std::string_view value = cut(declarations, ';');
        const std::string_view name = trimmed(cut(value, ':'));
        set(name, value);
    }
}

void Style::override_by(const Style& other) {
    if (other.is_filled) is_filled = other.is_filled;
    if (other.is_even_odd) is_even_odd = other.is_even_odd;
    if (other.is_visible) is_visible = other.is_visible;
    if (other.is_shown) is_shown = other.is_shown;
}

void StyleSheet::add(std::string_view text) {
    const std::string clean = without_comments(text);
    std::string_view rest = clean;
    while (!rest.empty()) {
        const std::string_view selectors = trimmed(rest.substr(0, rest.find_first_of("{;")));
        if (selectors.starts_with('@')) {
            // A statement up to its semicolon, or a block with what is nested in it.
            std::size_t at = std::min(rest.find_first_of("{;"), rest.size());
            int depth = 0;
            for (; at < rest.size(); ++at) {
                depth += rest[at] == '{' ? 1 : rest[at] == '}' ? -1 : 0;
                if (depth == 0) break;
            }
            rest.remove_prefix(std::min(at + 1, rest.size()));
            continue;
        }
        const std::string_view before = cut(rest, '{');
        Style style;
        style.set_all(cut(rest, '}'));
        add_rules(before, style);
    }
    std::stable_sort(rules_.begin(), rules_.end(),
                     [](const Rule& a, const Rule& b) { return a.rank < b.rank; });
}

void StyleSheet::add_rules(std::string_view selectors, const Style& style) {
    while (!selectors.empty()) {
        std::string_view selector = trimmed(cut(selectors, ','));
        if (selector.empty() || selector.find_first_of(" \t\n\r\f>+~[]:") != std::string_view::npos)
            continue;
        Rule rule;
        rule.style = style;
        const auto name = [&] {
            const std::size_t end = std::min(selector.find_first_of(".#"), selector.size());
            const std::string_view out = selector.substr(0, end);
            selector.remove_prefix(end);
            return std::string(out);
        };
        rule.tag = name();
        if (rule.tag == "*") rule.tag.clear();
        rule.rank = rule.tag.empty() ? 0 : 1;
        while (!selector.empty()) {
            const bool is_class = selector[0] == '.';
            selector.remove_prefix(1);
            if (is_class) {
                rule.classes.push_back(name());
            } else {
                rule.id = name();
            }
            rule.rank += is_class ? 100 : 10000;
        }
        rules_.push_back(std::move(rule));
    }
}

Style StyleSheet::of(std::string_view tag, std::string_view id, std::string_view classes) const {
    Style out;
    for (const Rule& rule : rules_) {
        const bool fits = (rule.tag.empty() || rule.tag == tag) &&
                          (rule.id.empty() || rule.id == id) &&
                          std::all_of(rule.classes.begin(), rule.classes.end(),
                                      [&](const std::string& c) { return has_class(classes, c); });
        if (fits) out.override_by(rule.style);
    }
    return out;
}

}  // namespace raymo::drawings
