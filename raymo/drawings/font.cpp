#include "raymo/drawings/font.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_MODULE_H
#include FT_OUTLINE_H
#include FT_TRUETYPE_TABLES_H

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <unordered_map>
#include <utility>
#include <vector>

#include "raymo/curves/contour.hpp"

namespace raymo::drawings {
namespace {

using curves::Curve;
using curves::Outline;

/// FreeType's memory for one font. Each block is headed by its size.
class Budget {
public:
    Budget() {
        memory.user = this;
        memory.alloc = &allocate;
        memory.free = &release;
        memory.realloc = &resize;
    }
    FT_MemoryRec_ memory{};

private:
    static constexpr std::size_t kMost = std::size_t{256} << 20;
    static constexpr std::size_t kHead = alignof(std::max_align_t);

    static Budget& of(FT_Memory memory) { return *static_cast<Budget*>(memory->user); }
    static std::size_t& size_of(void* block) {
        return *reinterpret_cast<std::size_t*>(static_cast<char*>(block) - kHead);
    }
    static void* allocate(FT_Memory memory, long size) { return resize(memory, 0, size, nullptr); }
    static void release(FT_Memory memory, void* block) {
        of(memory).used_ -= size_of(block);
        std::free(static_cast<char*>(block) - kHead);
    }
    static void* resize(FT_Memory memory, long, long new_size, void* block) {
        Budget& budget = of(memory);
        const auto size = static_cast<std::size_t>(new_size);
        const std::size_t old_size = block == nullptr ? 0 : size_of(block);
        if (new_size < 0 || size > kMost || budget.used_ - old_size + size > kMost) return nullptr;
        void* const head = std::realloc(
            block == nullptr ? nullptr : static_cast<char*>(block) - kHead, size + kHead);
        if (head == nullptr) return nullptr;
        budget.used_ = budget.used_ - old_size + size;
        void* const out = static_cast<char*>(head) + kHead;
        size_of(out) = size;
        return out;
    }

    std::size_t used_ = 0;
};

/// FreeType halves sums of control points, so it is given them 64 times as large.
constexpr int kShift = 6;

/// Gathers the curves of a glyph, in units of the font.
class Pen {
public:
    static int move(const FT_Vector* to, void* self) {
        Pen& pen = of(self);
        pen.finish();
        pen.at_ = point(to);
        return 0;
    }
    static int line(const FT_Vector* to, void* self) {
        of(self).add(curves::segment(of(self).at_, point(to)), point(to));
        return 0;
    }
    static int parabola(const FT_Vector* b, const FT_Vector* to, void* self) {
        of(self).add(curves::quadratic(of(self).at_, point(b), point(to)), point(to));
        return 0;
    }
    static int cubic(const FT_Vector* b, const FT_Vector* c, const FT_Vector* to, void* self) {
        of(self).add(curves::cubic(of(self).at_, point(b), point(c), point(to)), point(to));
        return 0;
    }
    [[nodiscard]] Outline take() {
        finish();
        return std::move(outline_);
    }

private:
    static Pen& of(void* self) { return *static_cast<Pen*>(self); }
    static Vec2 point(const FT_Vector* p) {
        constexpr double kUnit = 1.0 / (1 << kShift);
        return {static_cast<double>(p->x) * kUnit, static_cast<double>(p->y) * kUnit};
    }
    void add(const curves::Span2& span, Vec2 to) {
        bool is_point = true;
        for (std::size_t i = 1; i < 4; ++i) is_point = is_point && span.point(i) == span.point(0);
        if (!is_point) curve_.spans.push_back(span);
        at_ = to;
    }
    /// FreeType leads each curve back to where it began.
    void finish() {
        if (curve_.spans.empty()) return;
        curve_.closed = true;
        outline_.curves.push_back(std::exchange(curve_, {}));
    }

