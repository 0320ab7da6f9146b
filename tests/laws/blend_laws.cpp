// Blends of pairs of surfaces, in all positions in which they meet in lines or circles, against their definition (rolled.hpp).
//
// Two of the five surfaces get random sizes and places with a common axis or a common direction, bounded far away, and are
// mapped by a random similarity. One edge is blended, with a radius that may be too large. Then either
//   - the judge finds a ball at the edge, too, and points, ends of spans and the middles between them are where the definition
//     says; ends on the blend are r away from the spine, and normals are continuous across both contact curves; or
//   - the blend says that the radius is too large, the judge's ball gets stuck at a smaller one, too, and the radius that is
//     told to be the largest works, but not one that is 1 percent larger.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "raymo/blends/blend.hpp"
#include "raymo/math/tolerance.hpp"
#include "raymo/query/locate.hpp"
#include "raymo/trace/tracer.hpp"
#include "tests/laws/blend_pairs.hpp"
#include "tests/laws/judge.hpp"

namespace raymo::laws {
namespace {

/// One part, compiled.
class Blend {
public:
    explicit Blend(const csg::Solid& solid) : locator_(solid) {
        scene_.parts.push_back({"blend", solid, {}});
        auto compiled = trace::compile(scene_);
        if (!compiled) return;
        compiled_.emplace(std::move(*compiled));
        tracer_.emplace(*compiled_);
    }
    [[nodiscard]] bool ok() const { return compiled_.has_value(); }
    [[nodiscard]] query::Where where(Vec3 p) { return locator_.where(p); }
    const std::vector<trace::PartSpan>& spans(const Ray& ray) {
        tracer_->spans(ray, spans_);
        if (spans_.empty()) spans_.resize(1);
        return spans_[0];
    }

private:
    scene::Scene scene_;
    query::Locator locator_;
    std::optional<trace::CompiledScene> compiled_;
    std::optional<trace::Tracer> tracer_;
    std::vector<std::vector<trace::PartSpan>> spans_;
};

Real r(double x) { return static_cast<Real>(x); }

class Trial {
public:
    Trial(const Pair& pair, double radius, Random& random, Tally& tally)
        : pair_(pair),
          radius_(radius),
          random_(random),
          tally_(tally),
          rolled_(pair.op == csg::Op::unite ? pair.a.surface : pair.a.surface.complement(),
                  pair.op == csg::Op::intersection ? pair.b.surface.complement() : pair.b.surface,
                  r(pair.scale)) {}

    void run(std::uint64_t rays) {
        ++tally_.samples;
        auto made = attempt(radius_);
        Real reached = 0;
        centre_ = rolled_.follow(pair_.section, pair_.edge, r(radius_), reached);
        if (!made) return refused(made.error(), static_cast<double>(reached));
        if (made->edges != 1)
            return fault("blends not one edge but " + std::to_string(made->edges));
        if (!centre_) {
            return fault("blended, but the ball is stuck at " +
                         number(static_cast<double>(reached)));
        }
        Blend blend(made->solid);
        if (!blend.ok()) return fault("can not be compiled");
        roll();
        contacts(blend);
        // One fault of a blend is enough.
        const std::uint64_t faults = tally_.exceptions;
        for (std::uint64_t i = 0; i < rays && tally_.exceptions == faults; ++i) ray(blend);
    }

private:
    static std::string number(double x) {
        char text[40];
        std::snprintf(text, sizeof text, "%.17g", x);
        return text;
    }
    void fault(const std::string& what) {
        static constexpr std::array<const char*, 3> kOps{"union", "difference", "intersection"};
        const Vec3 at = rounded(pair_.edge);
        tally_.exception(
            what + ": " + kOps[static_cast<std::size_t>(pair_.op)] + "(" + text(*pair_.a.model) +
            ", " + text(*pair_.b.model) + ", blend: " + number(radius_) + ", near: [" +
            number(at.x) + ", " + number(at.y) + ", " + number(at.z) + "])" +
            (line_ ? " along " + coordinates(line_->origin) + " " + coordinates(line_->direction)
                   : ""));
    }
    static std::string coordinates(Vec3 p) {
        return number(p.x) + " " + number(p.y) + " " + number(p.z);
    }

