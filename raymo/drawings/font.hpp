// Fonts: the outlines of letters as exact curves, and how far they stand apart.
//
// TrueType letters are bounded by parabolas, those of PostScript and OpenType/CFF by cubics; FreeType reads both, and gives
// their control points in the whole numbers in which the font was drawn, 1000 or 2048 to the em. They are kept as they are:
// nothing is hinted, rounded to pixels or flattened.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "raymo/core/result.hpp"
#include "raymo/curves/outline.hpp"

namespace raymo::drawings {

/// One face of a font file. For one thread at a time.
class Font {
public:
    /// `bytes`: a TrueType, OpenType, Type 1 or WOFF file, which may be anything: what FreeType makes of it takes 256 MiB at
    /// most. `face` counts the faces of a collection, from 0. `name` is for messages.
    /// Error: bad_argument when the bytes are no such font.
    [[nodiscard]] static Result<std::shared_ptr<Font>> open(std::string name, std::string bytes,
                                                            long face = 0);
    ~Font();
    Font(const Font&) = delete;
    Font& operator=(const Font&) = delete;

    [[nodiscard]] const std::string& name() const { return name_; }

    // ---- In units of the font, y upwards from the base line

    /// Units to the em.
    [[nodiscard]] double em() const;
    /// Height of the capital H; of a font without one what it says of itself, else 0.7 em. Greater than 0.
    [[nodiscard]] double capital_height() const { return capital_height_; }
    /// From one base line to the next. Greater than 0.
    [[nodiscard]] double line_height() const { return line_height_; }

    /// The glyph of a character; 0 when the font has none.
    [[nodiscard]] std::uint32_t glyph_of(char32_t character) const;
    /// How far the next glyph stands from this one. Error: the font is damaged.
    [[nodiscard]] Result<double> advance(std::uint32_t glyph);
    /// What is added between these two: mostly 0 or less. Fonts without a table `kern` have none.
    [[nodiscard]] double kerning(std::uint32_t left, std::uint32_t right) const;

    // ---- In millimetres

    /// The curves of a glyph with the pen at the origin, where capitals are `size` high; null for one that shows nothing, as
    /// that of a space. Whoever asks for the same while it is held gets the same; `is_new` says that it was made now.
    /// Error: the font is damaged. Cost: some 5 us, next time 0.1 us.
    [[nodiscard]] Result<curves::OutlinePtr> outline(std::uint32_t glyph, double size,
                                                     bool& is_new);

    /// Memory that the glyphs read so far take.
    [[nodiscard]] double bytes() const { return bytes_; }

private:
    struct State;
    explicit Font(std::string name);
    [[nodiscard]] Result<void> start(std::string bytes, long face);
    /// Advance and curves of a glyph, read once.
    struct Glyph;
    [[nodiscard]] Result<Glyph*> glyph(std::uint32_t index);

    std::string name_;
    std::unique_ptr<State> state_;
    double capital_height_ = 0.0;
    double line_height_ = 0.0;
    double bytes_ = 0.0;
};

using FontPtr = std::shared_ptr<Font>;

}  // namespace raymo::drawings
