#include "apps/raymo/vocabulary.hpp"

#include <array>

namespace raymo::app {
namespace {

constexpr CommandInfo later(std::string_view name, std::string_view doc) {
    return {name, "", doc, "", false};
}

constexpr std::array kCommands{
    CommandInfo{
        "render", "FILE [-o OUT.png|-]", "draw a picture of the model",
        "Without -o the picture is named after the model and written to the current folder.\n"
        "Without a camera in the model it is shown whole, in a three-quarter view.\n\n"
        "Examples:\n"
        "  raymo render cup.raymo -o cup.png\n"
        "  raymo cup.raymo -o cup.png                        the same\n"
        "  raymo render cup.raymo -D height=90 --size 1920x1080 -o tall.png\n"
        "  raymo render cup.raymo --az 30 --el 15 --quality preview -o - | display\n"},
    CommandInfo{"check", "FILE", "parse and evaluate the model; print what is wrong with it",
                "Examples:\n"
                "  raymo check cup.raymo\n"
                "  raymo check cup.raymo -D height=-1\n"},
    CommandInfo{"rays", "FILE [--json] < rays", "spans of the model along rays",
                "Reads lines \"ox oy oz dx dy dz\": a point and a direction. Prints for each ray "
                "the intervals of t in\n"
                "which it is inside the model; t is in lengths of the given direction. Empty lines "
                "and lines that\n"
                "begin with # are skipped.\n\n"
                "Examples:\n"
                "  echo \"-100 0 5  1 0 0\" | raymo rays cup.raymo\n"
                "  raymo rays cup.raymo --part handle --from-origin --json < probes.txt\n"},
    CommandInfo{"inside", "FILE [--json] < points", "whether points are in, on or out of the model",
                "Reads lines \"x y z\". Prints in, on or out for each. Empty lines and lines that "
                "begin with # are\n"
                "skipped.\n\n"
                "Examples:\n"
                "  echo \"0 0 5\" | raymo inside cup.raymo\n"
                "  raymo inside cup.raymo --part handle --json < points.txt\n"},
    CommandInfo{"dump", "FILE --stage tokens|ast|model|compiled",
                "what the program makes of the model, stage by stage",
                "Examples:\n"
                "  raymo dump cup.raymo --stage ast\n"
                "  raymo dump cup.raymo --stage model | less\n"},
    later("measure", "volume, area, centroid, inertia, bounds"),
    later("mesh", "triangles for printing"),
    later("voxels", "a grid of densities"),
    later("section", "the outline in a plane"),
    later("drawing", "visible and hidden edges"),
    later("fmt", "the program text in standard form"),
    later("animate", "a picture for each t from 0 to 1"),
    later("shell", "the RAYMO command language"),
    later("repl", "SML line by line"),
    later("studio", "the live editor in the browser"),
    later("lsp", "language server"),
    later("bench", "the project's own benchmarks"),
    later("completion", "completion for a command shell"),
};

constexpr std::string_view kInput = "Model";
constexpr std::string_view kPicture = "Picture";
constexpr std::string_view kCamera = "Camera";
constexpr std::string_view kRun = "Running";
constexpr std::string_view kAnswer = "Answer";

constexpr std::array kOptions{
    OptionInfo{"-o,--output", "output", "OUT",
               "where the picture goes (.png); - is standard output; may be repeated", kPicture,
               "render"},
    OptionInfo{"-D,--define", "define", "NAME=VALUE",
               "set a param of the model to an SML expression; may be repeated", kInput},
    OptionInfo{"--params", "params", "FILE.json", "set params from an object of names and values",
               kInput},
    OptionInfo{"--json", "json", "", "one JSON object a line", kAnswer, "rays inside"},
    OptionInfo{"--part", "part", "NAME", "ask this part only", kAnswer, "rays inside"},
    OptionInfo{"--from-origin", "from-origin", "", "only what lies at t >= 0", kAnswer, "rays"},
    OptionInfo{"--stage", "stage", "STAGE", "tokens, ast, model or compiled", kAnswer, "dump"},
    OptionInfo{"--clash", "clash", "", "parts that overlap (not available yet)", kAnswer, "check"},
    OptionInfo{"--size", "size", "WxH", "width and height in pixels (800x600)", kPicture},
    OptionInfo{"--quality", "quality", "LEVEL", "draft, preview or final (final)", kPicture},
    OptionInfo{"--samples", "samples", "N", "rays a pixel, 1 to 4096 (as the quality asks for)",
               kPicture},
    OptionInfo{"--seed", "seed", "N", "of all that is random (1)", kPicture},
    OptionInfo{"--view", "view", "NAME", "a view of the model (its first)", kCamera},
    OptionInfo{"--eye", "eye", "X,Y,Z", "where the camera stands", kCamera},
    OptionInfo{"--look-at", "look-at", "X,Y,Z", "what it looks at", kCamera},
    OptionInfo{"--up", "up", "X,Y,Z", "which way is up in the picture", kCamera},
    OptionInfo{"--angle", "angle", "DEG", "angle of view over the larger side of the picture",
               kCamera},
    OptionInfo{"--projection", "projection", "KIND", "perspective or parallel", kCamera},
    OptionInfo{"--az", "az", "DEG", "fit the model, seen from this azimuth (-60)", kCamera},
    OptionInfo{"--el", "el", "DEG", "fit the model, seen from this elevation (28)", kCamera},
    OptionInfo{"--fit", "fit", "", "fit the model, whatever its own camera", kCamera},
    OptionInfo{"--threads", "threads", "N", "threads of the tracer (one for each processor)", kRun},
    OptionInfo{"--stats", "stats", "FORM",
               "tell about rays, time and memory on standard error, as text or --stats json", kRun},
    OptionInfo{"--quiet", "quiet", "", "no bar and no notes; errors and warnings only", kRun},
    OptionInfo{"--color", "color", "WHEN",
               "auto, always or never; NO_COLOR in the environment is never", kRun},
    OptionInfo{"--time-limit", "time-limit", "S",
               "of the whole run in seconds (without it: 60 s of evaluation)", kRun},
    OptionInfo{"--memory-limit", "memory-limit", "GIB", "of the whole process (4)", kRun},
    OptionInfo{"--call-depth", "call-depth", "N", "of functions that call functions (1000)", kRun},
    OptionInfo{"--solid-limit", "solid-limit", "N", "of solids that the program makes (10000000)",
               kRun},
};

constexpr std::array<std::string_view, 13> kLaterSuffixes{".exr", ".stl", ".3mf", ".obj", ".ply",
                                                          ".glb", ".vdb", ".npy", ".raw", ".svg",
                                                          ".dxf", ".mp4", ".gltf"};

}  // namespace

std::span<const CommandInfo> commands() { return kCommands; }

const CommandInfo* find_command(std::string_view name) {
    for (const CommandInfo& c : kCommands) {
        if (c.name == name) return &c;
    }
    return nullptr;
}

std::span<const OptionInfo> options() { return kOptions; }

std::span<const std::string_view> later_suffixes() { return kLaterSuffixes; }

std::string version_text() { return "raymo " RAYMO_VERSION "\n"; }

std::string program_help() {
    std::string out =
        "raymo: solids as short programs, seen exactly\n\n"
        "Usage: raymo COMMAND FILE [options]\n"
        "       raymo FILE -o OUT.png\n\n"
        "Commands:\n";
    std::string later_ones;
    for (const CommandInfo& c : kCommands) {
        if (c.available) {
            out += "  " + std::string(c.name) + std::string(10 - c.name.size(), ' ') +
                   std::string(c.doc) + "\n";
        } else {
            later_ones += (later_ones.empty() ? "" : ", ") + std::string(c.name);
        }
    }
    out += "Not available yet: " + later_ones + ".\n\n";
    out +=
        "`raymo COMMAND --help` tells about a command and its options; - is standard input or "
        "output.\n\n"
        "Examples:\n"
        "  raymo cup.raymo -o cup.png\n"
        "  raymo render cup.raymo -D height=90 --size 1920x1080 -o cup.png\n"
        "  raymo check cup.raymo\n"
        "  echo \"-100 0 5  1 0 0\" | raymo rays cup.raymo --json\n"
        "  echo \"0 0 5\" | raymo inside cup.raymo\n\n"
        "Exit codes: 0 done, 1 the model is wrong, 2 the command line or standard input is wrong,\n"
        "3 a file can not be read or written, 4 a check failed, 5 nothing to output, 70 a bug of "
        "ours, 130 interrupted.\n";
    return out;
}

}  // namespace raymo::app
