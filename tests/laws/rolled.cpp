#include "tests/laws/rolled.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace raymo::laws {
namespace {

/// Roundings of a distance, in extended precision, in parts of the size.
constexpr Real kRounding = 1e-17L;

struct Polar {
    Real along, across;
    RealVec away;  ///< unit; any where across is 0
};
Polar polar(const RealSurface& s, RealVec p) {
    const RealVec d = p - s.point;
    const Real along = dot(d, s.axis);
    const RealVec away = d - s.axis * along;
    const Real across = norm(away);
    if (across > 0) return {along, across, away * (1 / across)};
    const RealVec other = std::fabs(s.axis.x) < 0.5L ? RealVec{1, 0, 0} : RealVec{0, 1, 0};
    return {along, 0, unit(cross(s.axis, other))};
}

/// Solution of three equations with those rows; nothing where they are dependent.
std::optional<RealVec> solved(RealVec a, RealVec b, RealVec c, RealVec right) {
    const RealVec bc = cross(b, c);
    const Real det = dot(a, bc);
    if (!(std::fabs(det) > 1e-12L * norm(a) * norm(b) * norm(c))) return std::nullopt;
    return (bc * right.x + cross(c, a) * right.y + cross(a, b) * right.z) * (1 / det);
}

}  // namespace

