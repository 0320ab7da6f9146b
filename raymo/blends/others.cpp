#include "raymo/blends/others.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "raymo/math/tolerance.hpp"

namespace raymo::blends {
namespace {

using solids::Where;

/// How far beside a contact it is asked what is solid, in parts of the radius.
constexpr double kBeside = 0x1p-14;
/// Stretches that are no longer than this part of the radius are not halved any more,
constexpr double kFinest = 0x1p-5;
/// nor those that have been halved so often.
constexpr int kMostHalvings = 12;

/// Work is told in lumps of so many units of 100 ns.
constexpr double kLump = 1e3;

/// Whether a face is met at an end of the segment that is within `reach` of t: there the wedge is cut by it.
bool is_end(const Segment& segment, std::size_t face, double t, double reach) {
    if (segment.is_closed) return false;
    return std::any_of(std::begin(segment.ends), std::end(segment.ends), [&](const End& end) {
        return std::fabs(end.at - t) < reach &&
               std::find(end.faces.begin(), end.faces.end(), face) != end.faces.end();
    });
}

/// Whether a third face, whose surface is at the distance d from it, comes into the ball about c at parameter t.
bool is_in_the_way(const Body& body, const Segment& segment, std::size_t f, Vec3 c, double d,
                   double radius, double t, double margin) {
    // An oblique one reaches some way along.
    if (is_end(segment, f, t, 4.0 * margin)) return false;
    const Aabb& box = body.leaves()[body.faces()[f].leaf].box;
    if (!grown(box, radius).contains(c)) return false;
    if (!(std::fabs(d) < (1.0 - kPress) * radius)) return false;
    const Vec3 n = body.faces()[f].surface.normal(c);
    const Vec3 foot = c - n * d;
    if (!body.is_on(body.faces()[f], foot)) return false;
    // No farther than roundings ask for: blends have faces just within those of what they blend.
    const double size = max_norm(foot) + max_norm(max(abs(body.box().lo), abs(body.box().hi)));
    const Vec3 step = n * (64.0 * kPointError * size);
    const Where a = body.where(foot - step);
    const Where b = body.where(foot + step);
    return a != b && a != Where::on && b != Where::on;
}

/// How far a point is from a box.
double gap_to(const Aabb& box, Vec3 p) { return norm(max(max(box.lo - p, p - box.hi), Vec3{})); }

/// Whether a wall stands upright on a plane.
bool is_upright(const Surface& plane, const Surface& wall) {
    if (plane.kind != SurfaceKind::plane || wall.kind != SurfaceKind::wall) return false;
    EdgeCurve line;
    line.along = plane.axis;
    return runs_along(line, wall);
}

/// A stretch of the segment.
struct Stretch {
    double lo, hi;
    int halvings;
};

/// What a face has to do with the segment.
struct Relation {
    bool goes_along = false;  ///< its surface is as far off all along
    bool is_own[2]{};         ///< it is in the surface of face a, of face b
};

/// A place of the ball.
struct Place {
    double t = 0.0;
    std::optional<Touch> touch;
    std::optional<Fitting> contacts;  ///< how they are on the faces
    /// How far the contacts may go, at least, with nothing new beside them.
    std::optional<double> even;
};

/// What is known of a stretch.
struct View {
    Stretch stretch;
    Place* middle;      ///< null where the ball is lost
    const Touch* ball;  ///< there
    double half;        ///< the way to its ends, at most
};

class Others {
public:
    Others(const Body& body, const Segment& segment, double radius, double margin,
           const Spend& spend)
        : body_(body),
          segment_(segment),
          radius_(radius),
          margin_(margin),
          touch_work_(touch_work(body, segment)),
          spend_(spend) {
        const Surface& a = surface(segment.face_a);
        const Surface& b = surface(segment.face_b);
        is_upright_ = is_upright(a, b) || is_upright(b, a);
        if (!segment.space) wedge_ = wedge_of(segment, radius);
        relations_.resize(body.faces().size());
    }

