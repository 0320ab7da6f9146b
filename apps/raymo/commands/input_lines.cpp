#include "apps/raymo/commands/input_lines.hpp"

#include <optional>

#include "apps/raymo/text.hpp"

namespace raymo::app {

Attempt<bool> NumberLines::next(std::span<double> numbers) {
    constexpr std::string_view kBlank = " \t,\r";
    while (true) {
        Attempt<std::optional<std::string>> got = console_.read_line();
        if (!got) return tl::unexpected<Trouble>(got.error());
        if (!*got) return false;
        ++line_;
        std::string_view rest = **got;
        std::size_t count = 0;
        while (true) {
            const std::size_t start = rest.find_first_not_of(kBlank);
            if (start == std::string_view::npos) break;
            rest.remove_prefix(start);
            if (count == 0 && rest[0] == '#') break;
            const std::string_view word = rest.substr(0, rest.find_first_of(kBlank));
            rest.remove_prefix(word.size());
            const std::optional<double> value = parse_number(word);
            if (!value) return wrong(in_quotes(word) + " is not a finite number");
            if (count < numbers.size()) numbers[count] = *value;
            ++count;
        }
        if (count == 0) continue;
        if (count != numbers.size()) {
            return wrong("found " + std::to_string(count) + (count == 1 ? " number" : " numbers"));
        }
        return true;
    }
}

tl::unexpected<Trouble> NumberLines::wrong(const std::string& why) const {
    return trouble(kCommandWrong, "standard input:" + std::to_string(line_) + ": " + why,
                   "each line is " + std::string(what_));
}

}  // namespace raymo::app
