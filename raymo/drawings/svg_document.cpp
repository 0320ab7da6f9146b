#include "raymo/drawings/svg_document.hpp"

#include <expat.h>

#include <algorithm>
#include <cstring>
#include <memory>

namespace raymo::drawings {
namespace {

constexpr std::string_view kSvgSpace = "http://www.w3.org/2000/svg";
constexpr std::string_view kLinkSpace = "http://www.w3.org/1999/xlink";
constexpr std::size_t kMostNested = 10000;
constexpr std::size_t kMostBytes = std::size_t{1} << 30;
constexpr std::uint32_t kBetweenQuestions = 1024;

using Names = std::array<std::string_view, 6>;
constexpr Names kBox{"x", "y", "width", "height", "rx", "ry"};
constexpr Names kCircle{"cx", "cy", "r", "", "", ""};
constexpr Names kEllipse{"cx", "cy", "rx", "ry", "", ""};

struct KnownTag {
    std::string_view name;
    SvgTag tag;
    const Names* lengths;
};
constexpr auto kTags = std::to_array<KnownTag>({
    {"g", SvgTag::group, nullptr},
    {"a", SvgTag::group, nullptr},
    {"switch", SvgTag::choice, nullptr},
    {"svg", SvgTag::svg, &kBox},
    {"symbol", SvgTag::symbol, &kBox},
    {"use", SvgTag::use, &kBox},
    {"path", SvgTag::path, nullptr},
    {"polygon", SvgTag::path, nullptr},
    {"polyline", SvgTag::path, nullptr},
    {"rect", SvgTag::rectangle, &kBox},
    {"circle", SvgTag::circle, &kCircle},
    {"ellipse", SvgTag::ellipse, &kEllipse},
    {"text", SvgTag::text, nullptr},
    {"image", SvgTag::image, nullptr},
});

/// Whether a sign is in an encoding in which ASCII is one byte each.
bool has_single_bytes(std::string_view text) {
    return text.size() < 2 ||
           (text[0] != '\0' && text[1] != '\0' && text[0] != '\xfe' && text[0] != '\xff');
}

class Reader {
public:
    Reader(SvgDocument& document, const GoOn& go_on) : document_(document), go_on_(go_on) {}

    Result<void> read() {
        const std::unique_ptr<XML_ParserStruct, void (*)(XML_Parser)> owner(
            XML_ParserCreateNS(nullptr, ' '), &XML_ParserFree);
        parser_ = owner.get();
        if (parser_ == nullptr) return fail(ErrorCode::limit, "there is no memory left");
        XML_SetUserData(parser_, this);
        XML_SetElementHandler(parser_, &start, &end);
        XML_SetCharacterDataHandler(parser_, &characters);
        // At once: expat looks at what is not complete anew for each part that it is given.
        const std::string_view text = document_.text;
        if (text.size() > kMostBytes)
            return fail(ErrorCode::limit, "the drawing is larger than 1 GiB");
        if (!go_on_(bytes_)) return fail(ErrorCode::cancelled, "stopped");
        XML_Parse(parser_, text.data(), static_cast<int>(text.size()), 1);
        if (failure_) return Failure(std::move(*failure_));
        if (const XML_Error error = XML_GetErrorCode(parser_); error != XML_ERROR_NONE) {
            if (error == XML_ERROR_NO_MEMORY)
                return fail(ErrorCode::limit, "there is no memory left to read " + document_.name);
            const XML_Index at = error_index();
            return document_.wrong(at < 0 ? 0 : static_cast<std::size_t>(at),
                                   std::string("not well-formed XML: ") + XML_ErrorString(error),
                                   "save it anew as a plain SVG");
        }
        return apply_sheet();
    }

private:
    [[nodiscard]] XML_Index error_index() const { return XML_GetCurrentByteIndex(parser_); }

    static Reader& of(void* self) { return *static_cast<Reader*>(self); }
    static void XMLCALL start(void* self, const XML_Char* name, const XML_Char** attributes) {
        of(self).open(name, attributes);
    }
    static void XMLCALL end(void* self, const XML_Char*) { of(self).close(); }
    static void XMLCALL characters(void* self, const XML_Char* text, int length) {
        Reader& reader = of(self);
        if (!reader.may_go_on() || !reader.is_in_style_) return;
        reader.sheet_text_.append(text, static_cast<std::size_t>(length));
        reader.bytes_ += length;
    }

    bool may_go_on() {
        if (failure_) return false;
        if (++steps_ % kBetweenQuestions != 0) return true;
        const double elements =
            static_cast<double>(document_.elements.capacity() * sizeof(SvgElement));
        if (go_on_(bytes_ + elements)) return true;
        stop(Error{ErrorCode::cancelled, "stopped", {}, {}, -1, {}});
        return false;
    }
    void stop(Error error) {
        if (!failure_) failure_ = std::move(error);
        XML_StopParser(parser_, XML_FALSE);
    }
    void stop_at(std::size_t at, std::string what, std::string hint = {},
                 ErrorCode code = ErrorCode::bad_argument) {
        stop(document_.wrong(at, std::move(what), std::move(hint), code).value());
    }

