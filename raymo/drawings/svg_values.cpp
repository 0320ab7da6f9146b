#include "raymo/drawings/svg_values.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "raymo/core/shown.hpp"
#include "raymo/math/affine.hpp"

namespace raymo::drawings {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

/// Bytes of a value that messages show.
constexpr std::size_t kMostShown = 16;

/// The power of ten of the first digit of a number that is not 0, which there is.
double decimal_exponent(std::string_view number) {
    const std::size_t e = std::min(number.find_first_of("eE"), number.size());
    const std::size_t point = std::min(number.find('.'), e);
    const std::size_t first = number.find_first_of("123456789");
    double exponent = 0.0;
    for (const char c : number.substr(e)) {
        if (is_digit(c)) exponent = 10.0 * exponent + (c - '0');  // may become infinite
    }
    if (number.substr(e).find('-') != std::string_view::npos) exponent = -exponent;
    return exponent + (first < point ? static_cast<double>(point - first) - 1.0
                                     : static_cast<double>(point) - static_cast<double>(first));
}

Misfit misfit(std::size_t at, std::string what) { return {at, std::move(what)}; }

}  // namespace

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f'; }

std::string shortened(std::string_view text, std::size_t most) {
    std::size_t end = std::min(most, text.size());
    while (end < text.size() && end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80)
        --end;
    std::string out(text.substr(0, end));
    std::replace_if(out.begin(), out.end(), is_space, ' ');
    return end < text.size() ? out + "..." : out;
}

void Scanner::skip_spaces() {
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
}

bool Scanner::skip_comma() {
    skip_spaces();
    if (peek() != ',') return false;
    ++at_;
    skip_spaces();
    return true;
}

std::string_view Scanner::word() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && is_letter(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
}

bool Scanner::is_at_number() const {
    const char c = peek();
    return is_digit(c) || c == '.' || c == '-' || c == '+';
}

tl::unexpected<Misfit> Scanner::expected(std::string_view what) const {
    if (is_done()) return tl::unexpected(misfit(at_, std::string(what) + " is missing at the end"));
    return tl::unexpected(misfit(at_, std::string(what) + " is missing before \"" +
                                          shortened(text_.substr(at_), kMostShown) + "\""));
}

Read<double> Scanner::number() {
    const std::size_t begin = at_;
    std::size_t from = at_;
    if (peek() == '+') ++from;
    std::size_t digits = from < text_.size() && text_[from] == '-' && from == at_ ? from + 1 : from;
    if (digits < text_.size() && text_[digits] == '.') ++digits;
    if (digits >= text_.size() || !is_digit(text_[digits])) return expected("a number");
    double value = 0.0;
    const char* const end = text_.data() + text_.size();
    const auto [stop, error] = std::from_chars(text_.data() + from, end, value);
    at_ = static_cast<std::size_t>(stop - text_.data());
    if (error == std::errc::result_out_of_range) {
        // from_chars does not tell too small from too large, but the place of the first digit that is not 0 does.
        if (decimal_exponent(text_.substr(begin, at_ - begin)) < 0.0) return 0.0;
        return tl::unexpected(misfit(begin, "the number is too large"));
    }
    // "1em": the number ends before the e, which is where from_chars stops, too.
    return value;
}

Read<bool> Scanner::flag() {
    const char c = peek();
    if (c != '0' && c != '1') return expected("a flag, 0 or 1,");
    ++at_;
    return c == '1';
}

Read<Length> read_length(std::string_view text) {
    Scanner scanner(text);
    scanner.skip_spaces();
    const auto number = scanner.number();
    if (!number) return tl::unexpected(number.error());
    const std::size_t at = scanner.at();
    const bool is_part = scanner.peek() == '%';
    if (is_part) scanner.skip();
    const std::string_view unit = is_part ? std::string_view("%") : scanner.word();
    scanner.skip_spaces();
    constexpr double kInch = 25.4;
    struct Unit {
        std::string_view name;
        double mm;
    };
    static constexpr auto kUnits = std::to_array<Unit>({{"", Length::kPixel},
                                                        {"px", Length::kPixel},
                                                        {"mm", 1.0},
                                                        {"cm", 10.0},
                                                        {"in", kInch},
                                                        {"pt", kInch / 72.0},
                                                        {"pc", kInch / 6.0},
                                                        {"Q", 0.25},
                                                        {"%", 0.0}});
    for (const Unit& known : kUnits) {
        if (known.name == unit && scanner.is_done())
            return Length{is_part ? *number / 100.0 : *number, known.mm};
    }
    return tl::unexpected(
        misfit(at, "\"" + shortened(text.substr(std::min(at, text.size())), kMostShown) +
                       "\" is none of the units px, mm, cm, in, pt, pc, Q and %"));
}

Read<ViewBox> read_view_box(std::string_view text) {
    std::array<double, 4> n{};
    std::size_t count = 0;
    Scanner scanner(text);
    scanner.skip_spaces();
    for (; !scanner.is_done(); ++count) {
        const auto number = scanner.number();
        if (!number) return tl::unexpected(number.error());
        if (count < n.size()) n[count] = *number;
        if (scanner.skip_comma() && scanner.is_done()) return scanner.expected("a number");
    }
    if (count != n.size())
        return tl::unexpected(
            misfit(0, "a view box is four numbers, not " + std::to_string(count)));
    if (!(n[2] > 0.0 && n[3] > 0.0))
        return tl::unexpected(
            misfit(0, "the width and the height of a view box must be greater than 0, not " +
                          shown(n[2]) + " and " + shown(n[3])));
    return ViewBox{n[0], n[1], n[2], n[3]};
}

