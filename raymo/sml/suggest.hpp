// "Did you mean ...?"
#pragma once

#include <string>
#include <string_view>

namespace raymo::sml {

/// Finds among known names the one nearest to what was written, by Damerau-Levenshtein distance: at most a third of
/// the length may differ (case alone counts less).
class Suggestion {
public:
    explicit Suggestion(std::string_view written) : written_(written) {}
    void consider(std::string_view known);
    [[nodiscard]] bool found() const { return !best_.empty(); }
    /// "did you mean `x`?", or empty.
    [[nodiscard]] std::string hint() const;

private:
    std::string_view written_;
    std::string best_;
    int distance_ = 1 << 20;
};

/// At most some forty characters, so that messages stay readable.
[[nodiscard]] std::string shortened(std::string_view text);

}  // namespace raymo::sml
