// A picture in linear light.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "raymo/image/zeroed_memory.hpp"
#include "raymo/math/vec.hpp"

namespace raymo::image {

/// Linear RGB floats by rows, top row first.
struct Film {
    int width = 0;
    int height = 0;
    std::vector<float, Zeroed<float>> rgb;

    Film() = default;
    Film(int w, int h)
        : width(w), height(h), rgb(3 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
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

/// 8-bit sRGB by rows, top row first; values are clipped to 0..1 and rounded to nearest.
[[nodiscard]] std::vector<std::uint8_t> to_srgb8(const Film& film);
/// The same for `count` components, so that a picture can be encoded row by row. Not a number
/// becomes 0.
void to_srgb8(const float* linear, std::size_t count, std::uint8_t* out);

}  // namespace raymo::image
