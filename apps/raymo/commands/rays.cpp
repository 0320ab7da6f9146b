#include <array>
#include <cmath>

#include "apps/raymo/commands/commands.hpp"
#include "apps/raymo/commands/input_lines.hpp"
#include "apps/raymo/system/interrupt.hpp"
#include "apps/raymo/text.hpp"
#include "raymo/query/spans.hpp"

namespace raymo::app {
namespace {

std::string json_end(Session& session, const query::NamedEnd& end, const std::string& part) {
    std::string out = "{\"t\":" + json_number(end.t) +
                      ",\"point\":" + (std::isfinite(end.t) ? json_vector(end.point) : "null");
    if (!end.on_surface) {
        return out + ",\"normal\":null,\"part\":" + json_string(part) +
               ",\"material\":null,\"leaf\":null,\"face\":null}";
    }
    return out + ",\"normal\":" + json_vector(end.normal) + ",\"part\":" + json_string(part) +
           ",\"material\":" + json_string(end.material) +
           ",\"leaf\":" + json_string(session.leaf_name(end.leaf)) +
           ",\"face\":" + json_string(end.face) + "}";
}

std::string json_line(Session& session, const std::vector<query::NamedSpan>& spans) {
    std::string out = "{\"spans\":[";
    for (std::size_t i = 0; i < spans.size(); ++i) {
        const query::NamedSpan& s = spans[i];
        const std::string& part = session.outcome.scene.parts[s.part].name;
        out += (i == 0 ? "{\"enter\":" : ",{\"enter\":") + json_end(session, s.enter, part) +
               ",\"exit\":" + json_end(session, s.exit, part) + "}";
    }
    return out + "]}\n";
}

std::string surface(Session& session, const query::NamedEnd& end) {
    return end.on_surface ? session.leaf_name(end.leaf) + " " + std::string(end.face) : "-";
}

/// "3 .. 5  knob  sphere@cup.raymo:7:10 surface .. cylinder@cup.raymo:8:3 top", or "nothing".
std::string text_lines(Session& session, const std::vector<query::NamedSpan>& spans) {
    if (spans.empty()) return "nothing\n";
    std::string out;
    for (std::size_t i = 0; i < spans.size(); ++i) {
        const query::NamedSpan& s = spans[i];
        out += (i == 0 ? "" : "; ") + number(s.enter.t) + " .. " + number(s.exit.t) + "  " +
               session.outcome.scene.parts[s.part].name + "  " + surface(session, s.enter) +
               " .. " + surface(session, s.exit);
    }
    return out + "\n";
}

}  // namespace

int run_rays(Session& session) {
    const Options& options = session.options;
    if (options.file == "-") {
        return session.explain(
            Trouble{kCommandWrong, "standard input holds the rays; give the model as a file", {}});
    }
    int code = session.compile();
    if (code != kDone) return code;
    query::SpanOptions wanted;
    wanted.from_origin = options.from_origin;
    if (!options.part.empty()) {
        const Attempt<std::size_t> part = session.find_part(options.part);
        if (!part) return session.explain(part.error());
        wanted.part = *part;
    }
    trace::Tracer tracer(*session.compiled);
    NumberLines lines(session.console, "a ray as ox oy oz dx dy dz");
    Watch watch(session.console, "tracing", session.deadline());
    std::vector<query::NamedSpan> spans;
    {
        const Timer timer(session.stats.trace);
        while (code == kDone) {
            std::array<double, 6> n{};
            Attempt<bool> more = lines.next(n);
            const Ray ray{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
            if (more && *more && max_norm(ray.direction) == 0.0)
                more = lines.wrong("the direction is zero");
            if (!more) {
                code = session.explain(more.error());
                break;
            }
            if (watch.cancelled()) {
                code = session.stopped(watch);
                break;
            }
            if (!*more) break;
            query::named_spans(*session.compiled, tracer, ray, wanted, spans);
            session.console.out.write(options.json ? json_line(session, spans)
                                                   : text_lines(session, spans));
            if (session.console.out.error() != 0) break;
        }
    }
    session.stats.rays = tracer.counts();
    session.finish();
    return code;
}

}  // namespace raymo::app