    /// All faces ask for the same places.
    Fitting look(double lo, double hi, std::size_t first) {
        const std::size_t count = body_.faces().size();
        const View whole = view_of({lo, hi, 0});
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t f = (first + i) % count;
            if (f == segment_.face_a || f == segment_.face_b) continue;
            Fitting found = look_at(f, whole);
            while (found.fit == Fit::good && !open_.empty()) {
                const Stretch at = open_.back();
                open_.pop_back();
                found = look_at(f, view_of(at));
            }
            if (found.fit != Fit::good) {
                found.found = f;
                return is_paid() ? found : Fitting{Fit::stopped};
            }
            if (work_ >= kLump && !is_paid()) return {Fit::stopped};
        }
        return {is_paid() ? Fit::good : Fit::stopped};
    }

private:
    bool is_paid() { return !spend_ || spend_(std::exchange(work_, 0.0)); }
    [[nodiscard]] const Surface& surface(std::size_t f) const { return body_.faces()[f].surface; }
    [[nodiscard]] const Leaf& leaf_of(std::size_t f) const {
        return body_.leaves()[body_.faces()[f].leaf];
    }

    const Relation& relation(std::size_t f) {
        std::optional<Relation>& known = relations_[f];
        if (known) return *known;
        known.emplace();
        known->goes_along = !segment_.space && runs_along(segment_.edge, surface(f));
        for (const std::size_t i : {0U, 1U}) {
            const std::size_t own = i == 0 ? segment_.face_a : segment_.face_b;
            known->is_own[i] = f == own || is_one(surface(f), surface(own));
        }
        return *known;
    }

    [[nodiscard]] std::optional<Touch> touch(double t) const {
        if (segment_.space) return touch_at(body_, segment_, radius_, t);
        return wedge_ ? std::optional(touch_at(segment_, *wedge_, t)) : std::nullopt;
    }

    Place& place_at(double t) {
        const auto [place, is_new] = places_.try_emplace(t);
        if (is_new) {
            place->second.t = t;
            place->second.touch = touch(t);
            work_ += touch_work_;
        }
        return place->second;
    }

    const Fitting& contacts_at(Place& here, const Touch& ball) {
        if (!here.contacts) {
            here.contacts = at_contacts(body_, segment_, ball, radius_);
            work_ += 4.0 * body_.where_work();
        }
        return *here.contacts;
    }

    double distance(std::size_t f, Vec3 p) {
        work_ += surface(f).work();
        return surface(f).distance(p);
    }

    /// How far a point at a place may go along with the ball, at least, before its distance from a surface, which is d there,
    /// comes down to `size`.
    [[nodiscard]] double way_to(const Surface& s, double d, Vec3 p, double t, double size) const {
        const double off = std::fabs(d) - size;
        if (!(off > 0.0) || segment_.space) return off;
        // Up to here parallels of the surface have no smaller radius of curvature than that.
        const double round = 0.5 * s.least_round(p);
        if (!(round > off)) return off;
        const EdgeCurve& edge = segment_.edge;
        const double slope = std::fabs(dot(s.normal(p), edge.tangent(t)));
        double bend = 1.0 / round;
        if (edge.is_circle) bend += 1.0 / norm(cross(p - edge.origin, edge.along));
        const double way = 2.0 * off / (slope + std::sqrt(slope * slope + 2.0 * bend * off));
        return std::max(off, std::min(way, round));
    }

    /// How far the contacts may go, at least, with the same about them all the way: no boundary comes between what is asked
    /// there.
    double even_way(Place& here, const Touch& ball) {
        if (here.even) return *here.even;
        double least = Aabb::kInf;
        const double size = 2.0 * kBeside * radius_;
        for (std::size_t i = 0; i < 2; ++i) {
            const Vec3 p = ball.contact[i];
            for (const Leaf& leaf : body_.leaves()) {
                const double gap = gap_to(leaf.near, p) - size;
                if (gap >= least || least <= 0.0) continue;
                if (!leaf.unknown.empty()) least = std::max(gap, 0.0);
                for (std::size_t f = leaf.first_face; f < leaf.first_face + leaf.face_count; ++f) {
                    const Relation& face = relation(f);
                    if (face.is_own[i] || (is_upright_ && face.is_own[1 - i])) continue;
                    const double d = distance(f, p);
                    if (!face.goes_along) {
                        least =
                            std::min(least, std::max(gap, way_to(surface(f), d, p, here.t, size)));
                    } else if (std::fabs(d) > 0.25 * size && std::fabs(d) < size) {
                        least = 0.0;
                    }
                }
            }
        }
        here.even = least;
        return least;
    }

    /// Whether a face, whose surface is at the distance d from the centre in the middle of a stretch, may come into the ball there.
    bool may_come(std::size_t f, const View& view, double d) {
        const double size = (1.0 - kPress) * radius_;
        const Relation& face = relation(f);
        const bool stays = face.goes_along || face.is_own[0] || face.is_own[1];
        if (stays && std::fabs(d) >= size) return false;
        const Vec3 c = view.ball->centre;
        return std::max(way_to(surface(f), d, c, view.middle->t, size),
                        gap_to(leaf_of(f).near, c) - size) < view.half;
    }

