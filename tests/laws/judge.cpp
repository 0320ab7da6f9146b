#include "tests/laws/judge.hpp"

#include <cmath>
#include <cstdio>

#include "raymo/math/tolerance.hpp"

namespace raymo::laws {

Traced::Traced(const ModelPtr& model) : model_(model) {
    scene::Scene scene;
    scene.parts.push_back({"part", build(model), {}});
    auto compiled = trace::compile(scene);
    if (!compiled) {
        error_ = compiled.error().message;
        return;
    }
    scene_.emplace(std::move(*compiled));
    tracer_.emplace(*scene_);
}

const std::vector<trace::PartSpan>& Traced::spans(const Ray& ray) {
    tracer_->spans(ray, spans_);
    if (spans_.empty()) spans_.resize(1);
    return spans_[0];
}

std::string describe(const Model& model, const Ray& ray) {
    char line[400];
    std::snprintf(line, sizeof line, " along origin {%a, %a, %a} direction {%a, %a, %a}",
                  ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y,
                  ray.direction.z);
    return text(model) + line;
}

namespace {

RealPoint at(const Ray& ray, double t) {
    const Real s = static_cast<Real>(t);
    return {static_cast<Real>(ray.origin.x) + s * static_cast<Real>(ray.direction.x),
            static_cast<Real>(ray.origin.y) + s * static_cast<Real>(ray.direction.y),
            static_cast<Real>(ray.origin.z) + s * static_cast<Real>(ray.direction.z)};
}

struct Judge {
    Traced& traced;
    const Model& model;
    const Ray& ray;
    double size, rounding;
    Tally& tally;

