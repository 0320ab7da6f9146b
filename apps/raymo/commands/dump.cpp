#include "apps/raymo/commands/commands.hpp"
#include "apps/raymo/dump_model.hpp"
#include "apps/raymo/text.hpp"

namespace raymo::app {
namespace {

int dump_compiled(Session& session) {
    if (const int code = session.compile(); code != kDone) return code;
    const trace::CompiledScene& scene = *session.compiled;
    const Aabb& box = scene.bounds();
    std::string out = "parts " + std::to_string(scene.part_count()) + "\nleaves " +
                      number(scene.leaf_count()) + "\nstored_leaves " +
                      std::to_string(scene.stored_leaves()) + "\nbytes " +
                      std::to_string(scene.bytes()) + "\ntransparent " +
                      (scene.has_transparency() ? "yes" : "no") + "\n";
    out += box.empty() ? "bounds empty\n"
                       : "bounds " + json_vector(box.lo) + " " + json_vector(box.hi) + "\n";
    session.console.out.write(out);
    return kDone;
}

}  // namespace

int run_dump(Session& session) {
    const std::string& stage = session.options.stage;
    const std::string name = session.options.file == "-" ? "<stdin>" : session.options.file;
    int code = kDone;
    if (stage == "tokens") {
        if (code = session.read(); code == kDone)
            session.console.out.write(sml::dump_tokens(session.text));
    } else if (stage == "ast") {
        if (code = session.read(); code == kDone)
            session.console.out.write(sml::dump_ast(name, session.text));
    } else if (stage == "model") {
        if (code = session.evaluate(); code == kDone) dump_model(session, session.console.out);
    } else if (stage == "compiled") {
        code = dump_compiled(session);
    } else if (stage == "commands") {
        return session.explain(
            Trouble{kCommandWrong, "raymo dump --stage commands is not available yet", {}});
    } else {
        const std::string found = stage.empty() ? "" : ": " + in_quotes(stage) + " is none";
        return session.explain(Trouble{kCommandWrong, "raymo dump needs a stage" + found,
                                       "--stage tokens, ast, model or compiled"});
    }
    session.finish();
    return code;
}

}  // namespace raymo::app