    void open(std::string_view name, const XML_Char** attributes) {
        if (!may_go_on()) return;
        here_ = static_cast<std::size_t>(std::max<XML_Index>(0, XML_GetCurrentByteIndex(parser_)));
        const std::size_t space = name.rfind(' ');
        const bool is_ours = space == std::string_view::npos || name.substr(0, space) == kSvgSpace;
        if (space != std::string_view::npos) name.remove_prefix(space + 1);
        if (document_.elements.empty() && (!is_ours || name != "svg")) {
            stop_at(here_, "this is no SVG: it begins with <" + shortened(name, 40) + ">");
            return;
        }
        if (open_.size() >= kMostNested) {
            stop_at(here_, "its elements are nested more than 10000 deep", "ungroup what it draws",
                    ErrorCode::limit);
            return;
        }
        is_in_style_ = is_ours && name == "style";
        // What is in an element that is not known does not show: metadata, filters, what programs keep for themselves.
        const auto* const known =
            is_ours ? std::find_if(kTags.begin(), kTags.end(),
                                   [&](const KnownTag& t) { return t.name == name; })
                    : kTags.end();
        const auto index = static_cast<std::uint32_t>(document_.elements.size());
        SvgElement& element = document_.elements.emplace_back();
        element.tag = known == kTags.end() ? SvgTag::hidden : known->tag;
        element.at = here_;
        if (!open_.empty()) {
            element.parent = open_.back().index;
            std::uint32_t& link = open_.back().last_child == kNoElement
                                      ? document_.elements[element.parent].first_child
                                      : document_.elements[open_.back().last_child].next_sibling;
            link = index;
            open_.back().last_child = index;
        }
        open_.push_back({index, kNoElement});
        // Its attributes are those of another language.
        if (!is_ours) return;
        take_attributes(element, name, known == kTags.end() ? nullptr : known->lengths, attributes);
    }

    void close() {
        if (failure_) return;
        is_in_style_ = false;
        open_.pop_back();
    }

    void take_attributes(SvgElement& element, std::string_view tag, const Names* lengths,
                         const XML_Char** attributes) {
        Selected selected{static_cast<std::uint32_t>(document_.elements.size() - 1),
                          std::string(tag),
                          {},
                          {},
                          {}};
        for (; *attributes != nullptr; attributes += 2) {
            std::string_view name = attributes[0];
            const std::string_view value = attributes[1];
            const std::size_t space = name.rfind(' ');
            if (space != std::string_view::npos) {
                if (name.substr(0, space) != kLinkSpace) continue;
                name.remove_prefix(space + 1);
                if (name != "href" || !element.href.empty()) continue;
            }
            if (name == "id") {
                document_.ids.try_emplace(std::string(value), selected.index);
                bytes_ += static_cast<double>(value.size()) + 100.0;
                selected.id = value;
            } else if (name == "class") {
                selected.classes = value;
            } else if (name == "style") {
                selected.own.set_all(value);
            } else if (name == "href" && element.tag == SvgTag::use) {
                element.href = value;
            } else if (name == "systemLanguage" || name == "requiredExtensions") {
                element.is_conditional = true;
            } else if (name == "transform-origin") {
                element.style.is_placed = true;
            } else if (name == "transform") {
                take(name, read_transform(value), element.transform);
            } else if (name == "viewBox" &&
                       (element.tag == SvgTag::svg || element.tag == SvgTag::symbol)) {
                take(name, read_view_box(value), element.view_box);
            } else if (name == "preserveAspectRatio" &&
                       (element.tag == SvgTag::svg || element.tag == SvgTag::symbol)) {
                take(name, read_aspect(value), element.aspect);
            } else if (element.tag == SvgTag::path &&
                       ((tag == "path" && name == "d") || (tag != "path" && name == "points"))) {
                draw(element, name, value);
            } else {
                element.style.set(name, value);
                if (lengths != nullptr) take_length(element, *lengths, name, value);
            }
            if (failure_) return;
        }
        bytes_ += static_cast<double>(element.href.capacity() + sizeof(Selected) +
                                      selected.classes.size() + selected.id.size());
        selected_.push_back(std::move(selected));
    }

    void take_length(SvgElement& element, const Names& names, std::string_view name,
                     std::string_view value) {
        for (std::size_t i = 0; i < names.size(); ++i) {
            if (names[i].empty() || names[i] != name || value == "auto") continue;
            const bool is_size = name != "x" && name != "y" && name != "cx" && name != "cy";
            take(name, read_length(value), element.lengths[i]);
            if (!failure_ && is_size && element.lengths[i]->value < 0.0)
                stop_at(place_of(name, 0),
                        "`" + std::string(name) + "` must be at least 0, not \"" +
                            shortened(value, 16) + "\"",
                        name[0] == 'r' ? "write a radius without its sign"
                                       : "sizes point to the right and downwards: move `x` or `y`");
        }
    }

