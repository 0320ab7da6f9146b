// Texts read whole, and outputs that are whole or absent.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "apps/raymo/exit_code.hpp"
#include "apps/raymo/system/console.hpp"

namespace raymo::app {

/// All of a file ("-": standard input). Trouble: kFileTrouble when it can not be read or is a
/// directory; kModelWrong when it is longer than sml::kMaxTextBytes, of which no more than that is read.
[[nodiscard]] Attempt<std::string> read_text(const std::string& path, const Console& console);
/// The same of what must be a file: pipes, devices and sockets, for which one might wait forever, are refused at once, as is
/// "-", which is a name like any other.
[[nodiscard]] Attempt<std::string> read_regular(const std::string& path);

/// Where a result goes: a file, or standard output for "-".
class Outputs {
public:
    explicit Outputs(Console& console) : console_(console) {}
    ~Outputs();
    Outputs(const Outputs&) = delete;
    Outputs& operator=(const Outputs&) = delete;

    /// Finds out, before any work is done, whether the file can be written.
    [[nodiscard]] static Attempt<void> check(const std::string& path);
    /// Writes the bytes under a temporary name beside `path`. Devices and pipes, which can not be
    /// replaced, get them at commit().
    [[nodiscard]] Attempt<void> prepare(const std::string& path,
                                        std::span<const std::uint8_t> bytes);
    /// Gives all prepared files their names. Files of which this has not been reached are removed
    /// by the destructor.
    [[nodiscard]] Attempt<void> commit();

private:
    struct Prepared {
        std::string path;       ///< as the user wrote it
        std::string target;     ///< behind symbolic links
        std::string temporary;  ///< empty: written directly
        std::span<const std::uint8_t> bytes;
    };
    Console& console_;
    std::vector<Prepared> prepared_;
};

/// "out/cup.png" for "models/cup.raymo" and ".png" is "cup.png": the file's name with another
/// suffix.
[[nodiscard]] std::string with_suffix(std::string_view path, std::string_view suffix);
/// ".png" of "out/cup.png", in lower case; empty when there is none.
[[nodiscard]] std::string suffix_of(std::string_view path);

}  // namespace raymo::app
