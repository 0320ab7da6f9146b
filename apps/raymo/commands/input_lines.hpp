// Lines of numbers on standard input.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>

#include "apps/raymo/exit_code.hpp"
#include "apps/raymo/system/console.hpp"

namespace raymo::app {

/// Reads lines of a fixed count of numbers, apart by spaces, tabs or commas; skips empty ones and those that begin with #.
class NumberLines {
public:
    /// `what` describes a line for errors: "a point as x y z".
    NumberLines(Console& console, std::string_view what) : console_(console), what_(what) {}

    /// Fills `numbers` from the next line; false at the end of the input.
    /// Trouble names the line and what was found there.
    [[nodiscard]] Attempt<bool> next(std::span<double> numbers);
    /// An error about the line read last.
    [[nodiscard]] tl::unexpected<Trouble> wrong(const std::string& why) const;

private:
    Console& console_;
    std::string_view what_;
    std::size_t line_ = 0;
};

}  // namespace raymo::app
