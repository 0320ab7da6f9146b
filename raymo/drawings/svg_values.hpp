// What attributes of SVG hold: numbers, lengths and transformations [SVG11 4.2, 7.6, 7.10].
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "raymo/math/vec2.hpp"

namespace raymo::drawings {

/// What is wrong with a value, and at which of its bytes.
struct Misfit {
    std::size_t at = 0;
    std::string what;
};
template <class T>
using Read = tl::expected<T, Misfit>;

/// White space of XML and CSS.
[[nodiscard]] bool is_space(char c);

/// A value as a message shows it: its first `most` bytes at most, in whole characters, then "..." where more follows; white
/// space is blanks.
[[nodiscard]] std::string shortened(std::string_view text, std::size_t most);

/// Reads a value from its beginning to its end.
class Scanner {
public:
    explicit Scanner(std::string_view text) : text_(text) {}

    [[nodiscard]] std::size_t at() const { return at_; }
    [[nodiscard]] bool is_done() const { return at_ >= text_.size(); }
    /// The next byte; 0 at the end.
    [[nodiscard]] char peek() const { return is_done() ? '\0' : text_[at_]; }
    void skip(std::size_t bytes = 1) { at_ = std::min(at_ + bytes, text_.size()); }
    void skip_spaces();
    /// White space with at most one comma in it; true when there was a comma.
    bool skip_comma();
    /// Letters, as far as they go.
    std::string_view word();
    [[nodiscard]] bool is_at_number() const;
    /// A finite number: 1, -.5, +1e-3.
    Read<double> number();
    /// 0 or 1, which may touch what follows.
    Read<bool> flag();
    /// A misfit here: "`what`, not `...`".
    [[nodiscard]] tl::unexpected<Misfit> expected(std::string_view what) const;

private:
    std::string_view text_;
    std::size_t at_ = 0;
};

/// A length, or a part of the viewport.
struct Length {
    double value = 0.0;
    double unit = 25.4 / 96.0;  ///< [mm]; 0: a part, and the value is of 1

    [[nodiscard]] bool is_part() const { return unit == 0.0; }
    [[nodiscard]] double millimetres() const { return value * unit; }
    /// In px, of which 96 are an inch.
    [[nodiscard]] double of(double whole) const {
        return is_part() ? value * whole : unit == kPixel ? value : value * (unit / kPixel);
    }
    static constexpr double kPixel = 25.4 / 96.0;  ///< [mm]
};
/// Units: px (or none), mm, cm, in, pt, pc, Q, %.
[[nodiscard]] Read<Length> read_length(std::string_view text);

/// What `viewBox` says.
struct ViewBox {
    double x = 0.0, y = 0.0, width = 0.0, height = 0.0;
};
[[nodiscard]] Read<ViewBox> read_view_box(std::string_view text);

/// What `preserveAspectRatio` says: how a view box lies in a viewport of another shape.
struct Aspect {
    bool is_free = false;  ///< stretched
    bool covers = false;   ///< as large as to cover the viewport, not to fit in it
    double x = 0.5, y = 0.5;
};
[[nodiscard]] Read<Aspect> read_aspect(std::string_view text);

/// A list of matrix, translate, scale, rotate, skewX, skewY; the first is applied last.
[[nodiscard]] Read<Affine2> read_transform(std::string_view text);

/// p -> a(b(p)).
[[nodiscard]] constexpr Affine2 operator*(const Affine2& a, const Affine2& b) {
    const Vec2 offset = a({b.x, b.y});
    return {a.xx * b.xx + a.xy * b.yx, a.xx * b.xy + a.xy * b.yy, offset.x,
            a.yx * b.xx + a.yy * b.yx, a.yx * b.xy + a.yy * b.yy, offset.y};
}

}  // namespace raymo::drawings
