// Materials, lights, cameras and what is behind everything.

#include <fmt/core.h>

#include <cmath>

#include "raymo/sml/builtins/call.hpp"
#include "raymo/sml/suggest.hpp"
#include "raymo/sml/text.hpp"

namespace raymo::sml {
namespace {

using scene::Material;

// A number from `low` to `high`, where the argument is given.
bool between(Call& call, std::size_t i, double low, double high, double& out) {
    if (!call.has(i)) return true;
    double x = 0.0;
    if (!call.number(i, x)) return false;
    if (!(x >= low && x <= high)) {
        return call.fail(
            i, ErrorCode::out_of_range,
            std::isinf(high)
                ? fmt::format("{} must be at least {}", call.argument_name(i), number_text(low))
                : fmt::format("{} must be from {} to {}", call.argument_name(i), number_text(low),
                              number_text(high)),
            {}, fmt::format("this is {}", number_text(x)));
    }
    out = x;
    return true;
}

constexpr double kNoLimit = Aabb::kInf;
constexpr auto kFacets = std::to_array<std::string_view>({"trowbridge-reitz", "gaussian", "phong"});

// The arguments of material() and of every preset, in this order.
constexpr std::string_view kMaterialParameters =
    "color? diffuse? specular? roughness? mirror? transmission? ior? absorption? | facets? metal?";

bool adjust(Call& call, Material& m) {
    if (call.has(0)) {
        std::string name;
        if (!call.colour(0, m.color, name)) return false;
        if (!name.empty()) m.name = m.name.empty() ? name : m.name + " " + name;
    }
    if (!between(call, 1, 0, 1, m.diffuse) || !between(call, 2, 0, 1, m.specular) ||
        !between(call, 3, 0, 1, m.roughness) || !between(call, 4, 0, 1, m.mirror) ||
        !between(call, 5, 0, 1, m.transmission) || !between(call, 6, 1, 10, m.ior) ||
        !between(call, 9, 0, 1, m.metal)) {
        return false;
    }
    if (call.has(7)) {
        if (call[7].is(Tag::number)) {
            double x = 0.0;
            if (!between(call, 7, 0, kNoLimit, x)) return false;
            m.absorption = {x, x, x};
        } else {
            if (!call.vector(7, m.absorption)) return false;
            for (int c = 0; c < 3; ++c) {
                if (m.absorption[c] >= 0.0) continue;
                return call.fail(7, ErrorCode::out_of_range, "`absorption` must be at least 0", {},
                                 fmt::format("this has {}", number_text(m.absorption[c])));
            }
        }
    }
    if (call.has(8)) {
        std::size_t facets = 0;
        if (!call.choice(8, kFacets, facets)) return false;
        m.facets = static_cast<scene::Facets>(facets);
    }
    return true;
}

// `specular` is the reflectance at normal incidence, which for a body that does not conduct follows from its index
// of refraction: ((n - 1) / (n + 1))^2, some 0.04 or 0.05 for plastics, lacquer and rubber. The mirror image of a
// smooth surface weighs the same.
Material preset(std::string_view name, Vec3 srgb, double diffuse, double specular,
                double roughness) {
    Material m;
    m.name = name;
    m.color = scene::from_srgb(srgb);
    m.diffuse = diffuse;
    m.specular = specular;
    m.roughness = roughness;
    return m;
}

Material metal_preset(std::string_view name, Vec3 srgb, double roughness, double mirror) {
    Material m = preset(name, srgb, 0.25, std::max(0.8, mirror), roughness);
    m.metal = 1.0;
    m.mirror = mirror;
    return m;
}

Material clear_preset(std::string_view name, double ior, Vec3 absorption) {
    const double reflectance = (ior - 1.0) / (ior + 1.0) * ((ior - 1.0) / (ior + 1.0));
    Material m = preset(name, {1, 1, 1}, 0.02, reflectance, 0.05);
    m.transmission = 0.95;
    m.mirror = reflectance;
    m.ior = ior;
    m.absorption = absorption;
    return m;
}

bool finish(Call& call, Material m, Value& out) {
    if (!adjust(call, m)) return false;
    out = Value::object(new MaterialObject(std::move(m)));
    return true;
}

bool material(Call& call, Value& out) {
    Material m = scene::default_material();
    m.name.clear();
    return finish(call, std::move(m), out);
}
bool matte(Call& call, Value& out) {
    return finish(call, preset("matte", {0.9, 0.9, 0.9}, 0.9, 0.0, 1.0), out);
}
bool plastic(Call& call, Value& out) {
    Material m = preset("plastic", {0.9, 0.9, 0.9}, 0.85, 0.05, 0.2);
    m.mirror = 0.03;
    return finish(call, std::move(m), out);
}
bool metal(Call& call, Value& out) {
    return finish(call, metal_preset("metal", {0.78, 0.79, 0.8}, 0.25, 0.35), out);
}
bool gold(Call& call, Value& out) {
    return finish(call, metal_preset("gold", {1.0, 0.84, 0.42}, 0.18, 0.5), out);
}
bool copper(Call& call, Value& out) {
    return finish(call, metal_preset("copper", {0.95, 0.64, 0.54}, 0.2, 0.45), out);
}
bool chrome(Call& call, Value& out) {
    return finish(call, metal_preset("chrome", {0.92, 0.93, 0.94}, 0.05, 0.85), out);
}
bool glass(Call& call, Value& out) {
    return finish(call, clear_preset("glass", 1.5, {0.004, 0.001, 0.003}), out);
}
bool water(Call& call, Value& out) {
    return finish(call, clear_preset("water", 1.333, {0.006, 0.002, 0.001}), out);
}
bool rubber(Call& call, Value& out) {
    return finish(call, preset("rubber", {0.22, 0.22, 0.23}, 0.8, 0.04, 0.7), out);
}
bool wood(Call& call, Value& out) {
    return finish(call, preset("wood", {0.72, 0.52, 0.33}, 0.85, 0.04, 0.55), out);
}

// s.paint(material), s.paint(colour)
bool paint(Call& call, Value& out) {
    Material own;
    const Material* look = &own;
    if (call.has(1) && call[1].is(Tag::material)) {
        look = &call[1].as<MaterialObject>().value;
    } else if (call.has(1) && (call[1].is(Tag::builtin) || call[1].is(Tag::function))) {
        return call.fail(1, ErrorCode::bad_argument, "`look` must be a material or a colour",
                         "call it: glass()", "this is a function");
    } else {
        own = scene::default_material();
        own.name.clear();
        if (!call.colour(1, own.color, own.name)) return false;
    }
    if (call[0].is(Tag::list)) {
        const std::vector<Value> items = call[0].items();
        std::vector<Value> painted(items.size());
        for (std::size_t i = 0; i < items.size(); ++i) {
            if (!items[i].is(Tag::solid)) {
                return call.fail(0, ErrorCode::bad_argument, "every element must be a solid", {},
                                 fmt::format("this list has {} in it", kind_text(items[i])));
            }
            if (!call.result(
                    csg::paint(items[i].solid(), call.evaluator().material(*look), call.span()),
                    painted[i])) {
                return false;
            }
        }
        out = Value::list(std::move(painted));
        return true;
    }
    if (!call[0].is(Tag::solid)) return call.wrong_kind(0, "a solid");
    return call.result(
        csg::paint(call[0].take_solid(), call.evaluator().material(*look), call.span()), out);
}

enum LightArgument : std::size_t {
    kPosition,
    kDirection,
    kArea,
    kSpot,
    kTarget,
    kAngle,
    kBlur,
    kSamples,
    kPower,
    kColor,
    kShadows,
};

bool light(Call& call, Value& out) {
    scene::Light l;
    std::size_t kinds = 0;
    for (const std::size_t i : {std::size_t{kPosition}, std::size_t{kArea}, std::size_t{kSpot}}) {
        kinds += call.has(i) ? 1U : 0U;
    }
    const bool is_directional = call.has(kDirection) && !call.has(kSpot);
    if (kinds + (is_directional ? 1U : 0U) != 1) {
        return call.fail(ErrorCode::bad_argument,
                         "give one of `position`, `direction`, `area` or `spot`",
                         "write light(position: (200, -150, 300))");
    }
    if (call.has(kPosition)) {
        if (!call.vector(kPosition, l.position)) return false;
    } else if (call.has(kSpot)) {
        l.kind = scene::LightKind::spot;
        if (!call.vector(kSpot, l.position)) return false;
        Vec3 target;
        if (call.has(kDirection)) {
            if (!call.direction(kDirection, l.direction)) return false;
        } else {
            if (call.has(kTarget) && !call.vector(kTarget, target)) return false;
            l.direction = target - l.position;
            if (max_norm(l.direction) == 0.0) {
                return call.fail(kTarget, ErrorCode::out_of_range,
                                 "the light and its target are the same point");
            }
        }
        l.direction = unit(l.direction);
        if (!between(call, kAngle, 0, 90, l.cone_angle) || !between(call, kBlur, 0, 90, l.blur))
            return false;
    } else if (call.has(kArea)) {
        l.kind = scene::LightKind::area;
        const bool is_list = call[kArea].is(Tag::list) && call[kArea].items().size() == 3;
        if (!is_list || !is_vector(call[kArea].items()[0], l.position) ||
            !is_vector(call[kArea].items()[1], l.edge_u) ||
            !is_vector(call[kArea].items()[2], l.edge_v)) {
            return call.wrong_kind(kArea, "a corner and two edges, each three numbers",
                                   "write area: [(0, 0, 300), (100, 0, 0), (0, 100, 0)]");
        }
        // Parallel to within rounding counts as parallel.
        const double extent = max_norm(cross(l.edge_u, l.edge_v));
        if (!(extent > 1e-12 * max_norm(l.edge_u) * max_norm(l.edge_v))) {
            return call.fail(kArea, ErrorCode::out_of_range, "the area has no extent",
                             "its two edges must point in different directions",
                             max_norm(l.edge_u) == 0.0 || max_norm(l.edge_v) == 0.0
                                 ? "an edge is (0, 0, 0)"
                                 : "the edges are parallel");
        }
    } else {
        l.kind = scene::LightKind::directional;
        if (!call.direction(kDirection, l.direction)) return false;
        l.direction = unit(l.direction);
    }
    double samples = l.samples;
    if (call.has(kSamples) && !call.whole(kSamples, 1, 4096, samples)) return false;
    l.samples = static_cast<int>(samples);
    if (!between(call, kPower, 0, kNoLimit, l.power)) return false;
    std::string name;
    if (call.has(kColor) && !call.colour(kColor, l.color, name)) return false;
    if (call.has(kShadows) && !call.flag(kShadows, l.shadows)) return false;
    out = Value::object(new LightObject(l));
    return true;
}

enum CameraArgument : std::size_t {
    kEye,
    kLookAt,
    kUp,
    kViewAngle,
    kProjection,
    kHeight,
    kAperture,
    kFocus,
    kShutter,
};

bool camera(Call& call, Value& out) {
    static constexpr auto kProjections =
        std::to_array<std::string_view>({"perspective", "parallel"});
    scene::Camera c;
    if (!call.vector(kEye, c.eye)) return false;
    if (call.has(kLookAt) && !call.vector(kLookAt, c.look_at)) return false;
    if (call.has(kUp) && !call.direction(kUp, c.up)) return false;
    const Vec3 sight = c.look_at - c.eye;
    if (max_norm(sight) == 0.0) {
        return call.fail(call.has(kLookAt) ? kLookAt : kEye, ErrorCode::out_of_range,
                         "`eye` and `look_at` are the same point",
                         "move the eye away from what it looks at");
    }
    if (norm(cross(unit(sight), unit(c.up))) < 1e-9) {
        if (call.has(kUp)) {
            return call.fail(kUp, ErrorCode::out_of_range, "`up` is parallel to the line of sight",
                             "seen from above, up: (0, 1, 0) is right");
        }
        c.up = {0, 1, 0};
    }
    if (call.has(kViewAngle)) {
        if (!call.number(kViewAngle, c.angle)) return false;
        if (!(c.angle > 0.0 && c.angle < 180.0)) {
            return call.fail(kViewAngle, ErrorCode::out_of_range,
                             "`angle` must be between 0 and 180", {},
                             fmt::format("this is {}", number_text(c.angle)));
        }
    }
    if (call.has(kProjection)) {
        std::size_t projection = 0;
        if (!call.choice(kProjection, kProjections, projection)) return false;
        c.projection = static_cast<scene::Projection>(projection);
    }
    if (call.has(kHeight) && !call.positive(kHeight, c.height)) return false;
    if (!between(call, kAperture, 0, kNoLimit, c.aperture) ||
        !between(call, kFocus, 0, kNoLimit, c.focus) ||
        !between(call, kShutter, 0, kNoLimit, c.shutter)) {
        return false;
    }
    out = Value::object(new CameraObject(c));
    return true;
}

// ambient(level) or ambient(colour)
bool ambient(Call& call, Value& out) {
    scene::Colour level;
    if (call[0].is(Tag::number)) {
        double x = 0.0;
        if (!between(call, 0, 0, kNoLimit, x)) return false;
        level = {x, x, x};
    } else {
        std::string name;
        if (!call.colour(0, level, name)) return false;
    }
    if (call.evaluator().in_main_file()) call.evaluator().scene().ambient = level;
    out = Value::nothing();
    return true;
}

// background(colour), background(bottom, top)
bool background(Call& call, Value& out) {
    scene::Background b;
    std::string name;
    if (call.has(2) ||
        (call[0].is(Tag::string) && call[0].string().find('.') != std::string::npos)) {
        return call.fail(call.has(2) ? 2 : 0, ErrorCode::not_available,
                         "pictures as a background are not available yet",
                         "give one colour, or two");
    }
    if (!call.colour(0, b.bottom, name)) return false;
    b.top = b.bottom;
    if (call.has(1) && !call.colour(1, b.top, name)) return false;
    if (call.evaluator().in_main_file()) call.evaluator().scene().background = b;
    out = Value::nothing();
    return true;
}

}  // namespace

std::span<const BuiltinRow> look_rows() {
    static constexpr auto kRows = std::to_array<BuiltinRow>({
        {"material", kMaterialParameters, &material, "How a surface looks."},
        {"matte", kMaterialParameters, &matte, "Dull, without highlights."},
        {"plastic", kMaterialParameters, &plastic, "Smooth and coloured, with white highlights."},
        {"metal", kMaterialParameters, &metal, "Brushed metal."},
        {"gold", kMaterialParameters, &gold, "Gold."},
        {"copper", kMaterialParameters, &copper, "Copper."},
        {"chrome", kMaterialParameters, &chrome, "A mirror of polished chrome."},
        {"glass", kMaterialParameters, &glass, "Clear glass."},
        {"water", kMaterialParameters, &water, "Water."},
        {"rubber", kMaterialParameters, &rubber, "Black rubber."},
        {"wood", kMaterialParameters, &wood, "Plain wood, without grain."},
        {"paint", "s look", &paint, "With a material or a colour where it has none yet."},
        {"light",
         "| position? direction? area? spot? target? angle? blur? samples? power? color? shadows?",
         &light, "A light."},
        {"camera", "eye look_at? up? angle? projection? height? aperture? focus? shutter?", &camera,
         "Where a picture is taken from."},
        {"ambient", "level", &ambient, "Light from everywhere."},
        {"background", "color top? | image?", &background,
         "What is behind: a colour, or two from bottom to top."},
    });
    return kRows;
}

}  // namespace raymo::sml
