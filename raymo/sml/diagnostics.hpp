// Where errors are collected.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "raymo/sml/sml.hpp"

namespace raymo::sml {

/// Collects diagnostics; past a hundred errors the rest is dropped, so that a broken text can not fill memory.
class Reporter {
public:
    static constexpr std::size_t kMaxErrors = 100;

    explicit Reporter(std::vector<Diagnostic>& out) : out_(out) {}

    void error(Error error, std::vector<CallSite> calls = {}) {
        ++errors_;
        if (errors_ > kMaxErrors) return;
        out_.push_back({Severity::error, std::move(error), std::move(calls)});
    }
    void error(ErrorCode code, SourceSpan where, std::string message, std::string hint = {},
               std::string label = {}) {
        error(Error{code, std::move(message), std::move(label), std::move(hint), -1, where});
    }
    void warn(SourceSpan where, std::string message, std::string hint = {}) {
        if (++warnings_ > kMaxErrors) return;
        out_.push_back(
            {Severity::warning,
             Error{ErrorCode::evaluation, std::move(message), {}, std::move(hint), -1, where},
             {}});
    }
    [[nodiscard]] std::size_t errors() const { return errors_; }
    [[nodiscard]] bool full() const { return errors_ >= kMaxErrors; }

private:
    std::vector<Diagnostic>& out_;
    std::size_t errors_ = 0;
    std::size_t warnings_ = 0;
};

}  // namespace raymo::sml