    void draw(SvgElement& element, std::string_view name, std::string_view value) {
        const double before = bytes_;
        const GoOn go_on = [&](double bytes) { return go_on_(before + bytes); };
        auto outline = name == "d" ? read_path(value, go_on) : read_polygon(value, go_on);
        if (!outline && outline.error().what.empty()) {
            stop(Error{ErrorCode::cancelled, "stopped", {}, {}, -1, {}});
            return;
        }
        curves::Outline drawn;
        take(name, std::move(outline), drawn);
        if (drawn.curves.empty()) return;
        for (const curves::Curve& curve : drawn.curves)
            bytes_ += static_cast<double>(curve.spans.capacity() * sizeof(curves::Span2)) + 64.0;
        element.outline = std::make_shared<const curves::Outline>(std::move(drawn));
    }

    template <class T, class Out>
    void take(std::string_view name, Read<T> read, Out& out) {
        if (read) {
            out = *std::move(read);
            return;
        }
        stop_at(place_of(name, read.error().at),
                "in `" + std::string(name) + "`, " + read.error().what);
    }

    /// The byte of the file at which byte `at` of an attribute's value stands, as far as that can be told: the value is
    /// looked for in the element's own text.
    [[nodiscard]] std::size_t place_of(std::string_view name, std::size_t at) const {
        const std::string_view text = document_.text;
        if (!has_single_bytes(text)) return here_;
        std::size_t i = here_;
        while (i < text.size() && text[i] != '>') {
            // A name stands behind white space or a colon, and before "=" and a quote.
            if (text[i] == '"' || text[i] == '\'') {
                const std::size_t close = text.find(text[i], i + 1);
                if (close == std::string_view::npos) return here_;
                std::size_t end = i;
                while (end > here_ && (text[end - 1] == '=' || is_space(text[end - 1]))) --end;
                std::size_t begin = end;
                while (begin > here_ && !is_space(text[begin - 1])) --begin;
                std::string_view found = text.substr(begin, end - begin);
                if (const std::size_t colon = found.rfind(':'); colon != std::string_view::npos)
                    found.remove_prefix(colon + 1);
                if (found == name) return in_value(i + 1, close, at);
                i = close;
            }
            ++i;
        }
        return here_;
    }
    /// A line's end is one blank in a value, and a reference one character.
    [[nodiscard]] std::size_t in_value(std::size_t begin, std::size_t end, std::size_t at) const {
        const std::string_view text = document_.text;
        std::size_t i = begin;
        for (; at > 0 && i < end; --at) {
            if (text[i] == '&') {
                i = std::min(end, text.find(';', i));
            } else if (text[i] == '\r' && i + 1 < end && text[i + 1] == '\n') {
                ++i;
            }
            ++i;
        }
        return std::min(i, end);
    }

    /// Attributes give way to the sheet, and the sheet to `style`.
    Result<void> apply_sheet() {
        StyleSheet sheet;
        const double before = bytes_;
        if (!sheet.add(sheet_text_, [&](double bytes) { return go_on_(before + bytes); }))
            return fail(ErrorCode::cancelled, "stopped");
        bytes_ += sheet.bytes();
        document_.left_out_rules = sheet.left_out();
        constexpr std::size_t kTestsBetweenQuestions = 65536;
        std::size_t tests = 0;
        for (const Selected& s : selected_) {
            SvgElement& element = document_.elements[s.index];
            if (sheet.size() > 0) {
                tests += sheet.size();
                if (tests >= kTestsBetweenQuestions) {
                    tests = 0;
                    if (!go_on_(bytes_)) return fail(ErrorCode::cancelled, "stopped");
                }
                element.style.override_by(sheet.of(s.tag, s.id, s.classes));
            }
            element.style.override_by(s.own);
        }
        return {};
    }

    struct Open {
        std::uint32_t index;
        std::uint32_t last_child;
    };
    /// What a style sheet selects elements by.
    struct Selected {
        std::uint32_t index;
        std::string tag, id, classes;
        Style own;
    };

    SvgDocument& document_;
    const GoOn& go_on_;
    XML_Parser parser_ = nullptr;
    std::optional<Error> failure_;
    std::vector<Open> open_;
    std::vector<Selected> selected_;
    std::string sheet_text_;
    std::size_t here_ = 0;
    double bytes_ = 0.0;
    std::uint32_t steps_ = 0;
    bool is_in_style_ = false;
};

}  // namespace

TextPlace place_in(std::string_view text, std::size_t at) {
    TextPlace out;
    for (const char c : text.substr(0, at)) {
        if (c == '\n') {
            ++out.line;
            out.column = 1;
        } else if ((static_cast<unsigned char>(c) & 0xc0) != 0x80) {
            ++out.column;
        }
    }
    return out;
}

Failure SvgDocument::wrong(std::size_t at, std::string what, std::string hint,
                           ErrorCode code) const {
    const TextPlace place = place_in(text, at);
    return fail(code,
                name + ", line " + std::to_string(place.line) + ", column " +
                    std::to_string(place.column) + ": " + what,
                std::move(hint));
}

Result<SvgDocument> read_svg(std::string name, std::string text, const GoOn& go_on) {
    SvgDocument document;
    document.name = std::move(name);
    document.text = std::move(text);
    if (auto read = Reader(document, go_on).read(); !read) return Failure(std::move(read).error());
    return document;
}

}  // namespace raymo::drawings