Real dot(RealVec a, RealVec b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
RealVec cross(RealVec a, RealVec b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Real norm(RealVec a) { return std::sqrt(dot(a, a)); }
RealVec unit(RealVec a) { return a * (1 / norm(a)); }
RealVec real(Vec3 a) {
    return {static_cast<Real>(a.x), static_cast<Real>(a.y), static_cast<Real>(a.z)};
}
Vec3 rounded(RealVec a) {
    return {static_cast<double>(a.x), static_cast<double>(a.y), static_cast<double>(a.z)};
}

Vec3 flat_direction(RealVec n, RealVec along, Random& random) {
    const std::array<double, 3> turns{0.0, 0.5, random.uniform(0.0, 1.0)};
    const Real turn = static_cast<Real>(turns[static_cast<std::size_t>(random.below(3))]) *
                      std::numbers::pi_v<Real>;
    const RealVec way = along * std::cos(turn) + cross(n, along) * std::sin(turn);
    return rounded(way) + random.in_cube(std::pow(10.0, random.uniform(-17, -1)));
}

Real RealSurface::distance(RealVec p) const {
    const Polar at = polar(*this, p);
    switch (kind) {
        case Kind::plane:
            return side * at.along;
        case Kind::sphere:
            return side * (norm(p - point) - radius);
        case Kind::cylinder:
            return side * (at.across - radius);
        case Kind::cone:
            if (!has_smooth_foot(p)) return side * norm(p - point);
            return side * (at.across * std::cos(half_angle) - at.along * std::sin(half_angle));
        case Kind::torus:
            return side * (std::hypot(at.across - radius, at.along) - tube);
    }
    return 0;
}

RealVec RealSurface::gradient(RealVec p) const {
    const Polar at = polar(*this, p);
    switch (kind) {
        case Kind::plane:
            return axis * side;
        case Kind::sphere:
            return unit(p - point) * side;
        case Kind::cylinder:
            return at.away * side;
        case Kind::cone:
            if (!has_smooth_foot(p)) return unit(p - point) * side;
            return (at.away * std::cos(half_angle) - axis * std::sin(half_angle)) * side;
        case Kind::torus: {
            const Real x = at.across - radius;
            return (at.away * x + axis * at.along) * (side / std::hypot(x, at.along));
        }
    }
    return axis;
}

bool RealSurface::has_smooth_foot(RealVec p) const {
    if (kind != Kind::cone) return true;
    const Polar at = polar(*this, p);
    return at.along * std::cos(half_angle) + at.across * std::sin(half_angle) > 0;
}

RealSurface RealSurface::complement() const {
    RealSurface other = *this;
    other.side = -side;
    return other;
}

RealSurface RealSurface::mapped(const Affine& map) const {
    const auto turned = [&](RealVec a) {
        const Mat3& m = map.linear;
        return RealVec{dot(real(m.row[0]), a), dot(real(m.row[1]), a), dot(real(m.row[2]), a)};
    };
    const Real scale = norm(turned(axis));
    RealSurface out = *this;
    out.point = turned(point) + real(map.offset);
    out.axis = unit(turned(axis));
    out.radius *= scale;
    out.tube *= scale;
    return out;
}

std::optional<RealVec> Rolled::solve(const RealSection& section, Real r, RealVec start) const {
    RealVec y = start;
    const RealVec normal = cross(section.u, section.v);
    for (int i = 0; i < 30; ++i) {
        const RealVec off{r - p_.distance(y), r - q_.distance(y), 0};
        const auto step = solved(p_.gradient(y), q_.gradient(y), normal, off);
        if (!step) return std::nullopt;
        y = y + *step;
        if (!(norm(y - section.origin) < 1e6L * size_)) return std::nullopt;
        if (norm(*step) <= 8 * kRounding * size_) {
            if (section.is_half && !(dot(y - section.origin, section.u) > 0)) return std::nullopt;
            // Newton's method may end where a gradient jumps.
            if (std::fabs(p_.distance(y) - r) > 64 * kRounding * size_ ||
                std::fabs(q_.distance(y) - r) > 64 * kRounding * size_)
                return std::nullopt;
            return y;
        }
    }
    return std::nullopt;
}

std::vector<RealVec> Rolled::level(const RealSection& section, Real r, Real reach) const {
    constexpr int kPlaces = 24;
    std::vector<RealVec> found;
    for (int i = 0; i <= kPlaces; ++i) {
        for (int k = 0; k <= kPlaces; ++k) {
            const Real x = section.is_half ? i : 2 * i - kPlaces;
            const auto y = solve(section, r,
                                 section.at(reach * (x + 0.3L) / kPlaces,
                                            reach * (2 * k - kPlaces + 0.2L) / kPlaces));
            if (!y || norm(*y - section.origin) > reach) continue;
            bool is_new = true;
            for (const RealVec& other : found) is_new &= norm(other - *y) > 1e-9L * size_;
            if (is_new) found.push_back(*y);
        }
    }
    return found;
}

std::optional<RealVec> Rolled::follow(const RealSection& section, RealVec edge, Real r,
                                      Real& reached) const {
    RealVec y = edge;
    const RealVec normal = cross(section.u, section.v);
    const auto sense = [&](RealVec at) {
        return dot(cross(p_.gradient(at), q_.gradient(at)), normal);
    };
    reached = 0;
    Real step = r / 256;
    while (reached < r) {
        if (!(step > 1e-9L * r)) return std::nullopt;
        const Real next = std::min(reached + step, r);
        const auto there = solve(section, next, y);
        // Where the spine comes to an end two of them meet, which differ by their sense, and they do so as fast as a
        // root; any other jump is to another spine.
        const bool is_steady = there && norm(*there - y) <= 30 * (next - reached) + next / 32 &&
                               (sense(y) > 0) == (sense(*there) > 0);
        if (!is_steady || !p_.has_smooth_foot(*there) || !q_.has_smooth_foot(*there)) {
            step /= 2;
            continue;
        }
        y = *there;
        reached = next;
    }
    return y;
}

std::optional<RealVec> Rolled::nearby(RealVec x, Real r) const {
    for (int i = 0; i < 60; ++i) {
        const RealVec a = p_.gradient(x);
        const RealVec b = q_.gradient(x);
        const Real off_a = r - p_.distance(x);
        const Real off_b = r - q_.distance(x);
        const Real cosine = dot(a, b);
        const Real det = 1 - cosine * cosine;
        if (!(det > 1e-9L)) return std::nullopt;
        const RealVec step =
            a * ((off_a - cosine * off_b) / det) + b * ((off_b - cosine * off_a) / det);
        x = x + step;
        if (!(norm(x) < 1e6L * size_)) return std::nullopt;
        if (norm(step) > kRounding * size_) continue;
        if (std::fabs(p_.distance(x) - r) < 16 * kRounding * size_ &&
            std::fabs(q_.distance(x) - r) < 16 * kRounding * size_)
            return x;
        return std::nullopt;
    }
    return std::nullopt;
}

bool Rolled::is_of_edge(RealVec centre) const {
    RealVec y = centre;
    Real r = r_;
    Real step = r_ / 16;
    while (r > 0) {
        if (!(step > 1e-6L * r_)) return false;
        const Real next = std::max(r - step, Real{0});
        const auto there = nearby(y, next);
        if (!there || norm(*there - y) > 30 * (r - next) || !p_.has_smooth_foot(*there) ||
            !q_.has_smooth_foot(*there)) {
            step /= 2;
            continue;
        }
        y = *there;
        r = next;
    }
    return true;
}

std::optional<RealVec> Rolled::polished_foot(RealVec x, RealVec y) const {
    // p = r, q = r, and x in the plane across.
    const auto residual = [&](RealVec at) {
        return RealVec{p_.distance(at) - r_, q_.distance(at) - r_,
                       dot(at - x, cross(p_.gradient(at), q_.gradient(at)))};
    };
    for (int i = 0; i < 30; ++i) {
        const RealVec f = residual(y);
        const RealVec across = cross(p_.gradient(y), q_.gradient(y));
        // The third equation's gradient by differences; its terms with x change slowly.
        const Real h = 1e-7L * r_;
        RealVec slope;
        slope.x = (residual(y + RealVec{h, 0, 0}).z - residual(y - RealVec{h, 0, 0}).z) / (2 * h);
        slope.y = (residual(y + RealVec{0, h, 0}).z - residual(y - RealVec{0, h, 0}).z) / (2 * h);
        slope.z = (residual(y + RealVec{0, 0, h}).z - residual(y - RealVec{0, 0, h}).z) / (2 * h);
        const auto step =
            solved(p_.gradient(y), q_.gradient(y), norm(slope) > 0 ? slope : across, f * Real{-1});
        if (!step) return std::nullopt;
        y = y + *step;
        if (norm(*step) <= 64 * kRounding * size_) return y;
    }
    return std::nullopt;
}

RealVec Rolled::approached(RealVec x, RealVec y) const {
    Real step = r_ / 16;
    while (step > 1e-9L * r_) {
        const RealVec way = unit(cross(p_.gradient(y), q_.gradient(y)));
        const Real sense = dot(x - y, way) < 0 ? -1 : 1;
        const auto next = nearby(y + way * (sense * step), r_);
        if (next && norm(*next - x) < norm(y - x)) {
            y = *next;
        } else {
            step /= 2;
        }
    }
    return y;
}

RealVec Rolled::nearest_along(RealVec x, RealVec y) const {
    constexpr int kSteps = 32;
    RealVec best = y;
    for (const Real sense : {Real{1}, Real{-1}}) {
        RealVec at = y;
        RealVec before = unit(cross(p_.gradient(y), q_.gradient(y))) * sense;
        for (int i = 0; i < kSteps; ++i) {
            RealVec way = unit(cross(p_.gradient(at), q_.gradient(at)));
            if (dot(way, before) < 0) way = way * Real{-1};
            const auto next = nearby(at + way * (r_ / kSteps), r_);
            if (!next) break;
            before = way;
            at = *next;
            if (norm(at - x) < norm(best - x)) best = at;
        }
    }
    return best;
}

std::optional<RealVec> Rolled::foot_from(RealVec x, RealVec y) const {
    const auto is_nearer = [&](const std::optional<RealVec>& foot) {
        return foot && norm(*foot - x) <= norm(y - x) + 1e-6L * r_;
    };
    if (const auto foot = polished_foot(x, y); is_nearer(foot)) return foot;
    // From a start that is next to a centre of curvature the steps may lead to another foot, farther away.
    const auto foot = polished_foot(x, approached(x, y));
    return is_nearer(foot) ? foot : std::nullopt;
}

std::optional<Rolled::Nearest> Rolled::on_spine(RealVec x, Care care) const {
    std::optional<Nearest> best;
    const auto beside = spines_.size() == 1 ? nearby(x, r_) : std::nullopt;
    Real least = std::numeric_limits<Real>::infinity();
    for (std::size_t s = 0; s < spines_.size(); ++s) {
        const auto look = [&](RealVec y) {
            const auto foot = foot_from(x, y);
            if (!foot || !(norm(*foot - x) < least)) return;
            least = norm(*foot - x);
            best = Nearest{*foot, s};
        };
        RealVec y;
        Real near = std::numeric_limits<Real>::infinity();
        for (const RealVec& point : spines_[s].points) {
            if (norm(point - x) < near) {
                near = norm(point - x);
                y = point;
            }
        }
        if (beside && norm(*beside - x) < near) {
            near = norm(*beside - x);
            y = *beside;
        }
        look(y);
        if (care == Care::quick) continue;
        for (const RealVec& point : spines_[s].points) {
            if (norm(point - x) < near + 0.25L * r_) look(nearest_along(x, point));
        }
    }
    return best;
}

bool Rolled::is_between_contacts(RealVec x, RealVec centre) const {
    const RealVec a = p_.gradient(centre) * Real{-1};
    const RealVec b = q_.gradient(centre) * Real{-1};
    // x - c = s a + t b, by products with a and b.
    const RealVec d = x - centre;
    const Real cosine = dot(a, b);
    return dot(d, a) - cosine * dot(d, b) >= 0 && dot(d, b) - cosine * dot(d, a) >= 0;
}

Side Rolled::closing(RealVec x, Real margin, Care care) const {
    const Real p = p_.distance(x);
    const Real q = q_.distance(x);
    if (p < -margin || q < -margin) return Side::in;
    if (p <= margin || q <= margin) return Side::unclear;
    if (p >= r_ && q >= r_) return Side::out;
    const Real slack = 256 * kRounding * size_;
    Real least = std::numeric_limits<Real>::infinity();
    bool is_blended = false;
    const auto try_foot = [&](const RealSurface& one, const RealSurface& other, Real d) {
        if (d >= r_) return;
        const RealVec y = x + one.gradient(x) * (r_ - d);
        if (std::fabs(one.distance(y) - r_) > slack || other.distance(y) < r_ - slack) return;
        least = std::min(least, r_ - d);
    };
    try_foot(p_, q_, p);
    try_foot(q_, p_, q);
    if (const auto spine = on_spine(x, care)) {
        const Real d = norm(spine->at - x);
        if (d < least) {
            least = d;
            is_blended = d < spines_[spine->spine].reach && is_between_contacts(x, spine->at);
        }
    }
    if (!is_blended || least < r_ - margin) return Side::out;
    return least > r_ + margin ? Side::in : Side::unclear;
}

}  // namespace raymo::laws
