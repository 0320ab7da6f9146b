// Blends of surfaces that cross in any position, against their definition (rolled.hpp).
//
// Two of the five surfaces get random sizes, places and directions, bounded far away; all edges that they make are blended. The
// judge does not follow any curve along: it knows the balls' centres as thousands of points with both distances equal to the radius, found by
// Newton's method from random starts, and looks for the nearest centre from the nearest of these. Chamfers and conics are judged in
// the plane across at that centre (profiled.hpp).
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "raymo/blends/blend.hpp"
#include "raymo/query/locate.hpp"
#include "raymo/trace/tracer.hpp"
#include "tests/laws/judge.hpp"
#include "tests/laws/law.hpp"
#include "tests/laws/profiled.hpp"

namespace raymo::laws {
namespace {

constexpr double kFar = 16.0;
constexpr double kNear = 4.0;  ///< what is looked at
/// Paths of balls are cubics to 2^-30 of the radius, and gaps at contacts 2^-33 of it; so are the patches of chamfers and conics.
/// Positions are of the size of kFar.
constexpr Real kMargin = 4e-9L;
/// Rays that graze a surface may be moved aside, as kLoose has it, by 2^-29 of the largest coordinates, 4 kFar, and more where errors are magnified.
constexpr Real kGrazing = 4e-7L;
constexpr std::uint64_t kRaysEach = 1000;

Real r(double x) { return static_cast<Real>(x); }

struct Operand {
    ModelPtr model;
    RealSurface surface;
};

Operand any_operand(Random& random) {
    Operand out;
    RealSurface& s = out.surface;
    const double size = random.uniform(0.7, 2.0);
    s.kind = static_cast<RealSurface::Kind>(random.below(5));
    switch (s.kind) {
        case RealSurface::Kind::plane:
            out.model = moved(block({4 * kFar, 4 * kFar, kFar}), Vec3{-2 * kFar, -2 * kFar, -kFar});
            break;
        case RealSurface::Kind::sphere:
            out.model = sphere(size);
            s.radius = r(size);
            break;
        case RealSurface::Kind::cylinder:
            out.model = cylinder(size, 4 * kFar, true);
            s.radius = r(size);
            break;
        case RealSurface::Kind::cone: {
            const double tangent = random.uniform(0.2, 1.2);
            out.model = cone(2 * kFar * tangent, 0, 2 * kFar);
            s.half_angle = std::atan2(r(2 * kFar * tangent), r(2 * kFar));
            s.axis = {0, 0, -1};
            s.point.z = r(2 * kFar);
            const Vec3 down{0, 0, -2 * kFar + random.uniform(0.5, 3.0)};
            out.model = moved(out.model, down);
            s.point = s.point + real(down);
            break;
        }
        case RealSurface::Kind::torus: {
            const double tube = size * random.uniform(0.25, 0.7);
            out.model = torus(size, tube);
            s.radius = r(size);
            s.tube = r(tube);
            break;
        }
    }
    const Affine map =
        translation(random.in_cube(1.0)) * rotation(random.direction(), random.uniform(0, 360));
    out.model = moved(out.model, map);
    s = s.mapped(map);
    return out;
}

class Crossing {
public:
    /// `is_ball`: or else a chamfer or a conic.
    Crossing(Random& random, Tally& tally, bool is_ball)
        : random_(random), tally_(tally), is_ball_(is_ball) {}

