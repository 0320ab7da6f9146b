// SML, the solid modelling language: text in, scene out. Knows no files, no rays and no pictures: those are handed in.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "raymo/core/progress.hpp"
#include "raymo/core/result.hpp"
#include "raymo/math/ray.hpp"
#include "raymo/scene/scene.hpp"

namespace raymo::sml {

/// No program text is longer: 64 MiB.
inline constexpr std::size_t kMaxTextBytes = std::size_t{64} << 20;

/// The texts of one evaluation. SourceSpan::file is an index into this.
struct SourceFile {
    std::string path;  ///< as shown in messages
    std::string text;
};
using SourceMap = std::vector<SourceFile>;

enum class Severity : std::uint8_t { error, warning };

/// One frame of "called from".
struct CallSite {
    SourceSpan where;
    std::string function;
};

/// An Error with what the language knows about it.
struct Diagnostic {
    Severity severity = Severity::error;
    Error error;
    std::vector<CallSite> calls;  ///< innermost first
};

/// The message with file, line, column, the line of text with a caret, label, hint and calls, as in the manual's
/// chapter on errors. Columns count code points from 1. `color` adds ANSI colours.
[[nodiscard]] std::string format(const Diagnostic& diagnostic, const SourceMap& sources,
                                 bool color = false);

/// One crossing of a solid along a ray, for the builtin `hits`.
struct HitInterval {
    double enter, exit;  ///< t; may be infinite
    Vec3 enter_point, exit_point, enter_normal, exit_normal;
};

/// Answers about solids that need rays; handed in by the app so that the language stays below the tracer.
struct Answers {
    std::function<Result<std::vector<HitInterval>>(const csg::Solid&, const Ray&)> hits;
    std::function<Result<bool>(const csg::Solid&, Vec3)> contains;
    std::function<Result<bool>(const csg::Solid&)> is_empty;
};

struct Limits {
    int call_depth = 1000;
    double solids = 1e7;                ///< solids made by the program
    double seconds = 60.0;              ///< of evaluation
    double bytes = 4.0 * (1ULL << 30);  ///< of values and solids
};

/// A font as a file holds it.
struct FontFile {
    std::string bytes;
    long face = 0;  ///< of a collection
};

/// What the language is given from outside.
struct Host {
    /// What is in the file that `path` names in the file `from`: a program that is imported, a drawing or a font; path as
    /// resolved in `resolved` (used to recognise a file that is named twice). Null: no file can be read.
    std::function<Result<std::string>(const std::string& from, const std::string& path,
                                      std::string& resolved)>
        load;
    /// The font that is called that: a family, "DejaVu Sans", and what else tells it from others of its family, "DejaVu
    /// Sans:bold". Null: fonts must be given as files.
    std::function<Result<FontFile>(const std::string& name)> font;
    Answers answers;
    std::function<void(std::string_view line)> print;  ///< null: dropped
    /// Seconds of CPU so far; null: no time limit.
    std::function<double()> seconds;
    Limits limits;
    Progress* progress = nullptr;  ///< polled for cancellation
    /// -D name=value: an SML expression for each parameter.
    std::map<std::string, std::string> params;
};

/// A parameter as declared, for sliders and `--help`.
struct Parameter {
    std::string name;
    std::string doc;
    SourceSpan span;
};

struct Outcome {
    SourceMap sources;
    std::vector<Diagnostic> diagnostics;  ///< errors and warnings in order of appearance
    std::vector<Parameter> parameters;
    scene::Scene scene;  ///< whole only when ok
    bool ok = false;
};

/// Parses, resolves and runs a program. Never throws, never crashes: whatever the text, an Outcome comes back. All
/// independent syntax and name errors are reported together; a run-time error ends the run.
[[nodiscard]] Outcome evaluate(std::string path, std::string text, const Host& host);

/// Parses and resolves only.
[[nodiscard]] Outcome check(std::string path, std::string text, const Host& host);

/// Printable stages: one token or node a line.
[[nodiscard]] std::string dump_tokens(std::string_view text);
[[nodiscard]] std::string dump_ast(std::string path, std::string text);

}  // namespace raymo::sml
