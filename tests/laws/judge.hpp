// The tracer's answers for a ray, against a model's own judge of points.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "raymo/trace/tracer.hpp"
#include "tests/laws/law.hpp"
#include "tests/laws/model.hpp"

namespace raymo::laws {

/// A model compiled. Not to be moved while a tracer is in use.
class Traced {
public:
    explicit Traced(const ModelPtr& model);
    Traced(const Traced&) = delete;
    Traced& operator=(const Traced&) = delete;

    [[nodiscard]] bool ok() const { return scene_.has_value(); }
    [[nodiscard]] const std::string& error() const { return error_; }
    [[nodiscard]] trace::Tracer& tracer() { return *tracer_; }
    [[nodiscard]] const trace::CompiledScene& scene() const { return *scene_; }
    [[nodiscard]] const ModelPtr& model() const { return model_; }
    /// Spans of the only part.
    const std::vector<trace::PartSpan>& spans(const Ray& ray);

private:
    ModelPtr model_;
    std::optional<trace::CompiledScene> scene_;
    std::optional<trace::Tracer> tracer_;
    std::vector<std::vector<trace::PartSpan>> spans_;
    std::string error_;
};

/// Rounding of positions on a ray: in units of 2^-53 times the largest coordinate on the way.
inline constexpr double kTight = 512.0;
/// The same for rays that run along faces and edges: these are moved aside by 2^14 position errors.
inline constexpr double kLoose = 0x1p24;

/// What is written in reports.
[[nodiscard]] std::string describe(const Model& model, const Ray& ray);

/// Judges the spans of `traced` along the ray, and the first hit and the shadow from its origin, against `judge` (the same
/// model, or an equal one). `size`: largest coordinate of the model; `rounding`: kTight or kLoose.
void judge_ray(Traced& traced, const Model& judge, const Ray& ray, double size, double rounding,
               Random& random, Tally& tally);

/// ask(t, is_in) just behind the beginning, in the middle and just before the end of each stretch of a line, in a part or not, from
/// t = -reach to reach. `inset`: how near to its ends, as part of the stretch; but never nearer than the ends are known.
template <class Ask>
void ask_stretches(std::span<const trace::PartSpan> spans, Real reach, double inset, Ask&& ask) {
    Real last = -reach;
    const auto stretch = [&](double to, double error, bool is_in) {
        const Real until = std::min(static_cast<Real>(to) - static_cast<Real>(error), reach);
        if (until > last) {
            for (const double f : {inset, 0.5, 1 - inset})
                ask(last + (until - last) * static_cast<Real>(f), is_in);
        }
        last = std::max(last, static_cast<Real>(to) + static_cast<Real>(error));
    };
    for (const trace::PartSpan& span : spans) {
        stretch(span.enter.t, span.enter.error, false);
        stretch(span.exit.t, span.exit.error, true);
    }
    stretch(static_cast<double>(reach), 0.0, false);
}

}  // namespace raymo::laws
