#include "raymo/blends/blend.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "raymo/blends/corner.hpp"
#include "raymo/blends/largest.hpp"
#include "raymo/blends/touching.hpp"
#include "raymo/blends/tube.hpp"
#include "raymo/blends/vertex.hpp"

namespace raymo::blends {
namespace {

/// Of the body's size: below it what a wedge reaches beyond faces comes near to roundings.
constexpr double kSmallest = 0x1p-24;

/// Of that size: how well it is told where faces touch.
constexpr double kPlace = 0x1p-24;

// What things take, in units of some 100 ns.
constexpr double kSearchWork = 5e6;  ///< to look for a radius that works, at most,
constexpr double kRefineWork = 2e6;  ///< and then for the largest
constexpr double kTubeWork = 1e6;    ///< a wedge along a curve in space
double corner_work(const Body& body, const Corner& corner) {
    return static_cast<double>(body.faces().size() + corner.sides.size());
}

/// Looks for a radius that works, as long as that is allowed and worth it.
class Trials {
public:
    Trials(const Spend& spend, double most)
        : most_(most), spend_([this, &spend](double work) {
              work_ += work;
              is_stopped_ = is_stopped_ || (spend && !spend(work));
              return !is_stopped_ && !is_cut_short();
          }) {}
    Trials(const Trials&) = delete;
    Trials& operator=(const Trials&) = delete;

