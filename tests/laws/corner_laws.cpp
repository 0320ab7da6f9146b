// Rounded convex polyhedra with many faces in a corner, and filleted hollows of their shape, against their definition.
//
// The centres of balls of radius r within P = { n_i.x <= k_i } are P_r = { n_i.x <= k_i - r }, and P with its edges rounded is
// all that is no farther than r from P_r, as long as every face of P has its own face of P_r left. The judge knows of no
// corners: the foot of a point on P_r is the point itself, or its foot on one, two or three of the planes, whichever is nearest of
// those that are in P_r. Which faces are left is asked line by line. All in extended precision.
//
// The polyhedra: hulls of points on an ellipsoid, whose corners have three to seven faces in any position; pyramids and double
// pyramids, regular, or off that by as little as roundings, whose balls coincide or nearly do.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <numbers>

#include "raymo/blends/blend.hpp"
#include "raymo/query/locate.hpp"
#include "raymo/trace/tracer.hpp"
#include "tests/laws/judge.hpp"
#include "tests/laws/law.hpp"
#include "tests/laws/rolled.hpp"

namespace raymo::laws {
namespace {

/// Roundings of points, of planes and of what they make; sharp corners have them magnified.
constexpr Real kMargin = 4e-9L;
/// The same for rays nearly in planes, which they meet with errors magnified, or aside of where they should.
constexpr Real kGrazing = 1e-7L;
constexpr double kSize = 4.0;  ///< of a cube about the origin that holds the polyhedra

Real r(double x) { return static_cast<Real>(x); }

struct RealPlane {
    RealVec normal;
    Real offset;
};

class Polyhedron {
public:
    explicit Polyhedron(std::vector<RealPlane> planes) : planes_(std::move(planes)) {}

    [[nodiscard]] std::size_t size() const { return planes_.size(); }
    [[nodiscard]] const std::vector<RealPlane>& planes() const { return planes_; }

    /// The point of three inner planes.
    [[nodiscard]] std::optional<RealVec> vertex(std::size_t i, std::size_t k, std::size_t m,
                                                Real radius) const {
        const RealVec a = planes_[i].normal, b = planes_[k].normal, c = planes_[m].normal;
        const Real det = dot(a, cross(b, c));
        if (std::fabs(det) < 1e-12L) return std::nullopt;
        return (cross(b, c) * (planes_[i].offset - radius) +
                cross(c, a) * (planes_[k].offset - radius) +
                cross(a, b) * (planes_[m].offset - radius)) *
               (1 / det);
    }
    /// Whether P_r holds a point that is on its planes `on`, however well that is known, and `slack` within the others.
    [[nodiscard]] bool holds(RealVec p, Real radius, Real slack,
                             std::initializer_list<std::size_t> on = {}) const {
        for (std::size_t i = 0; i < size(); ++i) {
            if (std::find(on.begin(), on.end(), i) != on.end()) continue;
            if (dot(planes_[i].normal, p) > planes_[i].offset - radius + slack) return false;
        }
        return true;
    }
    /// Distance of a point from P_r; and its foot.
    [[nodiscard]] Real distance(RealVec p, Real radius) const {
        Real least = -1;
        const auto consider = [&](RealVec c, std::initializer_list<std::size_t> on) {
            const Real d = norm(c - p);
            if ((least < 0 || d < least) && holds(c, radius, 1e-14L, on)) least = d;
        };
        consider(p, {});
        const auto off = [&](std::size_t i) {
            return planes_[i].offset - radius - dot(planes_[i].normal, p);
        };
        for (std::size_t i = 0; i < size(); ++i) {
            const RealVec a = planes_[i].normal;
            consider(p + a * off(i), {i});
            for (std::size_t k = 0; k < i; ++k) {
                const RealVec b = planes_[k].normal;
                const Real g = dot(a, b);
                if (1 - g * g < 1e-12L) continue;
                consider(
                    p + (a * (off(i) - g * off(k)) + b * (off(k) - g * off(i))) * (1 / (1 - g * g)),
                    {i, k});
                for (std::size_t m = 0; m < k; ++m) {
                    if (const auto c = vertex(i, k, m, radius)) consider(*c, {i, k, m});
                }
            }
        }
        return least;
    }
    /// Of the edges of P the shortest that P_r has in their place; below zero if one is used up.
    [[nodiscard]] Real least_edge(Real radius) const {
        Real least = 1000;
        for (std::size_t i = 0; i < size(); ++i) {
            for (std::size_t k = 0; k < i; ++k) {
                if (stretch(i, k, 0) > 0) least = std::min(least, stretch(i, k, radius));
            }
        }
        return least;
    }
    /// Of the faces of P_r the one with the shortest longest edge; below zero if one is used up.
    [[nodiscard]] Real least_face(Real radius) const {
        Real least = 1000;
        for (std::size_t i = 0; i < size(); ++i) {
            Real longest = -1000;
            for (std::size_t k = 0; k < size(); ++k) {
                if (k != i) longest = std::max(longest, stretch(i, k, radius));
            }
            least = std::min(least, longest);
        }
        return least;
    }

private:
    /// Length of what two inner planes have in common within the others.
    [[nodiscard]] Real stretch(std::size_t i, std::size_t k, Real radius) const {
        const RealVec a = planes_[i].normal, b = planes_[k].normal;
        const Real g = dot(a, b);
        if (1 - g * g < 1e-12L) return -1;
        const Real oa = planes_[i].offset - radius, ob = planes_[k].offset - radius;
        const RealVec from = (a * (oa - g * ob) + b * (ob - g * oa)) * (1 / (1 - g * g));
        const RealVec way = unit(cross(a, b));
        Real lo = -1000, hi = 1000;
        for (std::size_t m = 0; m < size(); ++m) {
            if (m == i || m == k) continue;
            const Real room = planes_[m].offset - radius - dot(planes_[m].normal, from);
            const Real speed = dot(planes_[m].normal, way);
            if (std::fabs(speed) < 1e-14L) {
                if (room < -1e-12L) return -1000;
                continue;
            }
            if (speed > 0) {
                hi = std::min(hi, room / speed);
            } else {
                lo = std::max(lo, room / speed);
            }
        }
        return hi - lo;
    }

