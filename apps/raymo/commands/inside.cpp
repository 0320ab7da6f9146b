#include <array>

#include "apps/raymo/commands/commands.hpp"
#include "apps/raymo/commands/input_lines.hpp"
#include "raymo/query/locate.hpp"

namespace raymo::app {
namespace {

std::string_view name_of(query::Where where) {
    switch (where) {
        case query::Where::in:
            return "in";
        case query::Where::on:
            return "on";
        case query::Where::out:
            break;
    }
    return "out";
}

}  // namespace

int run_inside(Session& session) {
    const Options& options = session.options;
    if (options.file == "-") {
        return session.explain(Trouble{
            kCommandWrong, "standard input holds the points; give the model as a file", {}});
    }
    int code = session.evaluate();
    if (code != kDone) return code;
    if (session.outcome.scene.parts.empty()) return session.nothing_there();
    std::optional<std::size_t> part;
    if (!options.part.empty()) {
        const Attempt<std::size_t> found = session.find_part(options.part);
        if (!found) return session.explain(found.error());
        part = *found;
    }
    std::optional<query::Locator> locator;
    {
        const Timer timer(session.stats.compile);
        locator.emplace(session.outcome.scene);
    }
    NumberLines lines(session.console, "a point as x y z");
    Watch watch(session.console, "locating", session.deadline());
    {
        const Timer timer(session.stats.trace);
        while (code == kDone) {
            std::array<double, 3> n{};
            const Attempt<bool> more = lines.next(n);
            if (!more) {
                code = session.explain(more.error());
                break;
            }
            if (watch.cancelled()) {
                code = session.stopped(watch);
                break;
            }
            if (!*more) break;
            const Vec3 p{n[0], n[1], n[2]};
            const std::string_view where =
                name_of(part ? locator->where(*part, p) : locator->where(p));
            session.console.out.write(options.json ? "{\"where\":\"" : "");
            session.console.out.write(where);
            session.console.out.write(options.json ? "\"}\n" : "\n");
            if (session.console.out.error() != 0) break;
        }
    }
    session.finish();
    return code;
}

}  // namespace raymo::app
