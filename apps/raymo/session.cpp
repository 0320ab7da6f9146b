#include "apps/raymo/session.hpp"

#include <algorithm>
#include <cstdlib>
#include <ctime>

#include "apps/raymo/answers.hpp"
#include "apps/raymo/imports.hpp"
#include "apps/raymo/params_file.hpp"
#include "apps/raymo/system/executor.hpp"
#include "apps/raymo/system/files.hpp"
#include "apps/raymo/system/fonts.hpp"
#include "apps/raymo/system/interrupt.hpp"
#include "apps/raymo/system/memory_limit.hpp"
#include "apps/raymo/text.hpp"

namespace raymo::app {
namespace {

constexpr std::size_t kMostErrors = 20;  // printed; the rest is counted

int exit_code(ErrorCode code) {
    switch (code) {
        case ErrorCode::empty:
            return kNothing;
        case ErrorCode::cancelled:
            return kInterrupted;
        default:
            return kModelWrong;
    }
}

std::string seconds(double s) {
    return number(static_cast<double>(static_cast<long>(s * 1e4 + 0.5)) / 1e4);
}

double seconds_since(Watch::Clock::time_point start) {
    return std::chrono::duration<double>(Watch::Clock::now() - start).count();
}

}  // namespace

double cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Session::Session(const Options& o, Console& c)
    : options(o), console(c), threads_(o.threads > 0 ? o.threads : available_processors()) {
    if (o.time_limit) {
        deadline_ = Watch::Clock::now() + std::chrono::duration_cast<Watch::Clock::duration>(
                                              std::chrono::duration<double>(*o.time_limit));
    }
    stats.threads = threads_;
}

Session::~Session() = default;

int Session::read() {
    const Timer timer(stats.parse);
    Attempt<std::string> got = read_text(options.file, console);
    if (!got) return explain(got.error());
    text = *std::move(got);
    return kDone;
}

Attempt<sml::Host> Session::host(Watch& watch) {
    sml::Host out;
    const auto imports = std::make_shared<const Imports>(options.file);
    out.load = [imports](const std::string& from, const std::string& path, std::string& resolved) {
        return imports->load(from, path, resolved);
    };
    out.font = [](const std::string& name) { return find_font(name); };
    out.answers = make_answers(&watch);
    out.print = [this](std::string_view line) { console.note(line); };
    out.limits.call_depth = options.call_depth;
    out.limits.solids = options.solids;
    if (options.time_limit) out.limits.seconds = *options.time_limit;
    // The program's own account comes first: unlike the limit of the process it can name a line.
    out.limits.bytes = 0.9 * options.memory_limit.value_or(default_memory_limit());
    out.progress = &watch;
    if (!options.params_file.empty()) {
        const Attempt<std::string> json = read_text(options.params_file, console);
        if (!json) return tl::unexpected<Trouble>(json.error());
        auto params = params_from_json(*json, options.params_file);
        if (!params) return tl::unexpected<Trouble>(params.error());
        out.params = *std::move(params);
    }
    for (const auto& [name, value] : options.params) out.params[name] = value;
    return out;
}

int Session::evaluate() {
    if (const int code = read(); code != kDone) return code;
    Watch watch(console, "evaluating", deadline_);
    Attempt<sml::Host> given = host(watch);
    if (!given) return explain(given.error());
    {
        const Timer timer(stats.evaluate);
        const Watch::Clock::time_point start = Watch::Clock::now();
        // The language looks at the clock for the first time when it begins to run what it has parsed.
        bool running = false;
        given->seconds = [this, start, &running] {
            if (!std::exchange(running, true)) stats.parse += seconds_since(start);
            return cpu_seconds();
        };
        const double before = stats.parse;
        outcome =
            sml::evaluate(options.file == "-" ? "<stdin>" : options.file, std::move(text), *given);
        if (!running) stats.parse += seconds_since(start);  // it never came to that
        stats.evaluate -= stats.parse - before;
    }
    if (!outcome.ok && watch.cancelled()) return stopped(watch);
    return print_diagnostics();
}

int Session::print_diagnostics() {
    // What -D and --params say is part of the command line.
    const auto is_of_command = [this](const Error& e) {
        if (!e.where.known()) return e.code == ErrorCode::name;
        return outcome.sources[e.where.file].path.starts_with("-D ");
    };
    bool model_wrong = false;
    int code = outcome.ok ? kDone : kCommandWrong;
    std::string out;
    std::size_t errors = 0;
    for (const sml::Diagnostic& d : outcome.diagnostics) {
        if (d.severity == sml::Severity::error) {
            model_wrong = model_wrong || !is_of_command(d.error);
            if (++errors > kMostErrors) continue;
        }
        out += sml::format(d, outcome.sources, console.color);
        if (!out.ends_with('\n')) out += '\n';
    }
    if (!outcome.ok && (model_wrong || errors == 0)) code = kModelWrong;
    if (errors > kMostErrors)
        out += "and " + std::to_string(errors - kMostErrors) + " more errors\n";
    console.raw(out);
    return code;
}

int Session::compile() {
    if (const int code = evaluate(); code != kDone) return code;
    if (outcome.scene.parts.empty()) return nothing_there();
    Watch watch(console, "preparing", deadline_);
    const Timer timer(stats.compile);
    Result<trace::CompiledScene> made = trace::compile(outcome.scene, &watch);
    if (watch.cancelled()) return stopped(watch);
    if (!made) return explain(made.error());
    compiled.emplace(*std::move(made));
    stats.leaves = compiled->leaf_count();
    stats.stored_leaves = compiled->stored_leaves();
    stats.scene_bytes = compiled->bytes();
    return kDone;
}

Attempt<std::size_t> Session::find_part(const std::string& name) const {
    std::vector<std::string> known;
    for (std::size_t i = 0; i < outcome.scene.parts.size(); ++i) {
        if (outcome.scene.parts[i].name == name) return i;
        if (known.size() < 1000) known.push_back(outcome.scene.parts[i].name);
    }
    std::string hint = did_you_mean(name, known);
    if (hint.empty() && known.size() <= 10) {
        hint = "the parts are";
        for (const std::string& k : known) hint += " " + in_quotes(k);
    }
    return trouble(kCommandWrong, "the model has no part " + in_quotes(name), hint);
}

std::pair<std::size_t, std::size_t> Session::line_and_column(const SourceSpan& span) {
    const std::string& source = outcome.sources[span.file].text;
    if (line_starts_.size() < outcome.sources.size()) line_starts_.resize(outcome.sources.size());
    std::vector<std::uint32_t>& starts = line_starts_[span.file];
    if (starts.empty()) {
        starts.push_back(0);
        for (std::size_t i = 0; i < source.size(); ++i) {
            if (source[i] == '\n') starts.push_back(static_cast<std::uint32_t>(i + 1));
        }
    }
    const auto after = std::upper_bound(starts.begin(), starts.end(), span.begin);
    const auto line = static_cast<std::size_t>(after - starts.begin());
    std::size_t column = 1;
    const std::size_t end = std::min<std::size_t>(span.begin, source.size());
    for (std::size_t i = *(after - 1); i < end; ++i) {
        if ((static_cast<unsigned char>(source[i]) & 0xc0) != 0x80) ++column;
    }
    return {line, column};
}

std::string Session::leaf_name(const trace::LeafInfo& leaf) {
    std::string out(leaf.primitive);
    if (!leaf.span.known() || leaf.span.file >= outcome.sources.size()) return out;
    const auto [line, column] = line_and_column(leaf.span);
    return out + "@" + outcome.sources[leaf.span.file].path + ":" + std::to_string(line) + ":" +
           std::to_string(column);
}

int Session::explain(const Error& error) {
    console.raw(sml::format({sml::Severity::error, error, {}}, outcome.sources, console.color));
    return exit_code(error.code);
}

int Session::explain(const Trouble& t) {
    if (t.code != kInterrupted) console.error(t);
    return t.code;
}

int Session::stopped(const Watch& watch) {
    if (interrupted() || !watch.late()) return kInterrupted;
    console.error({kModelWrong,
                   "the time limit of " + number(*options.time_limit) + " s has passed",
                   "give more with --time-limit"});
    return kModelWrong;
}

int Session::nothing_there() {
    console.error({kNothing, "the model is empty: there is nothing to show", {}});
    return kNothing;
}

void Session::finish() {
    if (options.stats == StatsForm::json) console.raw(stats_json(stats) + "\n");
    if (options.stats == StatsForm::text) console.raw(stats_text(stats));
}

std::string stats_json(const Stats& s) {
    const auto count = [](const char* name, std::uint64_t n) {
        return json_string(name) + ":" + std::to_string(n);
    };
    return "{\"rays\":{" + count("primary", s.rays.primary) + "," + count("shadow", s.rays.shadow) +
           "," + count("secondary", s.rays.secondary) + "},\"tests\":{" +
           count("boxes", s.rays.boxes) + "," + count("leaves", s.rays.leaves) +
           "},\"seconds\":{\"parse\":" + json_number(s.parse) +
           ",\"evaluate\":" + json_number(s.evaluate) + ",\"compile\":" + json_number(s.compile) +
           ",\"trace\":" + json_number(s.trace) + ",\"write\":" + json_number(s.write) +
           "},\"cpu_seconds\":" + json_number(cpu_seconds()) +
           ",\"threads\":" + std::to_string(s.threads) + ",\"leaves\":" + json_number(s.leaves) +
           "," + count("stored_leaves", s.stored_leaves) + "," +
           count("scene_bytes", s.scene_bytes) + ",\"peak_memory\":" + json_number(peak_memory()) +
           "}";
}

std::string stats_text(const Stats& s) {
    return "rays      primary " + std::to_string(s.rays.primary) + ", shadow " +
           std::to_string(s.rays.shadow) + ", secondary " + std::to_string(s.rays.secondary) +
           "; boxes " + std::to_string(s.rays.boxes) + ", leaves " + std::to_string(s.rays.leaves) +
           "\nseconds   parse " + seconds(s.parse) + ", evaluate " + seconds(s.evaluate) +
           ", compile " + seconds(s.compile) + ", trace " + seconds(s.trace) + ", write " +
           seconds(s.write) + "; CPU " + seconds(cpu_seconds()) + " on " +
           std::to_string(s.threads) + (s.threads == 1 ? " thread" : " threads") +
           "\nmodel     leaves " + number(s.leaves) + ", stored " +
           std::to_string(s.stored_leaves) + " in " +
           file_size(static_cast<double>(s.scene_bytes)) + "\nmemory    " +
           file_size(peak_memory()) + " at most\n";
}

}  // namespace raymo::app