    /// Work that is to be done. False: no more of it.
    bool go_on(double work) { return spend_(work); }
    /// Whether a ball fits along a segment; false, too, where there is no more time to find out.
    bool fits(const Body& body, const Segment& segment, double radius) {
        // What is in the way of one ball is in the way of the next one, too.
        const Fitting fitting = fitting_of(body, segment, radius, spend_, suspect_);
        if (fitting.fit != Fit::good) suspect_ = fitting.found;
        return fitting.fit == Fit::good;
    }
    /// Whether it was not worth it to find the largest.
    [[nodiscard]] bool is_cut_short() const { return work_ > most_; }
    /// One works: to find a better one is worth so much more.
    void found(double more) { most_ = work_ + more; }
    /// The error, unless `spend` stopped all.
    [[nodiscard]] Failure told(Failure failure) const {
        return is_stopped_ ? fail(ErrorCode::cancelled, "stopped") : std::move(failure);
    }

private:
    double most_;
    double work_ = 0.0;
    bool is_stopped_ = false;
    std::size_t suspect_ = 0;  ///< the face next to which it was seen last that a ball does not fit
    Spend spend_;
};

/// A hint that tells the largest radius that fits, or the largest that was found.
std::string largest_of(const Body& body, Trials& trials, const std::function<bool(double)>& fits,
                       double radius) {
    const double size = max_norm(body.box().size());
    bool any = false;
    // Between faces that are nearly flat large balls fit, but not that large ones.
    const auto tried = [&](double r) {
        const bool is_good = fits(r);
        if (is_good && !any) trials.found(kRefineWork);
        any = any || is_good;
        return is_good;
    };
    const double most = largest_that(tried, std::max(kSmallest * size, 1e-307),
                                     std::min({radius, 0x1p20 * size, 1e300}));
    if (trials.is_cut_short())
        return most > 0.0 ? fmt::format("a radius of {:g} works here", most)
                          : "take a smaller radius";
    return most > 0.0 ? fmt::format("the largest radius that works here is {:g}", most)
                      : "no radius works here: choose other edges with `near` or `where`";
}

/// The corners of segments for another radius, if balls roll between all of them.
std::optional<std::vector<Corner>> settled(const Body& body, std::vector<Segment>& segments,
                                           Profile profile, double radius) {
    auto corners = find_corners(body, segments, profile, radius);
    if (!corners) return std::nullopt;
    for (const Segment& s : segments) {
        const bool rests = s.ends[0].rest_face || s.ends[1].rest_face;
        if (rests && !s.is_used_up && s.rolled() < -kPress * radius) return std::nullopt;
    }
    return *std::move(corners);
}

bool is_inside(const csg::Solid& solid, Vec3 p) {
    const auto body = Body::make(csg::Op::unite, {solid});
    return body && body->where(p) != solids::Where::out;
}

Failure touching_error(const Body& body, std::size_t face_a, std::size_t face_b,
                       const std::string& where) {
    return fail(ErrorCode::out_of_range,
                fmt::format("{} and {} touch each other{}", body.name_of(body.faces()[face_a]),
                            body.name_of(body.faces()[face_b]), where),
                "move or resize one of them so that they cross at an angle");
}

/// Error: faces that touch without an edge, which would be left as they are without a word; unless one edge is asked for and there is.
Result<void> check_touching(const Body& body, bool within_operands, std::optional<Edges> only,
                            const std::vector<Segment>& edges, const Form& form,
                            const Spend& spend) {
    if (form.near && !edges.empty()) return {};
    const auto chosen = [&](Vec3 p) { return !form.where || is_inside(form.where, p); };
    auto touching = find_touching(body, within_operands, only, edges, chosen, spend);
    if (!touching) return Failure(std::move(touching).error());
    if (!*touching) return {};
    const auto& [face_a, face_b, at] = **touching;
    return touching_error(body, face_a, face_b,
                          " at " + place_text(at, kPlace * max_norm(body.box().size())));
}

Failure does_not_fit(const Body& body, const std::vector<Segment>& segments, std::size_t which,
                     const Fitting& fitting, const Form& form, const Spend& spend) {
    const Segment& segment = segments[which];
    if (fitting.fit == Fit::endless_bend) {
        return fail(ErrorCode::out_of_range,
                    fmt::format("the edge between {} and {} bends too sharply to be followed",
                                body.name_of(body.faces()[segment.face_a]),
                                body.name_of(body.faces()[segment.face_b])),
                    "move or resize one of them, or choose other edges with `near` or `where`");
    }
    if (fitting.fit == Fit::touching)
        return touching_error(body, segment.face_a, segment.face_b, "");
    std::string message = fmt::format("a ball of radius {:g} does not fit between {} and {}",
                                      form.radius, body.name_of(body.faces()[segment.face_a]),
                                      body.name_of(body.faces()[segment.face_b]));
    if (fitting.fit == Fit::off_face) {
        message += fmt::format(": it reaches beyond {}", body.name_of(body.faces()[fitting.face]));
    } else if (fitting.fit == Fit::blocked) {
        message += fmt::format(": {} is in its way", body.name_of(body.faces()[fitting.face]));
    }
    Trials trials(spend, kSearchWork);
    const auto fits = [&](double r) {
        if (!trials.go_on(static_cast<double>(segments.size()))) return false;
        std::vector<Segment> again = segments;
        return settled(body, again, form.profile, r) &&
               (again[which].is_used_up || trials.fits(body, again[which], r));
    };
    std::string hint = largest_of(body, trials, fits, form.radius);
    return trials.told(fail(ErrorCode::out_of_range, std::move(message), std::move(hint)));
}

Failure does_not_fit(const Body& body, const std::vector<Segment>& segments, const Corner& corner,
                     const Fitting& fitting, const Form& form, const Spend& spend) {
    std::string message =
        fmt::format("a ball of radius {:g} does not fit {}", form.radius, name_of(body, corner));
    if (fitting.fit == Fit::blocked)
        message += fmt::format(": {} is in its way", body.name_of(body.faces()[fitting.face]));
    Trials trials(spend, kSearchWork);
    const auto fits = [&](double r) {
        if (!trials.go_on(static_cast<double>(segments.size()))) return false;
        std::vector<Segment> again = segments;
        const auto corners = settled(body, again, form.profile, r);
        return corners && std::all_of(corners->begin(), corners->end(), [&](const Corner& c) {
                   return trials.go_on(corner_work(body, c)) &&
                          fitting_of(body, c, r).fit == Fit::good;
               });
    };
    std::string hint = largest_of(body, trials, fits, form.radius);
    return trials.told(fail(ErrorCode::out_of_range, std::move(message), std::move(hint)));
}

/// Where a ball fits everywhere, but what it leaves can not be made.
Failure is_too_sharp(const Body& body, const Segment& segment, const Form& form, SourceSpan span,
                     const Spend& spend) {
    const double radius = form.radius;
    constexpr int kMostTrials = 8;
    Trials trials(spend, kSearchWork + kMostTrials * kTubeWork);
    const auto works = [&](double r) {
        Form smaller = form;
        smaller.radius = r;
        return trials.fits(body, segment, r) && trials.go_on(kTubeWork) &&
               tube_wedge(body, segment, smaller, segment.lo, segment.hi, span).has_value();
    };
    const char* what = form.profile == Profile::ball    ? "ball"
                       : form.profile == Profile::conic ? "conic"
                                                        : "chamfer";
    // Two digits are enough.
    double smaller = 0.0;
    for (int i = 1; i <= kMostTrials && smaller == 0.0; ++i) {
        const double unit = std::pow(10.0, std::floor(std::log10(radius * std::exp2(-i))) - 1.0);
        const double tried = std::floor(radius * std::exp2(-i) / unit) * unit;
        if (works(tried)) smaller = tried;
    }
    std::string hint = smaller > 0.0 ? fmt::format("a radius of {:g} works here", smaller)
                       : trials.is_cut_short()
                           ? "take a smaller radius"
                           : "let them meet less slantingly, or choose other edges with `near` or "
                             "`where`";
    return trials.told(
        fail(ErrorCode::out_of_range,
             fmt::format("the edge between {} and {} bends too sharply for a {} of radius {:g}",
                         body.name_of(body.faces()[segment.face_a]),
                         body.name_of(body.faces()[segment.face_b]), what, radius),
             std::move(hint)));
}

/// Distance of a point from a segment; along a curve in space from its nearest node or so.
double distance_to(const Segment& segment, Vec3 p) {
    if (!segment.space) {
        const Vec3 d = p - segment.edge.origin;
        double t = dot(d, segment.edge.along);
        if (segment.edge.is_circle) {
            t = std::atan2(dot(d, segment.edge.up), dot(d, segment.edge.across));
            // The turn nearest to the middle.
            const double turn = 2.0 * std::numbers::pi;
            t += turn * std::round((segment.middle() - t) / turn);
        }
        return norm(segment.point(std::clamp(t, segment.lo, segment.hi)) - p);
    }
    constexpr int kPlaces = 256;
    double least = Aabb::kInf;
    for (int i = 0; i <= kPlaces; ++i) {
        const double t = segment.lo + (segment.hi - segment.lo) * i / kPlaces;
        least = std::min(least, norm(segment.point(t) - p));
    }
    return least;
}

void select(std::vector<Segment>& segments, const Form& form) {
    if (form.where) {
        std::erase_if(segments, [&](const Segment& s) {
            return !is_inside(form.where, s.point(s.middle()));
        });
    }
    if (form.near && !segments.empty()) {
        const auto nearest = std::min_element(
            segments.begin(), segments.end(), [&](const Segment& a, const Segment& b) {
                return distance_to(a, *form.near) < distance_to(b, *form.near);
            });
        Segment only = std::move(*nearest);
        segments.clear();
        segments.push_back(std::move(only));
    }
}

csg::Solid painted(csg::Solid solid, csg::MaterialId material, SourceSpan span) {
    return material == csg::kNoMaterial ? solid : csg::paint(std::move(solid), material, span);
}

/// Whether a part of a body's boundary that is added shows the same as one that is cut and left without material.
bool shows_alike(const Body& body, csg::MaterialId material) {
    return material != csg::kNoMaterial ||
           std::all_of(body.leaves().begin(), body.leaves().end(),
                       [](const Leaf& leaf) { return leaf.material == csg::kNoMaterial; });
}

/// Whether a tube is nowhere where something is taken away for another.
bool stands_apart(const RoundedRing& ring, const std::vector<RoundedRing>& others) {
    const auto is_clear = [](const RoundedRing& tube, const RoundedRing& sectors) {
        return overlap(csg::bounds(tube.tube), csg::bounds(sectors.sectors)).empty();
    };
    return std::all_of(others.begin(), others.end(), [&](const RoundedRing& other) {
        return is_clear(ring, other) && is_clear(other, ring);
    });
}

csg::Solid rounded_off(csg::Solid solid, std::vector<RoundedRing> rings, SourceSpan span) {
    std::vector<csg::Solid> cut{std::move(solid)};
    std::vector<csg::Solid> joined(1);
    for (RoundedRing& ring : rings) {
        cut.push_back(std::move(ring.sectors));
        joined.push_back(std::move(ring.tube));
    }
    joined[0] = csg::boolean(csg::Op::difference, std::move(cut), span);
    return csg::boolean(csg::Op::unite, std::move(joined), span);
}

/// The box that holds the edges which may be chosen. `chosen`: those that are.
Aabb choice_of(const Form& form, const std::vector<Segment>& chosen) {
    Aabb box = form.where ? csg::bounds(form.where) : Aabb::everything();
    if (form.near && !chosen.empty()) {
        Aabb around;
        around.include(*form.near);
        box = overlap(box, grown(around, distance_to(chosen[0], *form.near)));
    }
    return box;
}

/// What is known of the faces must be enough: an edge that can not be seen would be left sharp without a word.
Result<void> check_known(const Body& body, bool within_operands, double radius,
                         const Aabb& choice) {
    for (const Leaf& leaf : body.leaves()) {
        if (leaf.unknown.empty()) continue;
        for (const Leaf& other : body.leaves()) {
            // A whole ellipsoid has no edges of its own.
            if (&leaf == &other ? !within_operands || leaf.face_count == 0
                                : !within_operands && leaf.operand == other.operand)
                continue;
            if (overlap(overlap(grown(leaf.box, radius), other.box), choice).empty()) continue;
            return fail(
                ErrorCode::bad_argument,
                &leaf == &other
                    ? fmt::format("{} can not be blended: {}", body.name_of(leaf), leaf.unknown)
                    : fmt::format("{} can not be blended with {}: {}", body.name_of(leaf),
                                  body.name_of(other), leaf.unknown),
                "blends join planes, spheres, cylinders, cones and tori");
        }
    }
    return {};
}

Result<Blended> blend(const Body& body, csg::Solid sharp, bool within_operands,
                      std::optional<Edges> only, const Form& form, SourceSpan span,
                      const Spend& spend) {
    if (!body.box().bounded()) {
        return fail(ErrorCode::unbounded, "an unbounded solid can not be blended",
                    "intersect it with something finite first");
    }
    if (body.box().empty()) return Blended{std::move(sharp), 0};
    const double size = max_norm(body.box().size());
    if (form.radius < kSmallest * size) {
        return fail(
            ErrorCode::out_of_range,
            fmt::format("a radius of {:g} is lost in a solid of size {:g}", form.radius, size),
            "take a larger one, or leave the edges sharp");
    }
    auto found = find_segments(body, within_operands, std::min(form.radius, size), spend);
    if (!found) return Failure(std::move(found).error());
    std::vector<Segment>& segments = *found;
    if (auto checked = check_touching(body, within_operands, only, segments, form, spend);
        !checked) {
        return Failure(std::move(checked).error());
    }
    const auto go_on = [&](double work) { return !spend || spend(work); };
    const Failure stopped = fail(ErrorCode::cancelled, "stopped");
    if (only) {
        std::erase_if(segments,
                      [&](const Segment& s) { return s.is_convex != (*only == Edges::convex); });
    }
    select(segments, form);
    if (auto known = check_known(body, within_operands, form.radius, choice_of(form, segments));
        !known) {
        return Failure(std::move(known).error());
    }

    if (!go_on(static_cast<double>(segments.size()))) return stopped;
    auto corners = find_corners(body, segments, form.profile, form.radius);
    if (!corners) return Failure(std::move(corners).error());
    for (std::size_t i = 0; i < segments.size(); ++i) {
        if (segments[i].is_used_up) continue;
        const Fitting fitting = fitting_of(body, segments[i], form.radius, spend);
        if (fitting.fit == Fit::stopped) return stopped;
        if (fitting.fit != Fit::good) return does_not_fit(body, segments, i, fitting, form, spend);
    }
    for (const Corner& corner : *corners) {
        if (!go_on(corner_work(body, corner))) return stopped;
        if (const Fitting fitting = fitting_of(body, corner, form.radius); fitting.fit != Fit::good)
            return does_not_fit(body, segments, corner, fitting, form, spend);
    }
    std::vector<Job> jobs;
    for (Segment& segment : segments) {
        if (segment.is_used_up) continue;
        Job job;
        job.extent = extent_of(body, segment, form.radius);
        job.segment = std::move(segment);
        jobs.push_back(std::move(job));
    }
    std::vector<std::array<EndPlan, 2>> plans(jobs.size());
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        if (!go_on(static_cast<double>(jobs.size()) * 0.1)) return stopped;
        if (jobs[i].segment.is_closed) continue;
        for (std::size_t end = 0; end < 2; ++end) plans[i][end] = plan_of(body, jobs, i, end);
    }
    std::vector<RoundedRing> rings;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        if (!go_on(jobs[i].segment.space ? kTubeWork : 10.0)) return stopped;
        extend(body, jobs, i, form.radius, plans[i]);
        const Segment& segment = jobs[i].segment;
        const csg::MaterialId material = body.leaves()[body.faces()[segment.face_a].leaf].material;
        if (segment.space && form.profile == Profile::ball && shows_alike(body, material)) {
            auto ring = rounded_ring(body, segment, form.radius, span);
            if (ring && *ring && stands_apart(**ring, rings)) {
                (*ring)->tube = painted(std::move((*ring)->tube), material, span);
                rings.push_back(*std::move(*ring));
                continue;
            }
        }
        auto made = segment.space ? tube_wedge(body, segment, form, jobs[i].lo, jobs[i].hi, span)
                                  : solid_of(segment, form, jobs[i].lo, jobs[i].hi, span);
        if (!made && segment.space && made.error().code == ErrorCode::out_of_range)
            return is_too_sharp(body, segment, form, span, spend);
        if (!made) return Failure(std::move(made).error());
        jobs[i].solid = painted(std::move(*made), material, span);
    }
    std::vector<csg::Solid> rounds;
    std::vector<csg::Solid> fillets;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        if (!jobs[i].solid) continue;
        auto cut = cut_at_ends(body, jobs, i, plans[i], span);
        if (!cut) return Failure(std::move(cut).error());
        (jobs[i].segment.is_convex ? rounds : fillets).push_back(std::move(*cut));
    }
    if (form.profile == Profile::ball) {
        for (const Corner& corner : *corners) {
            auto made = solids_of(body, corner, form, span);
            if (!made) return Failure(std::move(made).error());
            auto& to = corner.is_convex ? rounds : fillets;
            to.insert(to.end(), made->begin(), made->end());
        }
    }
    Blended out{std::move(sharp), jobs.size()};
    if (!rings.empty()) out.solid = rounded_off(std::move(out.solid), std::move(rings), span);
    if (!rounds.empty()) {
        rounds.insert(rounds.begin(), std::move(out.solid));
        out.solid = csg::boolean(csg::Op::difference, std::move(rounds), span);
    }
    if (!fillets.empty()) {
        fillets.insert(fillets.begin(), std::move(out.solid));
        out.solid = csg::boolean(csg::Op::unite, std::move(fillets), span);
    }
    return out;
}

}  // namespace

Result<Blended> blended(csg::Op op, std::vector<csg::Solid> operands, const Form& form,
                        SourceSpan span, const Spend& spend) {
    auto body = Body::make(op, operands);
    if (!body) return Failure(std::move(body).error());
    csg::Solid sharp = csg::boolean(op, std::move(operands), span);
    return blend(*body, std::move(sharp), false, std::nullopt, form, span, spend);
}

Result<Blended> blended_edges(const csg::Solid& solid, Edges edges, const Form& form,
                              SourceSpan span, const Spend& spend) {
    auto body = Body::make(csg::Op::unite, {solid});
    if (!body) return Failure(std::move(body).error());
    return blend(*body, solid, true, edges, form, span, spend);
}

}  // namespace raymo::blends
