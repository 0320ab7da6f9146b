#include "apps/raymo/system/console.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "apps/raymo/system/interrupt.hpp"

namespace raymo::app {
namespace {

constexpr std::size_t kBuffer = 1U << 16;
constexpr std::size_t kLongestLine = 1U << 20;

/// 0 or errno.
int write_all(int descriptor, std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(descriptor, text.data(), text.size());
        if (written < 0) {
            if (errno == EINTR && !interrupted()) continue;
            return errno;
        }
        text.remove_prefix(static_cast<std::size_t>(written));
    }
    return 0;
}

}  // namespace

void Writer::write(std::string_view text) {
    if (error_ != 0) return;
    if (buffer_.size() + text.size() > kBuffer) {
        flush();
        if (text.size() > kBuffer) {
            if (error_ == 0) error_ = write_all(descriptor_, text);
            return;
        }
    }
    buffer_ += text;
}

bool Writer::flush() {
    if (error_ == 0 && !buffer_.empty()) error_ = write_all(descriptor_, buffer_);
    buffer_.clear();
    return error_ == 0;
}

Console::Console(int in, int out_descriptor, int err)
    : out(out_descriptor),
      in_(in),
      out_(out_descriptor),
      err_(err),
      error_is_terminal_(isatty(err) == 1) {}

bool Console::output_is_terminal() const { return isatty(out_) == 1; }

int Console::columns() const {
    winsize size{};
    if (ioctl(err_, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
    return 80;
}

void Console::raw(std::string_view text) {
    static_cast<void>(write_all(err_, text));  // nobody is left to tell
}

void Console::error(const Trouble& trouble) {
    std::string text = color ? "\033[1;31merror:\033[0m " : "error: ";
    text += trouble.message;
    text += '\n';
    if (!trouble.hint.empty()) {
        text += color ? "\033[1;36mhint:\033[0m " : "hint: ";
        text += trouble.hint;
        text += '\n';
    }
    out.flush();
    raw(text);
}

void Console::warning(std::string_view message) {
    std::string text = color ? "\033[1;33mwarning:\033[0m " : "warning: ";
    text += message;
    text += '\n';
    raw(text);
}

void Console::note(std::string_view message) {
    if (quiet) return;
    std::string text(message);
    text += '\n';
    raw(text);
}

Attempt<std::optional<std::string>> Console::read_line() {
    while (true) {
        const std::size_t end = pending_.find('\n', consumed_);
        if (end != std::string::npos) {
            std::string line = pending_.substr(consumed_, end - consumed_);
            consumed_ = end + 1;
            if (line.ends_with('\r')) line.pop_back();
            return line;
        }
        pending_.erase(0, consumed_);
        consumed_ = 0;
        if (at_end_) {
            if (pending_.empty()) return std::nullopt;
            std::string line;
            line.swap(pending_);
            return line;
        }
        if (pending_.size() > kLongestLine) {
            return trouble(kCommandWrong, "a line of standard input is longer than 1 MiB");
        }
        out.flush();
        std::array<char, kBuffer> buffer;
        const ssize_t got = ::read(in_, buffer.data(), buffer.size());
        if (got > 0) {
            pending_.append(buffer.data(), static_cast<std::size_t>(got));
        } else if (got == 0 || interrupted()) {
            at_end_ = true;
        } else if (errno != EINTR) {
            return trouble(kFileTrouble,
                           std::string("can not read standard input: ") + std::strerror(errno));
        }
    }
}

int Console::finish(int code) {
    if (out.flush()) return code;
    if (code != kDone) return code;
    if (out.error() != EPIPE) {
        error({kFileTrouble,
               std::string("can not write standard output: ") + std::strerror(out.error()),
               {}});
    }
    return kFileTrouble;
}

}  // namespace raymo::app
