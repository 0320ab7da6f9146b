#include "raymo/blends/profile_curve.hpp"

#include "raymo/blends/conic.hpp"

namespace raymo::blends {

std::optional<ProfileCurve::Ends> ProfileCurve::ends(const Station& station) const {
    const Vec3 a = station.contact[0];
    const Vec3 b = station.contact[1];
    const Vec3 out_a = (a - station.centre) / spine_.radius();
    const Vec3 out_b = (b - station.centre) / spine_.radius();
    if (!is_straight()) return Ends{a + out_a * depth_, b + out_b * depth_};
    const Vec3 chord = b - a;
    const double length = norm(chord);
    // The chord meets both faces at half the angle between their normals.
    const double sine = 0.5 * length / spine_.radius();
    const double beyond = depth_ / sine;
    if (!(beyond <= length)) return std::nullopt;
    const Vec3 more = chord * (beyond / length);
    return Ends{a - more, b + more};
}

double ProfileCurve::part(double from, double to, double v) const {
    if (v == 0.0) return from;
    if (v == 1.0) return to;
    if (is_straight()) return from + (to - from) * v;
    return ConicDistances(Level(0.0), 1.0, Level(0.0), 1.0, form_.shape).part(from, to, v);
}

bool ProfileCurve::append_points(const Station& station, std::span<const double> at,
                                 std::vector<Vec3>& out) const {
    const std::size_t first = out.size();
    if (is_straight()) {
        const auto end = ends(station);
        if (!end) return false;
        for (const double t : at) out.push_back(end->a * (1.0 - t) + end->b * t);
    } else if (!append_conic_points(station, at, out)) {
        return false;
    }
    for (std::size_t i = first; i < out.size(); ++i) {
        if (!(station.speed_of(out[i]) > 0.0)) return false;
    }
    return true;
}

bool ProfileCurve::append_conic_points(const Station& station, std::span<const double> at,
                                       std::vector<Vec3>& out) const {
    const Surface& a = spine_.surface(0);
    const Surface& b = spine_.surface(1);
    const ConicDistances conic(level_of(a), a.distance(station.contact[1]), level_of(b),
                               b.distance(station.contact[0]), form_.shape);
    // It keeps to the triangle of both contacts and the edge, and is followed from the nearer contact on.
    const Vec3 edge = spine_.segment().point(station.t);
    const double most = 2.0 * (norm(station.contact[0] - edge) + norm(station.contact[1] - edge));
    Vec3 p = station.contact[at.front() <= 0.5 ? 0 : 1];
    for (const double t : at) {
        if (t == 0.0 || t == 1.0) {
            p = station.contact[t == 0.0 ? 0 : 1];
        } else {
            const Vec3 last = p;
            const auto from = conic.at(1.0 - t);
            if (!to_distances(a, from.a, b, from.b, station.tangent, p)) return false;
            if (!(norm(p - last) <= most)) return false;
        }
        out.push_back(p);
    }
    return true;
}

}  // namespace raymo::blends
