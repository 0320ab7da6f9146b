// Names and texts of a program, each stored once and spoken of by number.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <unordered_map>

namespace raymo::sml {

using Symbol = std::uint32_t;
inline constexpr Symbol kNoSymbol = 0xffffffffU;

/// Interns strings: equal texts have equal symbols.
class Symbols {
public:
    [[nodiscard]] Symbol intern(std::string_view text) {
        if (const auto found = index_.find(text); found != index_.end()) return found->second;
        texts_.emplace_back(text);
        const auto symbol = static_cast<Symbol>(texts_.size() - 1);
        index_.emplace(texts_.back(), symbol);
        return symbol;
    }
    /// kNoSymbol when the text was never interned.
    [[nodiscard]] Symbol find(std::string_view text) const {
        const auto found = index_.find(text);
        return found == index_.end() ? kNoSymbol : found->second;
    }
    [[nodiscard]] const std::string& text(Symbol symbol) const { return texts_[symbol]; }

private:
    std::deque<std::string> texts_;  // addresses stay valid: the index holds views of them
    std::unordered_map<std::string_view, Symbol> index_;
};

}  // namespace raymo::sml