    [[nodiscard]] Side side(double t) const {
        const RealPoint p = at(ray, t);
        const Real reach = std::fabs(p.x) + std::fabs(p.y) + std::fabs(p.z) +
                           static_cast<Real>(max_norm(ray.origin) * 2.0 + size);
        return classify(model, p, reach * static_cast<Real>(rounding * kUnitRoundoff));
    }
    void fault(const char* what, double t) const {
        char place[64];
        std::snprintf(place, sizeof place, " at t = %a: ", t);
        tally.exception(what + std::string(place) + describe(*traced.model(), ray));
    }
    /// `inside` is what the tracer says.
    void point(double t, bool inside) const {
        if (!std::isfinite(t)) return;
        ++tally.samples;
        const Side truth = side(t);
        if (truth == Side::in && !inside) fault("lost: inside, but in no span", t);
        if (truth == Side::out && inside) fault("phantom: outside, but in a span", t);
    }
};

void judge_ends(const Judge& judge, const std::vector<trace::PartSpan>& spans) {
    double last = -std::numeric_limits<double>::infinity();
    for (const trace::PartSpan& span : spans) {
        // From very far away the ends of a thin span may be the same double.
        if (!(span.enter.t <= span.exit.t) || !(span.enter.t >= last))
            judge.fault("spans out of order", span.enter.t);
        last = span.exit.t;
        for (const bool entering : {true, false}) {
            const trace::Hit& hit = entering ? span.enter : span.exit;
            if (std::isinf(hit.t)) continue;
            if (!(hit.error >= 0.0) || hit.entering != entering)
                judge.fault("end is not an end", hit.t);
            if (!(std::fabs(norm(hit.normal) - 1.0) < 1e-12))
                judge.fault("normal is not of unit length", hit.t);
            const double facing = dot(hit.normal, judge.ray.direction) / norm(judge.ray.direction);
            if (entering ? facing > 1e-3 : facing < -1e-3)
                judge.fault("normal faces the wrong way", hit.t);
        }
    }
}

/// The first crossing ahead of the origin must be the one that the spans show.
void judge_first(const Judge& judge, const std::vector<trace::PartSpan>& spans) {
    const trace::Hit* expected = nullptr;
    bool clear = true;  // false when an end is so near the origin that either answer is right
    const double blur = (max_norm(judge.ray.origin) + judge.size) * judge.rounding * kUnitRoundoff /
                        max_norm(judge.ray.direction);
    for (const trace::PartSpan& span : spans) {
        for (const trace::Hit* hit : {&span.enter, &span.exit}) {
            if (std::isinf(hit->t)) continue;
            if (std::fabs(hit->t) <= 4.0 * hit->error + blur) clear = false;
            if (hit->t > 0.0 && expected == nullptr) expected = hit;
        }
    }
    if (!clear) return;
    trace::RayQuery query;
    query.ray = judge.ray;
    trace::Hit hit;
    const bool found = judge.traced.tracer().first_hit(query, hit);
    ++judge.tally.samples;
    if (found != (expected != nullptr)) {
        // A part that the ray only grazes may be left out by one and not by the other.
        double t = found ? hit.t : expected->t;
        for (const trace::PartSpan& span : spans) {
            if (!found && &span.enter == expected) t = 0.5 * (span.enter.t + span.exit.t);
        }
        if (judge.side(t) != Side::unclear) {
            judge.fault(found ? "first_hit: phantom hit" : "first_hit: lost hit", t);
        }
        return;
    }
    if (found &&
        (hit.entering != expected->entering ||
         !(std::fabs(hit.t - expected->t) <= 2.0 * (hit.error + expected->error) + blur))) {
        // Here, too, a part or a gap that the ray only grazes may be in one and not in the other.
        double next = hit.t;
        for (const trace::PartSpan& span : spans) {
            if (span.enter.t > expected->t) next = std::min(next, span.enter.t);
            if (span.exit.t > expected->t) next = std::min(next, span.exit.t);
        }
        double between = 0.5 * (expected->t + next);
        // What ends or begins too early was seen the other way from the origin on.
        if (hit.t < expected->t && hit.entering != expected->entering) between = 0.5 * hit.t;
        if (judge.side(between) == Side::unclear) return;
        char what[160];
        std::snprintf(what, sizeof what,
                      "first_hit: %s at %.17g +- %g, the spans say %s at %.17g +- %g",
                      hit.entering ? "in" : "out", hit.t, hit.error,
                      expected->entering ? "in" : "out", expected->t, expected->error);
        judge.fault(what, hit.t);
    }
    bool starts_inside = false;
    for (const trace::PartSpan& span : spans)
        starts_inside |= span.enter.t < 0.0 && span.exit.t > 0.0;
    const bool blocked = judge.traced.tracer().occluded(query);
    if (blocked != (found || starts_inside)) judge.fault("occluded: disagrees with the spans", 0.0);
}

}  // namespace

void judge_ray(Traced& traced, const Model& judge_model, const Ray& ray, double size,
               double rounding, Random& random, Tally& tally) {
    const Judge judge{traced, judge_model, ray, size, rounding, tally};
    const std::vector<trace::PartSpan> spans = traced.spans(ray);
    ++tally.rays;
    judge_ends(judge, spans);

    const double speed = norm(ray.direction);
    const double middle = -dot(ray.origin, ray.direction) / (speed * speed);
    const double half = 2.0 * size / speed;
    const auto inside = [&](double t) {
        for (const trace::PartSpan& span : spans) {
            if (span.enter.t <= t && t <= span.exit.t) return true;
        }
        return false;
    };
    // The tracer says how far its ends may be off; a place within that is not judged.
    const auto judge_at = [&](double t, bool expected) {
        for (const trace::PartSpan& span : spans) {
            for (const trace::Hit* end : {&span.enter, &span.exit}) {
                if (std::fabs(t - end->t) <= end->error) return;
            }
        }
        judge.point(t, expected);
    };
    for (std::size_t i = 0; i < spans.size(); ++i) {
        const double a = std::max(spans[i].enter.t, middle - half);
        const double b = std::min(spans[i].exit.t, middle + half);
        if (!(a < b)) continue;
        for (const double w : {1e-6, 0.5, 1.0 - 1e-6}) {
            const double t = a + w * (b - a);
            if (t > a && t < b) judge_at(t, true);
        }
        // Just beyond the ends, and between spans.
        const double step = 1e-6 * (b - a);
        judge_at(spans[i].enter.t - step, inside(spans[i].enter.t - step));
        judge_at(spans[i].exit.t + step, inside(spans[i].exit.t + step));
        if (i + 1 < spans.size()) judge_at(0.5 * (spans[i].exit.t + spans[i + 1].enter.t), false);
    }
    for (int i = 0; i < 16; ++i) {
        const double t = middle + half * ((i + random.uniform(0, 1)) / 8.0 - 1.0);
        judge_at(t, inside(t));
    }
    judge_first(judge, spans);
}

}  // namespace raymo::laws
