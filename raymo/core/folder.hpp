// Paths of files.
#pragma once

#include <string>

namespace raymo {

/// "models/" of "models/cup.raymo"; empty for a plain name.
[[nodiscard]] inline std::string folder_of(const std::string& path) {
    return path.substr(0, path.rfind('/') + 1);  // npos + 1 is 0
}

}  // namespace raymo
