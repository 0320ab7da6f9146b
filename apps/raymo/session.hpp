// From the options to an evaluated and compiled model, with what is wrong told on the way.
#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include "apps/raymo/options.hpp"
#include "apps/raymo/system/console.hpp"
#include "apps/raymo/system/watch.hpp"
#include "raymo/core/executor.hpp"
#include "raymo/render/render.hpp"
#include "raymo/sml/sml.hpp"
#include "raymo/trace/tracer.hpp"

namespace raymo::app {

/// What --stats tells.
struct Stats {
    double parse = 0.0, evaluate = 0.0, compile = 0.0, trace = 0.0,
           write = 0.0;  ///< [s] of the clock on the wall
    trace::RayCounts rays;
    double leaves = 0.0;
    std::size_t stored_leaves = 0;
    std::size_t scene_bytes = 0;
    int threads = 1;
};
[[nodiscard]] std::string stats_text(const Stats& stats);
/// One object on one line.
[[nodiscard]] std::string stats_json(const Stats& stats);

/// One run of the program. Every function that can fail prints what is wrong and returns an exit code other than kDone.
class Session {
public:
    Session(const Options& options, Console& console);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// Reads the program text only.
    [[nodiscard]] int read();
    /// Reads, parses and runs the program; prints its errors and warnings.
    [[nodiscard]] int evaluate();
    /// evaluate(), then makes the scene ready for rays. kNothing when it has no part.
    [[nodiscard]] int compile();

    /// Index of the part of that name; all parts for "". Trouble: none has that name.
    [[nodiscard]] Attempt<std::size_t> find_part(const std::string& name) const;
    /// "sphere@cup.raymo:7:10".
    [[nodiscard]] std::string leaf_name(const trace::LeafInfo& leaf);

    /// What to return when a layer below fails; prints the error with its place.
    [[nodiscard]] int explain(const Error& error);
    [[nodiscard]] int explain(const Trouble& trouble);
    /// What to return when the work was cancelled: kInterrupted, or kModelWrong with a message for the time limit.
    [[nodiscard]] int stopped(const Watch& watch);
    [[nodiscard]] int nothing_there();

    [[nodiscard]] std::optional<Watch::Clock::time_point> deadline() const { return deadline_; }
    [[nodiscard]] int threads() const { return threads_; }
    /// Prints the statistics if they are asked for.
    void finish();

    const Options& options;
    Console& console;
    Stats stats;
    std::string text;
    sml::Outcome outcome;
    std::optional<trace::CompiledScene> compiled;

private:
    [[nodiscard]] int print_diagnostics();
    [[nodiscard]] Attempt<sml::Host> host(Watch& watch);
    /// 1-based line, and column in code points.
    [[nodiscard]] std::pair<std::size_t, std::size_t> line_and_column(const SourceSpan& span);

    std::optional<Watch::Clock::time_point> deadline_;
    int threads_;
    std::vector<std::vector<std::uint32_t>> line_starts_;  ///< by file, made when first asked for
};

/// Seconds of CPU time of the process so far.
[[nodiscard]] double cpu_seconds();

/// Adds the time until its end to a phase.
class Timer {
public:
    explicit Timer(double& seconds) : seconds_(seconds) {}
    ~Timer() { seconds_ += std::chrono::duration<double>(Watch::Clock::now() - start_).count(); }
    Timer(const Timer&) = delete;
    Timer& operator=(const Timer&) = delete;

private:
    double& seconds_;
    Watch::Clock::time_point start_ = Watch::Clock::now();
};

}  // namespace raymo::app
