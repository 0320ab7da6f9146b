#include <algorithm>

#include "apps/raymo/camera.hpp"
#include "apps/raymo/commands/commands.hpp"
#include "apps/raymo/system/executor.hpp"
#include "apps/raymo/system/files.hpp"
#include "apps/raymo/text.hpp"
#include "apps/raymo/vocabulary.hpp"
#include "raymo/formats/png.hpp"
#include "raymo/query/emptiness.hpp"

namespace raymo::app {
namespace {

Attempt<std::vector<std::string>> chosen_outputs(const Options& options, const Console& console) {
    std::vector<std::string> outputs = options.outputs;
    if (outputs.empty()) {
        if (options.file == "-") {
            return trouble(kCommandWrong,
                           "no output named: the model on standard input has no name to go by",
                           "give one with -o OUT.png, or -o - for standard output");
        }
        outputs.push_back(with_suffix(options.file, ".png"));
    }
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        const std::string& path = outputs[i];
        if (std::count(outputs.begin(), outputs.end(), path) > 1) {
            return trouble(kCommandWrong, "output " + in_quotes(path) + " is named twice");
        }
        const std::string suffix = suffix_of(path);
        const auto later = later_suffixes();
        if (path == "-") {
            if (console.output_is_terminal()) {
                return trouble(kCommandWrong, "a terminal can not show a picture's bytes",
                               "name a file with -o OUT.png, or send standard output to one");
            }
        } else if (std::find(later.begin(), later.end(), suffix) != later.end()) {
            return trouble(kCommandWrong, "-o " + path + ": " + suffix + " is not available yet",
                           "use .png");
        } else if (suffix != ".png" && path.rfind("/dev/", 0) != 0) {
            return trouble(kCommandWrong,
                           "-o " + path + ": the suffix " + in_quotes(suffix) + " is not known",
                           "use .png");
        }
        if (Attempt<void> writable = Outputs::check(path); !writable) {
            return tl::unexpected<Trouble>(writable.error());
        }
    }
    return outputs;
}

int trace_picture(Session& session, const render::Look& look, image::Film& film) {
    const Options& options = session.options;
    render::Options wanted;
    wanted.width = options.width;
    wanted.height = options.height;
    wanted.quality = options.quality;
    wanted.samples = options.samples;
    wanted.seed = options.seed;
    wanted.kept = image::Kept::codes;
    const std::unique_ptr<Executor> executor = make_executor(session.threads());
    Watch watch(session.console, "tracing", session.deadline());
    render::Stats counted;
    const Timer timer(session.stats.trace);
    Result<image::Film> made =
        render::render(*session.compiled, look, wanted, *executor, watch, &counted);
    if (watch.cancelled()) return session.stopped(watch);
    if (!made) return session.explain(made.error());
    session.stats.rays = counted.rays;
    film = *std::move(made);
    return kDone;
}

}  // namespace

int run_render(Session& session) {
    const Options& options = session.options;
    const Attempt<std::vector<std::string>> outputs = chosen_outputs(options, session.console);
    if (!outputs) return session.explain(outputs.error());
    if (const int code = session.compile(); code != kDone) return code;
    {
        Watch watch(session.console, "looking for solids", session.deadline());
        const Result<bool> empty =
            query::is_empty(session.outcome.scene, *session.compiled, &watch);
        if (watch.cancelled()) return session.stopped(watch);
        if (!empty) return session.explain(empty.error());
        if (*empty) return session.nothing_there();
    }
    const Aabb& box = session.compiled->bounds();
    const double aspect = static_cast<double>(options.width) / options.height;
    const Attempt<scene::Camera> camera =
        wished_camera(session.outcome.scene, options.camera, box, aspect);
    if (!camera) return session.explain(camera.error());
    session.outcome.scene.cameras = {{"", *camera}};
    const render::Look look = render::look_of(session.outcome.scene, box, aspect);
    image::Film film;
    if (const int code = trace_picture(session, look, film); code != kDone) return code;

    {
        const Timer timer(session.stats.write);
        const Result<formats::Bytes> png = formats::encode_png(std::move(film));
        if (!png) return session.explain(png.error());
        Outputs files(session.console);
        for (const std::string& path : *outputs) {
            if (Attempt<void> ready = files.prepare(path, *png); !ready)
                return session.explain(ready.error());
        }
        if (Attempt<void> written = files.commit(); !written)
            return session.explain(written.error());
    }
    if (options.outputs.empty()) session.console.note("wrote " + (*outputs)[0]);
    session.finish();
    return kDone;
}

}  // namespace raymo::app
