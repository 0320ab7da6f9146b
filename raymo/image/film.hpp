// A picture: linear light, or what a screen shows of it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "raymo/image/zeroed_memory.hpp"
#include "raymo/math/vec.hpp"

namespace raymo::image {

/// What a film holds of a picture.
enum class Kept : std::uint8_t {
    light,  ///< linear floats, to go on computing with
    codes,  ///< only what a screen shows of it, in a quarter of the memory
};

/// RGB by rows, top row first: linear floats or 8-bit sRGB.
struct Film {
    int width = 0;
    int height = 0;
    std::vector<float, Zeroed<float>> rgb;                    ///< empty where codes are kept
    std::vector<std::uint8_t, Zeroed<std::uint8_t>> codes{};  ///< empty where light is kept

    Film() = default;
    Film(int w, int h, Kept kept = Kept::light)
        : width(w),
          height(h),
          rgb(kept == Kept::light ? components() : 0),
          codes(kept == Kept::codes ? components() : 0) {}
    /// Of all pixels together.
    [[nodiscard]] std::size_t components() const {
        return 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    }
    /// `count` pixels of linear light from (x, y) to the right, three floats each. For both kinds.
    void put(int x, int y, const float* linear, std::size_t count);

    // The others are for a film that keeps light.

    void set(int x, int y, Vec3 colour) {
        set(static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                static_cast<std::size_t>(x),
            colour);
    }
    /// By number, row by row.
    void set(std::size_t pixel, Vec3 colour) {
        float* p = &rgb[3 * pixel];
        p[0] = static_cast<float>(colour.x);
        p[1] = static_cast<float>(colour.y);
        p[2] = static_cast<float>(colour.z);
    }
    [[nodiscard]] Vec3 at(int x, int y) const {
        const float* p = &rgb[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                   static_cast<std::size_t>(x))];
        return {p[0], p[1], p[2]};
    }
};

/// 8-bit sRGB of a film that keeps light, by rows; values are clipped to 0..1 and rounded to nearest.
[[nodiscard]] std::vector<std::uint8_t> to_srgb8(const Film& film);
/// The same for `count` components, so that a picture can be encoded row by row. Not a number
/// becomes 0.
void to_srgb8(const float* linear, std::size_t count, std::uint8_t* out);

}  // namespace raymo::image
