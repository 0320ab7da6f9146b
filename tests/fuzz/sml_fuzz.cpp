// libFuzzer: whatever the text, evaluate() returns, and every diagnostic can be shown.
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <string>
#include <string_view>

#include "raymo/sml/sml.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace raymo;
    const std::string text(reinterpret_cast<const char*>(data), size);
    sml::Host host;
    host.limits.solids = 1000;
    host.limits.call_depth = 200;
    host.limits.bytes = 16.0 * (1 << 20);
    host.limits.seconds = 0.1;
    host.seconds = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
    host.answers.contains = [](const csg::Solid& s, Vec3 p) -> Result<bool> {
        return csg::bounds(s).contains(p);
    };
    host.answers.is_empty = [](const csg::Solid& s) -> Result<bool> {
        return csg::bounds(s).empty();
    };
    // A file that imports itself, and one that is the text again.
    host.load = [&](const std::string&, const std::string& path,
                    std::string& resolved) -> Result<std::string> {
        if (path.size() > 8) return fail(ErrorCode::io, "no such file");
        resolved = path;
        return path == "self" ? std::string("import \"self\" as s") : text;
    };
    const sml::Outcome outcome = sml::evaluate("fuzz.raymo", text, host);
    for (const sml::Diagnostic& d : outcome.diagnostics) {
        if (sml::format(d, outcome.sources, true).empty()) __builtin_trap();
    }
    if (outcome.ok != (outcome.diagnostics.empty() || [&] {
            for (const auto& d : outcome.diagnostics) {
                if (d.severity == sml::Severity::error) return false;
            }
            return true;
        }())) {
        __builtin_trap();
    }
    static_cast<void>(sml::dump_tokens(text));
    static_cast<void>(sml::dump_ast("fuzz.raymo", text));
    return 0;
}
