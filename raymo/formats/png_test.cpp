#include "raymo/formats/png.hpp"

#include <doctest/doctest.h>
#include <png.h>

#include <cmath>
#include <cstring>
#include <string>

using namespace raymo;

namespace {

image::Film ramp(int w, int h) {
    image::Film film(w, h);
    for (int y = 0; y < h; ++y) {
        for (int x = 0; x < w; ++x) {
            film.set(x, y, {(x + 0.5) / w, (y + 0.5) / h, 0.5 + 0.5 * std::sin(0.05 * x * y)});
        }
    }
    return film;
}

std::vector<std::uint8_t> decode(const formats::Bytes& bytes, int& width, int& height) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    REQUIRE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) != 0);
    image.format = PNG_FORMAT_RGB;
    std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(image));
    REQUIRE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr) != 0);
    width = static_cast<int>(image.width);
    height = static_cast<int>(image.height);
    return pixels;
}

}  // namespace

TEST_CASE("png: what is written reads back to the same pixels") {
    for (const auto& [w, h] : {std::pair{1, 1}, {7, 3}, {321, 123}, {1, 500}, {4001, 2}}) {
        const image::Film film = ramp(w, h);
        const auto bytes = formats::encode_png(film);
        REQUIRE(bytes.has_value());
        int width = 0;
        int height = 0;
        CHECK(decode(*bytes, width, height) == image::to_srgb8(film));
        CHECK(width == w);
        CHECK(height == h);
    }
}

TEST_CASE("png: a film of codes gives the same file as one of light") {
    for (const auto& [w, h] : {std::pair{1, 1}, {7, 3}, {321, 123}, {1, 500}}) {
        const image::Film light = ramp(w, h);
        image::Film codes(w, h, image::Kept::codes);
        for (int y = 0; y < h; ++y) {
            codes.put(0, y,
                      &light.rgb[3 * static_cast<std::size_t>(y) * static_cast<std::size_t>(w)],
                      static_cast<std::size_t>(w));
        }
        const auto a = formats::encode_png(light);
        const auto b = formats::encode_png(codes);
        REQUIRE(a.has_value());
        REQUIRE(b.has_value());
        CHECK(*a == *b);
    }
}

TEST_CASE("png: the file says that it is sRGB") {
    const auto bytes = formats::encode_png(ramp(8, 8));
    REQUIRE(bytes.has_value());
    const std::string text(bytes->begin(), bytes->end());
    CHECK(text.find("sRGB") != std::string::npos);
    CHECK(text.substr(1, 3) == "PNG");
}

TEST_CASE("png: a film that is no picture is an error") {
    CHECK_FALSE(formats::encode_png(image::Film{}).has_value());
    image::Film broken(4, 4);
    broken.rgb.pop_back();
    image::Film short_of_codes(4, 4, image::Kept::codes);
    short_of_codes.codes.pop_back();
    for (const image::Film& film : {broken, short_of_codes}) {
        const auto answer = formats::encode_png(film);
        REQUIRE_FALSE(answer.has_value());
        CHECK(answer.error().code == ErrorCode::bad_argument);
    }
}
