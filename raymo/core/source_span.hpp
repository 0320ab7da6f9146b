// Where in the program text something stands.
#pragma once

#include <cstdint>

namespace raymo {

/// A half-open range of bytes in one source file. `file` is an index into the list of loaded files (sml::SourceMap);
/// kNoFile means "made by the program itself, not by a text".
struct SourceSpan {
    static constexpr std::uint32_t kNoFile = 0xffffffffU;

    std::uint32_t file = kNoFile;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;

    [[nodiscard]] constexpr bool known() const { return file != kNoFile; }
    friend constexpr bool operator==(const SourceSpan&, const SourceSpan&) = default;
};

}  // namespace raymo
