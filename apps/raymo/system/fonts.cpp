#include "apps/raymo/system/fonts.hpp"

#include <fontconfig/fontconfig.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <memory>
#include <vector>

#include "apps/raymo/system/files.hpp"
#include "apps/raymo/text.hpp"

namespace raymo::app {
namespace {

/// Where Debian keeps the fonts of fonts-dejavu-core, of which one is the default: found here without a look at the others,
/// and whatever fonts of that name a user may have.
constexpr const char* kDejaVu = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr std::string_view kDejaVuFamily = "DejaVu Sans";

template <auto kDestroy>
struct Destroy {
    template <class T>
    void operator()(T* p) const {
        kDestroy(p);
    }
};
using Config = std::unique_ptr<FcConfig, Destroy<FcConfigDestroy>>;
using Pattern = std::unique_ptr<FcPattern, Destroy<FcPatternDestroy>>;
using Properties = std::unique_ptr<FcObjectSet, Destroy<FcObjectSetDestroy>>;
using Fonts = std::unique_ptr<FcFontSet, Destroy<FcFontSetDestroy>>;

const FcChar8* bytes(const std::string& text) {
    return reinterpret_cast<const FcChar8*>(text.c_str());
}

std::vector<std::string> all(FcPattern* pattern, const char* property) {
    std::vector<std::string> out;
    FcChar8* text = nullptr;
    for (int i = 0; FcPatternGetString(pattern, property, i, &text) == FcResultMatch; ++i)
        out.emplace_back(reinterpret_cast<const char*>(text));
    return out;
}

bool is_same(const std::string& a, const std::string& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
        return std::tolower(static_cast<unsigned char>(x)) ==
               std::tolower(static_cast<unsigned char>(y));
    });
}

/// The names of a property of all fonts that fit a pattern, each once, in order.
std::vector<std::string> known(FcConfig* config, FcPattern* pattern, const char* property) {
    std::vector<std::string> out;
    const Properties properties(FcObjectSetBuild(property, nullptr));
    const Fonts fonts(FcFontList(config, pattern, properties.get()));
    if (fonts == nullptr) return out;
    for (int i = 0; i < fonts->nfont; ++i) {
        for (std::string& name : all(fonts->fonts[i], property)) out.push_back(std::move(name));
    }
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

/// Whether a font has what a name asks for: weights, slants and widths are numbers, and fontconfig takes the nearest.
bool keeps(FcPattern* asked, FcPattern* found, const char* property) {
    double wanted = 0.0;
    const FcResult said = FcPatternGetDouble(asked, property, 0, &wanted);
    if (said == FcResultNoMatch) return true;
    double got = 0.0;
    return said == FcResultMatch && FcPatternGetDouble(found, property, 0, &got) == FcResultMatch &&
           got == wanted;
}

/// Whether a name says one family, and once each only what is looked at afterwards. fontconfig takes sizes, languages and
/// faces of a file as wishes, and forgets what it does not know: so the properties are read from the name as well.
bool is_plain(FcPattern* asked, std::string_view name) {
    static constexpr auto kProperties =
        std::to_array<std::string_view>({FC_FAMILY, FC_STYLE, FC_WEIGHT, FC_SLANT, FC_WIDTH});
    const auto is_known = [](std::string_view property) {
        return std::find(kProperties.begin(), kProperties.end(), property) != kProperties.end();
    };
    FcPatternIter at;
    FcPatternIterStart(asked, &at);
    bool has_family = false;
    for (bool more = FcPatternIterIsValid(asked, &at) != FcFalse; more;
         more = FcPatternIterNext(asked, &at) != FcFalse) {
        const std::string_view property = FcPatternIterGetObject(asked, &at);
        if (!is_known(property) || FcPatternIterValueCount(asked, &at) != 1) return false;
        has_family = has_family || (property == FC_FAMILY && !all(asked, FC_FAMILY).empty());
    }
    for (std::size_t colon = name.find(':'); colon != std::string_view::npos;) {
        const std::size_t next = name.find(':', colon + 1);
        const std::string_view part = name.substr(colon + 1, next - colon - 1);
        const std::size_t equals = part.find('=');
        if (equals != std::string_view::npos && !is_known(part.substr(0, equals))) return false;
        colon = next;
    }
    return has_family;
}

Result<sml::FontFile> read(const std::string& path, int face) {
    Attempt<std::string> got = read_regular(path);
    if (!got) return fail(ErrorCode::io, got.error().message, got.error().hint);
    return sml::FontFile{*std::move(got), face};
}

Failure no_such(const std::string& name, std::string hint) {
    return fail(ErrorCode::io, "there is no font " + in_quotes(name) + " on this machine",
                std::move(hint));
}

std::string install_hint(const std::string& family) {
    if (family.starts_with("DejaVu")) return "install it: apt-get install fonts-dejavu-core";
    return "install it, or name a font file: font: \"fonts/name.ttf\"";
}

}  // namespace

