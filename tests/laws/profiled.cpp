#include "tests/laws/profiled.hpp"

#include <cmath>

namespace raymo::laws {
namespace {

/// The function of a surface at a point.
Real function_at(const RealSurface& s, RealVec x) {
    const Real e = s.side * s.distance(x);
    switch (s.kind) {
        case RealSurface::Kind::sphere:
        case RealSurface::Kind::cylinder:
            return e * (2 * s.radius + e);
        case RealSurface::Kind::torus:
            return e * (2 * s.tube + e);
        case RealSurface::Kind::plane:
        case RealSurface::Kind::cone:
            break;
    }
    return e;
}

}  // namespace

Profiled::Section Profiled::section_at(RealVec centre) const {
    Section out;
    const RealVec to_p = rolled_.p().gradient(centre);
    const RealVec to_q = rolled_.q().gradient(centre);
    out.centre = centre;
    out.a = centre - to_p * radius_;
    out.b = centre - to_q * radius_;
    const RealVec across = cross(cross(to_p, to_q), out.b - out.a);
    out.outward = unit(dot(across, to_p) < 0 ? across : across * Real{-1});
    return out;
}

Real Profiled::level(const Section& section, RealVec x) const {
    if (!shape_) return dot(x - section.a, section.outward) / radius_;
    const Real g = function_at(rolled_.p(), x) / function_at(rolled_.p(), section.b);
    const Real h = function_at(rolled_.q(), x) / function_at(rolled_.q(), section.a);
    // The root of the condition's two sides, which has the same sign.
    return 1 - g - h - std::sqrt(2 * (1 - *shape_) * std::max(g, Real{0}) * std::max(h, Real{0}));
}

bool Profiled::is_seen(const Section& section, RealVec x, Real margin) const {
    constexpr int kMostSteps = 400;
    const RealVec d = section.centre - x;
    const Real length = norm(d);
    Real at = 0;
    for (int i = 0; i < kMostSteps; ++i) {
        const RealVec p = x + d * (at / length);
        const Real free = std::min(rolled_.p().distance(p), rolled_.q().distance(p));
        if (free < margin / 2) return false;
        at += free;
        if (at >= length) return true;
    }
    return false;
}

Side Profiled::filled(RealVec x, Real margin) const {
    const Real p = rolled_.p().distance(x);
    const Real q = rolled_.q().distance(x);
    if (p < -margin || q < -margin) return Side::in;
    if (p <= margin || q <= margin) return Side::unclear;
    const auto spine = rolled_.on_spine(x);
    if (!spine) return Side::out;
    const Section section = section_at(spine->at);
    // Where the conic runs is told by how its function changes in the plane across.
    const RealVec along = unit(section.b - section.a);
    const Real step = 1e-5L * radius_;
    const Real by_u = level(section, x + along * step) - level(section, x - along * step);
    const Real by_v =
        level(section, x + section.outward * step) - level(section, x - section.outward * step);
    const RealVec way = unit(along * by_u + section.outward * by_v) * margin;
    const bool is_in = level(section, x) > 0;
    if ((level(section, x + way) > 0) != is_in || (level(section, x - way) > 0) != is_in)
        return Side::unclear;
    if (!is_in) return Side::out;
    // Between the lines through the contacts.
    const RealVec to_a = unit(section.a - section.centre);
    const RealVec to_b = unit(section.b - section.centre);
    const RealVec d = x - section.centre;
    const Real cosine = dot(to_a, to_b);
    const Real part_a = dot(d, to_a) - cosine * dot(d, to_b);
    const Real part_b = dot(d, to_b) - cosine * dot(d, to_a);
    if (part_a < -margin || part_b < -margin) return Side::out;
    if (part_a <= margin || part_b <= margin) return Side::unclear;
    return is_seen(section, x, margin) ? Side::in : Side::unclear;
}

Real Profiled::begins(RealVec c, RealVec way) const {
    const Section section = section_at(c);
    const Real toward = dot(way, section.outward);
    if (!(toward > 0)) return radius_;
    Real before = dot(section.a - c, section.outward) / toward;
    if (!shape_) return before;
    // From the chord on, where nothing is filled, to where one of the solids is.
    Real after = before;
    const auto free = [&](Real t) {
        const RealVec x = c + way * t;
        return std::min(rolled_.p().distance(x), rolled_.q().distance(x));
    };
    for (int i = 0; i < 200 && free(after) > 1e-12L * radius_; ++i) {
        after += free(after);
        if (after > 100 * radius_) return radius_;
    }
    for (int i = 0; i < 64; ++i) {
        const Real middle = (before + after) / 2;
        (level(section, c + way * middle) > 0 ? after : before) = middle;
    }
    return before;
}

}  // namespace raymo::laws