    [[nodiscard]] Result<blends::Blended> attempt(double radius) const {
        blends::Form form;
        form.radius = radius;
        form.near = rounded(pair_.edge);
        return blends::blended(pair_.op, {build(pair_.a.model), build(pair_.b.model)}, form);
    }

    void refused(const Error& error, double reached) {
        ++tally_.samples;
        double most = 0;
        if (error.code != ErrorCode::out_of_range ||
            error.hint.rfind("the largest radius", 0) != 0 ||
            std::sscanf(error.hint.c_str(), "the largest radius that works here is %lf", &most) !=
                1) {
            return fault("refused without a largest radius (the ball is stuck at " +
                         number(reached) + "): " + error.message + "; " + error.hint);
        }
        // Rounded down to three digits.
        if (centre_ && !(most >= radius_ * (1 - 0.0101)))
            return fault("refused, but a ball fits: " + error.message + "; " + error.hint);
        if (!(most <= reached * (1 + 1e-6) && most >= reached * (1 - 0.0101))) {
            return fault("the largest radius is told to be " + number(most) + ", but is " +
                         number(reached) + ": " + error.message);
        }
        if (!attempt(most)) return fault("does not work: " + error.hint);
        if (attempt(1.0101 * most)) return fault("a larger one works: " + error.hint);
    }

    /// Tells the judge which balls are rolled: those of the edge.
    void roll() {
        std::vector<RealVec> centres{*centre_};
        for (const RealVec& c : rolled_.level(pair_.section, r(radius_), r(kReach * pair_.scale))) {
            if (norm(c - *centre_) > 1e-6L * r(radius_)) centres.push_back(c);
        }
        std::vector<Rolled::Spine> spines;
        for (const RealVec& c : centres) {
            Rolled::Spine spine;
            if (spines.empty()) spine.reach = 1.0001L * norm(c - pair_.edge);
            const int count = 96;
            for (int i = 0; i < count; ++i) {
                const double t = pair_.is_circle ? 2 * std::numbers::pi * i / count
                                                 : kFar * (2.0 * i / (count - 1) - 1.0);
                spine.points.push_back(pair_.place(c, t));
            }
            spines.push_back(std::move(spine));
        }
        rolled_.roll(r(radius_), std::move(spines));
    }

    [[nodiscard]] double any_place() {
        return pair_.is_circle ? random_.uniform(0, 2 * std::numbers::pi)
                               : kFar * random_.uniform(-0.4, 0.4);
    }
    /// Where all that is far away does not matter.
    [[nodiscard]] bool is_near(RealVec x) const {
        const RealVec d = x - pair_.section.origin;
        const Real along = dot(d, pair_.along);
        const Real limit = r(kReach * pair_.scale);
        return norm(d - pair_.along * along) < limit &&
               std::fabs(along) < (pair_.is_circle ? limit : r(0.6 * kFar * pair_.scale));
    }

    /// `rounding` of positions, in units of 2^-53: points and surfaces far from the origin carry roundings of that size.
    void judge(RealVec x, bool is_in, double rounding, const char* what) {
        if (!is_near(x)) return;
        const Real margin = r(rounding * kUnitRoundoff) * (norm(x) + r(10 * kFar * pair_.scale));
        const Side truth = rolled_.closing(x, margin);
        ++tally_.samples;
        if (truth == Side::unclear) return;
        if ((truth == Side::in) != ((pair_.op == csg::Op::unite) == is_in)) {
            const Vec3 p = rounded(x);
            fault(std::string(what) + " [" + number(p.x) + ", " + number(p.y) + ", " + number(p.z) +
                  "] is said to be " + (is_in ? "in" : "out"));
        }
    }

    /// A point on or near the tube, or anywhere near the edge.
    [[nodiscard]] RealVec any_point() {
        const double t = any_place();
        const RealVec e = pair_.place(pair_.edge, t);
        const RealVec c = pair_.place(*centre_, t);
        switch (random_.below(3)) {
            case 0:
                return e + real(random_.in_cube(1.5)) * norm(e - c);
            case 1:
                return e + (c - e) * r(random_.uniform(-0.5, 1.5));
            default: {
                const RealVec a = contact(rolled_.p(), c) - c;
                const RealVec b = contact(rolled_.q(), c) - c;
                const Real s = r(random_.uniform(-0.2, 1.2));
                const RealVec towards = a * (1 - s) + b * s;
                const Real off = r(std::pow(10.0, random_.uniform(-8, 0)));
                return c + unit(towards) * (r(radius_) * (random_.chance(0.5) ? 1 + off : 1 - off));
            }
        }
    }
    [[nodiscard]] RealVec contact(const RealSurface& s, RealVec c) const {
        return c - s.gradient(c) * r(radius_);
    }