    /// True if it was blended.
    bool run(std::uint64_t rays) {
        a_ = any_operand(random_);
        b_ = any_operand(random_);
        op_ = static_cast<csg::Op>(random_.below(3));
        radius_ = std::pow(10.0, random_.uniform(-1.7, -0.5));
        form_ = {};
        form_.radius = radius_;
        if (!is_ball_) {
            form_.profile = random_.chance(0.5) ? blends::Profile::chamfer : blends::Profile::conic;
            if (form_.profile == blends::Profile::conic) form_.shape = random_.uniform(-0.95, 0.95);
        }
        const auto made = blends::blended(op_, {build(a_.model), build(b_.model)}, form_);
        ++tally_.samples;
        if (!made) {
            if (made.error().message.empty() || made.error().hint.empty()) fault("gives no reason");
            return false;
        }
        if (made->edges == 0) return false;
        Rolled rolled(op_ == csg::Op::unite ? a_.surface : a_.surface.complement(),
                      op_ == csg::Op::intersection ? b_.surface.complement() : b_.surface, 1);
        Rolled::Spine spine;
        spine.reach = r(4 * kFar);
        for (int i = 0; i < 20000 && spine.points.size() < 3000; ++i) {
            const auto x = rolled.nearby(real(random_.in_cube(2 * kNear)), r(radius_));
            if (x && norm(*x) < r(3 * kNear)) spine.points.push_back(*x);
        }
        if (spine.points.size() < 500) return false;
        const std::vector<RealVec> cloud = spine.points;
        rolled.roll(r(radius_), {std::move(spine)});
        const auto shape =
            form_.profile == blends::Profile::conic ? std::optional(r(form_.shape)) : std::nullopt;
        const Profiled profiled(rolled, r(radius_), shape);
        profiled_ = is_ball_ ? nullptr : &profiled;
        scene::Scene scene;
        scene.parts.push_back({"crossing", made->solid, {}});
        const auto compiled = trace::compile(scene);
        if (!compiled) {
            fault("can not be compiled");
            return true;
        }
        trace::Tracer tracer(*compiled);
        query::Locator locator(made->solid);
        const std::uint64_t faults = tally_.exceptions;
        for (std::uint64_t i = 0; i < rays && tally_.exceptions == faults; ++i) {
            ++tally_.rays;
            const RealVec c =
                cloud[static_cast<std::size_t>(random_.below(static_cast<int>(cloud.size())))];
            const RealVec to_a = rolled.p().gradient(c) * Real{-1};
            const RealVec to_b = rolled.q().gradient(c) * Real{-1};
            const Real s = r(random_.uniform(-0.3, 1.3));
            const Real off = r(std::pow(10.0, random_.uniform(-7, 0)));
            const RealVec way = unit(to_a * (1 - s) + to_b * s);
            const Real deep = is_ball_ ? r(radius_) : profiled.begins(c, way);
            const RealVec target = c + way * (deep * (random_.chance(0.5) ? 1 + off : 1 - off));
            const Vec3 at = rounded(target);
            judge(rolled, real(at), locator.where(at) == query::Where::in, kMargin, "point");
            const bool is_grazing = random_.chance(0.3);
            Ray line{at, random_.direction()};
            if (is_grazing) {
                // Through a contact, in the plane that touches there: along the edge, across it, or at any angle.
                const RealVec n = random_.chance(0.5) ? to_a : to_b;
                const RealVec along = unit(cross(to_a, to_b));
                line = {rounded(c + n * r(radius_)), flat_direction(n, along, random_)};
            }
            line.origin = line.origin - line.direction * random_.uniform(0, 2);
            tracer.spans(line, spans_);
            if (spans_.empty()) spans_.resize(1);
            ask_stretches(spans_[0], r(2 * kNear), 1e-6, [&](Real t, bool is_in) {
                judge(rolled, real(line.origin) + real(line.direction) * t, is_in,
                      is_grazing ? kGrazing : kMargin, "ray at");
            });
        }
        return true;
    }

private:
    void judge(const Rolled& rolled, RealVec x, bool is_in, Real margin, const char* what) {
        if (norm(x) > r(kNear)) return;
        ++tally_.samples;
        // Where x is in the closing if the answer is wrong; rounds are closings of the complement.
        const Side other = (op_ == csg::Op::unite) == is_in ? Side::out : Side::in;
        if (truth(rolled, x, margin, Rolled::Care::quick) != other ||
            truth(rolled, x, margin, Rolled::Care::thorough) != other)
            return;
        // Where the solids come close without an edge nothing is blended.
        const auto nearest = rolled.on_spine(x);
        if (other == Side::in && nearest && !rolled.is_of_edge(nearest->at)) return;
        const Vec3 p = rounded(x);
        char place[120];
        std::snprintf(place, sizeof place, " [%.17g, %.17g, %.17g] is said to be %s", p.x, p.y, p.z,
                      is_in ? "in" : "out");
        fault(std::string(what) + place);
    }
    [[nodiscard]] Side truth(const Rolled& rolled, RealVec x, Real margin,
                             Rolled::Care care) const {
        return profiled_ != nullptr ? profiled_->filled(x, margin)
                                    : rolled.closing(x, margin, care);
    }
    void fault(const std::string& what) {
        static constexpr const char* kOps[] = {"union", "difference", "intersection"};
        static constexpr const char* kKinds[] = {"ball", "conic", "chamfer"};
        char form[100];
        std::snprintf(form, sizeof form, "%.17g, kind: \"%s\"", radius_,
                      kKinds[static_cast<std::size_t>(form_.profile)]);
        std::string call = form;
        if (form_.profile == blends::Profile::conic) {
            std::snprintf(form, sizeof form, ", shape: %.17g", form_.shape);
            call += form;
        }
        tally_.exception(what + ": " + kOps[static_cast<std::size_t>(op_)] + "(" + text(*a_.model) +
                         ", " + text(*b_.model) + ", blend: " + call + ")");
    }

    Random& random_;
    Tally& tally_;
    Operand a_, b_;
    csg::Op op_ = csg::Op::unite;
    double radius_ = 1.0;
    bool is_ball_;
    blends::Form form_;
    const Profiled* profiled_ = nullptr;  ///< while it runs, unless it is a ball
    std::vector<std::vector<trace::PartSpan>> spans_;
};

void crossings(std::uint64_t rays, Random& random, Tally& tally, bool is_ball) {
    const std::uint64_t count = std::max<std::uint64_t>(rays / kRaysEach, 10);
    std::uint64_t blended = 0;
    for (std::uint64_t i = 0; i < count; ++i)
        blended += Crossing(random, tally, is_ball).run(rays / count) ? 1 : 0;
    if (8 * blended < count) tally.exception("hardly any pair could be blended");
}

}  // namespace

void add_crossing_laws(std::vector<Law>& laws) {
    laws.push_back({"blends: surfaces that cross in any position", 1500000,
                    [](std::uint64_t rays, Random& random, Tally& tally) {
                        crossings(rays, random, tally, true);
                    }});
    laws.push_back({"blends: chamfers and conics of surfaces that cross", 1500000,
                    [](std::uint64_t rays, Random& random, Tally& tally) {
                        crossings(rays, random, tally, false);
                    }});
}

}  // namespace raymo::laws
