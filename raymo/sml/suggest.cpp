#include "raymo/sml/suggest.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace raymo::sml {
namespace {

constexpr std::size_t kLongest = 40;

// Twice the optimal string alignment distance, where a change of case counts 1 instead of 2.
int distance(std::string_view a, std::string_view b) {
    std::array<std::array<int, kLongest + 1>, kLongest + 1> d{};
    const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
    for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = static_cast<int>(2 * i);
    for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = static_cast<int>(2 * j);
    for (std::size_t i = 1; i <= a.size(); ++i) {
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const char x = a[i - 1];
            const char y = b[j - 1];
            const int change = x == y ? 0 : (lower(x) == lower(y) ? 1 : 2);
            d[i][j] = std::min({d[i - 1][j] + 2, d[i][j - 1] + 2, d[i - 1][j - 1] + change});
            if (i > 1 && j > 1 && x == b[j - 2] && a[i - 2] == y) {
                d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 2);
            }
        }
    }
    return d[a.size()][b.size()];
}

}  // namespace

void Suggestion::consider(std::string_view known) {
    if (written_.size() > kLongest || known.size() > kLongest || known == written_) return;
    const int found = distance(written_, known);
    const int allowed =
        std::max(2, 2 * static_cast<int>(std::max(written_.size(), known.size())) / 3);
    const bool all_changed = found >= 2 * static_cast<int>(std::max(written_.size(), known.size()));
    if (found > allowed || all_changed) return;
    if (found < distance_ || (found == distance_ && known < best_)) {
        distance_ = found;
        best_ = known;
    }
}

std::string Suggestion::hint() const {
    return best_.empty() ? std::string() : "did you mean `" + best_ + "`?";
}

std::string shortened(std::string_view text) {
    if (text.size() <= kLongest) return std::string(text);
    std::size_t end = kLongest - 3;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
    return std::string(text.substr(0, end)) + "...";
}

}  // namespace raymo::sml
