#include "raymo/query/spans.hpp"

#include <algorithm>
#include <cmath>

namespace raymo::query {
namespace {

NamedEnd named(const trace::CompiledScene& scene, const trace::Tracer& tracer,
               const trace::Hit& hit) {
    NamedEnd end;
    end.t = hit.t + 0.0;
    constexpr Vec3 kPlus{};  // turns -0 into 0, for readers
    end.point = hit.point + kPlus;
    end.on_surface = std::isfinite(hit.t) && hit.surface.leaf != trace::SurfaceId::kNone;
    if (!end.on_surface) return end;
    end.normal = hit.normal + kPlus;
    const std::string& name = scene.material(hit.material).name;
    end.material = hit.material == csg::kNoMaterial || name.empty() ? std::string_view("default")
                                                                    : std::string_view(name);
    end.leaf = tracer.leaf_info(hit.surface);
    end.face = tracer.face_name(hit.surface);
    return end;
}

}  // namespace

void named_spans(const trace::CompiledScene& scene, trace::Tracer& tracer, const Ray& ray,
                 const SpanOptions& options, std::vector<NamedSpan>& out) {
    out.clear();
    std::vector<std::vector<trace::PartSpan>> by_part;
    tracer.spans(ray, by_part);
    for (std::size_t part = 0; part < by_part.size(); ++part) {
        if (options.part != SpanOptions::kAllParts && part != options.part) continue;
        for (const trace::PartSpan& span : by_part[part]) {
            if (options.from_origin && span.exit.t <= 0.0) continue;
            NamedSpan s{part, named(scene, tracer, span.enter), named(scene, tracer, span.exit)};
            if (options.from_origin && s.enter.t < 0.0) {
                s.enter = NamedEnd{};
                s.enter.point = ray.origin;
            }
            out.push_back(s);
        }
    }
    std::sort(out.begin(), out.end(), [](const NamedSpan& a, const NamedSpan& b) {
        return a.enter.t != b.enter.t ? a.enter.t < b.enter.t : a.part < b.part;
    });
}

}  // namespace raymo::query