Read<Aspect> read_aspect(std::string_view text) {
    Scanner scanner(text);
    scanner.skip_spaces();
    const std::size_t at = scanner.at();
    std::string_view place = scanner.word();
    if (place == "defer") {
        scanner.skip_spaces();
        place = scanner.word();
    }
    Aspect out;
    const auto part = [](std::string_view word) {
        return word == "Min" ? 0.0 : word == "Mid" ? 0.5 : word == "Max" ? 1.0 : -1.0;
    };
    if (place == "none") {
        out.is_free = true;
    } else if (place.size() == 8 && place[0] == 'x' && place[4] == 'Y' &&
               part(place.substr(1, 3)) >= 0.0 && part(place.substr(5)) >= 0.0) {
        out.x = part(place.substr(1, 3));
        out.y = part(place.substr(5));
    } else {
        return tl::unexpected(
            misfit(at, "the aspect ratio is \"none\", or a place like \"xMidYMid\", not \"" +
                           shortened(text.substr(at), kMostShown) + "\""));
    }
    scanner.skip_spaces();
    const std::string_view size = scanner.word();
    out.covers = size == "slice";
    scanner.skip_spaces();
    if (!scanner.is_done() || (!size.empty() && size != "slice" && size != "meet"))
        return tl::unexpected(
            misfit(at, "behind its place an aspect ratio says \"meet\" or \"slice\""));
    return out;
}

namespace {

/// One function of a list.
Read<Affine2> read_function(Scanner& scanner) {
    const std::size_t at = scanner.at();
    const std::string_view name = scanner.word();
    struct Known {
        std::string_view name;
        std::array<std::size_t, 2> counts;
    };
    static constexpr auto kKnown = std::to_array<Known>({{"matrix", {6, 6}},
                                                         {"translate", {1, 2}},
                                                         {"scale", {1, 2}},
                                                         {"rotate", {1, 3}},
                                                         {"skewX", {1, 1}},
                                                         {"skewY", {1, 1}}});
    const auto* const known =
        std::find_if(kKnown.begin(), kKnown.end(), [&](const Known& k) { return k.name == name; });
    if (known == kKnown.end())
        return tl::unexpected(misfit(
            at,
            "the transformations are matrix, translate, scale, rotate, skewX and skewY" +
                (name.empty() ? std::string() : ", not \"" + shortened(name, kMostShown) + "\"")));
    scanner.skip_spaces();
    if (scanner.peek() != '(') return scanner.expected("\"(\"");
    scanner.skip();
    scanner.skip_spaces();
    std::array<double, 6> n{};
    std::size_t count = 0;
    while (scanner.peek() != ')') {
        const auto number = scanner.number();
        if (!number) return tl::unexpected(number.error());
        if (count == n.size()) break;
        n[count++] = *number;
        scanner.skip_comma();
    }
    if (count != known->counts[0] && count != known->counts[1])
        return tl::unexpected(misfit(
            at,
            std::string(name) + " takes " + std::to_string(known->counts[0]) +
                (known->counts[0] == known->counts[1] ? std::string()
                                                      : " or " + std::to_string(known->counts[1])) +
                " numbers, not " + std::to_string(count)));
    if (scanner.peek() != ')') return scanner.expected("\")\"");
    scanner.skip();
    if (name == "matrix") return Affine2{n[0], n[2], n[4], n[1], n[3], n[5]};
    if (name == "translate") return Affine2{1, 0, n[0], 0, 1, n[1]};
    if (name == "scale") return Affine2{n[0], 0, 0, 0, count == 2 ? n[1] : n[0], 0};
    const SinCos turn = sin_cos_degrees(n[0]);
    if (name != "rotate" && turn.cos == 0.0)
        return tl::unexpected(misfit(at, "the " + std::string(name) + " by " + shown(n[0]) +
                                             " degrees is a right angle, which has no tangent"));
    if (name == "skewX") return Affine2{1, turn.sin / turn.cos, 0, 0, 1, 0};
    if (name == "skewY") return Affine2{1, 0, 0, turn.sin / turn.cos, 1, 0};
    const Affine2 about{1, 0, n[1], 0, 1, n[2]};
    const Affine2 back{1, 0, -n[1], 0, 1, -n[2]};
    return about * Affine2{turn.cos, -turn.sin, 0, turn.sin, turn.cos, 0} * back;
}

}  // namespace

Read<Affine2> read_transform(std::string_view text) {
    Affine2 out;
    Scanner scanner(text);
    scanner.skip_spaces();
    Scanner none = scanner;
    if (none.word() == "none") {
        none.skip_spaces();
        if (none.is_done()) return out;
    }
    while (!scanner.is_done()) {
        const auto next = read_function(scanner);
        if (!next) return tl::unexpected(next.error());
        out = out * *next;
        scanner.skip_comma();
    }
    return out;
}

}  // namespace raymo::drawings
