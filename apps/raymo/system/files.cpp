#include "apps/raymo/system/files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "apps/raymo/system/interrupt.hpp"
#include "apps/raymo/text.hpp"
#include "raymo/core/folder.hpp"
#include "raymo/sml/sml.hpp"

namespace raymo::app {
namespace {

class Descriptor {
public:
    explicit Descriptor(int descriptor) : descriptor_(descriptor) {}
    ~Descriptor() {
        if (descriptor_ >= 0) close(descriptor_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    [[nodiscard]] int get() const { return descriptor_; }

private:
    int descriptor_;
};

tl::unexpected<Trouble> can_not(std::string_view what, const std::string& path, int error) {
    return trouble(kFileTrouble, "can not " + std::string(what) + " " + in_quotes(path) + ": " +
                                     std::strerror(error));
}

/// With its closing '/'.
std::string existing_folder_of(const std::string& path) {
    const std::string folder = folder_of(path);
    return folder.empty() ? "./" : folder;
}

/// The file behind symbolic links; the path itself when there is none yet.
std::string behind_links(const std::string& path) {
    const std::unique_ptr<char, decltype(&std::free)> real(realpath(path.c_str(), nullptr),
                                                           &std::free);
    return real ? std::string(real.get()) : path;
}

int write_bytes(int descriptor, std::span<const std::uint8_t> bytes) {
    while (!bytes.empty()) {
        if (interrupted()) return EINTR;
        const ssize_t n =
            ::write(descriptor, bytes.data(), std::min<std::size_t>(bytes.size(), 1U << 22));
        if (n < 0 && errno != EINTR) return errno;
        if (n > 0) bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
    return 0;
}

/// All that can be read from a file that is open. `must_be_regular`: nothing else is read.
Attempt<std::string> read_all(const Descriptor& file, const std::string& name,
                              bool must_be_regular) {
    if (file.get() < 0) return can_not("read", name, errno);
    struct stat info {};
    if (fstat(file.get(), &info) != 0) {
        if (must_be_regular) return can_not("read", name, errno);
    } else if (S_ISDIR(info.st_mode)) {
        return can_not("read", name, EISDIR);
    } else if (must_be_regular && !S_ISREG(info.st_mode)) {
        return trouble(kFileTrouble, "can not read " + in_quotes(name) + ": it is no file, but " +
                                         (S_ISFIFO(info.st_mode) ? "a pipe" : "a device"));
    }
    const auto too_long = [&] {
        return trouble(kModelWrong, in_quotes(name) + " is longer than " +
                                        std::to_string(sml::kMaxTextBytes >> 20) +
                                        " MiB, the limit of a program's text and of what it reads");
    };
    if (S_ISREG(info.st_mode) && info.st_size > static_cast<off_t>(sml::kMaxTextBytes))
        return too_long();
    std::string text;
    if (S_ISREG(info.st_mode)) text.reserve(static_cast<std::size_t>(info.st_size));
    std::vector<char> buffer(1U << 16);
    while (true) {
        const ssize_t got = read(file.get(), buffer.data(), buffer.size());
        if (got == 0) return text;
        if (got < 0) {
            if (errno == EINTR && !interrupted()) continue;
            if (interrupted()) return trouble(kInterrupted, "interrupted");
            return can_not("read", name, errno);
        }
        text.append(buffer.data(), static_cast<std::size_t>(got));
        if (text.size() > sml::kMaxTextBytes) return too_long();
    }
}

}  // namespace

Attempt<std::string> read_text(const std::string& path, const Console& console) {
    const bool standard = path == "-";
    const Descriptor file(standard ? dup(console.input())
                                   : open(path.c_str(), O_RDONLY | O_CLOEXEC));
    return read_all(file, standard ? "standard input" : path, false);
}

Attempt<std::string> read_regular(const std::string& path) {
    // Opening a pipe waits for a writer otherwise.
    const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    return read_all(file, path, true);
}

Outputs::~Outputs() {
    for (const Prepared& p : prepared_) {
        if (p.temporary.empty()) continue;
        unlink(p.temporary.c_str());
        unguard_file(p.temporary);
    }
}

Attempt<void> Outputs::check(const std::string& path) {
    if (path == "-") return {};
    const std::string target = behind_links(path);
    struct stat info {};
    if (stat(target.c_str(), &info) == 0) {
        if (S_ISDIR(info.st_mode)) return can_not("write", path, EISDIR);
        if (access(target.c_str(), W_OK) != 0) return can_not("write", path, errno);
        if (!S_ISREG(info.st_mode)) return {};
    } else if (errno != ENOENT) {
        return can_not("write", path, errno);
    }
    const std::string folder = existing_folder_of(target);
    if (stat(folder.c_str(), &info) != 0) return can_not("write", path, errno);
    if (!S_ISDIR(info.st_mode)) return can_not("write", path, ENOTDIR);
    if (access(folder.c_str(), W_OK | X_OK) != 0) return can_not("write", path, errno);
    return {};
}

Attempt<void> Outputs::prepare(const std::string& path, std::span<const std::uint8_t> bytes) {
    Prepared p{path, behind_links(path), {}, bytes};
    struct stat info {};
    const bool exists = path != "-" && stat(p.target.c_str(), &info) == 0;
    if (path == "-" || (exists && !S_ISREG(info.st_mode))) {
        prepared_.push_back(std::move(p));
        return {};
    }
    std::string name = existing_folder_of(p.target) + ".raymo-XXXXXX";
    const Descriptor file(mkostemp(name.data(), O_CLOEXEC));
    if (file.get() < 0) return can_not("write", path, errno);
    guard_file(name);
    p.temporary = name;
    prepared_.push_back(std::move(p));
    const mode_t mask = umask(0);
    umask(mask);
    const mode_t mode = exists ? (info.st_mode & 07777U) : (0666U & ~mask);
    if (fchmod(file.get(), mode) != 0) return can_not("write", path, errno);
    if (const int error = write_bytes(file.get(), bytes); error != 0) {
        if (interrupted()) return trouble(kInterrupted, "interrupted");
        return can_not("write", path, error);
    }
    return {};
}

Attempt<void> Outputs::commit() {
    if (interrupted()) return trouble(kInterrupted, "interrupted");
    for (Prepared& p : prepared_) {
        if (p.temporary.empty()) continue;
        if (rename(p.temporary.c_str(), p.target.c_str()) != 0)
            return can_not("write", p.path, errno);
        unguard_file(p.temporary);
        p.temporary.clear();
        p.bytes = {};
    }
    for (const Prepared& p : prepared_) {
        if (p.bytes.empty()) continue;
        if (p.path == "-") {
            console_.out.write({reinterpret_cast<const char*>(p.bytes.data()), p.bytes.size()});
            continue;
        }
        const Descriptor file(open(p.target.c_str(), O_WRONLY | O_CLOEXEC));
        if (file.get() < 0) return can_not("write", p.path, errno);
        if (const int error = write_bytes(file.get(), p.bytes); error != 0) {
            return can_not("write", p.path, error);
        }
    }
    prepared_.clear();
    return {};
}

std::string with_suffix(std::string_view path, std::string_view suffix) {
    const std::size_t slash = path.rfind('/');
    std::string_view name = slash == std::string_view::npos ? path : path.substr(slash + 1);
    const std::size_t dot = name.rfind('.');
    if (dot != std::string_view::npos && dot > 0) name = name.substr(0, dot);
    return std::string(name) + std::string(suffix);
}

std::string suffix_of(std::string_view path) {
    const std::size_t slash = path.rfind('/');
    const std::string_view name = slash == std::string_view::npos ? path : path.substr(slash + 1);
    const std::size_t dot = name.rfind('.');
    if (dot == std::string_view::npos || dot == 0) return {};
    std::string suffix(name.substr(dot));
    for (char& c : suffix) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return suffix;
}

}  // namespace raymo::app
