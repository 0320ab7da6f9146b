// Which files a model may import.
#pragma once

#include <string>

#include "raymo/core/result.hpp"

namespace raymo::app {

/// Reads what a model imports: paths are relative to the importing file and, links resolved, must not leave the folder of
/// the main file.
class Imports {
public:
    /// `main` is the main file, or "-": then its folder is the current one.
    explicit Imports(const std::string& main);

    /// `resolved` is the same for every way of naming the same file, and is how messages call it.
    /// Error: io, when the file can not be read or lies outside.
    [[nodiscard]] Result<std::string> load(const std::string& from, const std::string& path,
                                           std::string& resolved) const;

private:
    std::string
        shown_;  ///< the main file's folder as the user wrote it, with a slash; empty for the current one
    std::string root_;  ///< the same without links, from the root; empty when it can not be found
};

}  // namespace raymo::app
