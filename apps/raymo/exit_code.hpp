// What the program tells its caller.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace raymo::app {

enum Exit : int {
    kDone = 0,
    kModelWrong = 1,    ///< syntax, evaluation, assertion, a limit passed
    kCommandWrong = 2,  ///< the command line, or what it was given on standard input
    kFileTrouble = 3,   ///< a file can not be read or written
    kCheckFailed = 4,
    kNothing = 5,  ///< empty model
    kBug = 70,
    kInterrupted = 130,
};

/// Why a command can not go on; printed as "error: message" with the hint below.
struct Trouble {
    Exit code = kCommandWrong;
    std::string message;
    std::string hint;
};

template <class T>
using Attempt = tl::expected<T, Trouble>;

[[nodiscard]] inline tl::unexpected<Trouble> trouble(Exit code, std::string message,
                                                     std::string hint = {}) {
    return tl::unexpected<Trouble>(Trouble{code, std::move(message), std::move(hint)});
}

}  // namespace raymo::app
