// PNG, as bytes in memory.
#pragma once

#include <cstdint>
#include <vector>

#include "raymo/core/result.hpp"
#include "raymo/image/film.hpp"

namespace raymo::formats {

using Bytes = std::vector<std::uint8_t>;

/// 8-bit sRGB PNG of a film of either kind. The film is used up: move it in where it is not needed again. Errors:
/// out_of_range for a film without pixels, bad_argument for one whose size is not that of its pixels, limit beyond 4 GiB, io
/// when memory does not suffice.
[[nodiscard]] Result<Bytes> encode_png(image::Film film);

}  // namespace raymo::formats
