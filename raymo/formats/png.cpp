// Writing PNG with libpng.
//
// Speed: rows are not predicted, and deflated at the first level. On rendered pictures this takes half the time of the
// usual settings, and backdrops in flat bands make the files about as small.
//
// libpng reports errors by longjmp. All of its calls stand in one function that holds nothing with
// a destructor, so that jumping out of it skips none.
#include "raymo/formats/png.hpp"

#include <png.h>

#include <csetjmp>
#include <cstdlib>
#include <cstring>

namespace raymo::formats {
namespace {

/// Where the bytes go. Grows with malloc so that running out of memory is an answer, not an
/// exception.
struct Sink {
    unsigned char* bytes = nullptr;
    std::size_t size = 0;
    std::size_t capacity = 0;

    Sink() = default;
    Sink(const Sink&) = delete;
    Sink& operator=(const Sink&) = delete;
    ~Sink() { std::free(bytes); }

    bool append(const unsigned char* data, std::size_t count) {
        if (size + count > capacity) {
            std::size_t wanted = capacity < 4096 ? 65536 : capacity * 2;
            if (wanted < size + count) wanted = size + count;
            void* grown = std::realloc(bytes, wanted);
            if (grown == nullptr) return false;
            bytes = static_cast<unsigned char*>(grown);
            capacity = wanted;
        }
        std::memcpy(bytes + size, data, count);
        size += count;
        return true;
    }
};

void on_write(png_structp png, png_bytep data, png_size_t count) {
    auto* sink = static_cast<Sink*>(png_get_io_ptr(png));
    if (!sink->append(data, count)) png_error(png, "out of memory");
}
void on_flush(png_structp) {}
// libpng prints by itself otherwise.
void on_error(png_structp png, png_const_charp) { png_longjmp(png, 1); }
void on_warning(png_structp, png_const_charp) {}

/// `row` holds one encoded row. Everything the jump could leave half done belongs to `png`, which
/// the caller destroys.
bool write_picture(png_structp png, png_infop info, const image::Film& film, png_bytep row,
                   Sink* sink) {
    if (setjmp(png_jmpbuf(png)) != 0) return false;
    png_set_write_fn(png, sink, on_write, on_flush);
    png_set_IHDR(png, info, static_cast<png_uint_32>(film.width),
                 static_cast<png_uint_32>(film.height), 8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_NONE);
    png_set_compression_level(png, 1);
    png_set_compression_buffer_size(png, 65536);
    png_write_info(png, info);
    const std::size_t components = 3 * static_cast<std::size_t>(film.width);
    for (int y = 0; y < film.height; ++y) {
        image::to_srgb8(&film.rgb[static_cast<std::size_t>(y) * components], components, row);
        png_write_row(png, row);
    }
    png_write_end(png, nullptr);
    return true;
}

Failure out_of_memory() {
    return fail(ErrorCode::io, "png: the picture could not be encoded", "try a smaller --size");
}

}  // namespace

Result<Bytes> encode_png(const image::Film& film) {
    if (film.width <= 0 || film.height <= 0) {
        return fail(ErrorCode::out_of_range, "png: a picture needs at least one pixel");
    }
    const std::size_t components = 3 * static_cast<std::size_t>(film.width);
    if (film.rgb.size() != components * static_cast<std::size_t>(film.height)) {
        return fail(ErrorCode::bad_argument, "png: the picture's pixels do not match its size");
    }
    auto* row = static_cast<png_bytep>(std::malloc(components));
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, on_error, on_warning);
    png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
    Sink sink;
    const bool good =
        row != nullptr && info != nullptr && write_picture(png, info, film, row, &sink);
    png_destroy_write_struct(&png, &info);
    std::free(row);
    if (!good) return out_of_memory();
    return Bytes(sink.bytes, sink.bytes + sink.size);
}

}  // namespace raymo::formats
