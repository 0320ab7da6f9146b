// Standard input, output and error as the program uses them: by file descriptor, so that tests can
// hand in their own.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "apps/raymo/exit_code.hpp"

namespace raymo::app {

/// Buffered writing to a file descriptor. After a failed write everything is dropped and the error
/// is kept.
class Writer {
public:
    explicit Writer(int descriptor) : descriptor_(descriptor) {}
    ~Writer() { flush(); }
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;

    void write(std::string_view text);
    /// False once something could not be written.
    bool flush();
    /// errno of the first failed write, or 0.
    [[nodiscard]] int error() const { return error_; }

private:
    int descriptor_;
    int error_ = 0;
    std::string buffer_;
};

class Console {
public:
    Console(int in, int out, int err);

    Writer out;
    /// Colours on standard error; set from --color, NO_COLOR and the terminal.
    bool color = false;
    /// Drop notes (not warnings or errors).
    bool quiet = false;

    [[nodiscard]] int input() const { return in_; }
    [[nodiscard]] int output() const { return out_; }
    [[nodiscard]] bool error_is_terminal() const { return error_is_terminal_; }
    [[nodiscard]] bool output_is_terminal() const;
    /// Columns of the terminal behind standard error.
    [[nodiscard]] int columns() const;

    void error(const Trouble& trouble);
    void warning(std::string_view message);
    void note(std::string_view message);
    /// As it is, to standard error.
    void raw(std::string_view text);

    /// The next line of standard input without its end, or nothing at the end. Flushes `out` before
    /// it waits. A line longer than 1 MiB is an error, as is a failing read; an interrupted one
    /// ends the input.
    [[nodiscard]] Attempt<std::optional<std::string>> read_line();

    /// What became of `out`: kDone, or kFileTrouble with a message unless the reader has gone away.
    [[nodiscard]] int finish(int code);

private:
    int in_;
    int out_;
    int err_;
    bool error_is_terminal_;
    std::string pending_;
    std::size_t consumed_ = 0;
    bool at_end_ = false;
};

}  // namespace raymo::app
