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

/// Whether a text is that word, which is in small letters; CSS does not tell them from capitals.
bool is_word(std::string_view text, std::string_view word) {
    return std::equal(text.begin(), text.end(), word.begin(), word.end(), [](char a, char b) {
        return (a >= 'A' && a <= 'Z' ? static_cast<char>(a + 32) : a) == b;
    });
}

/// Whether a property moves shapes or makes them larger.
bool places(std::string_view name) {
    static constexpr auto kNames = std::to_array<std::string_view>(
        {"transform", "transform-origin", "transform-box", "translate", "rotate", "scale", "x", "y",
         "width", "height", "cx", "cy", "r", "rx", "ry", "d", "offset-path", "zoom"});
    return std::any_of(kNames.begin(), kNames.end(),
                       [&](std::string_view known) { return is_word(name, known); });
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
    const std::string clean = without_comments(value);
    say(name, clean, false);
}

void Style::say(std::string_view name, std::string_view value, bool is_important) {
    value = trimmed(cut(value, '!'));
    if (value.empty() || is_word(value, "inherit")) return;
    Style said;
    said.is_important_.fill(is_important);
    if (is_word(name, "fill"))
        said.is_filled = !is_word(value, "none") && !is_word(value, "transparent");
    if (is_word(name, "fill-rule")) said.is_even_odd = is_word(value, "evenodd");
    if (is_word(name, "visibility")) said.is_visible = is_word(value, "visible");
    if (is_word(name, "display")) said.is_shown = !is_word(value, "none");
    override_by(said);
}

void Style::set_all(std::string_view declarations) {
    const std::string clean = without_comments(declarations);
    std::string_view rest = clean;
    while (!rest.empty()) {
        std::string_view value = cut(rest, ';');
        const std::string_view name = trimmed(cut(value, ':'));
        is_placed = is_placed || (places(name) && !is_word(trimmed(value), "none") &&
                                  !is_word(trimmed(value), "auto"));
        const std::size_t mark = std::min(value.find('!'), value.size());
        say(name, value,
            is_word(trimmed(value.substr(std::min(mark + 1, value.size()))), "important"));
    }
}

void Style::override_by(const Style& other) {
    is_placed = is_placed || other.is_placed;
    constexpr std::array kProperties{&Style::is_filled, &Style::is_even_odd, &Style::is_visible,
                                     &Style::is_shown};
    for (std::size_t i = 0; i < kProperties.size(); ++i) {
        if (!(other.*kProperties[i]) || (is_important_[i] && !other.is_important_[i])) continue;
        this->*kProperties[i] = other.*kProperties[i];
        is_important_[i] = other.is_important_[i];
    }
}

bool StyleSheet::add(std::string_view text, const GoOn& go_on) {
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
        if (!add_rules(before, style, go_on)) return false;
    }
    std::stable_sort(rules_.begin(), rules_.end(),
                     [](const Rule& a, const Rule& b) { return a.rank < b.rank; });
    return true;
}

bool StyleSheet::add_rules(std::string_view selectors, const Style& style, const GoOn& go_on) {
    constexpr std::uint32_t kBetweenQuestions = 1024;
    do {
        if (++steps_ % kBetweenQuestions == 0 && !go_on(bytes_)) return false;
        if (style.is_empty()) return true;
        std::string_view selector = trimmed(cut(selectors, ','));
        if (selector.empty()) continue;
        if (selector.find_first_of(" \t\n\r\f>+~[]:") != std::string_view::npos) {
            ++left_out_;
            continue;
        }
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
        // A list of rules that has just doubled is twice as long as what is in it.
        bytes_ +=
            2.0 * sizeof(Rule) + static_cast<double>(rule.tag.capacity() + rule.id.capacity());
        for (const std::string& each : rule.classes)
            bytes_ += static_cast<double>(sizeof(std::string) + each.capacity());
        rules_.push_back(std::move(rule));
    } while (!selectors.empty());
    return true;
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
