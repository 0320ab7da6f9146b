#include "raymo/sml/drawings.hpp"

#include <algorithm>
#include <array>

#include "raymo/core/folder.hpp"
#include "raymo/sml/value.hpp"

namespace raymo::sml {

bool is_font_file(std::string_view name) {
    if (name.find('/') != std::string_view::npos) return true;
    std::string end(
        name.substr(name.rfind('.') == std::string_view::npos ? name.size() : name.rfind('.')));
    std::transform(end.begin(), end.end(), end.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    static constexpr auto kEnds = std::to_array<std::string_view>(
        {".ttf", ".otf", ".ttc", ".otc", ".pfb", ".pfa", ".woff", ".woff2"});
    return std::find(kEnds.begin(), kEnds.end(), end) != kEnds.end();
}

Result<drawings::FontPtr> Drawings::font(const std::string& from, const std::string& name) {
    const bool is_file = is_font_file(name);
    const Key key{is_file ? folder_of(from) : std::string(), name};
    if (const auto known = fonts_.find(key); known != fonts_.end()) return known->second;
    FontFile read;
    std::string resolved = name;
    if (is_file) {
        if (!host_.load) return fail(ErrorCode::io, "files can not be read here");
        auto bytes = host_.load(from, name, resolved);
        if (!bytes) return Failure(std::move(bytes).error());
        read.bytes = *std::move(bytes);
    } else {
        if (!host_.font) {
            return fail(ErrorCode::io, "fonts can not be looked up by name here",
                        "name a font file: font: \"fonts/name.ttf\"");
        }
        auto found = host_.font(name);
        if (!found) return Failure(std::move(found).error());
        read = *std::move(found);
    }
    drawings::FontPtr& font = is_file ? font_files_[resolved] : fonts_[key];
    if (font == nullptr) {
        Heap::current().charge(static_cast<double>(read.bytes.size()));
        auto opened = drawings::Font::open(name, std::move(read.bytes), read.face);
        if (!opened) return Failure(std::move(opened).error());
        font = *std::move(opened);
    }
    return fonts_[key] = font;
}

Result<drawings::DrawingPtr> Drawings::drawing(const std::string& from, const std::string& path,
                                               const drawings::GoOn& go_on) {
    const Key key{folder_of(from), path};
    if (const auto known = drawings_.find(key); known != drawings_.end()) return known->second;
    if (!host_.load) return fail(ErrorCode::io, "files can not be read here");
    std::string resolved;
    auto bytes = host_.load(from, path, resolved);
    if (!bytes) return Failure(std::move(bytes).error());
    drawings::DrawingPtr& drawing = drawing_files_[resolved];
    if (drawing == nullptr) {
        auto read = drawings::Drawing::read(resolved, *std::move(bytes), go_on);
        if (!read) return Failure(std::move(read).error());
        drawing = *std::move(read);
        Heap::current().charge(drawing->bytes());
    }
    return drawings_[key] = drawing;
}

Result<std::string> Drawings::text(const std::string& from, const std::string& path) const {
    if (!host_.load) return fail(ErrorCode::io, "files can not be read here");
    std::string resolved;
    return host_.load(from, path, resolved);
}

}  // namespace raymo::sml
