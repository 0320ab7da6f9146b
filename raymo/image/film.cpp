// From linear light to 8-bit sRGB, correctly rounded and by table.
//
// Code c is right for x where  decode((c - 1/2) / 255) <= x < decode((c + 1/2) / 255). These 255
// thresholds, rounded up to floats, decide exactly: x gets code c + 1 rather than c when x >=
// threshold[c]. To find c, floats from 2^-13 up to 1 are put in classes by their exponent and their
// first 8 bits of fraction. Within a class x grows by less than 2^-8 of itself, while neighbouring
// thresholds differ by more than 2.2 / 256 of themselves (decoding is at most a power 2.4 of the
// code, and c <= 255), so a class holds at most one threshold.
#include "raymo/image/film.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace raymo::image {
namespace {

constexpr std::uint32_t kFirst = (127U - 13U) << 8U;  ///< class of 2^-13; below it every code is 0
constexpr float kDarkest = 0x1p-13F;
constexpr float kBrightest = 0x1.fffffep-1F;   ///< the last float before 1
constexpr std::uint32_t kClasses = 13U << 8U;  ///< up to 1

class Encoder {
public:
    Encoder() {
        for (std::size_t c = 0; c < 255; ++c) {
            const double s = (static_cast<double>(c) + 0.5) / 255.0;
            const double x = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
            const auto f = static_cast<float>(x);
            threshold_[c] = static_cast<double>(f) < x ? std::nextafter(f, 2.0F) : f;
        }
        threshold_[255] = std::numeric_limits<float>::infinity();
        std::size_t c = 0;
        for (std::uint32_t i = 0; i < kClasses; ++i) {
            const float start = std::bit_cast<float>((kFirst + i) << 15U);
            while (start >= threshold_[c]) ++c;
            code_[i] = static_cast<std::uint8_t>(c);
        }
    }

    [[nodiscard]] std::uint8_t operator()(float x) const {
        // What is too dark or too bright is brought to the end of the table; so is what is no number, to the dark end.
        const float low = x > kDarkest ? x : kDarkest;
        const float in = low < kBrightest ? low : kBrightest;
        const std::uint8_t c = code_[(std::bit_cast<std::uint32_t>(in) >> 15U) - kFirst];
        return static_cast<std::uint8_t>(c + (in >= threshold_[c] ? 1 : 0));
    }

private:
    std::array<float, 256> threshold_{};
    std::array<std::uint8_t, kClasses> code_{};
};

}  // namespace

void Film::put(int x, int y, const float* linear, std::size_t count) {
    const std::size_t at = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                static_cast<std::size_t>(x));
    if (codes.empty()) {
        std::copy(linear, linear + 3 * count, rgb.data() + at);
    } else {
        to_srgb8(linear, 3 * count, codes.data() + at);
    }
}

void to_srgb8(const float* linear, std::size_t count, std::uint8_t* out) {
    static const Encoder kEncoder;
    const Encoder& encode = kEncoder;
    constexpr std::size_t kPixel = 3;
    std::array<std::uint8_t, kPixel> codes{};  // of the pixel before
    std::size_t i = 0;
    for (; i + kPixel <= count; i += kPixel) {
        // Backdrops and plain surfaces go on from pixel to pixel.
        if (i == 0 || std::memcmp(linear + i, linear + i - kPixel, kPixel * sizeof *linear) != 0) {
            for (std::size_t k = 0; k < kPixel; ++k) codes[k] = encode(linear[i + k]);
        }
        std::copy(codes.begin(), codes.end(), out + i);
    }
    for (; i < count; ++i) out[i] = encode(linear[i]);
}

std::vector<std::uint8_t> to_srgb8(const Film& film) {
    std::vector<std::uint8_t> codes(film.rgb.size());
    to_srgb8(film.rgb.data(), film.rgb.size(), codes.data());
    return codes;
}

}  // namespace raymo::image
