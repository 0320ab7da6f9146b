#include "apps/raymo/imports.hpp"

#include <sys/stat.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "apps/raymo/system/files.hpp"
#include "apps/raymo/text.hpp"
#include "raymo/core/folder.hpp"

namespace raymo::app {
namespace {

std::string without_links(const std::string& path) {
    const std::unique_ptr<char, decltype(&std::free)> real(realpath(path.c_str(), nullptr),
                                                           &std::free);
    return real ? std::string(real.get()) : std::string();
}

std::string with_slash(const std::string& path) { return path.ends_with('/') ? path : path + '/'; }

}  // namespace

Imports::Imports(const std::string& main) {
    if (main != "-") shown_ = folder_of(main);
    root_ = without_links(shown_.empty() ? "." : shown_);
    if (!root_.empty() && root_.back() != '/') root_ += '/';
}

Result<std::string> Imports::load(const std::string& from, const std::string& path,
                                  std::string& resolved) const {
    const std::string name = path.starts_with('/') ? path : folder_of(from) + path;
    if (name.find('\0') != std::string::npos)
        return fail(ErrorCode::io, "a path can not hold a zero byte");
    resolved = without_links(name);
    if (resolved.empty()) {
        return fail(ErrorCode::io, "can not read " + in_quotes(name) + ": " + std::strerror(errno));
    }
    const bool is_root = resolved + "/" == root_;
    if (root_.empty() || (!is_root && !resolved.starts_with(root_))) {
        return fail(ErrorCode::io, in_quotes(path) + " lies outside of the folder of the main file",
                    "move the file into that folder");
    }
    if (struct stat info{}; stat(resolved.c_str(), &info) == 0 && S_ISDIR(info.st_mode)) {
        return fail(ErrorCode::io, in_quotes(path) + " is a folder, not a file",
                    "name a file in it: \"" + with_slash(path) + "...\"");
    }
    Attempt<std::string> text = read_regular(resolved);
    if (!text) return fail(ErrorCode::io, text.error().message, text.error().hint);
    resolved = shown_ + resolved.substr(root_.size());
    return *std::move(text);
}

}  // namespace raymo::app
