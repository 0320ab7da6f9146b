#include "apps/raymo/commands/commands.hpp"

namespace raymo::app {

int run_check(Session& session) {
    if (session.options.clash) {
        return session.explain(
            Trouble{kCommandWrong, "raymo check --clash is not available yet", {}});
    }
    const int code = session.evaluate();
    session.finish();
    return code;
}

}  // namespace raymo::app