    std::vector<RealPlane> planes_;
};

RealPlane through(Vec3 a, Vec3 b, Vec3 c, Vec3 inside) {
    RealVec n = unit(cross(real(b) - real(a), real(c) - real(a)));
    if (dot(n, real(inside) - real(a)) > 0) n = n * -1;
    return {n, dot(n, real(a))};
}

/// The hull of points on an ellipsoid.
Polyhedron any_hull(Random& random) {
    const int count = 5 + random.below(4);
    const Vec3 axes{random.uniform(1, 3), random.uniform(1, 3), random.uniform(1, 3)};
    std::vector<Vec3> points;
    while (static_cast<int>(points.size()) < count) {
        const Vec3 p = random.direction() * axes;
        if (std::all_of(points.begin(), points.end(), [&](Vec3 q) { return norm(p - q) > 0.8; })) {
            points.push_back(p);
        }
    }
    std::vector<RealPlane> planes;
    Vec3 middle;
    for (const Vec3 p : points) middle = middle + p / count;
    for (std::size_t i = 0; i < points.size(); ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            for (std::size_t m = 0; m < k; ++m) {
                const RealPlane plane = through(points[i], points[k], points[m], middle);
                if (std::all_of(points.begin(), points.end(), [&](Vec3 p) {
                        return dot(plane.normal, real(p)) <= plane.offset + 1e-15L;
                    })) {
                    planes.push_back(plane);
                }
            }
        }
    }
    return Polyhedron(std::move(planes));
}

/// A pyramid, or two on one base; regular but for so much, with planes that miss its corners by nothing or so much.
Polyhedron any_pyramid(Random& random, bool is_double) {
    const int count = is_double ? 4 + random.below(3) : 4 + random.below(8);
    const double off = random.chance(0.3) ? 0.0 : std::pow(10.0, random.uniform(-15, -0.7));
    // Flat ones and sharp ones, too.
    const double wide = std::pow(10.0, random.uniform(-1.0, 0.5));
    std::vector<Vec3> base;
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * std::numbers::pi * (i + random.uniform(-off, off)) / count;
        base.push_back({wide * std::cos(angle), wide * std::sin(angle), 0});
    }
    const auto high = [&] { return std::pow(10.0, random.uniform(-0.7, 0.5)); };
    const Vec3 top = Vec3{0, 0, high()} + random.in_cube(0.5 * off);
    const Vec3 bottom = Vec3{0, 0, random.chance(0.3) ? -top.z : -high()};
    const Vec3 inside{0, 0, 0.01 * top.z};
    std::vector<RealPlane> planes;
    for (std::size_t i = 0; i < base.size(); ++i) {
        const Vec3 p = base[i];
        const Vec3 q = base[(i + 1) % base.size()];
        planes.push_back(through(p, q, top, inside));
        if (is_double) planes.push_back(through(p, q, bottom, inside));
    }
    if (!is_double) planes.push_back({{0, 0, -1}, 0});
    if (random.chance(0.3)) {
        const double moved = std::pow(10.0, random.uniform(-15, -2));
        for (RealPlane& plane : planes) plane.offset += r(random.uniform(-moved, moved));
    }
    return Polyhedron(std::move(planes));
}