    Vec2 at_;
    Curve curve_;
    Outline outline_;
};

// Readers of bitmaps, of formats that nobody has, and what draws pixels: left out.
constexpr const char* kUnused[] = {"pcf",        "bdf",     "winfonts", "pfr", "type42", "t1cid",
                                   "autofitter", "raster1", "smooth",   "sdf", "bsdf",   "ot-svg"};

constexpr std::size_t kFewSizes = 64;

}  // namespace

struct Font::Glyph {
    Outline outline;
    double advance = 0.0;
    std::unordered_map<double, std::weak_ptr<const Outline>> scaled;
    std::size_t next_sweep = kFewSizes;  ///< sizes at which those that nobody holds are forgotten
};

struct Font::State {
    Budget budget;
    std::string bytes;
    FT_Library library = nullptr;
    FT_Face face = nullptr;
    bool is_symbol = false;  ///< characters are numbered from U+F000
    std::unordered_map<std::uint32_t, Glyph> glyphs;

    State() = default;
    State(const State&) = delete;
    State& operator=(const State&) = delete;
    ~State() {
        if (face != nullptr) FT_Done_Face(face);
        if (library != nullptr) FT_Done_Library(library);
    }
};

Font::Font(std::string name) : name_(std::move(name)), state_(std::make_unique<State>()) {}
Font::~Font() = default;

Result<std::shared_ptr<Font>> Font::open(std::string name, std::string bytes, long face) {
    std::shared_ptr<Font> font(new Font(std::move(name)));
    if (auto started = font->start(std::move(bytes), face); !started)
        return Failure(std::move(started).error());
    return font;
}

Result<void> Font::start(std::string bytes, long face) {
    State& s = *state_;
    s.bytes = std::move(bytes);
    const auto refuse = [&](const std::string& what, std::string hint) {
        return fail(ErrorCode::bad_argument, "the font \"" + name_ + "\" " + what, std::move(hint));
    };
    if (FT_New_Library(&s.budget.memory, &s.library) != 0)
        return refuse("can not be read: there is no memory left", {});
    FT_Add_Default_Modules(s.library);
    for (const char* const unused : kUnused) {
        if (const FT_Module module = FT_Get_Module(s.library, unused); module != nullptr)
            FT_Remove_Module(s.library, module);
    }
    const auto* const data = reinterpret_cast<const FT_Byte*>(s.bytes.data());
    if (FT_New_Memory_Face(s.library, data, static_cast<FT_Long>(s.bytes.size()), face, &s.face) !=
        0) {
        s.face = nullptr;
        return refuse("can not be read: it is damaged, or of a kind that is not known",
                      "give a TrueType or OpenType file: .ttf or .otf");
    }
    if (!FT_IS_SCALABLE(s.face) || s.face->units_per_EM == 0)
        return refuse("has no outlines, only pixels",
                      "give a TrueType or OpenType file: .ttf or .otf");
    if (FT_Select_Charmap(s.face, FT_ENCODING_UNICODE) != 0) {
        s.is_symbol = FT_Select_Charmap(s.face, FT_ENCODING_MS_SYMBOL) == 0;
        if (!s.is_symbol) return refuse("does not say which of its glyphs is which character", {});
    }
    line_height_ = s.face->height > 0 ? static_cast<double>(s.face->height) : 1.2 * em();
    if (const std::uint32_t h = glyph_of(U'H'); h != 0) {
        auto capital = glyph(h);
        if (capital) {
            const Box2 box = curves::box_of((*capital)->outline);
            if (!box.empty()) capital_height_ = box.hi.y;
        }
    }
    const auto* const os2 = static_cast<const TT_OS2*>(FT_Get_Sfnt_Table(s.face, FT_SFNT_OS2));
    if (!(capital_height_ > 0.0) && os2 != nullptr && os2->version != 0xffff && os2->version >= 2)
        capital_height_ = os2->sCapHeight;
    if (!(capital_height_ > 0.0)) capital_height_ = 0.7 * em();
    return {};
}

double Font::em() const { return state_->face->units_per_EM; }

std::uint32_t Font::glyph_of(char32_t character) const {
    const std::uint32_t glyph = FT_Get_Char_Index(state_->face, character);
    if (glyph != 0 || !state_->is_symbol || character > 0xff) return glyph;
    return FT_Get_Char_Index(state_->face, 0xf000 + character);
}

Result<Font::Glyph*> Font::glyph(std::uint32_t index) {
    State& s = *state_;
    const auto [found, is_new] = s.glyphs.try_emplace(index);
    if (!is_new) return &found->second;
    Glyph& glyph = found->second;
    constexpr FT_Int32 kAsDrawn =
        FT_LOAD_NO_SCALE | FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP | FT_LOAD_IGNORE_TRANSFORM;
    if (FT_Load_Glyph(s.face, index, kAsDrawn) != 0 ||
        s.face->glyph->format != FT_GLYPH_FORMAT_OUTLINE) {
        s.glyphs.erase(found);
        return fail(ErrorCode::bad_argument,
                    "the font \"" + name_ + "\" is damaged: its glyph " + std::to_string(index) +
                        " can not be read",
                    "install the font anew, or choose another one");
    }
    FT_Outline& drawn = s.face->glyph->outline;
    FT_Outline_Funcs funcs{&Pen::move, &Pen::line, &Pen::parabola, &Pen::cubic, kShift, 0};
    Pen pen;
    const FT_Error error = FT_Outline_Decompose(&drawn, &funcs, &pen);
    glyph.outline = pen.take();
    if (error != 0) glyph.outline.curves.clear();  // what is no curve shows nothing
    glyph.outline.fill = (drawn.flags & FT_OUTLINE_EVEN_ODD_FILL) != 0 ? curves::Fill::even_odd
                                                                       : curves::Fill::non_zero;
    glyph.advance = static_cast<double>(s.face->glyph->metrics.horiAdvance);
    bytes_ += sizeof(Glyph) + curves::bytes_of(glyph.outline);
    return &glyph;
}

Result<double> Font::advance(std::uint32_t index) {
    auto found = glyph(index);
    if (!found) return Failure(std::move(found).error());
    return (*found)->advance;
}

double Font::kerning(std::uint32_t left, std::uint32_t right) const {
    FT_Vector by{};
    if (!FT_HAS_KERNING(state_->face) ||
        FT_Get_Kerning(state_->face, left, right, FT_KERNING_UNSCALED, &by) != 0) {
        return 0.0;
    }
    return static_cast<double>(by.x);
}

Result<curves::OutlinePtr> Font::outline(std::uint32_t index, double size, bool& is_new) {
    is_new = false;
    auto found = glyph(index);
    if (!found) return Failure(std::move(found).error());
    Glyph& glyph = **found;
    if (glyph.outline.curves.empty()) return curves::OutlinePtr();
    // Sizes that nobody holds any more are forgotten whenever their list has doubled: once for each of them on the average.
    if (glyph.scaled.size() >= glyph.next_sweep) {
        std::erase_if(glyph.scaled, [](const auto& known) { return known.second.expired(); });
        glyph.next_sweep = std::max(kFewSizes, 2 * glyph.scaled.size());
    }
    std::weak_ptr<const Outline>& known = glyph.scaled[size];
    if (curves::OutlinePtr held = known.lock(); held != nullptr) return held;
    Outline scaled = glyph.outline;
    for (Curve& curve : scaled.curves) {
        for (curves::Span2& span : curve.spans) {
            // Divided last, so that capitals are as high as they shall be to the last digit.
            for (double& x : span.x) x = x * size / capital_height_;
            for (double& y : span.y) y = y * size / capital_height_;
        }
    }
    const auto made = std::make_shared<const Outline>(std::move(scaled));
    known = made;
    is_new = true;
    return made;
}

}  // namespace raymo::drawings
