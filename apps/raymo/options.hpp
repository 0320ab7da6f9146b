// What the command line asks for.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/raymo/exit_code.hpp"
#include "raymo/render/render.hpp"
#include "raymo/scene/camera.hpp"

namespace raymo::app {

using Args = std::vector<std::string>;

enum class StatsForm : std::uint8_t { none, text, json };
enum class ColorWhen : std::uint8_t { automatic, always, never };

/// A camera that differs from the model's own in what is set here.
struct CameraWish {
    std::string view;  ///< a camera of the model by its name
    std::optional<Vec3> eye, look_at, up;
    std::optional<double> angle;
    std::optional<scene::Projection> projection;
    std::optional<double> azimuth, elevation;  ///< either asks for a fitted camera
    bool fit = false;
};

struct Options {
    std::string command;
    std::string file;                  ///< "-": standard input
    std::vector<std::string> outputs;  ///< "-": standard output
    std::map<std::string, std::string> params;
    std::string params_file;

    int width = 800;
    int height = 600;
    CameraWish camera;
    render::Quality quality = render::Quality::final;
    int samples = 0;
    std::uint64_t seed = 1;

    int threads = 0;  ///< 0: as many as there are processors
    StatsForm stats = StatsForm::none;
    bool quiet = false;
    ColorWhen color = ColorWhen::automatic;
    std::optional<double> time_limit;    ///< [s]
    std::optional<double> memory_limit;  ///< [bytes]
    int call_depth = 1000;
    double solids = 1e7;

    bool json = false;
    bool from_origin = false;
    std::string part;
    std::string stage;
    bool clash = false;
};

/// The options of one command as they were written; checked and turned into Options by read_options().
struct RawOptions {
    std::string file;
    std::vector<std::string> outputs, defines;
    std::map<std::string, std::string> values;  ///< "size" -> "800x600"; only those that were given
    std::vector<std::string> flags;             ///< "fit"; only those that were given
};

/// Checks every value. Trouble names the option, what was found and what is asked for.
[[nodiscard]] Attempt<Options> read_options(const std::string& command, const RawOptions& raw);

/// Splits the arguments of one command. `help` is set when its help is asked for.
/// Trouble: unknown options (with a suggestion), missing values, too many files.
struct Parsed {
    RawOptions raw;
    std::optional<std::string> help;
};
[[nodiscard]] Attempt<Parsed> parse_arguments(const std::string& command, const Args& arguments);

}  // namespace raymo::app