class Trial {
public:
    Trial(const Polyhedron& body, bool is_hollow, Random& random, Tally& tally)
        : body_(body), is_hollow_(is_hollow), random_(random), tally_(tally) {
        // What is rounded: in a block that no plane leaves, half-spaces, or blocks with a side in the plane.
        ModelPtr all = block({4 * kSize, 4 * kSize, 4 * kSize}, true);
        for (const RealPlane& plane : body.planes()) {
            const Vec3 n = rounded(plane.normal);
            const double offset = static_cast<double>(plane.offset);
            if (random.chance(0.5)) {
                all = meet(all, halfspace(n, offset));
                continue;
            }
            Affine map;
            Vec3 u, v;
            make_frame(n, u, v);
            for (int i = 0; i < 3; ++i)
                map.linear.row[static_cast<std::size_t>(i)] = {u[i], v[i], n[i]};
            map.offset = n * (offset - 4 * kSize);
            all = meet(all, moved(block({8 * kSize, 8 * kSize, 8 * kSize}, true), map));
        }
        if (is_hollow) all = cut(block({3 * kSize, 3 * kSize, 3 * kSize}, true), all);
        scale_ = std::pow(10.0, random.uniform(-3, 3));
        map_ = translation(random.in_cube(5 * scale_)) *
               rotation(random.direction(), random.uniform(0, 360)) *
               scaling({scale_, scale_, random.chance(0.5) ? scale_ : -scale_});
        model_ = moved(all, map_);
    }

    void run(std::uint64_t rays) {
        ++tally_.samples;
        radius_ = std::pow(10.0, random_.uniform(-1.5, 0.3));
        auto made = attempt(radius_);
        if (!made) {
            double most = 0;
            if (made.error().code != ErrorCode::out_of_range ||
                std::sscanf(made.error().hint.c_str(), "the largest radius that works here is %lf",
                            &most) != 1) {
                return fault("refused: " + made.error().message + "; " + made.error().hint);
            }
            most /= scale_;
            if (!(most < radius_)) return fault("told a largest radius that is larger");
            if (body_.least_edge(r(radius_)) > 1e-5L * r(radius_))
                return fault("refused, though no edge is used up: " + made.error().message);
            // Told to three digits.
            if (body_.least_edge(r(most * 1.011)) > 0)
                return fault("the largest radius is told as " + std::to_string(most));
            radius_ = most * (random_.chance(0.3) ? 1.0 : random_.uniform(0.2, 1.0));
            made = attempt(radius_);
            if (!made) return fault("does not work: " + std::to_string(radius_));
        }
        if (body_.least_face(r(radius_)) < -1e-4L * r(radius_))
            return fault("made, though a face is used up");
        tally_.samples += body_.least_edge(r(radius_)) < 0 ? 1 : 0;
        scene_.parts.push_back({"body", made->solid, {}});
        const auto compiled = trace::compile(scene_);
        if (!compiled) return fault("can not be compiled");
        trace::Tracer tracer(*compiled);
        query::Locator locator(made->solid);
        find_balls();
        const std::uint64_t faults = tally_.exceptions;
        for (std::uint64_t i = 0; i < rays && tally_.exceptions == faults; ++i) {
            ++tally_.rays;
            const Vec3 at = map_(any_point());
            judge(at, locator.where(at) == query::Where::in, kMargin, "point");
            ray(tracer, at);
        }
    }

private:
    [[nodiscard]] Result<blends::Blended> attempt(double radius) const {
        blends::Form form;
        form.radius = radius * scale_;
        return blends::blended_edges(
            build(model_), is_hollow_ ? blends::Edges::concave : blends::Edges::convex, form);
    }
    struct Ball {
        RealVec centre;
        std::array<RealVec, 3> normals;
    };
    void find_balls() {
        for (std::size_t i = 0; i < body_.size(); ++i) {
            for (std::size_t k = 0; k < i; ++k) {
                for (std::size_t m = 0; m < k; ++m) {
                    const auto c = body_.vertex(i, k, m, r(radius_));
                    if (!c || !body_.holds(*c, r(radius_), 1e-9L)) continue;
                    balls_.push_back({*c,
                                      {body_.planes()[i].normal, body_.planes()[k].normal,
                                       body_.planes()[m].normal}});
                }
            }
        }
    }
    /// On or near a ball or what joins it to others, or anywhere.
    [[nodiscard]] Vec3 any_point() {
        if (balls_.empty() || random_.chance(0.1)) return random_.in_cube(kSize);
        const Ball& ball =
            balls_[static_cast<std::size_t>(random_.below(static_cast<int>(balls_.size())))];
        RealVec towards = ball.normals[0] * r(random_.uniform(-0.1, 1));
        for (std::size_t i = 1; i < 3; ++i) {
            // Near to or on what one or two of the planes have, too.
            const double least = random_.chance(0.3) ? 0.0 : -0.1;
            towards = towards + ball.normals[i] * r(std::max(random_.uniform(-0.5, 1), least));
        }
        const Real off = r(std::pow(10.0, random_.uniform(-8, 0)));
        RealVec p =
            ball.centre + unit(towards) * (r(radius_) * (random_.chance(0.5) ? 1 + off : 1 - off));
        if (random_.chance(0.2))
            p = p + real(random_.direction()) * (r(radius_) * r(random_.uniform(0, 1)));
        return rounded(p);
    }

