// Every command and option by name: the command line, its help and its suggestions follow from these tables.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace raymo::app {

struct CommandInfo {
    std::string_view name;
    std::string_view synopsis;  ///< "FILE [-o OUT.png]"
    std::string_view doc;       ///< one line
    std::string_view details;   ///< examples, for its own help
    bool available = true;
};
[[nodiscard]] std::span<const CommandInfo> commands();
/// Null when there is none of that name.
[[nodiscard]] const CommandInfo* find_command(std::string_view name);

struct OptionInfo {
    std::string_view name;   ///< as CLI11 has it: "-o,--output"
    std::string_view key;    ///< "size"; how RawOptions knows it
    std::string_view value;  ///< "WxH"; empty: a flag
    std::string_view doc;
    std::string_view group;
    std::string_view only = {};  ///< commands that take it, with spaces; empty: all
};
[[nodiscard]] std::span<const OptionInfo> options();

/// Suffixes of outputs that belong to commands which are not there yet.
[[nodiscard]] std::span<const std::string_view> later_suffixes();

/// Help for the whole program.
[[nodiscard]] std::string program_help();
[[nodiscard]] std::string version_text();

}  // namespace raymo::app
