// Values or errors. No layer throws across its border; only apps print or exit.
#pragma once

#include <cstdint>
#include <string>
#include <tl/expected.hpp>
#include <utility>

#include "raymo/core/source_span.hpp"

namespace raymo {

/// What kind of thing went wrong; apps turn it into an exit code.
enum class ErrorCode : std::uint8_t {
    out_of_range,   ///< a number outside its documented range
    bad_argument,   ///< wrong kind, count or name of an argument
    singular,       ///< a transformation that can not be inverted
    unbounded,      ///< a solid without finite size where one is needed
    empty,          ///< nothing to output
    syntax,         ///< the program text does not parse
    name,           ///< an unknown name
    evaluation,     ///< the program failed while running
    assertion,      ///< an `assert` of the model
    limit,          ///< a limit (depth, time, memory, number of solids) was passed
    not_available,  ///< part of the language that is not built yet
    io,             ///< a file can not be read or written
    cancelled,      ///< stopped by the user
};

/// An error a designer can act on: what is wrong, where, and how to mend it.
struct Error {
    ErrorCode code = ErrorCode::evaluation;
    std::string
        message;  ///< one sentence about the user's thing: "sphere: radius must be greater than 0"
    std::string label;      ///< what the caret says: "this is -1"; may be empty
    std::string hint;       ///< a mend that works; may be empty
    int argument = -1;      ///< index of the schema parameter at fault, or -1
    SourceSpan where = {};  ///< filled in by the layer that knows the text

    [[nodiscard]] Error with_label(std::string text) && {
        label = std::move(text);
        return std::move(*this);
    }
    [[nodiscard]] Error at(SourceSpan span) && {
        where = span;
        return std::move(*this);
    }
};

template <class T>
using Result = tl::expected<T, Error>;
using Failure = tl::unexpected<Error>;

[[nodiscard]] inline Failure fail(ErrorCode code, std::string message, std::string hint = {}) {
    return Failure(Error{code, std::move(message), {}, std::move(hint), -1, {}});
}
[[nodiscard]] inline Failure fail(Error error) { return Failure(std::move(error)); }

}  // namespace raymo
