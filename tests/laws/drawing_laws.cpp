// Laws of what is swept along letters of a font and shapes of drawings, of either orientation and by either rule: outlines with
// thousands of curves, level and upright sides, parabolas, arcs, cusps and hair-thin slivers, which nobody drew for tracing.
#include <cmath>
#include <fstream>
#include <iterator>

#include "raymo/curves/contour.hpp"
#include "raymo/drawings/font.hpp"
#include "raymo/drawings/svg.hpp"
#include "tests/laws/law.hpp"
#include "tests/laws/rays.hpp"

namespace raymo::laws {
namespace {

using curves::Outline;
using curves::OutlinePtr;

drawings::FontPtr font() {
    const char* const path = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
    std::ifstream in(path, std::ios::binary);
    auto made = drawings::Font::open(path, {std::istreambuf_iterator<char>(in), {}});
    return made ? *made : nullptr;
}

/// A letter, sign or digit.
OutlinePtr letter(drawings::Font& font, Random& random) {
    for (;;) {
        const auto c = static_cast<char32_t>(0x21 + random.below(0x500));
        const std::uint32_t glyph = font.glyph_of(c);
        bool is_new = false;
        const auto outline =
            font.outline(glyph, random.chance(0.5) ? 4.0 : random.uniform(1, 5), is_new);
        if (glyph != 0 && outline && *outline != nullptr) return *outline;
    }
}

/// A shape of one element, with coordinates within about 20.
OutlinePtr shape(Random& random) {
    static constexpr auto kShapes = std::to_array<const char*>({
        "<path d='M0 0h9v9h-9zM3 3h3v3h-3z'/>",
        "<path d='M-8 0A8 5 20 1 1 8 0A4 9-30 0 0-8 0M-3-1a2 2 0 1 0 4 0 2 2 0 1 0-4 0'/>",
        "<path d='M0-9L5.3 7.3-8.6-2.8H8.6L-5.3 7.3Z'/>",
        "<path d='M-9 0q3-8 6 0t6 0 6 0V6q-3 4-6 0T-3 6-9 6z'/>",
        "<path d='M0 0C12 9-12 9 0 0S-9-12-2-3 5 5 0 0zM1 1l1e-6 3 2 0z'/>",
        "<path d='M-5-5C-4-5 5-6 5-5 5-4 6 4 5 5C4 5-4 6-5 5-5 4-6-3-5-5M0 0Q2 0 3 0T3 3z'/>",
        "<rect width='9' height='5' rx='2' ry='1'/>",
        "<ellipse cx='1' cy='2' rx='9' ry='0.5'/>",
        "<polygon points='0,0 9,0 9,1e-9 3,1 9,2 0,9 0,5 0,5 0,5'/>",
        "<path d='M0 0a1e3 1e3 0 0 1 9 0v5a7 7 0 0 0-9 0zM8 4h1v-3z'/>",
        "<path d='M0 0Q0 0 3 0Q3 3 3 3C3 3 0 3 0 3z'/>",
    });
    const double turn = random.chance(0.3) ? 90.0 * random.below(4) : random.uniform(0, 360);
    const bool is_even_odd = random.chance(0.5);
    const std::string text =
        "<svg width='0' height='0'><g transform='rotate(" + std::to_string(turn) +
        ")' fill-rule='" + (is_even_odd ? "evenodd" : "nonzero") + "'>" +
        kShapes[static_cast<std::size_t>(random.below(static_cast<int>(kShapes.size())))] +
        "</g></svg>";
    const drawings::GoOn always = [](double) { return true; };
    const auto drawing = drawings::Drawing::read("law", text, always);
    const auto drawn = (*drawing)->contour("", false, always);
    return curves::placed_outline(*drawn->contour);
}

/// Turned over, run through backwards, or both, about the origin; `beside_axis`: with x >= 0, where its least x is 0 or more.
OutlinePtr placed(const OutlinePtr& drawn, bool beside_axis, Random& random) {
    Outline outline = *drawn;
    const Box2 box = curves::box_of(outline);
    const double size = 4.0 / std::max(1.0, max_norm(box.size()));
    const bool is_mirrored = random.chance(0.5);
    const bool is_backwards = random.chance(0.5);
    for (curves::Curve& curve : outline.curves) {
        for (curves::Span2& span : curve.spans) {
            span = curves::mapped(span, {is_mirrored ? -size : size, 0, 0, 0, size, 0});
            if (is_backwards) span = curves::reversed(span);
        }
        if (is_backwards) std::reverse(curve.spans.begin(), curve.spans.end());
    }
    const Box2 now = curves::box_of(outline);
    Vec2 by = -now.centre();
    // A little beyond the axis, or nearly touching it: nearer, a ray that is moved aside again and again, each time by four times
    // as much, may miss the hole.
    if (beside_axis) by.x = -now.lo.x + (random.chance(0.5) ? 0x1p-14 : random.uniform(0.1, 1));
    for (curves::Curve& curve : outline.curves) {
        for (curves::Span2& span : curve.spans)
            span = curves::mapped(span, {1, 0, by.x, 0, 1, by.y});
    }
    return std::make_shared<const Outline>(std::move(outline));
}

/// Through a point at which curves meet: along the axes, along the curve, or anywhere. `is_turned`: what is turned about z.
AimedRay ray_at_joint(const Outline& outline, bool is_turned, Random& random) {
    const curves::Curve& curve = outline.curves[static_cast<std::size_t>(
        random.below(static_cast<int>(outline.curves.size())))];
    const curves::Span2& span =
        curve.spans[static_cast<std::size_t>(random.below(static_cast<int>(curve.spans.size())))];
    const Vec2 at = span.point(0);
    Vec2 along = span.point(1) - at;
    if (!(max_norm(along) > 0.0)) along = span.point(3) - at;
    const double turn = random.chance(0.5) ? 90.0 * random.below(4) : random.uniform(0, 360);
    const SinCos angle = sin_cos_degrees(turn);
    const auto placed = [&](Vec2 v, double z) {
        return is_turned ? Vec3{v.x * angle.cos, v.x * angle.sin, v.y} : Vec3{v.x, v.y, z};
    };
    const Vec3 p = placed(at, random.uniform(-1, 3));
    Vec3 d = random.direction();
    const int kind = random.below(4);
    if (kind == 0) d = random.axis();
    if (kind == 1) d = placed(along, 0.0);
    if (kind == 2) d.z = 0;
    if (!(max_norm(d) > 1e-3)) d = {0, 0, 1};
    return {{p - d * random.uniform(0, 3), d}, kLoose};
}

template <class OutlineOf>
void add(std::vector<Law>& laws, const std::string& name, std::initializer_list<const char*> solids,
         OutlineOf outline_of) {
    for (const std::string swept : solids) {
        laws.push_back(
            {name + ": " + swept, 1000000,
             [swept, outline_of](std::uint64_t rays, Random& random, Tally& tally) {
                 constexpr std::uint64_t kRaysEach = 200;
                 while (tally.rays < rays) {
                     const bool is_turned = swept == "revolve";
                     const OutlinePtr outline = placed(outline_of(random), is_turned, random);
                     const double h = random.uniform(0.5, 4);
                     ModelPtr model =
                         swept == "prism" ? prism(outline, h)
                         : swept == "conic"
                             ? conic(outline, h, random.chance(0.3) ? 0.0 : random.uniform(0, 2))
                             : revolve(outline,
                                       random.chance(0.5) ? 360.0 : random.uniform(1, 359));
                     const double scale =
                         random.chance(0.5) ? 1.0 : std::pow(10.0, random.uniform(-6, 6));
                     const Affine map = random.chance(0.5) ? scaling({scale, scale, scale})
                                                           : scaling({scale, scale, scale}) *
                                                                 random_map(random, 4);
                     Traced traced(moved(std::move(model), map));
                     if (!traced.ok()) {
                         tally.exception(traced.error());
                         return;
                     }
                     const double size = max_norm(map.offset) + 40.0 * scale;
                     for (std::uint64_t i = 0; i < kRaysEach; ++i) {
                         const AimedRay aimed = random.chance(0.4)
                                                    ? ray_at_joint(*outline, is_turned, random)
                                                    : any_ray(random, 5.0, 0.5);
                         const Ray ray{map(aimed.ray.origin), map.linear * aimed.ray.direction};
                         judge_ray(traced, *traced.model(), ray, size, aimed.rounding, random,
                                   tally);
                     }
                 }
             }});
    }
}

}  // namespace

void add_drawing_laws(std::vector<Law>& laws) {
    add(laws, "letters", {"prism", "conic", "revolve"},
        [font = font()](Random& random) { return letter(*font, random); });
    add(laws, "drawn shapes", {"prism", "conic", "revolve"},
        [](Random& random) { return shape(random); });
}

}  // namespace raymo::laws
