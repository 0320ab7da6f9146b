// The spans of a model along a ray, with the names a designer knows.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "raymo/scene/scene.hpp"
#include "raymo/trace/tracer.hpp"

namespace raymo::query {

/// One end of a span.
struct NamedEnd {
    double t = 0.0;           ///< in lengths of the ray's direction; may be infinite
    bool on_surface = false;  ///< false at infinity and where the ray was cut off: then only t and
                              ///< point have a meaning
    Vec3 point;
    Vec3 normal;  ///< unit, out of the part
    std::string_view
        material;           ///< name of the surface's material; "default" when nobody painted it
    trace::LeafInfo leaf;   ///< the primitive and the place in the text that made it
    std::string_view face;  ///< "side"
};
struct NamedSpan {
    std::size_t part = 0;  ///< index into Scene::parts
    NamedEnd enter;
    NamedEnd exit;
};

struct SpanOptions {
    static constexpr std::size_t kAllParts = std::numeric_limits<std::size_t>::max();
    std::size_t part = kAllParts;  ///< only this one
    bool from_origin = false;      ///< only t >= 0; a span that holds the origin begins there
};

/// Spans of the parts along the ray's whole line, ascending in t of their entry (then by part).
/// Views stay valid as long as the compiled scene.
void named_spans(const trace::CompiledScene& scene, trace::Tracer& tracer, const Ray& ray,
                 const SpanOptions& options, std::vector<NamedSpan>& out);

}  // namespace raymo::query
