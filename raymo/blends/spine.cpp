#include "raymo/blends/spine.hpp"

#include <algorithm>
#include <cmath>

#include "raymo/math/tolerance.hpp"

namespace raymo::blends {
namespace {

/// Nodes of the edge from one coarse place to the next.
constexpr std::size_t kStride = 8;

}  // namespace

Vec3 value_at(const Cubic& c, double u) {
    const double w = 1.0 - u;
    return c[0] * (w * w * w) + c[1] * (3.0 * w * w * u) + c[2] * (3.0 * w * u * u) +
           c[3] * (u * u * u);
}

Vec3 slope_at(const Cubic& c, double u) {
    const double w = 1.0 - u;
    return (c[1] - c[0]) * (w * w) + (c[2] - c[1]) * (2.0 * w * u) + (c[3] - c[2]) * (u * u);
}

double round_handle(Vec3 p, Vec3 from, Vec3 q, Vec3 to) {
    const double chord = norm(q - p);
    const double angle = std::atan2(norm(cross(from, to)), dot(from, to));
    if (angle < 0x1p-20) return chord / 3.0;
    return chord * (2.0 / 3.0) * std::tan(0.25 * angle) / std::sin(0.5 * angle);
}

Spine::Spine(const Body& body, const Segment& segment, double radius)
    : body_(body),
      segment_(segment),
      a_(body.faces()[segment.face_a].surface),
      b_(body.faces()[segment.face_b].surface),
      radius_(radius) {
    const Vec3 at = segment.point(segment.middle());
    rounding_ = 64.0 * kUnitRoundoff *
                (max_norm(body.box().size()) + max_norm(at) + max_norm(at - a_.point) +
                 max_norm(at - b_.point) + a_.radius + b_.radius + radius);
}

bool Spine::complete(Station& station, Vec3 sense) const {
    const double s = segment_.sign();
    const Vec3 c = station.centre;
    const Vec3 normal[2] = {outward(0, c), outward(1, c)};
    const auto way_at = [&](Vec3 p) {
        const Vec3 t = cross(outward(0, p), outward(1, p));
        return dot(t, sense) < 0.0 ? -t : t;
    };
    const Vec3 way = way_at(c);
    if (!(norm(way) > kSmooth)) return false;
    station.tangent = unit(way);
    // Differences along the tangent: what the path's own curvature adds is the same at both ends.
    const double h = 0x1p-14 * radius_;
    const Vec3 ahead = c + station.tangent * h;
    const Vec3 behind = c - station.tangent * h;
    const Vec3 turn = (unit(way_at(ahead)) - unit(way_at(behind))) * (0.5 / h);
    station.bend = turn - station.tangent * dot(turn, station.tangent);
    for (std::size_t i = 0; i < 2; ++i) {
        station.contact[i] = c - normal[i] * (s * radius_);
        // Past a surface's centre or axis its normal turns over.
        if (!(dot(normal[i], outward(i, station.contact[i])) > 0.0)) return false;
        station.way[i] =
            station.tangent - (outward(i, ahead) - outward(i, behind)) * (s * radius_ * 0.5 / h);
    }
    return is_finite(station.bend) && is_finite(station.way[0]) && is_finite(station.way[1]);
}

std::optional<Station> Spine::at(double t) const {
    const auto touch = touch_at(body_, segment_, radius_, t);
    if (!touch) return std::nullopt;
    Station station;
    station.t = t;
    station.centre = touch->centre;
    if (!complete(station, segment_.tangent(t))) return std::nullopt;
    return station;
}

std::optional<Station> Spine::between(const Station& from, const Station& to, Vec3 centre) const {
    const double s = segment_.sign();
    const Vec3 way = to.centre - from.centre;
    Station station;
    station.centre = centre;
    station.t = 0.5 * (from.t + to.t);
    if (!to_distances(a_, side(0) * s * radius_, b_, side(1) * s * radius_, unit(way),
                      station.centre)) {
        return std::nullopt;
    }
    if (!(norm(station.centre - centre) < norm(way))) return std::nullopt;
    if (!complete(station, from.tangent + to.tangent)) return std::nullopt;
    return station;
}

std::optional<Vec3> Spine::beside(Vec3 p, Vec3 across) const {
    const double s = segment_.sign();
    if (!to_distances(a_, side(0) * s * radius_, b_, side(1) * s * radius_, across, p)) {
        return std::nullopt;
    }
    return p;
}

double Spine::off(Vec3 c) const {
    // The shortest step to both distances.
    const double s = segment_.sign();
    const double off_a = a_.distance(c) - side(0) * s * radius_;
    const double off_b = b_.distance(c) - side(1) * s * radius_;
    const Vec3 na = a_.normal(c);
    const Vec3 nb = b_.normal(c);
    const double cosine = dot(na, nb);
    const double sine = norm(cross(na, nb));
    const double square = off_a * off_a + off_b * off_b - 2.0 * cosine * off_a * off_b;
    return std::sqrt(std::max(square, 0.0)) / sine;
}

Cubic path_between(const Station& from, const Station& to) {
    const Vec3 d = to.centre - from.centre;
    const double round = round_handle(from.centre, from.tangent, to.centre, to.tangent);
    double a = round;
    double b = round;
    // The curvatures of the cubic with these handles are (2/3) |d - b T'| across T / a^2, and so on.
    const double bend_a = norm(from.bend);
    const double bend_b = norm(to.bend);
    if (std::min(bend_a, bend_b) * norm(d) > 0x1p-8) {
        const Vec3 across_a = from.bend / bend_a;
        const Vec3 across_b = to.bend / bend_b;
        const double cross_a = dot(to.tangent, across_a);
        const double cross_b = dot(from.tangent, across_b);
        for (int i = 0; i < 6; ++i) {
            const double off_a = 1.5 * bend_a * a * a + b * cross_a - dot(d, across_a);
            const double off_b = 1.5 * bend_b * b * b - a * cross_b + dot(d, across_b);
            const double det = 9.0 * bend_a * a * bend_b * b + cross_a * cross_b;
            if (det == 0.0) break;
            a -= (3.0 * bend_b * b * off_a - cross_a * off_b) / det;
            b -= (3.0 * bend_a * a * off_b + cross_b * off_a) / det;
        }
        if (!(std::fabs(a - round) < 0.25 * round && std::fabs(b - round) < 0.25 * round)) {
            a = b = round;
        }
    }
    return {from.centre, from.centre + from.tangent * a, to.centre - to.tangent * b, to.centre};
}

std::vector<Station> coarse_stations(const Spine& spine, double lo, double hi) {
    const SpaceEdge& edge = *spine.segment().space;
    std::vector<double> at{lo};
    const std::size_t nodes = edge.steps() * (edge.is_closed() ? 3 : 1);
    const double turn = edge.is_closed() ? edge.last() : 0.0;
    std::size_t since = 0;
    for (std::size_t i = 0; i <= nodes; ++i) {
        const double t = edge.node(i) - turn;
        if (t <= lo || t >= hi || ++since < kStride) continue;
        since = 0;
        at.push_back(t);
    }
    at.push_back(hi);
    std::vector<Station> out;
    const bool is_ring = spine.is_ring(lo, hi);
    for (const double t : at) {
        if (is_ring && t == hi) {
            out.push_back(out.front());
            out.back().t = hi;
            break;
        }
        auto station = spine.at(t);
        if (!station) return {};
        out.push_back(*station);
    }
    return out;
}

}  // namespace raymo::blends
