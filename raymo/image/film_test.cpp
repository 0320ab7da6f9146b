#include "raymo/image/film.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "raymo/image/zeroed_memory.hpp"

using namespace raymo;
using image::Film;

namespace {

std::uint8_t encoded(float x) {
    std::uint8_t code = 0;
    image::to_srgb8(&x, 1, &code);
    return code;
}

/// The definition of IEC 61966-2-1, in long double.
int expected(float x) {
    if (!(x > 0.0F)) return 0;
    if (x >= 1.0F) return 255;
    const long double l = x;
    const long double s = l <= 0.0031308L ? 12.92L * l : 1.055L * std::pow(l, 1.0L / 2.4L) - 0.055L;
    return static_cast<int>(std::floor(255.0L * s + 0.5L));
}

}  // namespace

TEST_CASE("zeroed memory: blocks of all sizes come filled with zeros, and are given back") {
    for (const std::size_t bytes :
         {std::size_t{12}, std::size_t{1} << 20U, (std::size_t{2} << 20U) - 1,
          std::size_t{2} << 20U, (std::size_t{5} << 20U) + 3}) {
        CAPTURE(bytes);
        for (int turn = 0; turn < 3; ++turn) {
            std::vector<char*> blocks(8);
            for (char*& block : blocks) {
                block = static_cast<char*>(image::allocate_zeroed(bytes));
                REQUIRE(block != nullptr);
                CHECK(std::all_of(block, block + bytes, [](char c) { return c == 0; }));
                std::fill(block, block + bytes, 'a');
            }
            for (char* block : blocks) image::free_zeroed(block, bytes);
        }
    }
}

TEST_CASE("film: every 8-bit sRGB code decodes and encodes to itself") {
    for (int c = 0; c < 256; ++c) {
        const double s = c / 255.0;
        const double x = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
        CHECK(encoded(static_cast<float>(x)) == c);
    }
}

TEST_CASE("film: encoding is rounded correctly everywhere") {
    // All thresholds with their neighbouring floats, and a dense walk over all magnitudes.
    int wrong = 0;
    for (int c = 0; c < 255; ++c) {
        const long double s = (c + 0.5L) / 255.0L;
        const long double x = s <= 0.04045L ? s / 12.92L : std::pow((s + 0.055L) / 1.055L, 2.4L);
        float f = static_cast<float>(x);
        for (int i = 0; i < 4; ++i) f = std::nextafter(f, 0.0F);
        for (int i = 0; i < 9; ++i, f = std::nextafter(f, 2.0F)) {
            const int code = static_cast<long double>(f) >= x ? c + 1 : c;
            wrong += encoded(f) != code;
        }
    }
    CHECK(wrong == 0);
    for (float x = 0x1p-20F; x < 1.5F; x *= 1.0003F) wrong += encoded(x) != expected(x);
    CHECK(wrong == 0);
}

TEST_CASE("film: what is out of range or no number at all is clipped") {
    CHECK(encoded(-1.0F) == 0);
    CHECK(encoded(0.0F) == 0);
    CHECK(encoded(1.0F) == 255);
    CHECK(encoded(1e30F) == 255);
    CHECK(encoded(std::numeric_limits<float>::infinity()) == 255);
    CHECK(encoded(-std::numeric_limits<float>::infinity()) == 0);
    CHECK(encoded(std::numeric_limits<float>::quiet_NaN()) == 0);
    CHECK(encoded(std::numeric_limits<float>::denorm_min()) == 0);
}

TEST_CASE("film: rows go from the top, pixels from the left") {
    Film film(3, 2);
    film.set(2, 0, {1, 0, 0});
    film.set(0, 1, {0, 1, 0});
    const auto codes = image::to_srgb8(film);
    REQUIRE(codes.size() == 18);
    CHECK(codes[6] == 255);
    CHECK(codes[9 + 1] == 255);
    CHECK(film.at(2, 0) == Vec3{1, 0, 0});
}

TEST_CASE("film: begins black, whatever its memory was used for") {
    for (const int width : {1, 291, 292, 600, 800}) {  // below and above 2 MiB
        for (int turn = 0; turn < 2; ++turn) {
            Film film(width, 600);
            CHECK(std::all_of(film.rgb.begin(), film.rgb.end(), [](float x) { return x == 0.0F; }));
            std::fill(film.rgb.begin(), film.rgb.end(), 1.0F);
            const Film moved = std::move(film);
            CHECK(moved.at(width - 1, 599) == Vec3{1, 1, 1});
        }
    }
}

TEST_CASE("film: codes are those of the light that is put there") {
    const int width = 37;
    const int height = 5;
    Film light(width, height);
    Film codes(width, height, image::Kept::codes);
    CHECK(codes.rgb.empty());
    CHECK(codes.codes.size() == codes.components());
    std::vector<float> row(3 * width);
    for (int y = 0; y < height; ++y) {
        for (std::size_t i = 0; i < row.size(); ++i)
            row[i] =
                static_cast<float>(std::fmod(0.37 * static_cast<double>(i + 1) * (y + 1), 1.2));
        // In two parts, the second from the middle of the row on.
        for (Film* film : {&light, &codes}) {
            film->put(0, y, row.data(), 20);
            film->put(20, y, row.data() + 60, static_cast<std::size_t>(width - 20));
        }
    }
    CHECK(light.codes.empty());
    CHECK(light.at(36, 4).z == static_cast<double>(row.back()));
    const auto expected_codes = image::to_srgb8(light);
    CHECK(std::equal(codes.codes.begin(), codes.codes.end(), expected_codes.begin(),
                     expected_codes.end()));
}
