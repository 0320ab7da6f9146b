// Contours that others have drawn: letters of fonts, and drawings in SVG.

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "raymo/drawings/typeset.hpp"
#include "raymo/sml/builtins/call.hpp"
#include "raymo/sml/lexer.hpp"
#include "raymo/sml/suggest.hpp"
#include "raymo/sml/text.hpp"

namespace raymo::sml {
namespace {

// The slots of the parameters of text() and text_width().
constexpr std::size_t kText = 0;
constexpr std::size_t kSize = 1;
constexpr std::size_t kFont = 2;
constexpr std::size_t kSpacing = 3;
constexpr std::size_t kLineSpacing = 4;
constexpr std::size_t kAlign = 5;

std::u32string characters_of(std::string_view text) {
    std::u32string out;
    out.reserve(text.size());
    for (std::size_t at = 0; at < text.size();) {
        std::uint32_t length = 0;
        out.push_back(code_point(text, at, length));
        at += length;
    }
    return out;
}

/// An error of reading a file or of what is in it, at the argument that names it.
bool fail_at(Call& call, std::size_t i, Error error) {
    return call.fail(i, error.code, error.message, std::move(error.hint), std::move(error.label));
}

bool find_font(Call& call, drawings::FontPtr& out) {
    std::string name(kDefaultFont);
    if (call.has(kFont) && !call.text(kFont, name)) return false;
    if (name.empty()) {
        return call.fail(kFont, ErrorCode::bad_argument, "the font has no name",
                         fmt::format("leave out `font` for {}", kDefaultFont));
    }
    auto font = call.evaluator().drawings().font(call.evaluator().path(call.span()), name);
    if (!font) return fail_at(call, kFont, std::move(font).error());
    out = *std::move(font);
    return true;
}

bool set(Call& call, drawings::TextStyle style, drawings::SetText& out) {
    std::string written;
    drawings::FontPtr font;
    if (!call.text(kText, written) || (call.has(kSize) && !call.number(kSize, style.size)) ||
        (call.has(kSpacing) && !call.number(kSpacing, style.spacing)) ||
        (call.has(kLineSpacing) && !call.number(kLineSpacing, style.line_spacing)) ||
        !find_font(call, font)) {
        return false;
    }
    // A letter takes a node, its handle while it is set, and its character.
    constexpr double kBytesEach = 256.0;
    if (!call.evaluator().room(kBytesEach * static_cast<double>(written.size()), call.node()))
        return false;
    bool is_reported = false;
    const double before = font->bytes();
    auto made = drawings::typeset(*font, characters_of(written), style, [&] {
        is_reported = !call.evaluator().worked(1e6, call.node());
        return !is_reported;
    });
    // What the font keeps stays until the end.
    Heap::current().charge(font->bytes() - before);
    if (is_reported) return false;
    if (!made) {
        static constexpr std::array kSlots{kText, kSize, kSpacing, kLineSpacing, kFont};
        return call.fail(std::move(made).error(), kSlots);
    }
    out = *std::move(made);
    return true;
}

bool text(Call& call, Value& out) {
    drawings::TextStyle style;
    if (call.has(kAlign)) {
        static constexpr auto kAligns =
            std::to_array<std::string_view>({"left", "center", "right"});
        std::size_t chosen = 0;
        if (!call.choice(kAlign, kAligns, chosen)) return false;
        style.align = static_cast<drawings::Align>(chosen);
    }
    drawings::SetText made;
    if (!set(call, style, made)) return false;
    if (made.contour == nullptr) {
        return call.fail(kText, ErrorCode::empty, "the text shows nothing",
                         "where there may be none, ask first: if len(label) > 0 { ... }",
                         fmt::format("this is {}", quoted(shortened(call[kText].string()))));
    }
    if (made.is_backwards) {
        call.warn("letters are set from left to right, not joined, in every script",
                  "draw words of scripts that run from right to left as paths, for svg()");
    }
    return call.evaluator().made(std::move(made.contour), made.bytes, call.node(), out);
}

bool text_width(Call& call, Value& out) {
    drawings::SetText made;
    return set(call, {}, made) && call.result(made.width, out);
}

/// The id that is nearest to one that is not there, or the first ones.
std::string id_hint(std::string_view written, std::vector<std::string_view> ids) {
    Suggestion suggestion(written);
    for (const std::string_view id : ids) suggestion.consider(id);
    if (suggestion.found()) return suggestion.hint();
    if (ids.empty()) return "none of its elements has an id";
    constexpr std::size_t kMostShown = 8;
    const std::size_t shown = std::min(ids.size(), kMostShown);
    std::partial_sort(ids.begin(), ids.begin() + static_cast<long>(shown), ids.end());
    std::string hint = "its ids are";
    for (std::size_t i = 0; i < shown; ++i)
        hint += (i == 0 ? " `" : ", `") + shortened(ids[i]) + "`";
    return ids.size() > shown ? fmt::format("{} and {} more", hint, ids.size() - shown) : hint;
}

/// What a drawing without a filled shape has instead.
std::string empty_hint(const drawings::Drawn& drawn) {
    if (drawn.unfilled > 0) return "its shapes are not filled; `unfilled: true` takes them as well";
    if (drawn.texts > 0) return "its texts are no curves: turn them into paths where you draw";
    if (drawn.images > 0) return "its pictures are no curves: trace them where you draw";
    if (drawn.flat > 0) return "its shapes are flat: a `scale` or the size of the page is 0";
    return "what counts is the inside of paths, rectangles, circles, ellipses and polygons";
}

// svg("logo.svg", id: "front")
bool svg(Call& call, Value& out) {
    constexpr std::size_t kFile = 0;
    constexpr std::size_t kId = 1;
    constexpr std::size_t kUnfilled = 2;
    std::string file;
    std::string id;
    bool takes_unfilled = false;
    if (!call.text(kFile, file) || (call.has(kId) && !call.text(kId, id)) ||
        (call.has(kUnfilled) && !call.flag(kUnfilled, takes_unfilled))) {
        return false;
    }
    if (call.has(kId) && id.empty())
        return call.fail(kId, ErrorCode::bad_argument, "the id is empty",
                         "leave out `id` for the whole drawing");
    bool is_reported = false;
    const drawings::GoOn go_on = [&](double bytes) {
        is_reported = !call.evaluator().room(bytes, call.node()) ||
                      !call.evaluator().worked(1e6, call.node());
        return !is_reported;
    };
    const auto drawing =
        call.evaluator().drawings().drawing(call.evaluator().path(call.span()), file, go_on);
    if (is_reported) return false;
    if (!drawing) return fail_at(call, kFile, drawing.error());
    auto drawn = (*drawing)->contour(id, takes_unfilled, go_on);
    if (is_reported) return false;
    if (!drawn) {
        Error error = std::move(drawn).error();
        const bool is_id = error.code == ErrorCode::name;
        if (is_id) error.hint = id_hint(id, (*drawing)->ids());
        return fail_at(call, is_id ? kId : kFile, std::move(error));
    }
    const std::size_t blamed = call.has(kId) ? kId : kFile;
    if (drawn->contour == nullptr) {
        return call.fail(blamed, ErrorCode::empty, "nothing is filled in it", empty_hint(*drawn),
                         fmt::format("this is {}", quoted(shortened(call[blamed].string()))));
    }
    if (!(curves::extent_of(drawn->contour) <= curves::kLargestCoordinate)) {
        return call.fail(blamed, ErrorCode::out_of_range,
                         "the drawing is too large to be computed with",
                         "stay within 1e90 of the origin");
    }
    if (drawn->placed > 0) {
        call.warn(
            fmt::format("{} of its elements are moved or sized by `style`, which is not followed",
                        drawn->placed),
            "write `transform`, `width` and the like as attributes: save it as a plain SVG");
    }
    if (drawn->rules > 0) {
        call.warn(fmt::format("{} of its style sheet's selectors say what is filled, and are not "
                              "followed",
                              drawn->rules),
                  "select by one element, class or id, as in `.logo`; or say it at the shapes");
    }
    if (drawn->texts + drawn->images > 0) {
        const std::string_view both = drawn->texts > 0 && drawn->images > 0 ? " and " : "";
        call.warn(fmt::format("its {}{}{} are left out", drawn->texts > 0 ? "texts" : "", both,
                              drawn->images > 0 ? "pictures" : ""),
                  "turn them into paths where you draw");
    }
    return call.evaluator().made(std::move(drawn->contour), drawn->bytes, call.node(), out);
}

}  // namespace

std::span<const BuiltinRow> drawing_rows() {
    static constexpr auto kRows = std::to_array<BuiltinRow>({
        {"text", "text size? font? | spacing? line_spacing? align?", &text,
         "Letters as contours; `size` is the height of capitals."},
        {"text_width", "text size? font? | spacing? line_spacing?", &text_width,
         "How far the letters of text() reach: where the next one would begin."},
        {"svg", "file | id? unfilled?", &svg,
         "What is filled in a drawing, or in one element of it, in millimetres."},
    });
    return kRows;
}

}  // namespace raymo::sml