    void ray(Blend& blend) {
        ++tally_.rays;
        Vec3 target = rounded(any_point());
        judge(real(target), blend.where(target) == query::Where::in, kTight, "point");
        double rounding = kTight;
        const double size = radius_ + pair_.scale;
        Vec3 d = random_.direction();
        const bool is_in_plane = random_.chance(0.2);
        if (is_in_plane) {
            // Through a contact curve and in the plane that touches there: along the curve, across it, or at any angle.
            rounding = kLoose;
            const RealVec c = pair_.place(*centre_, any_place());
            const RealVec at = contact(random_.chance(0.5) ? rolled_.p() : rolled_.q(), c);
            const RealVec n = unit(at - c);
            const RealVec along = unit(cross(rolled_.p().gradient(c), rolled_.q().gradient(c)));
            target = rounded(at);
            d = flat_direction(n, along, random_);
        } else if (random_.chance(0.3)) {
            // Along the tube, and so grazing it.
            rounding = kLoose;
            const double t = any_place();
            d = rounded(pair_.place(pair_.edge, t + 0.01) - pair_.place(pair_.edge, t));
            d = unit(d) + random_.in_cube(std::pow(10.0, random_.uniform(-6, -1)));
        }
        const Ray line{target - d * (size * random_.uniform(0, 3)),
                       d * (size * random_.uniform(0.5, 2))};
        line_ = line;
        const RealVec from = real(line.origin);
        const RealVec step = real(line.direction);
        const Real reach = r(2 * kReach * pair_.scale) / norm(step);
        const auto& spans = blend.spans(line);
        ask_stretches(spans, reach, 1e-7, [&](Real t, bool is_in) {
            judge(from + step * t, is_in, rounding, "ray at");
        });
        for (const trace::PartSpan& span : spans) {
            for (const trace::Hit& hit : {span.enter, span.exit}) {
                if (!is_in_plane) known(line, hit);
                end(line, hit, rounding);
            }
        }
    }

    /// An end is known to 1e-9 of the solids' size across its surface, unless the ray glances off it.
    void known(const Ray& line, const trace::Hit& hit) {
        const RealVec x = real(line.origin) + real(line.direction) * r(hit.t);
        if (!is_near(x)) return;
        const double climb = std::fabs(dot(hit.normal, line.direction));
        if (climb < 1e-3 * norm(line.direction)) return;
        ++tally_.samples;
        const double across = hit.error * climb;
        if (!(across <= 1e-9 * (static_cast<double>(norm(x)) + 10 * kFar * pair_.scale)))
            fault("an end is known to " + number(across) + " only");
    }

    /// An end of a span on the tube is as far from the spine as the radius, and its normal points to it or away.
    void end(const Ray& line, const trace::Hit& hit, double rounding) {
        const RealVec x = real(line.origin) + real(line.direction) * r(hit.t);
        if (!is_near(x)) return;
        const Real size = norm(x) + r(pair_.scale);
        const auto spine = rolled_.on_spine(x);
        const Real p = rolled_.p().distance(x);
        const Real q = rolled_.q().distance(x);
        if (!spine || p < 1e-6L * size || q < 1e-6L * size || p >= r(radius_) || q >= r(radius_))
            return;
        const RealVec d = x - spine->at;
        ++tally_.samples;
        // Glancing rays know their ends less well across than along.
        const Real sine = std::fabs(dot(unit(d), unit(real(line.direction))));
        const Real way = r(hit.error) * norm(real(line.direction));
        const Real off = std::fabs(norm(d) - r(radius_));
        if (off > 1e-9L * size + way * sine) {
            fault("an end at " + number(hit.t) + " +- " + number(hit.error) + " is " +
                  number(static_cast<double>(off)) + " off the ball");
        }
        const Real turn = norm(cross(unit(d), real(hit.normal)));
        // No further than it turns within the error, and within what rays are moved aside by.
        const Real reach =
            way + r(rounding * kUnitRoundoff) * (norm(x) + r(10 * kFar * pair_.scale));
        Real known = 0;
        for (const RealVec axis : {RealVec{1, 0, 0}, RealVec{0, 1, 0}, RealVec{0, 0, 1}}) {
            const RealVec beside = x + axis * reach;
            const auto other = rolled_.on_spine(beside);
            if (!other) return;
            known = std::max(known, 2 * norm(cross(unit(d), unit(beside - other->at))));
        }
        if (turn > 1e-7L + known && sine > 1e-3L) {
            fault("a normal at " + number(hit.t) + " +- " + number(hit.error) + " is off by " +
                  number(static_cast<double>(turn)));
        }
    }