Result<sml::FontFile> find_font(const std::string& name) {
    if (name == kDejaVuFamily) {
        if (auto font = read(kDejaVu, 0)) return font;
    }
    const Config config(FcInitLoadConfigAndFonts());
    if (config == nullptr) return no_such(name, install_hint(name));
    const Pattern asked(name.find('\0') == std::string::npos ? FcNameParse(bytes(name)) : nullptr);
    if (asked == nullptr || !is_plain(asked.get(), name)) {
        return fail(ErrorCode::io, in_quotes(name) + " is no name of a font",
                    "write a family, or a family and its style, weight, slant or width: "
                    "\"DejaVu Sans:bold\"; a hyphen in a name is \"\\-\"");
    }
    const std::string family = all(asked.get(), FC_FAMILY).front();
    const Pattern wanted(FcPatternDuplicate(asked.get()));
    FcConfigSubstitute(config.get(), wanted.get(), FcMatchPattern);
    FcDefaultSubstitute(wanted.get());
    FcResult result = FcResultNoMatch;
    const Pattern found(FcFontMatch(config.get(), wanted.get(), &result));
    const auto has = [&](const char* property, const std::string& value) {
        const std::vector<std::string> values = all(found.get(), property);
        return std::any_of(values.begin(), values.end(),
                           [&](const std::string& v) { return is_same(v, value); });
    };
    if (found == nullptr || !has(FC_FAMILY, family)) {
        const Pattern any(FcPatternCreate());
        std::string hint = did_you_mean(family, known(config.get(), any.get(), FC_FAMILY));
        return no_such(name, hint.empty() ? install_hint(family) : std::move(hint));
    }
    const std::vector<std::string> styles = all(asked.get(), FC_STYLE);
    const bool is_exact =
        keeps(asked.get(), found.get(), FC_WEIGHT) && keeps(asked.get(), found.get(), FC_SLANT) &&
        keeps(asked.get(), found.get(), FC_WIDTH) &&
        std::all_of(styles.begin(), styles.end(),
                    [&](const std::string& style) { return has(FC_STYLE, style); });
    if (!is_exact) {
        const Pattern of_family(FcPatternCreate());
        FcPatternAddString(of_family.get(), FC_FAMILY, bytes(family));
        constexpr std::size_t kMostShown = 8;
        const std::vector<std::string> there = known(config.get(), of_family.get(), FC_STYLE);
        std::string hint = "there is";
        for (std::size_t i = 0; i < std::min(there.size(), kMostShown); ++i)
            hint += (i == 0 ? " " : ", ") + in_quotes(family + ":style=" + there[i]);
        if (there.size() > kMostShown)
            hint += " and " + std::to_string(there.size() - kMostShown) + " more";
        return no_such(name, std::move(hint));
    }
    const std::vector<std::string> files = all(found.get(), FC_FILE);
    if (files.empty()) return no_such(name, install_hint(family));
    int face = 0;
    FcPatternGetInteger(found.get(), FC_INDEX, 0, &face);
    return read(files[0], face);
}

}  // namespace raymo::app