    /// Nearly in a plane that bounds a ball's corner.
    [[nodiscard]] Vec3 near_plane() {
        const auto any = [&](const auto& list) -> const auto& {
            return list[static_cast<std::size_t>(random_.below(static_cast<int>(list.size())))];
        };
        const Ball& ball = any(balls_);
        const RealVec d = any(ball.normals) * r(random_.uniform(-1, 1)) +
                          any(ball.normals) * r(random_.uniform(-1, 1));
        const double off = std::pow(10.0, random_.uniform(-16, -1));
        return rounded(d) + random_.direction() * off;
    }

    void ray(trace::Tracer& tracer, Vec3 at) {
        const bool is_grazing = !balls_.empty() && random_.chance(0.3);
        const Real margin = is_grazing ? kGrazing : kMargin;
        const Vec3 d = unit(map_.linear * (is_grazing ? near_plane() : random_.direction()));
        const Ray line{at - d * (scale_ * random_.uniform(0, 3)), d * scale_};
        line_ = line;
        tracer.spans(line, spans_);
        if (spans_.empty()) spans_.resize(1);
        ask_stretches(spans_[0], r(3 * kSize), 1e-7, [&](Real t, bool is_in) {
            judge(line.origin + line.direction * static_cast<double>(t), is_in, margin, "ray at");
        });
    }

    void judge(Vec3 at, bool is_in, Real margin, const char* what) {
        const Vec3 p = inverse(map_)(at);
        if (max_norm(p) > kSize) return;
        ++tally_.samples;
        const Real d = body_.distance(real(p), r(radius_));
        if (std::fabs(d - r(radius_)) < margin) return;
        if ((d < r(radius_)) == (is_in != is_hollow_)) return;
        char place[400];
        std::snprintf(place, sizeof place,
                      " [%.17g, %.17g, %.17g], off by %.3Lg, is said to be %s; the last line is "
                      "[%.17g, %.17g, %.17g] + t [%.17g, %.17g, %.17g]",
                      at.x, at.y, at.z, d - r(radius_), is_in ? "in" : "out", line_.origin.x,
                      line_.origin.y, line_.origin.z, line_.direction.x, line_.direction.y,
                      line_.direction.z);
        fault(std::string(what) + place);
    }
    void fault(const std::string& what) {
        char size[40];
        std::snprintf(size, sizeof size, "%.17g", radius_ * scale_);
        tally_.exception(what + ": " + (is_hollow_ ? "filleted(" : "rounded(") + text(*model_) +
                         ", " + size + ")");
    }

    const Polyhedron& body_;
    bool is_hollow_;
    Random& random_;
    Tally& tally_;
    ModelPtr model_;
    Affine map_;
    double scale_ = 1.0;
    double radius_ = 1.0;
    std::vector<Ball> balls_;
    scene::Scene scene_;
    Ray line_;
    std::vector<std::vector<trace::PartSpan>> spans_;
};

void corners(std::uint64_t rays, Random& random, Tally& tally) {
    const std::uint64_t count = std::max<std::uint64_t>(rays / 100, 40);
    for (std::uint64_t i = 0; i < count; ++i) {
        const Polyhedron body =
            i % 2 == 0 ? any_hull(random) : any_pyramid(random, random.chance(0.5));
        Trial(body, random.chance(0.4), random, tally).run(rays / count);
    }
}

}  // namespace

void add_corner_laws(std::vector<Law>& laws) {
    laws.push_back({"blends: corners of many planes, by their definition", 1000000, corners});
}

}  // namespace raymo::laws