    /// Normals on both sides of the contact curves.
    void contacts(Blend& blend) {
        for (int i = 0; i < 8; ++i) {
            const double t = any_place();
            const RealVec c = pair_.place(*centre_, t);
            const RealVec a = contact(rolled_.p(), c);
            const RealVec b = contact(rolled_.q(), c);
            for (const auto& [at, other, surface] :
                 {std::tuple(a, b, &rolled_.p()), std::tuple(b, a, &rolled_.q())}) {
                const RealVec n = surface->gradient(at);
                const RealVec towards = unit((other - at) - n * dot(other - at, n));
                for (const double side : {-1.0, 1.0}) {
                    // Across the contact curve, by much less than a normal needs to turn.
                    const RealVec beside = at + towards * (r(side * 1e-9 * radius_));
                    const Vec3 from = rounded(beside + n * (r(0.25 * radius_)));
                    const Vec3 d = rounded(n * Real{-1});
                    // Down to the surface: the end next to it.
                    double nearest = 0;
                    Vec3 normal;
                    bool is_found = false;
                    for (const trace::PartSpan& span : blend.spans({from, d})) {
                        for (const auto* hit : {&span.enter, &span.exit}) {
                            const double off = std::fabs(hit->t - 0.25 * radius_);
                            if (is_found && off >= nearest) continue;
                            is_found = true;
                            nearest = off;
                            normal = hit->normal;
                        }
                    }
                    ++tally_.samples;
                    if (!is_found || nearest > 1e-9 * (norm(from) + pair_.scale)) {
                        fault("no surface at a contact");
                    } else if (norm(cross(real(normal), n)) > 1e-7L) {
                        fault("a normal jumps by " +
                              number(static_cast<double>(norm(cross(real(normal), n)))) +
                              " at a contact");
                    }
                }
            }
        }
    }

    const Pair& pair_;
    double radius_;
    Random& random_;
    Tally& tally_;
    Rolled rolled_;
    std::optional<RealVec> centre_;
    std::optional<Ray> line_;  ///< the last that was traced
};

void try_pair(int kind, std::uint64_t rays, Random& random, Tally& tally) {
    std::optional<Pair> pair;
    while (!pair) pair = any_pair(kind, random);
    const double radius = pair->scale * std::pow(10.0, random.uniform(-2.0, 0.5));
    Trial(*pair, radius, random, tally).run(rays);
}

void pairs(std::uint64_t rays, Random& random, Tally& tally) {
    const std::uint64_t count = std::max<std::uint64_t>(rays / 1000, 3 * kPairKinds);
    for (std::uint64_t i = 0; i < count; ++i)
        try_pair(static_cast<int>(i % kPairKinds), rays / count, random, tally);
}

/// Few pairs of one kind, each with many rays.
void rays_of_kind(int kind, std::uint64_t rays, Random& random, Tally& tally) {
    while (tally.rays < rays && tally.exceptions == 0) try_pair(kind, rays / 10, random, tally);
}

}  // namespace

void add_blend_laws(std::vector<Law>& laws) {
    laws.push_back({"blends: 1,000 pairs are what the ball leaves", 1000000, pairs});
    for (int kind = 0; kind < kPairKinds; ++kind) {
        laws.push_back({"rays at blends: " + pair_name(kind), 1000000,
                        [kind](std::uint64_t rays, Random& random, Tally& tally) {
                            rays_of_kind(kind, rays, random, tally);
                        }});
    }
}

}  // namespace raymo::laws