    View view_of(const Stretch& at) {
        const double t = 0.5 * (at.lo + at.hi);
        Place& here = place_at(t);
        const std::optional<Touch>& touch = here.touch;
        const std::optional<Touch>& from = place_at(at.lo).touch;
        const std::optional<Touch>& to = place_at(at.hi).touch;
        if (!touch || !from || !to) return {at, nullptr, nullptr, 0.0};
        // The ways of centre and contacts, in parts of the edge's: exact along lines and circles. Arcs are longer than their
        // chords: by less than a quarter where they turn by less than two radians.
        const auto way = [](const Touch& p, const Touch& q) {
            return std::max({norm(p.centre - q.centre), norm(p.contact[0] - q.contact[0]),
                             norm(p.contact[1] - q.contact[1])});
        };
        const bool is_bent = segment_.space || segment_.edge.is_circle;
        return {at, &here, &*touch,
                is_bent && at.halvings < 3 ? (at.hi - at.lo) * segment_.speed() + 2.0 * radius_
                                           : 1.25 * std::max(way(*from, *touch), way(*touch, *to))};
    }

    /// Looks at the middle of a stretch, and opens its halves where that does not settle it.
    Fitting look_at(std::size_t f, const View& view) {
        if (view.middle == nullptr) return {Fit::none, 0};
        Place& here = *view.middle;
        const Stretch& at = view.stretch;
        const double t = here.t;
        const double half = view.half;
        const Touch& ball = *view.ball;
        const Aabb& box = leaf_of(f).near;
        const double d = distance(f, ball.centre);
        const double beside[2] = {std::fabs(distance(f, ball.contact[0])),
                                  std::fabs(distance(f, ball.contact[1]))};
        const auto is_clear = [&](double off, Vec3 p, double size) {
            return off >= size + half || gap_to(box, p) >= size + half;
        };
        if (is_clear(std::fabs(d), ball.centre, (1.0 - kPress) * radius_) &&
            is_clear(beside[0], ball.contact[0], 0.0) &&
            is_clear(beside[1], ball.contact[1], 0.0)) {
            return {};
        }
        if (is_in_the_way(body_, segment_, f, ball.centre, d, radius_, t, margin_))
            return {Fit::blocked, f};
        // Where the face ends the edge an oblique one reaches some way along.
        const bool is_near = std::min(beside[0], beside[1]) < half;
        if (is_near && !is_end(segment_, f, t, 4.0 * margin_)) {
            if (const Fitting& contacts = contacts_at(here, ball); contacts.fit != Fit::good)
                return contacts;
        }
        if (half <= kFinest * radius_ || at.halvings == kMostHalvings) return {};
        // What holds here may hold all along.
        if (!may_come(f, view, d) && even_way(here, ball) >= half &&
            contacts_at(here, ball).fit == Fit::good) {
            return {};
        }
        open_.push_back({at.lo, t, at.halvings + 1});
        open_.push_back({t, at.hi, at.halvings + 1});
        return {};
    }

    const Body& body_;
    const Segment& segment_;
    double radius_;
    double margin_;
    double touch_work_;
    const Spend& spend_;
    double work_ = 0.0;           ///< since it was told
    std::optional<Wedge> wedge_;  ///< of a line or a circle
    /// The contacts are as far from the other one of the segment's surfaces as from the centre.
    bool is_upright_ = false;
    std::vector<std::optional<Relation>> relations_;  ///< of the faces, as they are asked for
    std::unordered_map<double, Place> places_;
    std::vector<Stretch> open_;
};

}  // namespace

Fitting at_contacts(const Body& body, const Segment& segment, const Touch& touch, double radius) {
    for (std::size_t i = 0; i < 2; ++i) {
        const Vec3 step = touch.outward[i] * (kBeside * radius);
        const Where inner = body.where(touch.contact[i] - step);
        const Where outer = body.where(touch.contact[i] + step);
        if (inner == Where::out || outer == Where::in) {
            return {Fit::off_face, i == 0 ? segment.face_a : segment.face_b};
        }
    }
    return {};
}

Fitting among_others(const Body& body, const Segment& segment, double radius, double lo, double hi,
                     double margin, const Spend& spend, std::size_t first) {
    return Others(body, segment, radius, margin, spend).look(lo, hi, first);
}

}  // namespace raymo::blends
