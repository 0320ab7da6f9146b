// Writing PNG [PNG03]: a signature and chunks, of which some hold the rows, deflated by ISA-L.
//
// Speed: ISA-L's first level takes a fifth of the time of zlib's. Rows are told as differences from the row above, as rendered
// pictures change little downwards: that makes files a quarter smaller.
#include "raymo/formats/png.hpp"

#include <isa-l.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string_view>

namespace raymo::formats {
namespace {

constexpr std::uint8_t kUp = 2;  ///< filter: each byte less the one above
constexpr std::uint32_t kLevel = 1;
constexpr std::size_t kMostInChunk = 1U << 30;

void put_number(std::uint8_t* to, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) to[i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

/// Length, name, data, checksum of name and data.
void put_chunk(Bytes& out, std::string_view name, const std::uint8_t* data, std::size_t size) {
    const std::size_t at = out.size();
    out.resize(at + size + 12);
    std::uint8_t* chunk = out.data() + at;
    put_number(chunk, static_cast<std::uint32_t>(size));
    std::memcpy(chunk + 4, name.data(), 4);
    if (size > 0) std::memcpy(chunk + 8, data, size);
    put_number(chunk + 8 + size, crc32_gzip_refl(0, chunk + 4, size + 4));
}

struct Freed {
    void operator()(void* p) const { std::free(p); }
};
using Memory = std::unique_ptr<std::uint8_t, Freed>;
/// Not touched before it is used. Null when there is none.
Memory room(std::size_t size) { return Memory(static_cast<std::uint8_t*>(std::malloc(size))); }

/// The rows of a film as they are deflated: each after the number of its filter.
class Rows {
public:
    explicit Rows(image::Film& film)
        : film_(film), width_(3 * static_cast<std::size_t>(film.width)) {}

    /// False: not enough memory.
    [[nodiscard]] bool filter() { return film_.codes.empty() ? filter_light() : filter_codes(); }
    [[nodiscard]] std::uint8_t* data() const { return out_; }
    [[nodiscard]] std::size_t size() const {
        return (width_ + 1) * static_cast<std::size_t>(film_.height);
    }

private:
    /// In the film's own memory: codes are shorter than its floats, and memory that was never touched before is dear.
    bool filter_light() {
        static_assert(sizeof(float) >=
                      2);  // a row and its filter are no longer than the floats of it
        const Memory codes = room(2 * width_);  // for two rows
        if (!codes) return false;
        out_ = reinterpret_cast<std::uint8_t*>(film_.rgb.data());
        std::uint8_t* above = codes.get();
        std::uint8_t* row = above + width_;
        std::memset(above, 0, width_);
        for (std::size_t y = 0; y < static_cast<std::size_t>(film_.height); ++y) {
            image::to_srgb8(&film_.rgb[y * width_], width_, row);
            put(y, row, above);
            std::swap(row, above);
        }
        return true;
    }
    bool filter_codes() {
        memory_ = room(size());
        if (!memory_) return false;
        out_ = memory_.get();
        const std::uint8_t* row = film_.codes.data();
        std::memcpy(out_ + 1, row, width_);
        *out_ = kUp;
        for (std::size_t y = 1; y < static_cast<std::size_t>(film_.height); ++y, row += width_)
            put(y, row + width_, row);
        return true;
    }
    void put(std::size_t y, const std::uint8_t* row, const std::uint8_t* above) {
        std::uint8_t* out = out_ + y * (width_ + 1);
        *out++ = kUp;
        for (std::size_t i = 0; i < width_; ++i)
            out[i] = static_cast<std::uint8_t>(row[i] - above[i]);
    }

    image::Film& film_;
    std::size_t width_;  ///< of a row of codes
    Memory memory_;
    std::uint8_t* out_ = nullptr;
};

/// Deflates `size` bytes into a stream as zlib has it. False: not enough memory.
bool pack(std::uint8_t* bytes, std::size_t size, Memory& out, std::size_t& count) {
    const Memory scratch = room(ISAL_DEF_LVL1_DEFAULT);
    const auto stream = std::make_unique<isal_zstream>();
    std::size_t most = size / 4 + 4096;
    out = room(most);
    if (!scratch || !out) return false;
    isal_deflate_init(stream.get());
    stream->level = kLevel;
    stream->level_buf = scratch.get();
    stream->level_buf_size = ISAL_DEF_LVL1_DEFAULT;
    stream->gzip_flag = IGZIP_ZLIB;
    stream->end_of_stream = 1;
    stream->flush = NO_FLUSH;
    stream->next_in = bytes;
    stream->avail_in = static_cast<std::uint32_t>(size);
    count = 0;
    for (;;) {
        const std::size_t free = std::min<std::size_t>(most - count, kMostInChunk);
        stream->next_out = out.get() + count;
        stream->avail_out = static_cast<std::uint32_t>(free);
        if (isal_deflate(stream.get()) != COMP_OK) return false;
        count += free - stream->avail_out;
        if (stream->internal_state.state == ZSTATE_END) return true;
        if (count < most) continue;
        most *= 2;
        void* grown = std::realloc(out.get(), most);
        if (grown == nullptr) return false;
        static_cast<void>(out.release());
        out.reset(static_cast<std::uint8_t*>(grown));
    }
}

Failure out_of_memory() {
    return fail(ErrorCode::io, "png: the picture could not be encoded", "try a smaller --size");
}

}  // namespace

Result<Bytes> encode_png(image::Film film) {
    if (film.width <= 0 || film.height <= 0) {
        return fail(ErrorCode::out_of_range, "png: a picture needs at least one pixel");
    }
    if ((film.codes.empty() ? film.rgb.size() : film.codes.size()) != film.components()) {
        return fail(ErrorCode::bad_argument, "png: the picture's pixels do not match its size");
    }
    Rows rows(film);
    if (rows.size() > 0xffffffffU) {
        return fail(ErrorCode::limit, "png: the picture is larger than 4 GiB",
                    "ask for a smaller --size");
    }
    Memory packed;
    std::size_t count = 0;
    if (!rows.filter() || !pack(rows.data(), rows.size(), packed, count)) return out_of_memory();

    Bytes out{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    out.reserve(count + 256);
    std::array<std::uint8_t, 13> header{};  // size; 8 bits, red, green and blue
    put_number(header.data(), static_cast<std::uint32_t>(film.width));
    put_number(header.data() + 4, static_cast<std::uint32_t>(film.height));
    header[8] = 8;
    header[9] = 2;
    put_chunk(out, "IHDR", header.data(), header.size());
    // sRGB, and for readers that do not know it what comes nearest: gamma 1 / 2.2, and its primaries.
    constexpr std::uint8_t kPerceptual = 0;
    put_chunk(out, "sRGB", &kPerceptual, 1);
    std::array<std::uint8_t, 4> gamma;
    put_number(gamma.data(), 45455);
    put_chunk(out, "gAMA", gamma.data(), gamma.size());
    constexpr std::array<std::uint32_t, 8> kPrimaries{31270, 32900, 64000, 33000,
                                                      30000, 60000, 15000, 6000};
    std::array<std::uint8_t, 32> primaries;
    for (std::size_t i = 0; i < 8; ++i) put_number(primaries.data() + 4 * i, kPrimaries[i]);
    put_chunk(out, "cHRM", primaries.data(), primaries.size());
    for (std::size_t at = 0; at < count; at += kMostInChunk)
        put_chunk(out, "IDAT", packed.get() + at, std::min(kMostInChunk, count - at));
    put_chunk(out, "IEND", nullptr, 0);
    return out;
}

}  // namespace raymo::formats
