// Fonts of the package fonts-dejavu-core, for tests.
#pragma once

#include <fstream>
#include <iterator>
#include <string>

namespace raymo::drawings {

/// A whole file; empty when it is not there.
inline std::string file(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline std::string dejavu(const std::string& face = "DejaVuSans") {
    return file("/usr/share/fonts/truetype/dejavu/" + face + ".ttf");
}

}  // namespace raymo::drawings
