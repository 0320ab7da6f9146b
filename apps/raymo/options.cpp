#include "apps/raymo/options.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <type_traits>

#include "apps/raymo/text.hpp"

namespace raymo::app {
namespace {

constexpr std::uint64_t kLongestSide = 32'768;
constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 27;  // 134 million
constexpr double kGiB = 1024.0 * 1024.0 * 1024.0;

tl::unexpected<Trouble> wrong(std::string_view option, std::string_view found,
                              std::string_view wanted) {
    return trouble(kCommandWrong, "--" + std::string(option) + ": " + in_quotes(found) +
                                      " is not " + std::string(wanted));
}

/// Reads the values one after another; the first that is wrong is remembered and ends the reading.
class Reader {
public:
    explicit Reader(const RawOptions& raw) : raw_(raw) {}

    [[nodiscard]] const std::string* text(const char* key) const {
        const auto found = raw_.values.find(key);
        return found == raw_.values.end() ? nullptr : &found->second;
    }
    [[nodiscard]] bool flag(std::string_view key) const {
        return std::find(raw_.flags.begin(), raw_.flags.end(), key) != raw_.flags.end();
    }
    template <class T>
    void whole(const char* key, std::uint64_t least, std::uint64_t most, T& out) {
        const std::string* s = text(key);
        if (s == nullptr) return;
        const std::optional<std::uint64_t> v = parse_whole(*s);
        if (v && least <= *v && *v <= most) {
            out = static_cast<T>(*v);
        } else if (most == std::numeric_limits<std::uint64_t>::max()) {
            refuse(wrong(key, *s, "a whole number that is not negative"));
        } else {
            refuse(wrong(
                key, *s,
                "a whole number from " + std::to_string(least) + " to " + std::to_string(most)));
        }
    }
    /// A number in (low, high) or, for `closed`, [low, high].
    void real(const char* key, double low, double high, bool closed, std::string_view wanted,
              std::optional<double>& out) {
        const std::string* s = text(key);
        if (s == nullptr) return;
        const std::optional<double> v = parse_number(*s);
        if (v && (closed ? low <= *v && *v <= high : low < *v && *v < high)) {
            out = v;
        } else {
            refuse(wrong(key, *s, wanted));
        }
    }
    void vector(const char* key, std::optional<Vec3>& out) {
        const std::string* s = text(key);
        if (s == nullptr) return;
        out = parse_vector(*s);
        if (!out) refuse(wrong(key, *s, "three numbers, as 10,-20,5"));
    }
    template <class T, std::size_t N>
    void choice(const char* key, const std::array<std::pair<std::string_view, T>, N>& choices,
                T& out) {
        const std::string* s = text(key);
        if (s == nullptr) return;
        std::string names;
        for (std::size_t i = 0; i < N; ++i) {
            if (choices[i].first == *s) {
                out = choices[i].second;
                return;
            }
            names += (i == 0 ? "" : (i + 1 == N ? " or " : ", ")) + std::string(choices[i].first);
        }
        refuse(wrong(key, *s, names));
    }
    void refuse(tl::unexpected<Trouble> t) {
        if (!trouble_) trouble_ = std::move(t).value();
    }
    [[nodiscard]] const std::optional<Trouble>& first_trouble() const { return trouble_; }

private:
    const RawOptions& raw_;
    std::optional<Trouble> trouble_;
};

void read_size(Reader& read, Options& out) {
    const std::string* s = read.text("size");
    if (s == nullptr) return;
    const std::size_t x = s->find_first_of("xX");
    const std::string_view whole = *s;
    const std::uint64_t w = parse_whole(whole.substr(0, x)).value_or(0);
    const std::uint64_t h =
        x == std::string::npos ? 0 : parse_whole(whole.substr(x + 1)).value_or(0);
    if (w == 0 || h == 0) {
        read.refuse(wrong("size", *s, "a width and a height of at least 1, as 800x600"));
    } else if (w > kLongestSide || h > kLongestSide || w * h > kMostPixels) {
        read.refuse(trouble(kCommandWrong, "--size: " + in_quotes(*s) + " is too large: at most " +
                                               std::to_string(kLongestSide) +
                                               " pixels a side and " + std::to_string(kMostPixels) +
                                               " in all"));
    } else {
        out.width = static_cast<int>(w);
        out.height = static_cast<int>(h);
    }
}

void read_camera(Reader& read, CameraWish& out) {
    if (const std::string* view = read.text("view")) out.view = *view;
    read.vector("eye", out.eye);
    read.vector("look-at", out.look_at);
    read.vector("up", out.up);
    read.real("angle", 0.0, 180.0, false, "an angle between 0 and 180 degrees", out.angle);
    read.real("az", -1e6, 1e6, true, "an angle in degrees", out.azimuth);
    read.real("el", -90.0, 90.0, true, "an angle from -90 to 90 degrees", out.elevation);
    out.fit = read.flag("fit") || out.azimuth || out.elevation;
    if (read.text("projection") != nullptr) {
        static constexpr std::array<std::pair<std::string_view, scene::Projection>, 2> kChoices{
            {{"perspective", scene::Projection::perspective},
             {"parallel", scene::Projection::parallel}}};
        out.projection.emplace();
        read.choice("projection", kChoices, *out.projection);
    }
    if (out.fit && (out.eye || out.look_at || !out.view.empty())) {
        const char* other = out.eye ? "--eye" : (out.look_at ? "--look-at" : "--view");
        read.refuse(trouble(kCommandWrong,
                            std::string("--az, --el and --fit place the camera, and so does ") +
                                other + "; give one or the other"));
    }
}

void read_running(Reader& read, Options& out) {
    read.whole("threads", 1, 1024, out.threads);
    read.whole("seed", 0, std::numeric_limits<std::uint64_t>::max(), out.seed);
    read.whole("samples", 1, 4096, out.samples);
    read.whole("call-depth", 1, 100'000, out.call_depth);
    std::uint64_t solids = 10'000'000;
    read.whole("solid-limit", 1, 1'000'000'000, solids);
    out.solids = static_cast<double>(solids);
    read.real("time-limit", 0.0, 1e9, false, "a number of seconds greater than 0", out.time_limit);
    read.real("memory-limit", 1.0 / 64, 1e6, true, "a number of GiB from 0.015625 to 1000000",
              out.memory_limit);
    if (out.memory_limit) *out.memory_limit *= kGiB;
    static constexpr std::array<std::pair<std::string_view, render::Quality>, 3> kQualities{
        {{"draft", render::Quality::draft},
         {"preview", render::Quality::preview},
         {"final", render::Quality::final}}};
    read.choice("quality", kQualities, out.quality);
    static constexpr std::array<std::pair<std::string_view, StatsForm>, 2> kForms{
        {{"json", StatsForm::json}, {"text", StatsForm::text}}};
    read.choice("stats", kForms, out.stats);
    static constexpr std::array<std::pair<std::string_view, ColorWhen>, 3> kColors{
        {{"auto", ColorWhen::automatic},
         {"always", ColorWhen::always},
         {"never", ColorWhen::never}}};
    read.choice("color", kColors, out.color);
}

}  // namespace

Attempt<Options> read_options(const std::string& command, const RawOptions& raw) {
    Options out;
    out.command = command;
    out.file = raw.file;
    out.outputs = raw.outputs;
    Reader read(raw);
    for (const std::string& define : raw.defines) {
        const std::size_t equals = define.find('=');
        if (equals == std::string::npos || equals == 0 || equals + 1 == define.size()) {
            return trouble(kCommandWrong,
                           "-D: " + in_quotes(define) + " is not NAME=VALUE, as -D height=90");
        }
        out.params[define.substr(0, equals)] = define.substr(equals + 1);
    }
    const auto take = [&](const char* key, std::string& to) {
        if (const std::string* s = read.text(key)) to = *s;
    };
    take("params", out.params_file);
    take("part", out.part);
    take("stage", out.stage);
    read_size(read, out);
    read_camera(read, out.camera);
    read_running(read, out);
    out.quiet = read.flag("quiet");
    out.json = read.flag("json");
    out.from_origin = read.flag("from-origin");
    out.clash = read.flag("clash");
    if (read.first_trouble()) return tl::unexpected<Trouble>(*read.first_trouble());
    return out;
}

}  // namespace raymo::app
